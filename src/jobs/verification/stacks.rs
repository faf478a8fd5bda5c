//! Two uniformly charged faces of any form, as stacks of parallel lines: closed forms for two lines,
//! fixed lines of both stacks where they are apart, and adaptive quadrature over both where they are near.
//!
//! A face that stands on edge is a stack of upright lines, one that lies parallel to the tiles' plane is
//! one of lines along x. Faces of different kinds are none of this module's: those that lie come in
//! pairs of opposite charge, as far above the mid-plane as below, on which an upright one does not act.

use std::f64::consts::FRAC_PI_2;
use std::sync::LazyLock;

use super::distance::between_edges;
use super::faces::{ChargedFace, Outline, gauss, halved};

/// Lines side by side.
struct Stack {
    /// Where the middle line crosses the plane that is normal to all lines, and the direction (of
    /// length 1) of the others from it.
    base: [f64; 2],
    side: [f64; 2],
    /// How far (m) the outer lines are from the middle one.
    reach: f64,
    ends: Ends,
}

/// Where lines begin and end.
enum Ends {
    /// On a circle about this place.
    Round(f64),
    /// As far on both sides.
    Equal(f64),
    /// On a polygon: corners by their places along the lines and from the middle one.
    Polygon([[f64; 2]; 4]),
}

struct Line {
    at: [f64; 2],
    low: f64,
    high: f64,
}

impl Stack {
    fn of(face: &ChargedFace) -> Self {
        let [a, b] = face.half;
        let Some(height) = face.height else {
            return Self {
                base: face.middle,
                side: face.along,
                reach: a,
                ends: match face.outline {
                    Outline::Disc => Ends::Round(0.0),
                    Outline::Rectangle => Ends::Equal(b),
                },
            };
        };
        let [x, y] = face.middle;
        let corner = |u: f64, v: f64| {
            let [c, s] = face.along;
            [x + u * a * c - v * b * s, u * a * s + v * b * c]
        };
        let corners = [
            corner(1.0, 1.0),
            corner(-1.0, 1.0),
            corner(-1.0, -1.0),
            corner(1.0, -1.0),
        ];
        Self {
            base: [y, height],
            side: [1.0, 0.0],
            reach: match face.outline {
                Outline::Disc => a,
                Outline::Rectangle => corners.iter().fold(0.0, |most, p| p[1].abs().max(most)),
            },
            ends: match face.outline {
                Outline::Disc => Ends::Round(x),
                Outline::Rectangle => Ends::Polygon(corners),
            },
        }
    }

    /// The line at an angle, whose sine is its distance from the middle one in reaches; and the share of
    /// the area per angle. With it, ends on a circle are smooth.
    fn line(&self, angle: f64) -> (Line, f64) {
        let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
        let u = self.reach * sine;
        let [low, high] = match &self.ends {
            Ends::Round(middle) => [middle - self.reach * cosine, middle + self.reach * cosine],
            Ends::Equal(half) => [-half, *half],
            Ends::Polygon(corners) => {
                let [mut low, mut high] = [f64::INFINITY, f64::NEG_INFINITY];
                for (k, p) in corners.iter().enumerate() {
                    let q = corners[(k + 1) % 4];
                    if u < p[1].min(q[1]) || u > p[1].max(q[1]) || p[1] == q[1] {
                        continue;
                    }
                    let place = p[0] + (u - p[1]) / (q[1] - p[1]) * (q[0] - p[0]);
                    [low, high] = [low.min(place), high.max(place)];
                }
                [low, high.max(low)]
            }
        };
        let at = [0, 1].map(|k| self.base[k] + u * self.side[k]);
        (Line { at, low, high }, self.reach * cosine)
    }

    /// Lines by a rule for each part whose ends are smooth, and their shares of the area.
    fn lines(&self, rule: &[[f64; 2]]) -> Vec<(Line, f64)> {
        let cuts = self.cuts(&[]);
        let angles = cuts.windows(2).flat_map(|pair| {
            let (middle, half) = (0.5 * (pair[0] + pair[1]), 0.5 * (pair[1] - pair[0]));
            let at = move |[x, weight]: &[f64; 2]| (middle + half * x, half * weight);
            rule.iter().map(at)
        });
        let lines = angles.map(|(angle, share)| {
            let (line, weight) = self.line(angle);
            (line, share * weight)
        });
        lines.filter(|(line, _)| line.low < line.high).collect()
    }

    /// The places of its outer lines in the normal plane.
    fn across(&self) -> [[f64; 2]; 2] {
        [-1.0, 1.0].map(|sign| [0, 1].map(|k| self.base[k] + sign * self.reach * self.side[k]))
    }

    /// The angle of the line that is nearest to a place in the normal plane.
    fn nearest(&self, at: [f64; 2]) -> f64 {
        let u = [0, 1].map(|k| (at[k] - self.base[k]) * self.side[k]);
        self.angle(u[0] + u[1])
    }

