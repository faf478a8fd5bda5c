//! Bounds of quadratic forms over boxes.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::cell::Quadratic;

#[test]
fn no_point_of_the_box_lies_outside_the_bounds() {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    for round in 0..300 {
        let mut random = || rng.random_range(-1.0..1.0);
        let mut form = Quadratic {
            value: random(),
            gradient: std::array::from_fn(|_| random()),
            hessian: std::array::from_fn(|_| random()),
        };
        let half: [f64; 3] = std::array::from_fn(|_| random() + 1.01);
        let steep = round % 2 == 0;
        if steep {
            form.gradient = std::array::from_fn(|i| form.hessian[i].signum() * 2.0 + 0.1);
            form.hessian[3..].fill(0.0);
        }
        let (low, high) = (form.least(&half), form.greatest(&half));
        let mut seen = [f64::INFINITY, f64::NEG_INFINITY];
        for k in 0..9 * 9 * 9 {
            let t = [k % 9, k / 9 % 9, k / 81].map(|i| i as f64 / 4.0 - 1.0);
            let u = form.at(std::array::from_fn(|i| t[i] * half[i]));
            assert!(low <= u && u <= high);
            seen = [seen[0].min(u), seen[1].max(u)];
        }
        if steep && (0..3).all(|i| half[i] < 2.0) {
            // The extremes lie at corners of the box, and without products nothing is lost.
            assert!(seen[0] - low < 1e-12 && high - seen[1] < 1e-12);
        }
        let step: [f64; 3] = std::array::from_fn(|i| 2.0 * half[i] * random().signum());
        let along = (0..=100)
            .map(|k| form.at(step.map(|s| s * (k as f64 / 100.0 - 0.5))))
            .fold(f64::NEG_INFINITY, f64::max);
        assert!(
            (form.greatest_along(&step) - along).abs() < 1e-3
                && along <= form.greatest_along(&step)
        );
    }
}
