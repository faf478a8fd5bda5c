//! Outlines: area and moments, convex parts, and rejected polygons.

use nalgebra::Vector2;
use tilebind::tile::Outline;
use tilebind::tile::outline::OutlineError;

fn outline(points: &[[f64; 2]]) -> Result<Outline, OutlineError> {
    Outline::new(points.iter().map(|p| Vector2::new(p[0], p[1])).collect())
}

#[test]
fn a_square_has_the_textbook_area_and_moments() {
    let square = outline(&[[1.0, 1.0], [3.0, 1.0], [3.0, 3.0], [1.0, 3.0]]).unwrap();
    assert!((square.area() - 4.0).abs() < 1e-14);
    assert!((square.centroid() - Vector2::new(2.0, 2.0)).norm() < 1e-14);
    // Polar second moment of a square of side a: a^4 / 6.
    assert!((square.second_moment_about_centroid() - 16.0 / 6.0).abs() < 1e-12);
}

#[test]
fn a_saw_blade_keeps_its_notches() {
    let mut points = vec![[0.0, 0.0], [4.0, 0.0]];
    for k in 0..4 {
        points.push([4.0 - k as f64, 2.0]);
        points.push([3.5 - k as f64, 1.0]);
    }
    points.push([0.0, 2.0]);
    let saw = outline(&points).unwrap();
    assert!(!saw.contains(Vector2::new(3.5, 1.5)));
    let in_parts = |p: Vector2<f64>| {
        saw.parts().iter().any(|part| {
            part.points
                .iter()
                .zip(&part.normals)
                .all(|(q, n)| n.dot(&(p - q)) <= 0.0)
        })
    };
    for i in 0..80 {
        for j in 0..40 {
            let p = Vector2::new(0.0251 + i as f64 * 0.05, 0.0249 + j as f64 * 0.05);
            assert_eq!(in_parts(p), saw.contains(p), "{p}");
        }
    }
}

#[test]
fn wrong_outlines_are_refused() {
    let clockwise = [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]];
    assert_eq!(outline(&clockwise).unwrap_err(), OutlineError::Clockwise);
    let bow_tie = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
    assert!(matches!(
        outline(&bow_tie).unwrap_err(),
        OutlineError::SelfCrossing(..)
    ));
    let spike = [[0.0, 0.0], [2.0, 0.0], [1.0, 0.0], [1.0, 1.0]];
    assert!(matches!(
        outline(&spike).unwrap_err(),
        OutlineError::SelfCrossing(..)
    ));
}

#[test]
fn points_on_straight_lines_are_dropped() {
    let square = outline(&[[0.0, 0.0], [0.5, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
    assert_eq!(square.unwrap().vertices().len(), 4);
}
