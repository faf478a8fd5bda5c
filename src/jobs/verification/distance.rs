//! The distance of two polygons, and how deep they overlap.
//!
//! The edges of a polygon are in a tree of circles about stretches of its rim, which turn with it: of two
//! rims only the stretches that are near each other are looked at.

use super::given::Pose;

type P = [f64; 2];

/// Largest number of edges that are looked at one by one.
const FEW: usize = 4;

/// A polygon at a pose.
pub(super) fn placed(outline: &[P], pose: Pose) -> Vec<P> {
    let at = At::new(pose);
    outline.iter().map(|p| at.of(*p)).collect()
}

/// A pose with its turn.
#[derive(Clone, Copy)]
struct At {
    place: P,
    turn: [f64; 2],
}

impl At {
    fn new([x, y, theta]: Pose) -> Self {
        Self {
            place: [x, y],
            turn: [libm::sin(theta), libm::cos(theta)],
        }
    }

    fn of(&self, p: P) -> P {
        let ([x, y], [sine, cosine]) = (self.place, self.turn);
        [
            x + cosine * p[0] - sine * p[1],
            y + sine * p[0] + cosine * p[1],
        ]
    }
}

/// The radius of gyration (m) of a polygon about the origin.
pub(super) fn gyration(polygon: &[P]) -> f64 {
    let [mut area, mut moment] = [0.0; 2];
    for (k, p) in polygon.iter().enumerate() {
        let q = polygon[(k + 1) % polygon.len()];
        let cross = p[0] * q[1] - p[1] * q[0];
        let square = |k: usize| p[k] * p[k] + p[k] * q[k] + q[k] * q[k];
        area += cross / 2.0;
        moment += cross * (square(0) + square(1)) / 12.0;
    }
    (moment / area).sqrt()
}

/// The rim of a polygon.
pub(super) struct Rim {
    points: Vec<P>,
    /// The whole rim first; the first half of a stretch follows it.
    stretches: Vec<Stretch>,
}

/// Edges in a row, and a circle about them.
struct Stretch {
    edges: [usize; 2],
    middle: P,
    radius: f64,
    /// The number of its second half; none of few edges.
    second: Option<usize>,
}

impl Rim {
    pub fn new(points: Vec<P>) -> Self {
        let mut rim = Self {
            stretches: Vec::new(),
            points,
        };
        if !rim.points.is_empty() {
            rim.grow(0, rim.points.len());
        }
        rim
    }

    fn grow(&mut self, from: usize, to: usize) -> usize {
        let along = |k: usize| {
            let ends = (from..=to).map(|it| self.points[it % self.points.len()][k]);
            let low = ends.clone().fold(f64::INFINITY, f64::min);
            0.5 * (low + ends.fold(f64::NEG_INFINITY, f64::max))
        };
        let middle = [along(0), along(1)];
        let ends = (from..=to).map(|it| between(self.points[it % self.points.len()], middle));
        // A little more than rounding takes from it.
        let radius = ends.fold(0.0, f64::max) * (1.0 + 1e-12);
        let number = self.stretches.len();
        self.stretches.push(Stretch {
            edges: [from, to],
            middle,
            radius,
            second: None,
        });
        if to - from > FEW {
            let half = from.midpoint(to);
            self.grow(from, half);
            self.stretches[number].second = Some(self.grow(half, to));
        }
        number
    }

    fn at(&self, pose: Pose) -> Placed<'_> {
        Placed {
            rim: self,
            at: At::new(pose),
        }
    }
}

/// The distance (m) of two polygons that lie apart, the second at a pose; of others, minus the depth of
/// the point of either's rim that is deepest in the other.
pub(super) fn clearance(fixed: &Rim, moving: &Rim, pose: Pose) -> f64 {
    let [a, b] = [fixed.at([0.0; 3]), moving.at(pose)];
    let apart = a.distance(&b);
    let is_within = |a: &Placed, b: &Placed| a.first().is_some_and(|p| b.contains(p));
    if apart > 0.0 && !is_within(&a, &b) && !is_within(&b, &a) {
        return apart;
    }
    let depth = a.depth(&b).max(b.depth(&a));
    if depth > 0.0 { -depth } else { apart }
}

/// A rim at a pose.
struct Placed<'a> {
    rim: &'a Rim,
    at: At,
}

