//! Soft-iron shields behind magnets, as factors on the energies of pairs of magnets.
//!
//! # The smooth factor
//! A magnet with a shield acts on another one with the factor
//!
//! ```text
//! g   = eta(r) + (G - eta(r)) S(cos(alpha) / delta)
//! eta = 1 - A / (1 + (r / l)^2),      S(t) = 1 / (1 + exp(-t))
//! ```
//!
//! r (m) is the distance of the two magnets' centres and alpha the angle between the normal of the
//! face that carries the magnet and the line to the other one. A pair's energy is multiplied by
//! the product of its two magnets' factors. In front (`cos(alpha) >> delta`) g is G, the front
//! gain, which is 1 unless iron behind the magnet strengthens it; behind, g is eta: 1 - A close
//! by, 1 far away, half-way at the distance l. The force and the torque are the derivatives of the
//! factor times the energy, both terms of the product rule, so energy is conserved.
//!
//! This is a model with the right limits and as few constants as a measurement can tell apart,
//! not a solution of the magnetostatic problem with iron: it takes the field of a pair to be that
//! without iron but for a factor. Calibrate it (`tilebind calibrate`) before
//! trusting it.
//!
//! # The nearest-face rule
//! [`ShieldRule::NearestFace`] counts a pair in full if its magnets sit on the two faces, one of
//! each tile, whose middles are nearest to each other, and not at all otherwise (Majumder and
//! Reif, *Barcoded Magnetic Tiles for Programmable Assemblies*, take shielded faces to act on the
//! face opposite alone). Where another pair of faces becomes the nearest one the energy jumps:
//! barriers across such places depend on the jump, and energy is not conserved. The rule is there
//! for comparison with published results.

mod bounds;
mod kernel;
mod potential;

use nalgebra::Vector2;

pub use bounds::ShieldedBounds;
pub use potential::ShieldedPotential;

/// The constants of a face's shield.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shield {
    /// A: how much of the energy is lost behind, close by (0 to 1).
    pub attenuation: f64,
    /// l: the distance (m) at which half of that loss is left.
    pub length: f64,
    /// delta: width of the passage from front to back, in cos(alpha).
    pub width: f64,
    /// G: the factor in front; 1 for a shield that only takes away.
    pub front_gain: f64,
}

/// How shields act.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ShieldRule {
    /// By the smooth factor.
    #[default]
    Smooth,
    /// Only the pair of nearest faces acts.
    NearestFace,
}

impl ShieldRule {
    /// What design files call each rule.
    pub const NAMES: [(&'static str, Self); 2] = [
        ("smooth", Self::Smooth),
        ("nearest-face", Self::NearestFace),
    ];

    /// What design files call this rule.
    pub fn name(self) -> &'static str {
        match self {
            Self::Smooth => "smooth",
            Self::NearestFace => "nearest-face",
        }
    }
}

/// The shields of two tiles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shields {
    /// How they act.
    pub rule: ShieldRule,
    /// One entry for each face of the fixed tile: its shield, if it has one.
    pub fixed: Vec<Option<Shield>>,
    /// The same for the moving tile.
    pub moving: Vec<Option<Shield>>,
}

impl Shields {
    /// Whether all pairs of magnets act in full.
    pub fn is_none(&self) -> bool {
        let mut all = self.fixed.iter().chain(&self.moving);
        self.rule == ShieldRule::Smooth && all.all(Option::is_none)
    }
}

/// A factor g and its derivatives by the distance (1/m) and by cos(alpha).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Factor {
    /// g.
    pub value: f64,
    /// dg/dr (1/m).
    pub by_distance: f64,
    /// dg/dcos(alpha).
    pub by_cosine: f64,
}

impl Factor {
    /// Of a magnet without a shield.
    pub const NONE: Self = Self {
        value: 1.0,
        by_distance: 0.0,
        by_cosine: 0.0,
    };
}

impl Shield {
    /// The factor at the distance `r` (m) and the cosine of the angle between the face's normal
    /// and the line to the other magnet.
    pub fn factor(&self, r: f64, cosine: f64) -> Factor {
        let ratio = r / self.length;
        let share = 1.0 / (1.0 + ratio * ratio);
        let eta = 1.0 - self.attenuation * share;
        let eta_slope = self.attenuation * 2.0 * ratio / self.length * share * share;
        let front = logistic(cosine / self.width);
        Factor {
            value: eta + (self.front_gain - eta) * front,
            by_distance: eta_slope * (1.0 - front),
            by_cosine: (self.front_gain - eta) * front * (1.0 - front) / self.width,
        }
    }
}

/// S(t) = 1 / (1 + exp(-t)), without overflow.
fn logistic(t: f64) -> f64 {
    if t >= 0.0 {
        1.0 / (1.0 + libm::exp(-t))
    } else {
        let e = libm::exp(t);
        e / (1.0 + e)
    }
}

/// The factor of a pair, the product of its two magnets' factors, with its gradient by the second
/// magnet's place (1/m) and its derivative by that magnet's angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairFactor {
    /// The product of the two factors.
    pub value: f64,
    /// By the second magnet's place (1/m).
    pub gradient: Vector2<f64>,
    /// By the second magnet's angle (1/rad).
    pub slope: f64,
}

/// A magnet's shield and the normal of its face.
pub type Front = (Option<Shield>, Vector2<f64>);

/// The factor of two magnets with the way `r` (m) from the first to the second. Coinciding
/// magnets count as seen sideways.
pub fn pair_factor(first: Front, second: Front, r: Vector2<f64>) -> PairFactor {
    let distance = r.norm();
    let d = if distance > 0.0 {
        r / distance
    } else {
        Vector2::zeros()
    };
    let cosines = [first.1.dot(&d), -second.1.dot(&d)];
    let [a, b] = [(first.0, cosines[0]), (second.0, cosines[1])].map(|(shield, cosine)| {
        shield.map_or(Factor::NONE, |shield| shield.factor(distance, cosine))
    });
    let inverse = if distance > 0.0 { 1.0 / distance } else { 0.0 };
    let across = |normal: Vector2<f64>, cosine: f64| (normal - d * cosine) * inverse;
    let first_gradient = d * a.by_distance + across(first.1, cosines[0]) * a.by_cosine;
    let second_gradient = d * b.by_distance + across(-second.1, cosines[1]) * b.by_cosine;
    // Turning the second magnet turns its normal.
    let turned = Vector2::new(-second.1.y, second.1.x);
    PairFactor {
        value: a.value * b.value,
        gradient: first_gradient * b.value + second_gradient * a.value,
        slope: -a.value * b.by_cosine * turned.dot(&d),
    }
}
