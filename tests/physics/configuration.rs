//! Angles, motions between configurations and their inverses.

use std::f64::consts::PI;

use nalgebra::Vector2;
use tilebind::configuration::{Configuration, wrap_angle};

#[test]
fn angles_are_wrapped_into_the_half_open_interval() {
    assert_eq!(wrap_angle(PI), PI);
    assert_eq!(wrap_angle(-PI), PI);
    assert!((wrap_angle(3.5 * PI) + 0.5 * PI).abs() < 1e-15);
    assert_eq!(wrap_angle(1.0), 1.0);
}

#[test]
fn interpolation_takes_the_shorter_way_round() {
    let a = Configuration::new(0.0, 0.0, 3.0);
    let b = Configuration::new(1.0, 2.0, -3.0);
    let m = a.interpolate(&b, 0.5);
    assert!((m.x - 0.5).abs() < 1e-15 && (m.y - 1.0).abs() < 1e-15);
    assert!((m.theta.abs() - PI).abs() < 1e-12);
}

#[test]
fn the_inverse_undoes_the_transform() {
    let q = Configuration::new(0.3, -0.2, 1.1);
    let p = Vector2::new(0.7, 0.4);
    assert!((q.inverse_transform(q.transform(p)) - p).norm() < 1e-15);
    assert!((q.inverse().transform(q.transform(p)) - p).norm() < 1e-15);
}
