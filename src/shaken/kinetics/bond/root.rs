//! The temperature at which a bond's depth equals the cost of docking.

/// Tolerances of a root: of the function, and of its argument.
const CLOSE: [f64; 2] = [3e-3, 5e-4];

/// The upper root of `bonds exp(x) - cost(x)` for a nearly linear cost, by iterating with the line
/// through the last two costs. `None` if this does not converge.
pub(super) fn straight_root(
    bonds: f64,
    cost: &dyn Fn(f64) -> f64,
    [least, most]: [f64; 2],
) -> Option<f64> {
    /// A tenth of the greatest depth.
    const ASIDE: f64 = 2.3;
    const MOST: usize = 8;
    let mut points = [most, most - ASIDE].map(|x| [x, cost(x)]);
    for _ in 0..MOST {
        let [[a, first], [b, second]] = points;
        let slope = (first - second) / (a - b);
        // Newton's method from above: the function is convex.
        let mut x = most;
        for _ in 0..60 {
            let by = bonds * libm::exp(x) - slope;
            let step = (bonds * libm::exp(x) - second - slope * (x - b)) / by;
            if !(by > 0.0 && step.is_finite()) {
                return None;
            }
            x -= step;
        }
        if !(least..=most).contains(&x) {
            return None;
        }
        let found = [x, cost(x)];
        if (bonds * libm::exp(x) - found[1]).abs() < CLOSE[0] || (x - b).abs() < CLOSE[1] {
            return Some(x);
        }
        points = [points[1], found];
    }
    None
}

/// The upper root of a function that increases beyond it, by bisection and secants (Illinois);
/// `None` if there is none between the ends.
pub(super) fn root(f: impl Fn(f64) -> f64, [least, most]: [f64; 2]) -> Option<f64> {
    let (mut high, mut low) = (most, most);
    let mut above = f(high);
    if above <= 0.0 {
        return None;
    }
    let mut below = above;
    while below > 0.0 {
        (high, above) = (low, below);
        if low <= least {
            return None;
        }
        low = (low - 1.0).max(least);
        below = f(low);
    }
    let mut side = 0;
    for _ in 0..40 {
        let next = (low * above - high * below) / (above - below);
        let value = f(next);
        if value.abs() < CLOSE[0] || high - low < CLOSE[1] {
            return Some(next);
        }
        if value > 0.0 {
            (high, above) = (next, value);
            below *= if side == 1 { 0.5 } else { 1.0 };
            side = 1;
        } else {
            (low, below) = (next, value);
            above *= if side == -1 { 0.5 } else { 1.0 };
            side = -1;
        }
    }
    Some((low + high) / 2.0)
}
