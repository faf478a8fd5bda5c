//! Contour lines of values on a grid.

/// A place on the grid, in steps.
pub type GridPosition = (f64, f64);

/// The pieces of a contour line of values on a grid, by marching triangles: each square is cut
/// along a diagonal, and a line crosses each triangle in at most one piece.
pub fn contour(values: &[f64], [columns, rows]: [usize; 2], level: f64) -> Vec<[GridPosition; 2]> {
    let corner = |i: usize, j: usize| ((i as f64, j as f64), values[j * columns + i]);
    let mut pieces = Vec::new();
    for j in 0..rows.saturating_sub(1) {
        for i in 0..columns.saturating_sub(1) {
            let [a, b, c, d] = [
                corner(i, j),
                corner(i + 1, j),
                corner(i + 1, j + 1),
                corner(i, j + 1),
            ];
            for triangle in [[a, b, c], [a, c, d]] {
                let crossings: Vec<GridPosition> = (0..3)
                    .filter_map(|k| {
                        let (p, q) = (triangle[k], triangle[(k + 1) % 3]);
                        let crosses = (p.1 < level) != (q.1 < level);
                        let t = (level - p.1) / (q.1 - p.1);
                        let between = |a: f64, b: f64| a + (b - a) * t;
                        crosses.then(|| (between(p.0.0, q.0.0), between(p.0.1, q.0.1)))
                    })
                    .collect();
                if let [p, q] = crossings[..] {
                    pieces.push([p, q]);
                }
            }
        }
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::contour;

    #[test]
    fn the_contour_of_a_plane_is_a_straight_line() {
        // Values x + y on 4 x 3 points; the level 2.5 is the line x + y = 2.5.
        let values: Vec<f64> = (0..12).map(|k| (k % 4 + k / 4) as f64).collect();
        let pieces = contour(&values, [4, 3], 2.5);
        assert!(!pieces.is_empty());
        assert!(
            pieces
                .iter()
                .flatten()
                .all(|p| (p.0 + p.1 - 2.5).abs() < 1e-12)
        );
        assert!(contour(&values, [4, 3], 9.0).is_empty());
    }
}
