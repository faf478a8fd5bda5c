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
//! This is a model with the right limits and as few constants as a measurement can tell apart, not
//! a solution of the magnetostatic problem with iron: it assumes that iron changes the energy of a
//! pair only by a factor. Calibrate it (`tilebind calibrate`) before trusting it.
//!
//! # The nearest-face rule
//! [`ShieldRule::NearestFace`] counts a pair in full if its magnets sit on the two faces, one of
//! each tile, whose midpoints are nearest to each other, and not at all otherwise (Majumder and
//! Reif, *Barcoded Magnetic Tiles for Programmable Assemblies*, assume that shielded faces act only
//! on the opposite face). The energy is discontinuous where another pair of faces becomes the
//! nearest: barriers across such places depend on the jump, and energy is not conserved. The rule
//! exists for comparison with published results.

pub(super) mod kernel;
mod pairs;
mod potential;

pub use potential::ShieldedPotential;

use nalgebra::Vector2;

use crate::configuration::Configuration;

/// The constants of a face's shield.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shield {
    /// A: the fraction of the energy lost directly behind the magnet (0 to 1).
    pub attenuation: f64,
    /// l: the distance (m) at which half of that loss remains.
    pub length: f64,
    /// delta: width of the transition from front to back, in cos(alpha).
    pub width: f64,
    /// G: the factor in front; 1 for a shield that only attenuates.
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
    /// The name of each rule in design files.
    pub const NAMES: [(&'static str, Self); 2] = [
        ("smooth", Self::Smooth),
        ("nearest-face", Self::NearestFace),
    ];

    /// The name of this rule in design files.
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

impl Shield {
    /// The factor g at the distance `r` (m) and the cosine of the angle between the face's normal
    /// and the line to the other magnet.
    pub fn factor(&self, r: f64, cosine: f64) -> f64 {
        let ratio = r / self.length;
        let eta = 1.0 - self.attenuation * (1.0 / (1.0 + ratio * ratio));
        eta + (self.front_gain - eta) * logistic(cosine / self.width)
    }
}

/// The faces of the fixed and of the moving tile, given by their midpoints (m), that are nearest to each
/// other; the first of equal ones.
pub fn nearest_faces([fixed, moving]: [&[Vector2<f64>]; 2], q: &Configuration) -> (usize, usize) {
    let (rotation, position) = (q.rotation(), q.position());
    let mut nearest = (f64::INFINITY, (0, 0));
    for (j, moving) in moving.iter().enumerate() {
        let moving = position + rotation * moving;
        for (i, fixed) in fixed.iter().enumerate() {
            let found = ((moving - fixed).norm(), (i, j));
            if found < nearest {
                nearest = found;
            }
        }
    }
    nearest.1
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
