//! The factor by which a shield reduces a pair's interaction.

use nalgebra::Vector2;
use tilebind::potential::shielding::Shield;

use crate::plain::pair_factor;

const SHIELD: Shield = Shield {
    attenuation: 0.8,
    length: 0.03,
    width: 0.2,
    front_gain: 1.1,
};

#[test]
fn the_factor_has_its_limits() {
    let close = 1e-9;
    assert!((SHIELD.factor(close, 1.0) - 1.1).abs() < 0.01);
    assert!((SHIELD.factor(close, -1.0) - 0.2).abs() < 0.01);
    assert!((SHIELD.factor(10.0, -1.0) - 1.0).abs() < 0.01);
    let half = Shield {
        width: 1e-3,
        ..SHIELD
    };
    assert!((half.factor(0.03, -1.0) - 0.6).abs() < 1e-12);
    assert!(half.factor(0.03, -1e6).is_finite());
}

#[test]
fn the_derivatives_are_those_of_the_factor() {
    let turned = |angle: f64| Vector2::new(angle.cos(), angle.sin());
    for i in 0..50 {
        let t = i as f64;
        let r = turned(0.7 * t) * (0.02 + 0.002 * t);
        let (first, angle) = ((Some(SHIELD), turned(1.3 * t)), 2.1 * t);
        let at = |dx: f64, dy: f64, da: f64| {
            pair_factor(
                first,
                (Some(SHIELD), turned(angle + da)),
                r + Vector2::new(dx, dy),
            )
        };
        let factor = at(0.0, 0.0, 0.0);
        let h = 1e-6;
        let slopes = [
            (at(h, 0.0, 0.0).value - at(-h, 0.0, 0.0).value) / (2.0 * h),
            (at(0.0, h, 0.0).value - at(0.0, -h, 0.0).value) / (2.0 * h),
            (at(0.0, 0.0, h).value - at(0.0, 0.0, -h).value) / (2.0 * h),
        ];
        assert!((factor.gradient.x - slopes[0]).abs() < 1e-6 * factor.gradient.norm() + 1e-8);
        assert!((factor.gradient.y - slopes[1]).abs() < 1e-6 * factor.gradient.norm() + 1e-8);
        assert!((factor.slope - slopes[2]).abs() < 1e-6);
    }
}
