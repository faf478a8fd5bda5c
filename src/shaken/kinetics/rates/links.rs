//! Which places of a mesh are known to be connected.

use super::corridor::PathToFree;
use super::results::Rates;

/// The known paths between all pairs of places, the last of which is `free`: which basins have a
/// path there, which have none on the mesh, and which paths contact blocks.
pub(super) fn links(
    ways: &[PathToFree],
    closed: &[bool],
    blocked: &[Vec<bool>],
) -> Vec<Vec<PathToFree>> {
    let is_free = |place: usize| place == ways.len();
    let is_open = |place: usize| is_free(place) || ways[place] == PathToFree::Open;
    let is_closed = |place: usize| !is_free(place) && closed[place];
    let link = |from: usize, to: usize| match () {
        () if from == to => PathToFree::Open,
        () if blocked[from][to] => PathToFree::Blocked,
        () if is_closed(from) || is_closed(to) || is_open(from) != is_open(to) => PathToFree::Lost,
        () => PathToFree::Open,
    };
    let all = 0..=ways.len();
    all.clone()
        .map(|from| all.clone().map(|to| link(from, to)).collect())
        .collect()
}

impl Rates {
    /// Whether a rate is known: a path was found between the two places, or contact proves that
    /// there is none.
    pub fn is_known(&self, from: usize, to: usize) -> bool {
        self.links[from][to] != PathToFree::Lost
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
    fn a_way_is_known_if_it_was_found_or_is_blocked() {
        let ways = [PathToFree::Open, PathToFree::Blocked, PathToFree::Lost];
        let closed = [false, true, true];
        let no_way = |from: usize, to: usize| (from == 1) != (to == 1);
        let blocked: Vec<Vec<bool>> = (0..4)
            .map(|from| (0..4).map(|to| no_way(from, to)).collect())
            .collect();
        let links = links(&ways, &closed, &blocked);
        assert_eq!([links[0][3], links[3][0]], [PathToFree::Open; 2]);
        for other in [0, 2, 3] {
            assert_eq!([links[1][other], links[other][1]], [PathToFree::Blocked; 2]);
        }
        for other in [0, 3] {
            assert_eq!([links[2][other], links[other][2]], [PathToFree::Lost; 2]);
        }
    }
}
