//! The energy of two uniformly charged faces.

use super::faces::{ChargedFace, Outline, far, near};
use super::stacks;

/// The integral of charge times charge over distance.
pub(super) fn energy(a: &ChargedFace, b: &ChargedFace) -> f64 {
    let height = |it: &ChargedFace| it.height.unwrap_or(0.0);
    let way = [
        b.middle[0] - a.middle[0],
        b.middle[1] - a.middle[1],
        height(b) - height(a),
    ];
    let size = a.half[0] + a.half[1] + b.half[0] + b.half[1];
    let distance = libm::hypot(libm::hypot(way[0], way[1]), way[2]);
    let is_upright_rectangle =
        |it: &ChargedFace| it.height.is_none() && it.outline == Outline::Rectangle;
    let scale = a.area() * b.area() / (distance + size);
    // Fixed places leave less than 1e-7 of the integral.
    let integral = if distance > 3.0 * size {
        far(a, b, way)
    } else if is_upright_rectangle(a) && is_upright_rectangle(b) {
        near(a, b, [way[0], way[1]])
    } else {
        stacks::integral(a, b, 1e-8 * scale)
    };
    a.charge * b.charge * integral
}

#[cfg(test)]
mod tests {
    use super::*;

    const KINDS: [(Outline, bool); 4] = [
        (Outline::Rectangle, true),
        (Outline::Disc, true),
        (Outline::Rectangle, false),
        (Outline::Disc, false),
    ];

    fn face(
        (outline, upright): (Outline, bool),
        pose: [f64; 3],
        size: f64,
        height: f64,
    ) -> ChargedFace {
        let half = match outline {
            Outline::Rectangle => [size, 0.6 * size],
            Outline::Disc => [size; 2],
        };
        let along = [libm::cos(pose[2]), libm::sin(pose[2])];
        let place = ([pose[0], pose[1]], (!upright).then_some(height));
        ChargedFace::new(outline, place, along, half, 1.0)
    }

    /// The integral as a sum over small squares of both faces.
    fn summed(a: &ChargedFace, b: &ChargedFace) -> f64 {
        let squares = |it: &ChargedFace| -> Vec<[f64; 3]> {
            let part = |k: i32| (2.0 * f64::from(k) + 1.0) / 40.0 - 1.0;
            let all = (0..40).flat_map(|i| (0..40).map(move |j| [part(i), part(j)]));
            let is_inside =
                |p: &[f64; 2]| it.outline == Outline::Rectangle || libm::hypot(p[0], p[1]) < 1.0;
            let place = |[u, v]: [f64; 2]| {
                let ([u, v], [c, s]) = ([u * it.half[0], v * it.half[1]], it.along);
                let [x, y] = it.middle;
                match it.height {
                    None => [x + u * c, y + u * s, v],
                    Some(z) => [x + u * c - v * s, y + u * s + v * c, z],
                }
            };
            all.filter(is_inside).map(place).collect()
        };
        let (first, second) = (squares(a), squares(b));
        let over = |p: &[f64; 3]| -> f64 {
            let apart = |q: &[f64; 3]| (0..3).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>();
            second.iter().map(|q| 1.0 / apart(q).sqrt()).sum()
        };
        let sum: f64 = first.iter().map(over).sum();
        sum * a.area() * b.area() / (first.len() * second.len()) as f64
    }

    #[test]
    fn faces_of_every_two_kinds_agree_with_sums_over_small_squares() {
        for a in KINDS {
            for b in KINDS.into_iter().filter(|b| a.1 == b.1) {
                for pose in [[1.0, 0.4, 1.1], [0.2, 0.9, -0.4], [9.0, 2.0, 2.0]] {
                    let (a, b) = (face(a, [0.0, 0.0, 0.3], 0.5, 0.0), face(b, pose, 0.4, 0.35));
                    let (found, sum) = (energy(&a, &b), summed(&a, &b));
                    assert!((found / sum - 1.0).abs() < 3e-3, "{pose:?} {found} {sum}");
                }
            }
        }
    }

    /// Three ways: fixed places, stacks of lines, and for upright rectangles a closed form.
    #[test]
    fn the_formulas_agree_with_each_other() {
        for a in KINDS {
            for b in KINDS.into_iter().filter(|b| a.1 == b.1) {
                // As near as fixed places are used, in sums of the half sides, and nearer.
                for apart in [3.0, 2.0, 1.5, 1.2, 1.0, 0.9, 0.8, 0.7, 0.6, 0.5] {
                    for turn in [0.0, 0.5, 1.0, 1.5] {
                        let fixed = face(a, [0.0, 0.0, 0.3], 0.5, 0.0);
                        let size = |it: &ChargedFace| it.half[0] + it.half[1];
                        let other = face(b, [0.0, 0.0, 2.0], 0.4, 0.35);
                        let height = other.height.unwrap_or(0.0);
                        let r = apart * (size(&fixed) + size(&other));
                        let across = (r * r - height * height).sqrt();
                        let place = [across * libm::cos(turn), across * libm::sin(turn)];
                        let other = other.moved(place);
                        let exact = stacks::adaptive(&fixed, &other, 1e-12);
                        let off = |found: f64| (found / exact - 1.0).abs();
                        let by_lines = off(stacks::integral(&fixed, &other, 1e-9));
                        assert!(by_lines < 1e-8, "{a:?} {b:?} {apart} {turn} {by_lines:e}");
                        if apart == 3.0 {
                            let by_places = off(far(&fixed, &other, [place[0], place[1], height]));
                            assert!(by_places < 1e-7, "{a:?} {b:?} {turn} {by_places:e}");
                        }
                    }
                }
            }
        }
        for pose in [
            [0.5, 0.1, 0.3],
            [0.1, 0.2, 1.4],
            [0.0, 0.0, 0.3],
            [0.45, 0.0, 0.0],
        ] {
            let (a, b) = (
                face(KINDS[0], [0.0, 0.0, 0.3], 0.5, 0.0),
                face(KINDS[0], pose, 0.4, 0.0),
            );
            let ratio = stacks::adaptive(&a, &b, 1e-9) / near(&a, &b, [pose[0], pose[1]]);
            assert!((ratio - 1.0).abs() < 1e-6, "{pose:?} {ratio}");
        }
    }

    /// Two coincident unit squares: 4 ln(1 + sqrt 2) - (4 / 3) (sqrt 2 - 1); two discs of radius 1:
    /// 16 pi / 3.
    #[test]
    fn faces_on_themselves_have_the_known_energies() {
        let root = 2f64.sqrt();
        let square = 4.0 * libm::log(1.0 + root) - 4.0 / 3.0 * (root - 1.0);
        let disc = 16.0 * std::f64::consts::PI / 3.0;
        for upright in [true, false] {
            for (outline, half, known) in [
                (Outline::Rectangle, 0.5, square),
                (Outline::Disc, 1.0, disc),
            ] {
                let place = ([0.1, 0.2], (!upright).then_some(0.1));
                let it = ChargedFace::new(outline, place, [0.6, 0.8], [half; 2], 1.0);
                let ratio = energy(&it, &it) / known;
                let allowed = if upright && outline == Outline::Rectangle {
                    1e-9
                } else {
                    1e-6
                };
                assert!(
                    (ratio - 1.0).abs() < allowed,
                    "{outline:?} {upright} {ratio}"
                );
            }
        }
    }
}