impl Placed<'_> {
    fn first(&self) -> Option<P> {
        self.rim.points.first().map(|p| self.at.of(*p))
    }

    fn edge(&self, number: usize) -> [P; 2] {
        let points = &self.rim.points;
        [points[number], points[(number + 1) % points.len()]].map(|p| self.at.of(p))
    }

    fn edges(&self, stretch: &Stretch) -> impl Iterator<Item = [P; 2]> + '_ {
        (stretch.edges[0]..stretch.edges[1]).map(|it| self.edge(it))
    }

    /// Calls `found` with the edges of stretches that are wanted, by the middles and radii of their
    /// circles.
    fn visit(&self, mut wanted: impl FnMut(P, f64) -> bool, mut found: impl FnMut([P; 2])) {
        let mut open: Vec<usize> = (0..self.rim.stretches.len().min(1)).collect();
        while let Some(number) = open.pop() {
            let stretch = &self.rim.stretches[number];
            if !wanted(self.at.of(stretch.middle), stretch.radius) {
                continue;
            }
            match stretch.second {
                Some(second) => open.extend([number + 1, second]),
                None => self.edges(stretch).for_each(&mut found),
            }
        }
    }

    /// The distance (m) of two rims, 0 where they cross.
    fn distance(&self, other: &Self) -> f64 {
        let mut least = f64::INFINITY;
        let both = [&self.rim.stretches, &other.rim.stretches];
        let mut open = Vec::new();
        if both.iter().all(|it| !it.is_empty()) {
            open.push((0.0, [0, 0]));
        }
        while let Some((bound, numbers)) = open.pop() {
            if least == 0.0 {
                break;
            }
            if bound >= least {
                continue;
            }
            let [a, b] = [0, 1].map(|k| &both[k][numbers[k]]);
            let halves = match (a.second, b.second) {
                (None, None) => {
                    for [p, q] in self.edges(a) {
                        for [r, s] in other.edges(b) {
                            least = least.min(between_edges([p, q], [r, s]));
                        }
                    }
                    continue;
                }
                (Some(second), None) => [numbers[0] + 1, second].map(|it| [it, numbers[1]]),
                (Some(second), Some(_)) if a.radius > b.radius => {
                    [numbers[0] + 1, second].map(|it| [it, numbers[1]])
                }
                (_, Some(second)) => [numbers[1] + 1, second].map(|it| [numbers[0], it]),
            };
            let mut halves = halves.map(|numbers| {
                let [a, b] = [0, 1].map(|k| &both[k][numbers[k]]);
                let middles = between(self.at.of(a.middle), other.at.of(b.middle));
                (middles - a.radius - b.radius, numbers)
            });
            // The nearer one is taken next.
            halves.sort_by(|a, b| b.0.total_cmp(&a.0));
            open.extend(halves.into_iter().filter(|it| it.0 < least));
        }
        least
    }

    /// The distance (m) of a place from the rim, or `most` if that is less.
    fn distance_of(&self, p: P, most: f64) -> f64 {
        let least = std::cell::Cell::new(most);
        self.visit(
            |middle, radius| between(p, middle) - radius < least.get(),
            |[r, s]| least.set(least.get().min(to_edge(p, r, s))),
        );
        least.get()
    }

    /// Whether a ray from a place crosses the rim an odd number of times.
    fn contains(&self, p: P) -> bool {
        let mut crossings = 0;
        self.visit(
            |middle, radius| (middle[1] - p[1]).abs() <= radius && middle[0] + radius >= p[0],
            |[a, b]| {
                let is_crossed = (a[1] > p[1]) != (b[1] > p[1])
                    && p[0] < a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
                crossings += usize::from(is_crossed);
            },
        );
        crossings % 2 == 1
    }

    /// How deep (m) this rim dips into another polygon; 0 if it does not.
    fn depth(&self, other: &Self) -> f64 {
        let mut deepest = 0.0f64;
        let mut open: Vec<usize> = (0..self.rim.stretches.len().min(1)).collect();
        while let Some(number) = open.pop() {
            let stretch = &self.rim.stretches[number];
            let middle = self.at.of(stretch.middle);
            // Where no rim is within its circle, all of it is on one side; or no point of it is deeper.
            let beyond = 1.001 * stretch.radius + deepest;
            let away = other.distance_of(middle, beyond);
            if away + stretch.radius <= deepest || away >= beyond && !other.contains(middle) {
                continue;
            }
            match stretch.second {
                Some(second) => open.extend([second, number + 1]),
                None => {
                    for edge in self.edges(stretch) {
                        deepest = deepest.max(other.depth_of(edge));
                    }
                }
            }
        }
        deepest
    }

    /// How deep (m) an edge lies in this polygon: in pieces between the places where it crosses the rim.
    fn depth_of(&self, [p, q]: [P; 2]) -> f64 {
        let half = [0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])];
        let reach = between(p, half) * (1.0 + 1e-12);
        let mut cuts = vec![0.0, 1.0];
        self.visit(
            |middle, radius| between(middle, half) <= radius + reach,
            |[r, s]| cuts.extend(crossing(p, q, r, s)),
        );
        cuts.sort_by(f64::total_cmp);
        let at = |t: f64| [p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])];
        let middles = cuts.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
        let places = cuts.iter().copied().chain(middles).map(at);
        places
            .filter(|place| self.contains(*place))
            .map(|place| self.distance_of(place, f64::INFINITY))
            .fold(0.0, f64::max)
    }
}

fn between(a: P, b: P) -> f64 {
    libm::hypot(a[0] - b[0], a[1] - b[1])
}

