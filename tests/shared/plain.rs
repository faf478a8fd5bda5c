//! Point dipoles by the plain formulas, one pair at a time, bare or behind shields: the reference
//! for the kernels, groups and tables of many dipoles.

use nalgebra::{Vector2, Vector3};
use tilebind::Configuration;
use tilebind::potential::dipole::{Dipole, pair};
use tilebind::potential::shielding::{Shield, ShieldRule, Shields};
use tilebind::potential::{Potential, motion};
use tilebind::tile::{Magnet, Tile};
use tilebind::units::MU0_OVER_4PI;

/// A magnet's shield and the normal of its face.
pub type Front = (Option<Shield>, Vector2<f64>);

/// The interaction energy of two sets of point dipoles, one in each tile.
pub struct Plain {
    magnets: [Vec<(Dipole, Front, usize)>; 2],
    /// Midpoints of the faces, if only the nearest ones act.
    middles: Option<[Vec<Vector2<f64>>; 2]>,
}

impl Plain {
    /// The energy of dipoles without shields.
    pub fn new(fixed: &[Dipole], moving: &[Dipole]) -> Self {
        let bare = |dipole: &Dipole| (*dipole, (None, Vector2::x()), 0);
        Self {
            magnets: [fixed, moving].map(|dipoles| dipoles.iter().map(bare).collect()),
            middles: None,
        }
    }

    /// The energy of tiles with shields.
    pub fn shielded([fixed, moving]: [&Tile; 2], shields: &Shields) -> Self {
        let smooth = shields.rule == ShieldRule::Smooth;
        let magnets = |tile: &Tile, shields: &[Option<Shield>]| {
            let magnet = |magnet: &Magnet| {
                let shield = shields.get(magnet.face).copied().flatten();
                let normal = tile.faces[magnet.face].normal();
                let front = (shield.filter(|_| smooth), normal);
                (Dipole::from(magnet), front, magnet.face)
            };
            tile.magnets.iter().map(magnet).collect()
        };
        let middles = |tile: &Tile| tile.faces.iter().map(|face| face.middle()).collect();
        Self {
            magnets: [
                magnets(fixed, &shields.fixed),
                magnets(moving, &shields.moving),
            ],
            middles: (!smooth).then(|| [fixed, moving].map(middles)),
        }
    }

    fn lever(&self) -> f64 {
        let distances = self.magnets[1].iter().map(|(d, ..)| d.position.norm());
        distances.fold(1e-3, f64::max)
    }

    /// The pair of faces that acts alone.
    fn faces(&self, q: &Configuration) -> Option<[usize; 2]> {
        let [fixed, moving] = self.middles.as_ref()?;
        let pairs = (0..moving.len()).flat_map(|j| (0..fixed.len()).map(move |i| [i, j]));
        let distance = |&[i, j]: &[usize; 2]| (q.transform(moving[j]) - fixed[i]).norm();
        pairs.min_by(|a, b| distance(a).total_cmp(&distance(b)))
    }

    /// All acting pairs: the second tile's dipole in place, the two fronts, and the vector between
    /// them.
    fn pairs(&self, q: &Configuration) -> impl Iterator<Item = Pair> {
        let (rotation, faces) = (q.rotation(), self.faces(q));
        let [fixed, moving] = &self.magnets;
        moving.iter().flat_map(move |(second, front, face)| {
            let arm = rotation * second.position;
            let moment = rotation * second.moment;
            let front = (front.0, rotation * front.1);
            let place = q.position() + arm;
            let acts = move |first: usize| faces.is_none_or(|faces| faces == [first, *face]);
            let acting = fixed.iter().filter(move |(.., first)| acts(*first));
            acting.map(move |(first, other, _)| Pair {
                moments: [first.moment, moment],
                fronts: [*other, front],
                arm,
                r: place - first.position,
            })
        })
    }

    /// Sums over all pairs of their magnitudes: `K / r^3` for the energy, `3 K / r^4` for the force,
    /// and their moments. (The terms of one pair may cancel, so a pair's own energy is no measure of
    /// its error.)
    pub fn magnitudes(&self, q: &Configuration) -> (f64, Vector3<f64>) {
        let (mut energy, mut gradient) = (0.0, Vector3::zeros());
        for Pair {
            moments, arm, r, ..
        } in self.pairs(q)
        {
            let u = MU0_OVER_4PI * moments[0].norm() * moments[1].norm() / r.norm().powi(3);
            let force = 3.0 * u / r.norm();
            energy += u;
            gradient += Vector3::new(force, force, u + arm.norm() * force);
        }
        (energy, gradient)
    }

