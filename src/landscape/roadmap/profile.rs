//! The energy along a straight motion, sampled as densely as its curvature requires.

use nalgebra::Vector3;
use ordered_float::OrderedFloat;

use super::knot::{Knot, cubic, inner_extremes, work};
use super::point::Point;
use super::stretch::{Bends, ProfileTolerance, Stretch, StretchMotion};
use tiles::order::Order;
use tiles::problem::Problem;

/// The energy along a motion as a cubic spline: knots in order, both ends included, and the
/// spline's own highest and lowest points between them. The energy nowhere exceeds the larger of
/// its two neighbours by more than the tolerance.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// In the order of t.
    pub knots: Vec<Knot>,
}

/// Stretches are not halved more often than this.
const DEEPEST: u32 = 16;

impl Profile {
    /// Samples the straight motion from `a` to `b`.
    ///
    /// A stretch of duration h is accepted if one of two bounds shows that it is known within the
    /// tolerance, given the values and slopes at its ends:
    ///
    /// * the error of the cubic through them is at most `h^4 / 384` times the largest fourth
    ///   derivative (the error of Hermite's interpolation; Davis, *Interpolation and
    ///   Approximation*, theorem 3.5.1), or `h^3 / 96` times the largest third one (the integral of
    ///   Peano's kernel, theorem 3.7.1), or
    /// * if no bound of the fourth derivative is known, `U(t) <= U_a + s_a t + B t^2 / 2` with B a
    ///   bound of the second derivative, and the same from the other end, exceed the larger end by
    ///   no more.
    ///
    /// Blocks in contact have no bound of the former and only a very loose one of the latter. There
    /// a stretch shorter than [`Potential::feature_length`](tiles::potential::Potential) is
    /// accepted if the cubic predicts the energy at its midpoint. That is a check, not a proof;
    /// proved bounds of barriers come from the certificate.
    pub fn new(problem: &Problem, a: &Point, b: &Point, tolerance: &ProfileTolerance) -> Self {
        let mut one = Self::of_many(problem, &[[a, b]], tolerance);
        one.pop().expect("one profile for one motion")
    }

    /// Samples many motions together, so that their energies share the vectors of the potential's
    /// batches; each is sampled as it would be alone.
    pub fn of_many(
        problem: &Problem,
        pairs: &[[&Point; 2]],
        tolerance: &ProfileTolerance,
    ) -> Vec<Self> {
        let motions: Vec<StretchMotion> = pairs
            .iter()
            .map(|[a, b]| StretchMotion::new(problem, a, b, tolerance))
            .collect();
        let mut open: Vec<Stretch> = (0..pairs.len())
            .map(|number| Stretch {
                number,
                ends: motions[number].ends(pairs[number]),
                bends: Bends::NONE,
                depth: 0,
            })
            .collect();
        let mut settled: Vec<(usize, [Knot; 2])> = Vec::new();
        let (mut places, mut known) = (Vec::new(), Vec::new());
        while !open.is_empty() {
            open.retain_mut(|stretch| {
                let is_settled = stretch.depth >= DEEPEST
                    || motions[stretch.number].is_settled(&stretch.ends, &mut stretch.bends);
                if is_settled {
                    settled.push((stretch.number, stretch.ends));
                }
                !is_settled
            });
            places.clear();
            places.extend(open.iter().map(|s| motions[s.number].at(s.middle())));
            known.resize(places.len(), (0.0, Vector3::zeros()));
            problem.energies_and_gradients(&places, &mut known);
            let mut finer = Vec::with_capacity(2 * open.len());
            for (stretch, (energy, gradient)) in open.iter().zip(&known) {
                let motion = &motions[stretch.number];
                let middle = Knot {
                    t: stretch.middle(),
                    energy: *energy,
                    slope: gradient.dot(&motion.step),
                };
                let [a, b] = stretch.ends;
                let halves = [[a, middle], [middle, b]];
                if stretch.bends.is_none() && motion.is_foreseen(&a, &middle, &b) {
                    settled.extend(halves.map(|half| (stretch.number, half)));
                } else {
                    finer.extend(halves.map(|ends| Stretch {
                        ends,
                        depth: stretch.depth + 1,
                        ..*stretch
                    }));
                }
            }
            open = finer;
        }
        settled.order_by_key(|(number, [a, _])| (*number, OrderedFloat(a.t)));
        settled
            .chunk_by(|a, b| a.0 == b.0)
            .map(|some| Self::of_stretches(some.iter().map(|(_, ends)| ends)))
            .collect()
    }

    /// The profile of the accepted stretches of one motion, in order.
    fn of_stretches<'a>(stretches: impl IntoIterator<Item = &'a [Knot; 2]>) -> Self {
        let mut knots = Vec::with_capacity(16);
        for [a, b] in stretches {
            if knots.is_empty() {
                knots.push(*a);
            }
            knots.extend(inner_extremes(a, b));
            knots.push(*b);
        }
        Self { knots }
    }

    /// The highest knot.
    pub fn peak(&self) -> Knot {
        *self
            .knots
            .iter()
            .max_by_key(|knot| OrderedFloat(knot.energy))
            .expect("a profile has two ends")
    }

    /// Mechanical work against the energy, forwards and backwards (J): the sum of all climbs.
    pub fn work(&self) -> [f64; 2] {
        work(self.knots.iter().map(|knot| knot.energy))
    }

    /// The energy (J) at `count + 1` evenly spaced points from end to end.
    pub fn energies(&self, count: usize) -> impl Iterator<Item = f64> + '_ {
        let mut i = 1;
        (0..=count).map(move |k| {
            let t = k as f64 / count as f64;
            while i + 1 < self.knots.len() && self.knots[i].t <= t {
                i += 1;
            }
            cubic(&self.knots[i - 1], &self.knots[i], t)
        })
    }
}
