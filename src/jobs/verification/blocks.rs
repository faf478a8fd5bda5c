//! Two uniformly charged rectangles that stand on edge on a common mid-plane: the pole faces of blocks.

/// A rectangle seen from above: a line in the plane.
pub(super) struct Sheet {
    /// Its middle (m).
    pub middle: [f64; 2],
    /// The direction of its line.
    pub along: [f64; 2],
    /// Half its length and half its height (m).
    pub half: [f64; 2],
    /// The charge on its area.
    pub charge: f64,
}

/// The integral of charge times charge over distance.
pub(super) fn energy(a: &Sheet, b: &Sheet) -> f64 {
    let way = [b.middle[0] - a.middle[0], b.middle[1] - a.middle[1]];
    let size = a.half[0] + a.half[1] + b.half[0] + b.half[1];
    let integral = match libm::hypot(way[0], way[1]) > 6.0 * size {
        true => far(a, b, way),
        false => near(a, b, way),
    };
    a.charge * b.charge * integral
}

/// Gauss's three points on (-1, 1): at the least distance of `far` they leave some 1e-9 of the integral.
const THREE: [[f64; 2]; 3] = [
    [-0.774_596_669_241_483_4, 5.0 / 9.0],
    [0.0, 8.0 / 9.0],
    [0.774_596_669_241_483_4, 5.0 / 9.0],
];

fn far(a: &Sheet, b: &Sheet, way: [f64; 2]) -> f64 {
    let mut sum = 0.0;
    for [u, first] in THREE {
        for [v, second] in THREE {
            let at = |k: usize| way[k] + v * b.half[0] * b.along[k] - u * a.half[0] * a.along[k];
            let square = at(0) * at(0) + at(1) * at(1);
            for [z, third] in THREE {
                for [w, fourth] in THREE {
                    let height = z * a.half[1] - w * b.half[1];
                    sum += first * second * third * fourth / (square + height * height).sqrt();
                }
            }
        }
    }
    sum * a.half[0] * a.half[1] * b.half[0] * b.half[1]
}

fn near(a: &Sheet, b: &Sheet, way: [f64; 2]) -> f64 {
    let normal = [-a.along[1], a.along[0]];
    let dot = |p: [f64; 2], q: [f64; 2]| p[0] * q[0] + p[1] * q[1];
    let of_line = |v: f64| {
        let at = [way[0] + v * b.along[0], way[1] + v * b.along[1]];
        let (x, d) = (dot(at, a.along), dot(at, normal).abs());
        let [sum, difference] = [a.half[1] + b.half[1], (a.half[1] - b.half[1]).abs()];
        let over = |s: f64| integral(s, a.half[0] - x, d) - integral(s, -a.half[0] - x, d);
        2.0 * (over(sum) - over(difference))
    };
    // Where the other line or its ends are nearest, the integrand bends sharply.
    let slope = [dot(b.along, a.along), dot(b.along, normal)];
    let [x, d] = [dot(way, a.along), dot(way, normal)];
    let mut cuts = vec![-b.half[0], b.half[0]];
    cuts.extend([
        (-d) / slope[1],
        (a.half[0] - x) / slope[0],
        (-a.half[0] - x) / slope[0],
    ]);
    cuts.retain(|v| v.abs() <= b.half[0]);
    cuts.sort_by(f64::total_cmp);
    let total: f64 = cuts
        .windows(2)
        .map(|pair| eight(&of_line, pair[0], pair[1]))
        .sum();
    let allowed = 1e-11 * total.abs();
    let parts = cuts.windows(2).filter(|pair| pair[0] < pair[1]);
    parts
        .map(|pair| halved(&of_line, [pair[0], pair[1]], allowed, 24))
        .sum()
}

