//! Points of a motion at which the energy and its slope are known, and the cubic between two of
//! them.

/// A point of a profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Knot {
    /// Fraction of the motion, 0 to 1.
    pub t: f64,
    /// U (J).
    pub energy: f64,
    /// dU/dt (J).
    pub slope: f64,
}

/// The cubic through the values and slopes of two knots.
pub(super) fn cubic(a: &Knot, b: &Knot, t: f64) -> f64 {
    let h = b.t - a.t;
    let u = (t - a.t) / h;
    let (u2, u3) = (u * u, u * u * u);
    a.energy * (2.0 * u3 - 3.0 * u2 + 1.0)
        + a.slope * h * (u3 - 2.0 * u2 + u)
        + b.energy * (3.0 * u2 - 2.0 * u3)
        + b.slope * h * (u3 - u2)
}

/// Where the cubic through two knots is highest or lowest between them, in order.
pub(crate) fn inner_extremes(a: &Knot, b: &Knot) -> impl Iterator<Item = Knot> {
    // The derivative by u = (t - a.t) / h is p u^2 + 2 q u + r.
    let h = b.t - a.t;
    let climb = b.energy - a.energy;
    let (first, last) = (a.slope * h, b.slope * h);
    let p = 3.0 * (first + last) - 6.0 * climb;
    let q = 3.0 * climb - 2.0 * first - last;
    let r = first;
    let root = (q * q - p * r).sqrt();
    // The form of each root without cancellation.
    let sum = -(q + root.copysign(q));
    let (mut low, mut high) = (sum / p, r / sum);
    if low > high {
        std::mem::swap(&mut low, &mut high);
    }
    let (a, b) = (*a, *b);
    [low, high]
        .into_iter()
        .filter(|u| *u > 1e-9 && *u < 1.0 - 1e-9)
        .map(move |u| {
            let t = a.t + u * h;
            Knot {
                t,
                energy: cubic(&a, &b, t),
                slope: 0.0,
            }
        })
}

/// Mechanical work against a sequence of energies (J), forwards and backwards (J): the sums of all
/// climbs and of all falls.
pub fn work(energies: impl Iterator<Item = f64> + Clone) -> [f64; 2] {
    let mut work = [0.0; 2];
    for (here, next) in energies.clone().zip(energies.skip(1)) {
        work[0] += (next - here).max(0.0);
        work[1] += (here - next).max(0.0);
    }
    work
}
