//! Discs: cylinders that are magnetised along their axis.

pub mod elliptic;
pub mod face;
pub mod pair;

#[cfg(test)]
mod tests {
    use super::pair::{Face, Integral};
    use nalgebra::Vector2;

    fn brute(a: &Face, b: &Face, n: usize) -> f64 {
        let points = |f: &Face| {
            let [x, w] = crate::potential::cuboid::quadrature::gauss_legendre::<24>();
            let mut all = vec![];
            for i in 0..24 {
                let r = f.radius * (x[i] + 1.0) / 2.0;
                for k in 0..n {
                    let (s, c) = libm::sincos(k as f64 / n as f64 * std::f64::consts::TAU);
                    all.push((
                        f.centre.x - f.normal.y * r * c,
                        f.centre.y + f.normal.x * r * c,
                        r * s,
                        w[i] / 2.0 * f.radius * r * std::f64::consts::TAU / n as f64,
                    ));
                }
            }
            all
        };
        let (p, q) = (points(a), points(b));
        p.iter()
            .map(|p| {
                q.iter()
                    .map(|q| {
                        p.3 * q.3
                            / ((p.0 - q.0).powi(2) + (p.1 - q.1).powi(2) + (p.2 - q.2).powi(2)).sqrt()
                    })
                    .sum::<f64>()
            })
            .sum()
    }

    fn face(x: f64, y: f64, angle: f64, radius: f64) -> Face {
        Face { centre: Vector2::new(x, y), normal: Vector2::new(libm::cos(angle), libm::sin(angle)), radius }
    }

    #[test]
    fn agrees_with_quadrature() {
        let first = face(0.0, 0.0, 0.0, 1.0);
        for (x, y, a) in [
            (0.5, 0.2, 0.2), (0.1, 1.85, 0.1), (0.9, 0.9, 1.4), (0.05, 0.2, 0.02), (0.05, 1.95, 0.05),
            (0.001, 0.1, 0.0), (0.805, 0.0, 1.5), (-0.85, 0.5, 1.5), (0.0, 1.81, 0.0), (3.0, 2.0, 2.0), (20.0, 2.0, 2.0),
            (1e-5, 0.0, 0.0), (0.0, 1.8, 0.0), (0.8, 0.3, std::f64::consts::FRAC_PI_2),
        ] {
            let second = face(x, y, a, 0.8);
            let i = Integral::new(&first, &second);
            let j = Integral::new(&second, &first);
            let b = brute(&first, &second, 64);
            let e = 1e-6;
            let g = |dx, dy, da| Integral::new(&first, &face(x + dx, y + dy, a + da, 0.8)).value;
            let d = [g(e, 0., 0.) - g(-e, 0., 0.), g(0., e, 0.) - g(0., -e, 0.), g(0., 0., e) - g(0., 0., -e)]
                .map(|d| d / 2.0 / e);
            println!("{x} {y} {a}: {} swapped {:.1e} brute {:.1e} grad {:?} {:?} n={}", i.value, j.value / i.value - 1.0, b / i.value - 1.0,
                [i.gradient.x - d[0], i.gradient.y - d[1], i.slope - d[2]], [i.gradient.x, i.gradient.y, i.slope], super::pair::count(&first, &second));
        }
    }
}
