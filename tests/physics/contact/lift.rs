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

/// Along lines past outlines with teeth, in steps of a tenth of a millimetre.
#[test]
fn free_translations_are_those_that_are_free_one_by_one() {
    let mut several = 0;
    for contact in [
        Contact::new(&square(0.4), &square(0.3)),
        Contact::new(&saw(false), &saw(true)),
        Contact::new(&saw(false), &saw(false)),
    ] {
        let turned = |i: i32| {
            let angle = 0.37 * f64::from(i);
            let direction = Vector2::new(angle.cos(), angle.sin());
            // Past the other tile at up to its height.
            let aside = Vector2::new(-direction.y, direction.x) * (f64::from(i % 11) * 0.04);
            let theta = if i % 2 == 0 { 0.0 } else { angle };
            (Configuration::new(aside.x, aside.y, theta), direction)
        };
        // Teeth half in the gaps between teeth.
        let along = (Configuration::new(0.41, 0.0, 0.0), Vector2::y());
        for (q, direction) in (0..60).map(turned).chain([along]) {
            let range = [-0.9, 0.8];
            let found = contact.free_translations(&q, direction, range);
            several += usize::from(found.len() > 2);
            assert!(found.windows(2).all(|pair| pair[0][1] < pair[1][0]));
            for k in 0..1700 {
                let t = range[0] + 1e-3 * (f64::from(k) + 0.37);
                let (x, y) = (q.x + direction.x * t, q.y + direction.y * t);
                let within = found.iter().any(|[low, high]| *low <= t && t <= *high);
                let near = found.iter().flatten().any(|end| (end - t).abs() < 1e-6);
                let free = contact.is_free(&Configuration::new(x, y, q.theta));
                assert!(free == within || near, "{q:?} {t}: {found:?}");
            }
        }
    }
    assert!(several > 0);
}
