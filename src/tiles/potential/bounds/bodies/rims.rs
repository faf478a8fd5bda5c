//! What the rims of two magnets' faces say about the third derivatives of their energy: closer together
//! than a radius, far more than the faces do.
//!
//! Let `f = 1 / r` for points of two faces P1 and P2 of charge density 1, of which P2 moves, nu their
//! outward normals in their own planes, and t, n the tangent and the normal of a face that lies, in the
//! tiles' plane. As f is harmonic, `f_nn = -f_tt - f_zz`, so that for any two unit vectors a and b of the
//! tiles' plane `f_ab = d/dt f_w - a_n b_n f_zz`, where w is the unit vector whose angle from t is the sum
//! of theirs. Integrated over the face, second derivatives become an integral along its rim:
//!
//! `int f_ab dA = int (nu_t f_w - a_n b_n nu_z f_z) dl`, at most `int dl / r^2`.
//!
//! Used for P1 and then for P2, the third derivative for a shift of P2 is at most
//!
//! `K = int int (|nu1_t| + |nu1_z| |nu2_z|) dl1 dl2 / r^2 <= int sqrt(1 + nu2_z^2) (int dl1 / r^2) dl2`.
//!
//! Where P2 also turns by w, its points move off their plane by s w, s at most S: each s remains a factor of
//! at most S, or its derivative leaves an integral over P2, of `int |nu1_t| dl1 int dA2 / r^2`, at most X.
//! With c the speed of the middle of P2, and `v = c + S w`, the third derivative is at most
//!
//! `K v^3 + 3 X w v^2`.
//!
//! With f replaced by one of its derivatives, which is harmonic as well and has slopes of at most `2 / r^3`,
//! the fourth derivative is at most `L v^4 + 4 Y w v^3`, where L and Y are K and X with `2 / r^3` instead of
//! `1 / r^2`. The same holds for faces that stand, all of whose motions are along them, without the root.
//!
//! From a point at the distances p and q from the nearest and the farthest point of a circle of radius R,
//! `int dl / r^2 = 2 pi R / (p q)`. K and L are sums over arcs of the other rim, with the least p and q of each.

use std::f64::consts::PI;
use std::sync::LazyLock;

use nalgebra::Vector2;

use crate::potential::bodies::Body;
use crate::potential::simd::Level;
use crate::potential::simd::lanes::{Lanes, Task, WIDTH};
use crate::tile::magnet::Shape;

/// Arcs of half a rim, in whole vectors.
const ARCS: usize = 2 * WIDTH;
/// Of the arcs of half a circle: cosines and sines of their middles, and the largest roots that stand in K.
static ARC: LazyLock<[[f64; ARCS]; 3]> = LazyLock::new(|| {
    let arcs: [[f64; 3]; ARCS] = std::array::from_fn(|k| {
        let step = PI / ARCS as f64;
        let (sin, cos) = libm::sincos((k as f64 + 0.5) * step);
        let most = (sin + step / 2.0).min(1.0);
        [cos, sin, (1.0 + most * most).sqrt()]
    });
    [0, 1, 2].map(|i| arcs.map(|arc| arc[i]))
});

/// The rims of two discs that both lie or both stand.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rims {
    radii: [f64; 2],
    /// By pairs of faces as in [`distances`](super::faces::distances): from the middle of the first to that of
    /// the second (m), along the first face and across it.
    ways: [[f64; 2]; 4],
    /// The horizontal diameter of the second, in the same directions.
    diameter: [f64; 2],
    stand: bool,
}

impl Rims {
    /// Of two magnets; `None` if they are no discs.
    pub fn of(first: &Body, second: &Body) -> Option<Self> {
        if [first, second].iter().any(|it| it.shape != Shape::Disc) {
            return None;
        }
        let way = second.position - first.position;
        if first.stands {
            let distance = way.norm();
            let [one, other] = [first, second].map(|it| it.size[2] / 2.0);
            let [like, unlike] = [(one - other).abs(), one + other];
            return Some(Self {
                radii: [first, second].map(|it| it.size[0] / 2.0),
                ways: [like, like, unlike, unlike].map(|height| [distance, height]),
                diameter: [1.0, 0.0],
                stand: true,
            });
        }
        let normal = first.direction;
        let seen = |v: Vector2<f64>| [normal.perp(&v), normal.dot(&v)];
        let [one, other] = [first, second].map(|it| it.direction * (it.size[0] / 2.0));
        let ways = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];
        Some(Self {
            radii: [first, second].map(|it| it.size[1] / 2.0),
            ways: ways.map(|[a, b]| seen(way - one * a + other * b)),
            diameter: seen(Vector2::new(-second.direction.y, second.direction.x)),
            stand: false,
        })
    }

    /// K and L (1, 1/m) of a pair of faces that stay `apart` (m), while points move by at most `reach` (m).
    pub fn limits(&self, pair: usize, [apart, reach]: [f64; 2]) -> [f64; 2] {
        Level::best().run(Arcs {
            rims: self,
            way: self.ways[pair],
            apart,
            reach,
        })
    }
}

/// K and L of two faces, see [`Rims::limits`].
struct Arcs<'a> {
    rims: &'a Rims,
    way: [f64; 2],
    apart: f64,
    reach: f64,
}