pub(super) fn between_edges([p, q]: [P; 2], [r, s]: [P; 2]) -> f64 {
    if crossing(p, q, r, s).is_some() {
        return 0.0;
    }
    let ends = [
        to_edge(p, r, s),
        to_edge(q, r, s),
        to_edge(r, p, q),
        to_edge(s, p, q),
    ];
    ends.into_iter().fold(f64::INFINITY, f64::min)
}

/// Where on the edge from `p` to `q` (0 to 1) the edge from `r` to `s` crosses it.
fn crossing(p: P, q: P, r: P, s: P) -> Option<f64> {
    let [along, other] = [[q[0] - p[0], q[1] - p[1]], [s[0] - r[0], s[1] - r[1]]];
    let cross = |a: P, b: P| a[0] * b[1] - a[1] * b[0];
    let between = [r[0] - p[0], r[1] - p[1]];
    let slant = cross(along, other);
    let [t, u] = [cross(between, other) / slant, cross(between, along) / slant];
    (slant != 0.0 && (0.0..=1.0).contains(&t) && (0.0..=1.0).contains(&u)).then_some(t)
}

/// The distance of a point from an edge.
fn to_edge(p: P, a: P, b: P) -> f64 {
    let (along, to) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let square = along[0] * along[0] + along[1] * along[1];
    let t = ((to[0] * along[0] + to[1] * along[1]) / square).clamp(0.0, 1.0);
    let t = if square > 0.0 { t } else { 0.0 };
    libm::hypot(to[0] - t * along[0], to[1] - t * along[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [P; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

    #[test]
    fn squares_apart_touching_and_in_each_other() {
        let square = Rim::new(SQUARE.to_vec());
        let at = |x, y, theta| clearance(&square, &square, [x, y, theta]);
        assert!((at(1.5, 0.2, 0.0) - 0.5).abs() < 1e-15);
        assert_eq!(at(1.0, 0.3, 0.0), 0.0);
        assert!((at(0.9, 0.3, 0.0) + 0.1).abs() < 1e-12);
        assert!((at(2.0, 2.0, 0.0) - 2f64.sqrt()).abs() < 1e-15);
        // A bar across, with no corner inside.
        let bar = Rim::new(vec![[-1.0, 0.4], [2.0, 0.4], [2.0, 0.6], [-1.0, 0.6]]);
        assert!((clearance(&square, &bar, [0.0; 3]) + 0.4).abs() < 1e-12);
        let corner = at(1.0 + 0.5f64.sqrt() - 0.01, 0.1, std::f64::consts::FRAC_PI_4);
        assert!((corner + 0.01).abs() < 1e-9, "{corner}");
        // One inside the other.
        let small = Rim::new(SQUARE.map(|p| p.map(|x| 0.1 * x)).to_vec());
        assert!((clearance(&square, &small, [0.2, 0.3, 0.0]) + 0.3).abs() < 1e-12);
        assert!((clearance(&small, &square, [-0.2, -0.3, 0.0]) + 0.3).abs() < 1e-12);
    }

    /// Wavy rims of many edges, apart and overlapping, against all edges of both.
    #[test]
    fn many_edges_are_as_far_apart_as_one_by_one() {
        let wavy = |count: usize| -> Vec<P> {
            let turn = |k: usize| std::f64::consts::TAU * k as f64 / count as f64;
            let at = |a: f64| {
                let r = 1.0 + 0.1 * libm::cos(9.0 * a);
                [r * libm::cos(a), r * libm::sin(a)]
            };
            (0..count).map(|k| at(turn(k))).collect()
        };
        let (first, second) = (Rim::new(wavy(700)), Rim::new(wavy(501)));
        let [mut apart, mut overlapping] = [0; 2];
        for k in 0..40 {
            let k = f64::from(k);
            let pose = [1.7 + 0.02 * k, 0.03 * k, 0.7 * k];
            let found = clearance(&first, &second, pose);
            let [a, b] = [first.at([0.0; 3]), second.at(pose)];
            let all = |it: &Placed| -> Vec<[P; 2]> {
                (0..it.rim.points.len()).map(|k| it.edge(k)).collect()
            };
            let (of_a, of_b) = (all(&a), all(&b));
            let pairs = of_a.iter().flat_map(|e| of_b.iter().map(move |f| (*e, *f)));
            let least = pairs
                .map(|(e, f)| between_edges(e, f))
                .fold(f64::INFINITY, f64::min);
            if least > 0.0 {
                apart += 1;
                assert_eq!(found, least);
                continue;
            }
            overlapping += 1;
            let deepest = |edges: &[[P; 2]], other: &Placed| {
                edges.iter().map(|e| other.depth_of(*e)).fold(0.0, f64::max)
            };
            assert_eq!(found, -deepest(&of_a, &b).max(deepest(&of_b, &a)));
        }
        assert!(apart > 4 && overlapping > 4, "{apart} {overlapping}");
    }
}
