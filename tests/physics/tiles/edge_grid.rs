//! Edges near a point.

use nalgebra::Vector2;
use tilebind::tile::edge_grid::EdgeGrid;
use tilebind::tile::outline::distance_to_segment;

#[test]
fn no_near_edge_is_missed() {
    let n = 90;
    let vertices: Vec<Vector2<f64>> = (0..n)
        .map(|i| {
            let angle = i as f64 / n as f64 * std::f64::consts::TAU;
            let radius = if i % 2 == 0 { 0.2 } else { 0.15 };
            Vector2::new(radius * angle.cos(), 1.3 * radius * angle.sin())
        })
        .collect();
    let grid = EdgeGrid::new(&vertices);
    let mut found = Vec::new();
    let mut left_out = 0;
    for i in 0..60 {
        for j in 0..60 {
            let p = Vector2::new(-0.3 + 0.01 * i as f64, -0.3 + 0.0101 * j as f64);
            grid.near(p, 0.011, &mut found);
            for (edge, a) in vertices.iter().enumerate() {
                let b = vertices[(edge + 1) % n];
                let near = distance_to_segment(p, *a, b) <= 0.011;
                assert!(!near || found.contains(&(edge as u32)), "{p} {edge}");
            }
            left_out += n - found.len();
        }
    }
    assert!(left_out > 60 * 60 * 80);
}
