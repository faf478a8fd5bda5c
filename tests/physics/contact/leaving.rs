//! Tests whether contact is left once and for all on the way out.

use nalgebra::Vector2;
use tilebind::{Configuration, Design};

/// Along rays at 1100 angles and directions: whether contact lies inwards of where it is left.
fn is_left_once(name: &str) -> (f64, bool) {
    let path = format!("shapes/{name}.toml");
    let problem = Design::load(path.as_ref()).unwrap().problem();
    let contact = problem.contact.as_ref().unwrap();
    // Both about the bond and all over.
    let rays = (0..1100).map(|k| {
        let (a, b) = (f64::from(k % 33) - 16.0, f64::from(k / 33) - 16.0);
        let wide = if k % 2 == 0 { 0.19 } else { 0.004 };
        [wide * a, wide * b]
    });
    let is_left = |[phi, theta]: [f64; 2]| {
        let out = Vector2::new(libm::cos(phi), libm::sin(phi));
        let place = |r: f64| Configuration::new(r * out.x, r * out.y, theta);
        let end = contact.landing(&place(0.0), out).unwrap();
        let inwards = (1..120).map(|k| end - 5e-4 * f64::from(k) - 1e-6);
        inwards
            .filter(|r| *r > 0.0)
            .all(|r| !contact.is_free(&place(r)))
    };
    let mut rays = rays;
    (contact.least_lever(), rays.all(is_left))
}

#[test]
fn contact_with_a_positive_lever_is_left_once() {
    for name in [
        "paper-tile",
        "tab-20mm",
        "slot-15mm",
        "snug-tab",
        "dogleg",
        "arrowhead",
    ] {
        let (lever, once) = is_left_once(name);
        assert!(lever > 0.05 && once, "{name}: {lever}");
    }
}

/// A dovetail hooks in, and square teeth have walls along the way out.
#[test]
fn contact_that_is_left_twice_has_no_positive_lever() {
    let (lever, once) = is_left_once("dovetail");
    assert!(lever < 0.0 && !once, "{lever}");
    assert!(is_left_once("square-teeth-10mm").0 <= 0.0);
}
