//! Which places of a mesh are known to be connected.

use super::corridor::Way;
use super::results::{RateBounds, Rates};

/// The known paths between all pairs of places, the last of which is `free`: which basins have a
/// path there, which have none on the mesh, and which paths contact blocks.
pub(super) fn links(ways: &[Way], closed: &[bool], blocked: &[Vec<bool>]) -> Vec<Vec<Way>> {
    let is_free = |place: usize| place == ways.len();
    let is_open = |place: usize| is_free(place) || ways[place] == Way::Open;
    let is_closed = |place: usize| !is_free(place) && closed[place];
    let link = |from: usize, to: usize| match () {
        () if from == to => Way::Open,
        () if blocked[from][to] => Way::Blocked,
        () if is_closed(from) || is_closed(to) || is_open(from) != is_open(to) => Way::Lost,
        () => Way::Open,
    };
    let all = 0..=ways.len();
    all.clone()
        .map(|from| all.clone().map(|to| link(from, to)).collect())
        .collect()
}

impl RateBounds {
    /// The same without rates that are unknown because no path was found, and with 0 where contact
    /// proves that there is none.
    pub(super) fn known(mut self, links: &[Vec<Way>]) -> Self {
        const NOTHING: [f64; 2] = [0.0, f64::INFINITY];
        for (from, links) in links.iter().enumerate() {
            for (to, way) in links.iter().enumerate() {
                match way {
                    Way::Open => {}
                    Way::Blocked => self.rates[from][to] = [0.0; 2],
                    Way::Lost => self.rates[from][to] = NOTHING,
                }
            }
            let mut others = links.iter().enumerate().filter(|(to, _)| *to != from);
            if others.clone().any(|(_, way)| *way == Way::Lost) {
                self.leaving[from] = NOTHING;
            } else if others.all(|(_, way)| *way == Way::Blocked) {
                self.leaving[from] = [0.0; 2];
            }
        }
        self
    }
}

impl Rates {
    /// Whether a rate is known: a path was found between the two places, or contact proves that
    /// there is none.
    pub fn is_known(&self, from: usize, to: usize) -> bool {
        self.links[from][to] != Way::Lost
    }

    /// The same for the rate out of a place, by all paths.
    pub fn is_known_out(&self, from: usize) -> bool {
        (0..self.links.len()).all(|to| to == from || self.is_known(from, to))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three basins: one with a path out, one closed by contact, one without a known path.
    #[test]
    fn nothing_is_claimed_without_a_way_and_none_where_contact_blocks_all() {
        let ways = [Way::Open, Way::Blocked, Way::Lost];
        let closed = [false, true, true];
        let no_way = |from: usize, to: usize| (from == 1) != (to == 1);
        let blocked: Vec<Vec<bool>> = (0..4)
            .map(|from| (0..4).map(|to| no_way(from, to)).collect())
            .collect();
        let links = links(&ways, &closed, &blocked);
        let bounds = RateBounds {
            leaving: vec![[1.0, 2.0]; 4],
            rates: vec![vec![[1.0, 2.0]; 4]; 4],
        };
        let known = bounds.known(&links);
        let nothing = [0.0, f64::INFINITY];
        assert_eq!(known.rates[0][3], [1.0, 2.0]);
        assert_eq!(known.rates[3][0], [1.0, 2.0]);
        for other in [0, 2, 3] {
            assert_eq!(known.rates[1][other], [0.0; 2]);
            assert_eq!(known.rates[other][1], [0.0; 2]);
        }
        for other in [0, 3] {
            assert_eq!(known.rates[2][other], nothing);
            assert_eq!(known.rates[other][2], nothing);
        }
        assert_eq!(known.leaving[1], [0.0; 2]);
        for from in [0, 2, 3] {
            assert_eq!(known.leaving[from], nothing);
        }
    }
}
