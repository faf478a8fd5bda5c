//! Tests of how outlines match.

use nalgebra::Vector2;

use super::{Facing, matches};

/// The side of a square of 0.2 m that the moving edge lies on once it is shifted.
#[test]
fn edges_touch_where_both_ends_of_one_lie_on_the_other_s_line() {
    let fixed = [[0.1, -0.1], [0.1, 0.1]].map(Vector2::from);
    let stretch = |from: [f64; 2], to: [f64; 2], shift: [f64; 2]| {
        let facing = Facing::new(fixed, [from, to].map(Vector2::from), 0.0);
        facing
            .stretch(shift.into(), super::TOUCHING)
            .map(|ends| ends.map(|p| p.y))
    };
    let close = |found: Option<[f64; 2]>, low: f64, high: f64| {
        let [a, b] = found.expect("they touch");
        assert!((a - low).abs() < 1e-12 && (b - high).abs() < 1e-12);
    };
    close(stretch([0.0, 0.05], [0.0, -0.03], [0.1, 0.0]), -0.03, 0.05);
    close(stretch([0.0, 0.05], [0.0, -0.03], [0.1, 0.08]), 0.05, 0.1);
    close(stretch([0.0, 0.5], [0.0, -0.5], [0.1, 0.0]), -0.1, 0.1);
    // Slanted, so that one end touches; off the line; beyond the end.
    assert_eq!(stretch([0.0, 0.05], [0.02, -0.03], [0.1, 0.0]), None);
    assert_eq!(stretch([0.02, 0.05], [0.0, -0.03], [0.1, 0.0]), None);
    assert_eq!(stretch([0.0, 0.05], [0.0, -0.03], [0.11, 0.0]), None);
    assert_eq!(stretch([0.0, 0.05], [0.0, -0.03], [0.1, 0.2]), None);
}

#[test]
fn outlines_of_squares_match_along_their_sides() {
    let square = crate::tile::Outline::new(
        [[0.1, -0.1], [0.1, 0.1], [-0.1, 0.1], [-0.1, -0.1]]
            .map(Vector2::from)
            .to_vec(),
    )
    .unwrap();
    let contact = crate::contact::Contact::new(&square, &square);
    let found = matches(&contact, 100);
    // Each of four sides on each of four.
    let full = found.iter().filter(|it| (it.contact - 0.2).abs() < 1e-9);
    assert_eq!(full.count(), 16);
    assert!(
        found
            .iter()
            .all(|it| it.contact <= 0.2 + 1e-9 && it.gap == 0.0)
    );
}

#[test]
fn the_gap_of_a_match_is_what_neither_tile_fills_of_the_hull() {
    // A tab 30 mm wide in a notch 40 mm wide, both 20 mm deep: a slit on either side is left.
    let notched = [
        [0.1, -0.1],
        [0.1, -0.02],
        [0.08, -0.02],
        [0.08, 0.02],
        [0.1, 0.02],
        [0.1, 0.1],
        [-0.1, 0.1],
        [-0.1, -0.1],
    ];
    let tabbed = [
        [0.1, -0.1],
        [0.1, 0.1],
        [-0.1, 0.1],
        [-0.1, 0.015],
        [-0.12, 0.015],
        [-0.12, -0.015],
        [-0.1, -0.015],
        [-0.1, -0.1],
    ];
    let outline = |corners: &[[f64; 2]]| {
        crate::tile::Outline::new(corners.iter().map(|p| Vector2::from(*p)).collect()).unwrap()
    };
    let contact = crate::contact::Contact::new(&outline(&notched), &outline(&tabbed));
    let found = matches(&contact, 1000);
    let middle = found
        .iter()
        .find(|it| (it.contact - 0.19).abs() < 1e-9 && it.pose.y.abs() < 1e-9)
        .expect("shoulders and tip touch");
    // The hull runs straight from the tip's corners to the shoulders' ends and cuts a triangle off
    // each slit.
    let cut = 0.5 * 0.005 * (0.005 * 0.02 / 0.085);
    let gap = 2.0 * (0.005 * 0.02 - cut);
    assert!((middle.gap - gap).abs() < 1e-12, "{middle:?} {gap}");
}
