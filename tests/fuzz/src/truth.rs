//! Energies of dipoles and blocks, enclosed in plain interval arithmetic.

use physics::Configuration;
use physics::tile::{Magnet, Tile};
use physics::units::MU0_OVER_4PI;

use super::interval::Interval;

type Pair = [Interval; 2];

fn number(x: f64) -> Interval {
    Interval::of(x)
}

/// Sine and cosine of an angle between -4 and 4, by their series: what follows the term of degree
/// 44 is less than 4^45/45! < 1e-25.
fn sin_cos(x: Interval) -> Pair {
    let (mut sine, mut cosine, mut term) = (number(0.0), number(1.0), number(1.0));
    for degree in 1..=44 {
        term = term * x / number(f64::from(degree));
        match degree % 4 {
            1 => sine = sine + term,
            2 => cosine = cosine - term,
            3 => sine = sine - term,
            _ => cosine = cosine + term,
        }
    }
    [sine, cosine].map(|value| value + Interval::around_zero(1e-25))
}

fn turned([x, y]: Pair, [sine, cosine]: Pair) -> Pair {
    [x * cosine - y * sine, x * sine + y * cosine]
}

fn plus([a, b]: Pair, [c, d]: Pair) -> Pair {
    [a + c, b + d]
}

fn minus([a, b]: Pair, [c, d]: Pair) -> Pair {
    [a - c, b - d]
}

fn times([a, b]: Pair, factor: Interval) -> Pair {
    [a * factor, b * factor]
}

fn dot([a, b]: Pair, [c, d]: Pair) -> Interval {
    a * c + b * d
}

/// A magnet where it lies: its middle and the direction of its moment.
struct Placed<'a> {
    magnet: &'a Magnet,
    at: Pair,
    axis: Pair,
}

impl<'a> Placed<'a> {
    fn new(magnet: &'a Magnet, shift: Pair, turn: Pair) -> Self {
        let [sine, cosine] = sin_cos(number(magnet.angle));
        let at = [magnet.position.x, magnet.position.y].map(number);
        Self {
            magnet,
            at: plus(turned(at, turn), shift),
            axis: turned([cosine, sine], turn),
        }
    }
}

/// Every pair of magnets, one of each tile, the moving one at the offset `d` from `centre`.
fn pairs<'a>(
    fixed: &'a Tile,
    moving: &'a Tile,
    centre: &Configuration,
    d: [f64; 3],
) -> Vec<[Placed<'a>; 2]> {
    let [x, y, theta] = std::array::from_fn(|k| number(centre.to_array()[k]) + number(d[k]));
    let none = [0.0, 1.0].map(number);
    let mut all = Vec::new();
    for first in &fixed.magnets {
        for second in &moving.magnets {
            all.push([
                Placed::new(first, [0.0, 0.0].map(number), none),
                Placed::new(second, [x, y], sin_cos(theta)),
            ]);
        }
    }
    all
}

/// The energy (J) of point dipoles.
pub fn of_dipoles(fixed: &Tile, moving: &Tile, centre: &Configuration, d: [f64; 3]) -> Interval {
    let energy = |[first, second]: [Placed; 2]| {
        let apart = minus(second.at, first.at);
        let square = dot(apart, apart);
        let cube = square * square.sqrt();
        let along = dot(first.axis, apart) * dot(second.axis, apart) / square;
        let angular = dot(first.axis, second.axis) - number(3.0) * along;
        let strength = number(first.magnet.moment) * number(second.magnet.moment);
        number(MU0_OVER_4PI) * strength * angular / cube
    };
    let all = pairs(fixed, moving, centre, d).into_iter().map(energy);
    all.fold(number(0.0), |sum, energy| sum + energy)
}

/// Weights of Boole's rule, of 90.
const BOOLE: [f64; 5] = [7.0, 32.0, 12.0, 32.0, 7.0];
/// Panels are no longer than this share of the distance of the faces.
const PANEL: f64 = 0.7;
/// Most points of the rule for one pair of faces.
const MOST_POINTS: usize = 400_000;

/// Nodes of Boole's composite rule on [-1/2, 1/2] with their weights, which add up to 1.
fn nodes(panels: usize) -> Vec<(Interval, Interval)> {
    let all = number(panels as f64);
    let mut nodes = Vec::new();
    for panel in 0..panels {
        for (k, weight) in BOOLE.into_iter().enumerate() {
            let place = number((4 * panel + k) as f64) / (number(4.0) * all) - number(0.5);
            nodes.push((place, number(weight) / (number(90.0) * all)));
        }
    }
    nodes
}

