//! Tiles lifted off each other.

use nalgebra::Vector2;
use tilebind::Configuration;
use tilebind::contact::Contact;

use super::{saw, square};

#[test]
fn a_lift_ends_in_contact() {
    for contact in [
        Contact::new(&square(0.4), &square(0.3)),
        Contact::new(&saw(false), &saw(true)),
    ] {
        for i in 0..200 {
            let angle = 0.1 * i as f64;
            let q = Configuration::new(0.01 * angle.cos(), 0.02, 0.37 * i as f64 % 3.0);
            let direction = Vector2::new(angle.cos(), angle.sin());
            let t = contact.lift(&q, direction);
            let at =
                |t: f64| Configuration::new(q.x + direction.x * t, q.y + direction.y * t, q.theta);
            assert!(t > 0.0 && contact.is_free(&at(t)));
            assert!(contact.clearance(&at(t)).abs() < 1e-9);
            assert!(!contact.is_free(&at(t - 1e-5)));
        }
    }
}
