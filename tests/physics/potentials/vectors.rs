//! Functions of SIMD vectors against the standard library's, for every instruction set.

use std::f64::consts::PI;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::potential::simd::Level;
use tilebind::potential::simd::lanes::{Lanes, Task, WIDTH};

/// The vector functions at one argument.
struct Functions(f64);

impl Task for Functions {
    type Output = [f64; 4];

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> [f64; 4] {
        let x = l.splat(self.0);
        let (sin, cos) = l.sin_cos(x);
        let mut results = [0.0; 4];
        for (result, lanes) in
            results
                .iter_mut()
                .zip([sin, cos, l.reciprocal_sqrt(l.mul(x, x)), l.reciprocal(x)])
        {
            let mut values = [0.0; WIDTH];
            l.store(lanes, &mut values);
            assert!(values.iter().all(|v| v.to_bits() == values[0].to_bits()));
            *result = values[0];
        }
        results
    }
}

#[test]
fn vector_functions() {
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    for level in Level::available() {
        for i in 0..20_000 {
            let x = match i % 3 {
                0 => rng.random_range(-PI..PI),
                1 => rng.random_range(-1e5..1e5),
                // Close to a multiple of pi / 4, where quarter turns are told apart.
                _ => {
                    let eighths =
                        f64::from(rng.random_range(-40..40)) + 1e-12 * rng.random::<f64>();
                    eighths * PI / 4.0
                }
            };
            let [sin, cos, root, reciprocal] = level.run(Functions(x));
            assert!((sin - x.sin()).abs() < 3e-16, "{level}: sin {x}");
            assert!((cos - x.cos()).abs() < 3e-16, "{level}: cos {x}");
            if x != 0.0 {
                assert!(
                    (root * x.abs() - 1.0).abs() < 1e-13,
                    "{level}: 1 / sqrt {x}"
                );
                assert!((reciprocal * x - 1.0).abs() < 1e-13, "{level}: 1 / {x}");
            }
        }
        assert_eq!(level.run(Functions(0.0))[..2], [0.0, 1.0]);
    }
}

/// The logarithm of a ratio, and the angle of a vector, of each lane.
struct OfTwo([f64; WIDTH], [f64; WIDTH]);

impl Task for OfTwo {
    type Output = [[f64; WIDTH]; 2];

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> Self::Output {
        let mut out = [[f64::NAN; WIDTH]; 2];
        let (a, b) = (l.load(&self.0), l.load(&self.1));
        let x = l.sub(a, l.splat(1.0));
        l.store(l.ln_ratio(a, b), &mut out[0]);
        l.store(l.angle(x, b), &mut out[1]);
        out
    }
}

#[test]
fn logarithm_and_angle_agree_with_the_standard_library() {
    for level in Level::available() {
        for i in 0..2000 {
            let at = |k: usize, f: f64| (f * (8 * i + k) as f64).sin();
            let a = std::array::from_fn(|k| (6.0 * at(k, 0.731)).exp());
            let b = std::array::from_fn(|k| (9.0 * at(k, 1.377)).exp());
            let [ln, angle] = level.run(OfTwo(a, b));
            for k in 0..WIDTH {
                let exact = (a[k] / b[k]).ln();
                assert!(
                    (ln[k] - exact).abs() < 3e-16 * exact.abs().max(1.0),
                    "{level}"
                );
                let exact = b[k].atan2(a[k] - 1.0);
                assert!(
                    (angle[k] - exact).abs() < 9e-16,
                    "{level} {} {exact}",
                    angle[k]
                );
            }
        }
        let zero = level.run(OfTwo([1.0; WIDTH], [1e-300; WIDTH]));
        assert!(zero[1].iter().all(|a| (0.0..1.58).contains(a)), "{level}");
    }
}