/// The energy (J) of blocks as charged pole faces; `None` if faces are too close for a plain rule.
pub fn of_blocks(
    fixed: &Tile,
    moving: &Tile,
    centre: &Configuration,
    d: [f64; 3],
) -> Option<Interval> {
    let mut sum = number(0.0);
    for [first, second] in pairs(fixed, moving, centre, d) {
        let [a, b] = [&first, &second].map(|placed| {
            let [along, across, high] = placed.magnet.size.map(number);
            // The face's charge: magnetisation times its area.
            number(placed.magnet.moment) / (along * across * high) * across * high
        });
        for (s, one) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
            let mean = mean_of_reciprocals(&first, s, &second, one)?;
            sum = sum + number(s * one) * a * b * mean;
        }
    }
    Some(number(MU0_OVER_4PI) * sum)
}

/// The mean of 1/r between the points of two pole faces, each given by its side.
///
/// The sixth derivative of 1/r along a line is at most 6!/r^7 (Legendre), so that a panel of length
/// h gives the mean along one edge to within `6! h^6 / 1935360 / r^7` (the remainder of Boole's rule
/// is 8/945 (h/4)^7 f'''''').
fn mean_of_reciprocals(
    first: &Placed,
    side: f64,
    second: &Placed,
    other_side: f64,
) -> Option<Interval> {
    let face = |placed: &Placed, side: f64| {
        let [along, across, _] = placed.magnet.size;
        let middle = plus(
            placed.at,
            times(placed.axis, number(side) * number(along) / number(2.0)),
        );
        let [x, y] = placed.axis;
        (middle, times([-y, x], number(across)))
    };
    let ((at, edge), (other_at, other_edge)) = (face(first, side), face(second, other_side));
    let distance = least_distance(at, edge, other_at, other_edge);
    let [_, across, high] = first.magnet.size;
    let [_, other_across, other_high] = second.magnet.size;
    let lengths = [across, other_across, high, other_high];
    let panels = lengths.map(|length| (length / (PANEL * distance)).ceil().max(1.0));
    if distance.is_nan()
        || distance <= 0.0
        || panels.iter().product::<f64>() * 625.0 > MOST_POINTS as f64
    {
        return None;
    }
    let [s, t, z, w] = panels.map(|count| nodes(count as usize));
    let mut mean = number(0.0);
    for (s, first_weight) in &s {
        for (t, second_weight) in &t {
            let flat = minus(
                plus(at, times(edge, *s)),
                plus(other_at, times(other_edge, *t)),
            );
            let square = dot(flat, flat);
            let mut inner = number(0.0);
            for (z, third_weight) in &z {
                for (w, fourth_weight) in &w {
                    let rise = number(high) * *z - number(other_high) * *w;
                    let reciprocal = number(1.0) / (square + rise * rise).sqrt();
                    inner = inner + *third_weight * *fourth_weight * reciprocal;
                }
            }
            mean = mean + *first_weight * *second_weight * inner;
        }
    }
    let remainder = |(length, panels): (f64, f64)| {
        720.0 / 1_935_360.0 * (length / panels / distance).powi(6) / distance
    };
    let error: f64 = lengths.into_iter().zip(panels).map(remainder).sum();
    Some(mean + Interval::around_zero(1.0001 * error))
}

/// A lower bound of the distance (m) of two segments, each given by its middle and its whole edge:
/// points of either a few tenths of a millimetre apart, less what lies between them.
fn least_distance(at: Pair, edge: Pair, other_at: Pair, other_edge: Pair) -> f64 {
    const STEPS: usize = 32;
    let points = |at: Pair, edge: Pair| {
        let share = |k: usize| number(k as f64 / STEPS as f64 - 0.5);
        (0..=STEPS).map(move |k| plus(at, times(edge, share(k))))
    };
    let length = |edge: Pair| dot(edge, edge).sqrt().most();
    let mut least = f64::INFINITY;
    for p in points(at, edge) {
        for q in points(other_at, other_edge) {
            let apart = minus(p, q);
            least = least.min(dot(apart, apart).sqrt().least());
        }
    }
    least - (length(edge) + length(other_edge)) / (2.0 * STEPS as f64)
}
