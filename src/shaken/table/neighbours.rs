//! Neighbour lists: tiles within reach of each other, valid until a tile has moved too far.

use nalgebra::Vector2;

/// Pairs of points within a distance plus a margin, valid until a point has moved by half the
/// margin.
#[derive(Default)]
pub struct Neighbours {
    /// Pairs i < j, in order.
    pairs: Vec<[usize; 2]>,
    places: Vec<Vector2<f64>>,
    skin: f64,
}

impl Neighbours {
    /// All pairs of points within `range` (m), and some that are slightly farther apart.
    pub fn within(&mut self, range: f64, places: &[Vector2<f64>]) -> &[[usize; 2]] {
        let moved = |(now, then): (&Vector2<f64>, &Vector2<f64>)| (now - then).norm_squared();
        let farthest = places.iter().zip(&self.places).map(moved);
        let farthest = farthest.fold(0.0, f64::max).sqrt();
        if self.places.len() != places.len() || 2.0 * farthest > self.skin {
            self.skin = 0.1 * range;
            self.places = places.to_vec();
            self.pairs = pairs(range + self.skin, places);
        }
        &self.pairs
    }
}

/// All pairs of points within a range (m), found with a grid of cells of this size.
fn pairs(range: f64, places: &[Vector2<f64>]) -> Vec<[usize; 2]> {
    let low = places
        .iter()
        .fold(Vector2::repeat(f64::INFINITY), |low, p| low.inf(p));
    let high = places
        .iter()
        .fold(Vector2::repeat(f64::NEG_INFINITY), |high, p| high.sup(p));
    // Along each side at most as many cells as points.
    let most = places.len() as f64;
    let count = |extent: f64| (extent / range).floor().clamp(1.0, most.max(1.0));
    let counts = (high - low).map(count);
    let size = (high - low).component_div(&counts);
    let index = |value: f64, size: f64, count: f64| match size > 0.0 {
        true => (value / size).floor().clamp(0.0, count - 1.0) as usize,
        false => 0,
    };
    let [columns, rows] = [counts.x as usize, counts.y as usize];
    let mut cells: Vec<Vec<usize>> = vec![Vec::new(); columns * rows];
    let cell = |p: &Vector2<f64>| {
        let from = p - low;
        [
            index(from.x, size.x, counts.x),
            index(from.y, size.y, counts.y),
        ]
    };
    for (i, p) in places.iter().enumerate() {
        let [column, row] = cell(p);
        cells[row * columns + column].push(i);
    }
    let mut found = Vec::new();
    for (i, p) in places.iter().enumerate() {
        let [column, row] = cell(p);
        for row in row.saturating_sub(1)..(row + 2).min(rows) {
            for column in column.saturating_sub(1)..(column + 2).min(columns) {
                let others = cells[row * columns + column].iter();
                let near =
                    others.filter(|&&j| i < j && (places[j] - p).norm_squared() <= range * range);
                found.extend(near.map(|&j| [i, j]));
            }
        }
    }
    found.sort_unstable();
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn no_pair_is_missed() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(3);
        let mut places: Vec<Vector2<f64>> = (0..300)
            .map(|_| Vector2::new(7.0 * rng.random::<f64>(), 3.0 * rng.random::<f64>()))
            .collect();
        let mut list = Neighbours::default();
        for range in [0.4, 20.0] {
            for _ in 0..5 {
                let found = list.within(range, &places).to_vec();
                for i in 0..places.len() {
                    for j in i + 1..places.len() {
                        let is_near = (places[i] - places[j]).norm() <= range;
                        assert!(!is_near || found.contains(&[i, j]), "{i} {j}");
                    }
                }
                for p in &mut places {
                    *p += Vector2::new(rng.random::<f64>() - 0.5, rng.random::<f64>() - 0.5) * 0.02;
                }
            }
            list = Neighbours::default();
        }
    }
}
