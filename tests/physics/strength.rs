//! How strong a magnet is: the three ways to say it.

use std::f64::consts::PI;

use tilebind::tile::strength::{Strength, surface_field_share};

/// The field at a point on the axis, summed over both pole faces cut into small charges.
fn summed_field(size: [f64; 3], above: f64) -> f64 {
    let [l, a, b] = size;
    let n = 800;
    let sheet = |z: f64| -> f64 {
        let mut sum = 0.0;
        for i in 0..n {
            for j in 0..n {
                let x = a * ((f64::from(i) + 0.5) / f64::from(n) - 0.5);
                let y = b * ((f64::from(j) + 0.5) / f64::from(n) - 0.5);
                sum += z / (x * x + y * y + z * z).powf(1.5);
            }
        }
        sum * a * b / f64::from(n * n) / (4.0 * PI)
    };
    sheet(above) - sheet(l + above)
}

#[test]
fn the_surface_field_is_the_limit_of_the_field_above_the_face() {
    for size in [
        [0.010, 0.010, 0.003],
        [0.003, 0.010, 0.010],
        [0.02, 0.01, 0.01],
    ] {
        // The field falls off linearly right above the face: extrapolate from two heights.
        let step = 2e-4;
        let (near, far) = (summed_field(size, step), summed_field(size, 2.0 * step));
        let surface = 2.0 * near - far;
        let share = surface_field_share(size);
        assert!((surface / share - 1.0).abs() < 5e-3, "{surface} {share}");
    }
}

#[test]
fn the_surface_field_has_its_limits() {
    assert!((surface_field_share([1.0, 1e-4, 1e-4]) - 0.5).abs() < 1e-8);
    let (l, a, b) = (1e-6, 0.02, 0.01);
    let thin = 2.0 / PI * l * f64::hypot(1.0 / a, 1.0 / b);
    assert!((surface_field_share([l, a, b]) / thin - 1.0).abs() < 1e-6);
}

#[test]
fn the_three_ways_to_say_a_strength_agree() {
    let size = [0.010, 0.010, 0.003];
    let moment = Strength::Remanence(1.2).moment(size);
    assert!((moment - 0.28648).abs() < 1e-5);
    assert_eq!(Strength::Moment(moment).moment(size), moment);
    let field = 1.2 * surface_field_share(size);
    let from_field = Strength::SurfaceField(field).moment(size);
    assert!((from_field / moment - 1.0).abs() < 1e-14);
}
