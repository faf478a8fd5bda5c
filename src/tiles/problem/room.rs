//! The room of the moving tile: the configurations that the table's rim and the fixed tile leave.

use std::f64::consts::TAU;

use super::Problem;
use crate::configuration::Configuration;
use crate::parallel;
use crate::tile::Outline;

/// Number of examined configurations. Evenly spread, they measure a volume to about its surface
/// times their distance: within a few thousandths.
const EXAMINED: usize = 1 << 15;
/// Bases of Halton's sequence along x, y and theta.
const BASES: [usize; 3] = [2, 3, 5];

/// There is no room.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "the table leaves the moving tile no place beside the fixed one: enlarge `size` in [table]"
)]
pub struct NoRoom;

/// The room of the moving tile.
#[derive(Clone, Debug, PartialEq)]
pub struct Room {
    /// Evenly spread configurations of it: the free ones of Halton's sequence (1960,
    /// doi:10.1007/BF01386213).
    pub places: Vec<Configuration>,
    /// Its volume over 2 pi (m^2): the area that is left to the reference point, averaged over
    /// theta.
    pub area: f64,
}

impl Room {
    /// The room of a problem's moving tile. All of the tile is inside the rim.
    ///
    /// # Errors
    /// If there is none.
    pub fn new(problem: &Problem) -> Result<Self, NoRoom> {
        Self::within(problem, problem.space.half_size)
    }

    /// The same on a table of another half size (m) along x and y.
    ///
    /// # Errors
    /// If there is none.
    pub fn within(problem: &Problem, half_size: [f64; 2]) -> Result<Self, NoRoom> {
        let [x, y] = half_size;
        let size = [2.0 * x, 2.0 * y, TAU];
        let place = |k: usize| {
            let at = |axis: usize| (spread(k, BASES[axis]) - 0.5) * size[axis];
            let q = Configuration::new(at(0), at(1), at(2));
            (is_inside_the_rim(problem, &q, half_size) && problem.is_free(&q)).then_some(q)
        };
        let places = parallel::flat_map(1..EXAMINED + 1, place);
        let area = 4.0 * x * y * places.len() as f64 / EXAMINED as f64;
        match places.is_empty() {
            true => Err(NoRoom),
            false => Ok(Self { places, area }),
        }
    }
}

/// Whether the rim is around all of the moving tile.
fn is_inside_the_rim(problem: &Problem, q: &Configuration, half_size: [f64; 2]) -> bool {
    let is_inside = |tile: &Outline| tile.beyond_rim(q, half_size) <= 0.0;
    let contact = problem.contact.as_ref();
    contact.is_none_or(|contact| is_inside(contact.moving()))
}

/// The radical inverse: the digits of a whole number after the point, in reverse order.
fn spread(mut k: usize, base: usize) -> f64 {
    let (mut found, mut digit) = (0.0, 1.0);
    while k > 0 {
        digit /= base as f64;
        found += digit * (k % base) as f64;
        k /= base;
    }
    found
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::sample;

    /// Squares of side a on a table of width w: over all angles their width a (|cos| + |sin|) has the
    /// mean 4 a / pi and the mean square a^2 (1 + 2 / pi), and they block 2 a^2 + (4 a)^2 / 2 pi.
    #[test]
    fn the_room_of_squares() {
        let (w, a) = (2.0, 0.43);
        let mut problem = sample::pair(4, a, [&[0], &[2]]);
        let inside = w * w - 8.0 * w * a / PI + a * a * (1.0 + 2.0 / PI);
        let blocked = 2.0 * a * a + (4.0 * a).powi(2) / TAU;
        let found = Room::new(&problem).unwrap();
        assert!(
            (found.area / (inside - blocked) - 1.0).abs() < 3e-3,
            "{}",
            found.area
        );
        problem.space.half_size = [a; 2];
        assert_eq!(Room::new(&problem), Err(NoRoom));
    }
}
