//! The distance of two polygons, and how deep they overlap.

use super::given::Pose;

type P = [f64; 2];

/// A polygon at a pose.
pub(super) fn placed(outline: &[P], [x, y, theta]: Pose) -> Vec<P> {
    let (sine, cosine) = (libm::sin(theta), libm::cos(theta));
    let at = |p: &P| {
        [
            x + cosine * p[0] - sine * p[1],
            y + sine * p[0] + cosine * p[1],
        ]
    };
    outline.iter().map(at).collect()
}

/// The radius of gyration (m) of a polygon about the origin.
pub(super) fn gyration(polygon: &[P]) -> f64 {
    let [mut area, mut moment] = [0.0; 2];
    for (p, q) in edges(polygon) {
        let cross = p[0] * q[1] - p[1] * q[0];
        let square = |k: usize| p[k] * p[k] + p[k] * q[k] + q[k] * q[k];
        area += cross / 2.0;
        moment += cross * (square(0) + square(1)) / 12.0;
    }
    (moment / area).sqrt()
}

/// The distance (m) of two polygons that lie apart; of others, minus the depth of the point of either's
/// rim that is deepest in the other.
pub(super) fn clearance(a: &[P], b: &[P]) -> f64 {
    let depth = depth(a, b).max(depth(b, a));
    if depth > 0.0 {
        return -depth;
    }
    let mut least = f64::INFINITY;
    for (p, q) in edges(a) {
        for (r, s) in edges(b) {
            let apart = |k: usize| {
                let [low, high] = [r[k].min(s[k]), r[k].max(s[k])];
                (low - p[k].max(q[k])).max(p[k].min(q[k]) - high)
            };
            if apart(0).max(apart(1)) >= least {
                continue;
            }
            let ends = [
                to_edge(p, r, s),
                to_edge(q, r, s),
                to_edge(r, p, q),
                to_edge(s, p, q),
            ];
            least = ends.into_iter().fold(least, f64::min);
        }
    }
    least
}

fn edges(polygon: &[P]) -> impl Iterator<Item = (P, P)> + '_ {
    let next = |k: usize| polygon[(k + 1) % polygon.len()];
    polygon.iter().enumerate().map(move |(k, p)| (*p, next(k)))
}

/// How deep (m) the rim of `a` dips into `b`; 0 if it does not.
fn depth(a: &[P], b: &[P]) -> f64 {
    let mut deepest = 0.0f64;
    let bounds = |k: usize| {
        let all = b.iter().map(move |p| p[k]);
        [
            all.clone().fold(f64::INFINITY, f64::min),
            all.fold(f64::NEG_INFINITY, f64::max),
        ]
    };
    let bounds = [bounds(0), bounds(1)];
    for (p, q) in edges(a) {
        let is_aside = |k: usize| p[k].max(q[k]) < bounds[k][0] || p[k].min(q[k]) > bounds[k][1];
        if is_aside(0) || is_aside(1) {
            continue;
        }
        // The edge in pieces between the places where it crosses the other rim.
        let mut cuts = vec![0.0, 1.0];
        cuts.extend(edges(b).filter_map(|(r, s)| crossing(p, q, r, s)));
        cuts.sort_by(f64::total_cmp);
        let at = |t: f64| [p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])];
        let middles = cuts.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
        for point in cuts.iter().copied().chain(middles).map(at) {
            if is_inside(point, b) {
                let distances = edges(b).map(|(r, s)| to_edge(point, r, s));
                deepest = deepest.max(distances.fold(f64::INFINITY, f64::min));
            }
        }
    }
    deepest
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

/// Whether a ray from a point crosses the rim an odd number of times.
fn is_inside(p: P, polygon: &[P]) -> bool {
    let crossings = edges(polygon).filter(|(a, b)| {
        (a[1] > p[1]) != (b[1] > p[1])
            && p[0] < a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
    });
    crossings.count() % 2 == 1
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
        let at = |x, y, theta| clearance(&SQUARE, &placed(&SQUARE, [x, y, theta]));
        assert!((at(1.5, 0.2, 0.0) - 0.5).abs() < 1e-15);
        assert_eq!(at(1.0, 0.3, 0.0), 0.0);
        assert!((at(0.9, 0.3, 0.0) + 0.1).abs() < 1e-12);
        assert!((at(2.0, 2.0, 0.0) - 2f64.sqrt()).abs() < 1e-15);
        // A bar across, with no corner inside.
        let bar = [[-1.0, 0.4], [2.0, 0.4], [2.0, 0.6], [-1.0, 0.6]];
        assert!((clearance(&SQUARE, &bar) + 0.4).abs() < 1e-12);
        let corner = at(1.0 + 0.5f64.sqrt() - 0.01, 0.1, std::f64::consts::FRAC_PI_4);
        assert!((corner + 0.01).abs() < 1e-9, "{corner}");
    }
}