    fn angle(&self, u: f64) -> f64 {
        libm::asin((u / self.reach).clamp(-1.0, 1.0))
    }

    /// Angles between which ends are smooth, and these more.
    fn cuts(&self, more: &[f64]) -> Vec<f64> {
        let mut cuts = vec![-FRAC_PI_2, FRAC_PI_2];
        if let Ends::Polygon(corners) = &self.ends {
            cuts.extend(corners.iter().map(|p| self.angle(p[1])));
        }
        cuts.extend(more.iter().copied().filter(|it| it.is_finite()));
        cuts.sort_by(f64::total_cmp);
        cuts.dedup_by(|a, b| *a - *b < 1e-12);
        cuts
    }

    /// The angle where its plane cuts the other stack's, if it does.
    fn crossing(&self, other: &Self) -> Option<f64> {
        let normal = [-other.side[1], other.side[0]];
        let dot = |p: [f64; 2]| p[0] * normal[0] + p[1] * normal[1];
        let slant = dot(self.side);
        let way = [0, 1].map(|k| other.base[k] - self.base[k]);
        let u = dot(way) / slant;
        (slant != 0.0 && u.abs() < self.reach).then(|| self.angle(u))
    }
}

/// The integral of 1 / r over two parallel lines.
fn of_lines(a: &Line, b: &Line) -> f64 {
    let square = (a.at[0] - b.at[0]).powi(2) + (a.at[1] - b.at[1]).powi(2);
    // Lines on each other have no integral, and are met by no point of a quadrature but by chance.
    let square = square.max(1e-30 * (a.high - a.low).powi(2));
    let log = 0.5 * libm::log(square);
    // s asinh(s / rho) - sqrt(s^2 + rho^2)
    let g = |s: f64| {
        let root = (s * s + square).sqrt();
        s.abs() * (libm::log(s.abs() + root) - log) - root
    };
    g(a.high - b.low) - g(a.low - b.low) - g(a.high - b.high) + g(a.low - b.high)
}

/// Numbers of fixed lines, and how far apart two stacks are, in reaches of the larger, so that these many
/// leave less than 1e-8 of the integral: energies are small differences of four.
const LINES: [(usize, f64); 5] = [(12, 2.0), (16, 1.0), (24, 0.6), (32, 0.45), (40, 0.35)];

static RULES: LazyLock<Vec<Vec<[f64; 2]>>> =
    LazyLock::new(|| LINES.iter().map(|(count, _)| gauss(*count)).collect());

/// The integral of 1 / r over two faces of one kind, with an error of about `allowed`, or 1e-8 of it.
pub(super) fn integral(a: &ChargedFace, b: &ChargedFace, allowed: f64) -> f64 {
    let (first, second) = (Stack::of(a), Stack::of(b));
    let apart = between_edges(first.across(), second.across()) / first.reach.max(second.reach);
    match LINES.iter().position(|(_, least)| apart >= *least) {
        Some(at) => by_rule(&first, &second, &RULES[at]),
        None => adaptive(a, b, allowed),
    }
}

fn by_rule(first: &Stack, second: &Stack, rule: &[[f64; 2]]) -> f64 {
    let [first, second] = [first, second].map(|stack| stack.lines(rule));
    let over = |(line, weight): &(Line, f64)| {
        let each = second
            .iter()
            .map(|(other, weight)| weight * of_lines(line, other));
        weight * each.sum::<f64>()
    };
    first.iter().map(over).sum()
}

/// The same in halves, however near they are.
pub(super) fn adaptive(a: &ChargedFace, b: &ChargedFace, allowed: f64) -> f64 {
    let (first, second) = (Stack::of(a), Stack::of(b));
    let ends = [-FRAC_PI_2, FRAC_PI_2].map(|angle| first.nearest(second.line(angle).0.at));
    // Where lines come close to each other, integrands bend sharply.
    let more: Vec<f64> = ends.into_iter().chain(first.crossing(&second)).collect();
    let inner = |angle: f64| {
        let (line, weight) = first.line(angle);
        if line.high <= line.low {
            return 0.0;
        }
        let over = |angle: f64| {
            let (other, weight) = second.line(angle);
            weight * of_lines(&line, &other)
        };
        let cuts = second.cuts(&[second.nearest(line.at)]);
        weight * total(&over, &cuts, allowed / (4.0 * first.reach))
    };
    total(&inner, &first.cuts(&more), allowed)
}

fn total(f: &impl Fn(f64) -> f64, cuts: &[f64], allowed: f64) -> f64 {
    let parts = cuts.windows(2).map(|pair| [pair[0], pair[1]]);
    parts.map(|part| halved(f, part, allowed, 20)).sum()
}