impl Task for Arcs<'_> {
    type Output = [f64; 2];

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> [f64; 2] {
        let &Rims {
            radii: [one, other],
            diameter,
            stand,
            ..
        } = self.rims;
        let half_arc = other * (PI / (2 * ARCS) as f64);
        let (apart, margin) = (l.splat(self.apart), l.splat(self.reach + half_arc));
        let (own, along, up) = (l.splat(one), l.splat(self.way[0]), l.splat(self.way[1]));
        let [mut third, mut fourth] = [l.splat(0.0); 2];
        for k in (0..ARCS).step_by(WIDTH) {
            let aside = l.mul(l.splat(other), l.load(&ARC[0][k..]));
            let over = l.mul(l.splat(other), l.load(&ARC[1][k..]));
            let x = l.mul_add(aside, l.splat(diameter[0]), along);
            let h = l.mul_add(aside, l.splat(diameter[1]), up);
            let a = l.sqrt(l.mul_add(x, x, l.mul(over, over)));
            let square = l.mul(h, h);
            let (within, beyond) = (l.sub(a, own), l.add(a, own));
            let near = l.sub(l.sqrt(l.mul_add(within, within, square)), margin);
            let far = l.sub(l.sqrt(l.mul_add(beyond, beyond, square)), margin);
            let (near, far) = (l.max(near, apart), l.max(far, apart));
            let root = match stand {
                true => l.splat(1.0),
                false => l.load(&ARC[2][k..]),
            };
            let each = l.div(root, l.mul(near, far));
            third = l.add(third, each);
            fourth = l.add(fourth, l.div(l.add(each, each), near));
        }
        // Both halves of the rim are alike.
        let scale = 4.0 * half_arc * 2.0 * PI * one;
        [scale * l.sum(third), scale * l.sum(fourth)]
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::apart::Apart;
    use super::super::super::apart::tests::check;
    use super::super::faces::{PoleFace, distances};
    use super::*;
    use crate::potential::bodies::exact;
    use crate::units::MU0_OVER_4PI;

    /// Third derivatives by time, by differences of the energy along shifts and turns, are within the bound,
    /// and it is not much wider.
    #[test]
    fn third_derivatives_stay_within_their_bounds() {
        let (mut count, mut closest) = (0, [[f64::INFINITY; 2]; 2]);
        for k in 0..600u32 {
            let stands = k % 3 == 2;
            let even = |by: f64| 2.0 * (by * f64::from(k)).fract() - 1.0;
            let body = |position: Vector2<f64>, turn: f64| Body {
                position,
                direction: Vector2::new(libm::cos(turn), libm::sin(turn)),
                moment: 1.0,
                size: if stands {
                    [0.006, 0.006, 0.003]
                } else {
                    [0.003, 0.006, 0.006]
                },
                shape: Shape::Disc,
                stands,
            };
            let first = body(Vector2::zeros(), 0.0);
            let turn = [0.0, 0.05, 3.0][k as usize / 3 % 3] * even(0.618);
            let second = body(
                match stands {
                    true => Vector2::new(0.0065 + 0.001 * even(0.41), 0.001 * even(0.73)),
                    false => Vector2::new(0.0045 + 0.0015 * even(0.41), 0.006 * even(0.73)),
                },
                turn,
            );
            let between = distances(&first, &second);
            let least = between.map(|[aside, up]| libm::hypot(aside, up));
            if least.into_iter().fold(f64::INFINITY, f64::min) < 5e-4
                || between.iter().any(|it| it[0] <= 0.0)
            {
                continue;
            }
            let way = 2.4 * f64::from(k);
            let way = Vector2::new(libm::cos(way), libm::sin(way));
            // Lengths per time that go on over h = 0.01.
            let (h, speed, turning) = (0.008, 0.01, [0.0, 2.0][k as usize % 2]);
            let turning = if stands { 0.0 } else { turning };
            let radius = second.radius();
            let reach = (speed + turning * radius) * 2.0 * h;
            let [a, b] = [&first, &second].map(PoleFace::new);
            let rims = Rims::of(&first, &second).unwrap();
            let v = speed + turning * 0.0045;
            let mut third = 0.0;
            for (k, [aside, height]) in between.into_iter().enumerate() {
                let apart = libm::hypot((aside - reach).max(0.0), height);
                let limits = a.limits(&b, apart);
                let [k1, k2, x] = [limits.first, limits.second, limits.x];
                third += rims.limits(k, [apart, reach])[0] * v.powi(3) + 3.0 * x * turning * v * v;
                third += 3.0 * k2 * v * radius * turning * turning + k1 * radius * turning.powi(3);
            }
            let density = 1.0 / first.volume();
            let strength = MU0_OVER_4PI * density * density;
            let at = |t: f64| {
                let (sin, cos) = libm::sincos(turn + turning * t);
                exact(
                    &first,
                    &Body {
                        position: second.position + way * (speed * t),
                        direction: Vector2::new(cos, sin),
                        ..second
                    },
                )
                .energy
            };
            let bounds = Apart {
                energy: 4.0 * strength * first.volume(),
                slope: f64::INFINITY,
                remainder: strength * third / 6.0,
                is_coarse: false,
            };
            let ratio = check(&bounds, &at, (0.0, h, 1e-11), &k.to_string())[2];
            let of = &mut closest[usize::from(stands)][usize::from(turning > 0.0)];
            *of = of.min(ratio);
            count += 1;
        }
        assert!(count > 300, "{count}");
        let [[lying, turned], [standing, _]] = closest;
        let is_tight = lying < 7.0 && turned < 60.0 && standing < 7.0;
        assert!(is_tight, "{closest:?}");
    }
}