    fn derivative_bound(&self, q: &Configuration, reach: f64, terms: &[f64]) -> f64 {
        let bound = |pair: Pair| {
            let k = MU0_OVER_4PI * pair.moments[0].norm() * pair.moments[1].norm();
            motion::bound(terms, k, pair.r.norm() - reach)
        };
        self.pairs(q).map(bound).sum()
    }
}

struct Pair {
    moments: [Vector2<f64>; 2],
    fronts: [Front; 2],
    arm: Vector2<f64>,
    r: Vector2<f64>,
}

impl Potential for Plain {
    fn energy(&self, q: &Configuration) -> f64 {
        self.energy_and_gradient(q).0
    }

    fn energy_and_gradient(&self, q: &Configuration) -> (f64, Vector3<f64>) {
        let (mut energy, mut gradient) = (0.0, Vector3::zeros());
        for Pair {
            moments: [m1, m2],
            fronts: [first, second],
            arm,
            r,
        } in self.pairs(q)
        {
            let (u, force, slope) = pair(m1, m2, r);
            let w = if first.0.is_none() && second.0.is_none() {
                PairFactor::NONE
            } else {
                pair_factor(first, second, r)
            };
            let place = w.gradient * u - force * w.value;
            energy += w.value * u;
            let turn = w.slope * u + slope * w.value + arm.perp(&place);
            gradient += Vector3::new(place.x, place.y, turn);
        }
        if energy.is_finite() {
            (energy, gradient)
        } else {
            (f64::INFINITY, Vector3::zeros())
        }
    }

    /// Of bare dipoles, as the next one.
    fn curvature_bound(&self, q: &Configuration, reach: f64) -> f64 {
        let terms = motion::second_derivative(1.0 / self.lever());
        self.derivative_bound(q, reach, &terms)
    }

    fn fourth_derivative_bound(&self, q: &Configuration, reach: f64) -> f64 {
        let terms = motion::fourth_derivative(1.0 / self.lever());
        self.derivative_bound(q, reach, &terms)
    }

    fn displacement(&self, step: Vector3<f64>) -> f64 {
        step.xy().norm() + self.lever() * step.z.abs()
    }
}

/// The factor of a pair, the product of its two magnets' factors, with its gradient by the second
/// magnet's place (1/m) and its derivative by that magnet's angle.
pub struct PairFactor {
    pub value: f64,
    pub gradient: Vector2<f64>,
    pub slope: f64,
}

impl PairFactor {
    const NONE: Self = Self {
        value: 1.0,
        gradient: Vector2::new(0.0, 0.0),
        slope: 0.0,
    };
}

/// The factor of two magnets with the way `r` (m) from the first to the second.
pub fn pair_factor(first: Front, second: Front, r: Vector2<f64>) -> PairFactor {
    let distance = r.norm();
    let d = r / distance;
    let cosines = [first.1.dot(&d), -second.1.dot(&d)];
    let [a, b] = [(first.0, cosines[0]), (second.0, cosines[1])]
        .map(|(shield, cosine)| factor(shield, distance, cosine));
    let across = |normal: Vector2<f64>, cosine: f64| (normal - d * cosine) / distance;
    let first_gradient = d * a[1] + across(first.1, cosines[0]) * a[2];
    let second_gradient = d * b[1] + across(-second.1, cosines[1]) * b[2];
    // Turning the second magnet turns its normal.
    let turned = Vector2::new(-second.1.y, second.1.x);
    PairFactor {
        value: a[0] * b[0],
        gradient: first_gradient * b[0] + second_gradient * a[0],
        slope: -a[0] * b[2] * turned.dot(&d),
    }
}

/// A factor and its derivatives by the distance (1/m) and by the cosine.
fn factor(shield: Option<Shield>, r: f64, cosine: f64) -> [f64; 3] {
    let Some(shield) = shield else {
        return [1.0, 0.0, 0.0];
    };
    let ratio = r / shield.length;
    let share = 1.0 / (1.0 + ratio * ratio);
    let eta = 1.0 - shield.attenuation * share;
    let slope = shield.attenuation * 2.0 * ratio / shield.length * share * share;
    let front = 1.0 / (1.0 + (-cosine / shield.width).exp());
    [
        shield.factor(r, cosine),
        slope * (1.0 - front),
        (shield.front_gain - eta) * front * (1.0 - front) / shield.width,
    ]
}