/// An antiderivative in x of `s asinh(s / rho) - sqrt(s^2 + rho^2)`, `rho^2 = x^2 + d^2`, which is one of
/// 1 / r over both heights.
fn integral(s: f64, x: f64, d: f64) -> f64 {
    let rho = libm::hypot(x, d);
    let of_height = libm::hypot(d, s);
    let r = libm::hypot(rho, s);
    let mut sum = 0.0;
    if of_height > 0.0 {
        let log = libm::asinh(x / of_height);
        sum -= 0.5 * (x * r + of_height * of_height * log);
        if s > 0.0 {
            sum += s * s * log;
        }
    } else {
        sum -= 0.5 * x * r;
    }
    if s > 0.0 && rho > 0.0 {
        sum += s * (x * libm::asinh(s / rho) - d * libm::atan2(x * s, d * r));
    }
    sum
}

/// Gauss's eight points.
fn eight(f: &impl Fn(f64) -> f64, a: f64, b: f64) -> f64 {
    const POINTS: [[f64; 2]; 4] = [
        [0.183_434_642_495_649_8, 0.362_683_783_378_362],
        [0.525_532_409_916_329, 0.313_706_645_877_887_3],
        [0.796_666_477_413_626_7, 0.222_381_034_453_374_5],
        [0.960_289_856_497_536_3, 0.101_228_536_290_376_3],
    ];
    let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
    let at = |[x, weight]: [f64; 2]| weight * (f(middle - half * x) + f(middle + half * x));
    half * POINTS.into_iter().map(at).sum::<f64>()
}

/// An integral from `a` to `b`, in halves until these change it by less than is allowed.
fn halved(f: &impl Fn(f64) -> f64, [a, b]: [f64; 2], allowed: f64, left: u8) -> f64 {
    let middle = 0.5 * (a + b);
    let [first, second] = [eight(f, a, middle), eight(f, middle, b)];
    let both = first + second;
    if left == 0 || (both - eight(f, a, b)).abs() <= allowed {
        return both;
    }
    halved(f, [a, middle], allowed, left - 1) + halved(f, [middle, b], allowed, left - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sheet(x: f64, y: f64, turn: f64, half: [f64; 2]) -> Sheet {
        Sheet {
            middle: [x, y],
            along: [libm::cos(turn), libm::sin(turn)],
            half,
            charge: 1.0,
        }
    }

    #[test]
    fn near_and_far_agree_with_sums_over_small_squares() {
        let a = sheet(0.0, 0.0, 0.3, [0.5, 0.15]);
        for (x, y, turn) in [(1.0, 0.4, 1.1), (0.2, 0.9, -0.4), (4.0, 7.0, 2.0)] {
            let b = sheet(x, y, turn, [0.4, 0.25]);
            let n = 24;
            let part = |k: i32, half: f64| half * (2.0 * (f64::from(k) + 0.5) / f64::from(n) - 1.0);
            let mut sum = 0.0;
            for i in 0..n {
                for j in 0..n {
                    let (u, v) = (part(i, a.half[0]), part(j, b.half[0]));
                    let at = |k: usize| b.middle[k] + v * b.along[k] - u * a.along[k];
                    for k in 0..n {
                        for l in 0..n {
                            let z = part(k, a.half[1]) - part(l, b.half[1]);
                            sum += 1.0 / (at(0) * at(0) + at(1) * at(1) + z * z).sqrt();
                        }
                    }
                }
            }
            sum *= 16.0 * 0.5 * 0.15 * 0.4 * 0.25 / f64::from(n).powi(4);
            let found = energy(&a, &b);
            assert!((found / sum - 1.0).abs() < 1e-3, "{found} {sum}");
            let [near, far] = [near(&a, &b, b.middle), far(&a, &b, b.middle)];
            let allowed = if x > 3.0 { 1e-8 } else { 0.1 };
            assert!((near / far - 1.0).abs() < allowed, "{near} {far}");
        }
    }

    #[test]
    fn a_square_on_itself_has_the_known_energy() {
        // Two coincident unit squares: 4 ln(1 + sqrt 2) - (4 / 3) (sqrt 2 - 1).
        let a = || sheet(0.0, 0.0, 0.0, [0.5, 0.5]);
        let root = 2f64.sqrt();
        let known = 4.0 * libm::log(1.0 + root) - 4.0 / 3.0 * (root - 1.0);
        assert!(
            (energy(&a(), &a()) / known - 1.0).abs() < 1e-9,
            "{}",
            energy(&a(), &a())
        );
    }
}
