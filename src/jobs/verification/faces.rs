//! Uniformly charged faces of magnets, and integrals over two of them: rectangles and discs that stand
//! on edge on the tiles' mid-plane, the pole faces of magnets that lie; or that are parallel to it, those
//! of magnets that stand.

use std::sync::LazyLock;

/// A face of a magnet.
pub(super) struct ChargedFace {
    pub outline: Outline,
    /// Its middle, seen from above (m).
    pub middle: [f64; 2],
    /// Its height (m) above the mid-plane if it is parallel to that; `None` if it stands on edge.
    pub height: Option<f64>,
    /// The direction in the plane of its first size.
    pub along: [f64; 2],
    /// Half its sizes (m): in that direction, and across.
    pub half: [f64; 2],
    /// The charge on its area.
    pub charge: f64,
    /// Places (m, from its middle) with shares of its area that integrate polynomials up to the fifth
    /// degree.
    points: Vec<([f64; 3], f64)>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Outline {
    Rectangle,
    Disc,
}

/// Gauss's three points on (-1, 1).
const THREE: [[f64; 2]; 3] = [
    [-0.774_596_669_241_483_4, 5.0 / 9.0],
    [0.0, 8.0 / 9.0],
    [0.774_596_669_241_483_4, 5.0 / 9.0],
];

impl ChargedFace {
    pub fn new(
        outline: Outline,
        (middle, height): ([f64; 2], Option<f64>),
        along: [f64; 2],
        half: [f64; 2],
        charge: f64,
    ) -> Self {
        let place = |[u, v]: [f64; 2]| {
            let [u, v] = [u * half[0], v * half[1]];
            let [x, y] = along;
            match height {
                None => [u * x, u * y, v],
                Some(_) => [u * x - v * y, u * y + v * x, 0.0],
            }
        };
        let points = match outline {
            Outline::Rectangle => {
                let all = THREE.iter().flat_map(|a| THREE.map(|b| (a, b)));
                all.map(|(a, b)| (place([a[0], b[0]]), 0.25 * a[1] * b[1]))
                    .collect()
            }
            Outline::Disc => {
                // The middle, and six places about it.
                let [r, x, y] = [2.0 / 3.0, 1.0 / 6.0, 0.5f64].map(f64::sqrt);
                let round = [[r, 0.0], [x, y], [-x, y], [-r, 0.0], [-x, -y], [x, -y]];
                let round = round.map(|it| (place(it), 0.125));
                std::iter::once(([0.0; 3], 0.25)).chain(round).collect()
            }
        };
        Self {
            outline,
            middle,
            height,
            along,
            half,
            charge,
            points,
        }
    }

    /// The same with its middle elsewhere (m).
    pub fn moved(&self, middle: [f64; 2]) -> Self {
        Self {
            middle,
            points: self.points.clone(),
            ..*self
        }
    }

    /// Its area (m^2).
    pub fn area(&self) -> f64 {
        let around = 4.0 * self.half[0] * self.half[1];
        match self.outline {
            Outline::Rectangle => around,
            Outline::Disc => around * std::f64::consts::FRAC_PI_4,
        }
    }
}

/// The integral of 1 / r over two faces far apart, the second `way` from the first.
pub(super) fn far(a: &ChargedFace, b: &ChargedFace, way: [f64; 3]) -> f64 {
    let mut sum = 0.0;
    for (p, first) in &a.points {
        for (q, second) in &b.points {
            let square: f64 = (0..3).map(|k| (way[k] + q[k] - p[k]).powi(2)).sum();
            sum += first * second / square.sqrt();
        }
    }
    sum * a.area() * b.area()
}

/// Two upright rectangles: a closed form of three of the four integrals.
pub(super) fn near(a: &ChargedFace, b: &ChargedFace, way: [f64; 2]) -> f64 {
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

/// Places from -1 to 1 and weights of Gauss's rule with this many points: the roots of a Legendre
/// polynomial by Newton's steps.
pub(super) fn gauss(count: usize) -> Vec<[f64; 2]> {
    // The polynomial at x, and its derivative.
    let legendre = |x: f64| {
        let [mut one, mut before] = [x, 1.0];
        for k in 2..=count {
            let k = k as f64;
            [one, before] = [((2.0 * k - 1.0) * x * one - (k - 1.0) * before) / k, one];
        }
        (one, count as f64 * (x * one - before) / (x * x - 1.0))
    };
    let root = |k: usize| {
        let guess = std::f64::consts::PI * (k as f64 + 0.75) / (count as f64 + 0.5);
        let x = (0..8).fold(libm::cos(guess), |x, _| {
            let (value, slope) = legendre(x);
            x - value / slope
        });
        [x, 2.0 / ((1.0 - x * x) * legendre(x).1.powi(2))]
    };
    (0..count).map(root).collect()
}

/// Gauss's eight points.
fn eight(f: &impl Fn(f64) -> f64, a: f64, b: f64) -> f64 {
    static POINTS: LazyLock<Vec<[f64; 2]>> = LazyLock::new(|| gauss(8));
    let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
    let at = |[x, weight]: &[f64; 2]| weight * f(middle + half * x);
    half * POINTS.iter().map(at).sum::<f64>()
}

/// An integral from `a` to `b` by Kronrod's fifteen points, in halves until these and Gauss's seven among
/// them are so near each other that by experience the error is what is allowed.
pub(super) fn halved(f: &impl Fn(f64) -> f64, [a, b]: [f64; 2], allowed: f64, left: u8) -> f64 {
    // Places, and weights of all and of Gauss's.
    const POINTS: [[f64; 3]; 7] = [
        [0.991_455_371_120_812_6, 0.022_935_322_010_529_224, 0.0],
        [
            0.949_107_912_342_758_5,
            0.063_092_092_629_978_55,
            0.129_484_966_168_869_7,
        ],
        [0.864_864_423_359_769_1, 0.104_790_010_322_250_18, 0.0],
        [
            0.741_531_185_599_394_4,
            0.140_653_259_715_525_92,
            0.279_705_391_489_276_64,
        ],
        [0.586_087_235_467_691_1, 0.169_004_726_639_267_9, 0.0],
        [
            0.405_845_151_377_397_2,
            0.190_350_578_064_785_4,
            0.381_830_050_505_118_9,
        ],
        [0.207_784_955_007_898_47, 0.204_432_940_075_298_9, 0.0],
    ];
    const MIDDLE: [f64; 2] = [0.209_482_141_084_727_82, 0.417_959_183_673_469_4];
    let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
    let here = f(middle);
    let mut sums = MIDDLE.map(|weight| weight * here);
    let mut size = sums[0].abs();
    for [x, all, gauss] in POINTS {
        let [low, high] = [f(middle - half * x), f(middle + half * x)];
        sums[0] += all * (low + high);
        sums[1] += gauss * (low + high);
        size += all * (low.abs() + high.abs());
    }
    let [found, off, size] = [
        half * sums[0],
        half * (sums[0] - sums[1]).abs(),
        half * size,
    ];
    let share = 200.0 * off / size;
    let error = off.min(size * share * share.sqrt());
    // What is 0 everywhere has no share.
    if left == 0 || off == 0.0 || error <= allowed {
        return found;
    }
    halved(f, [a, middle], allowed, left - 1) + halved(f, [middle, b], allowed, left - 1)
}
