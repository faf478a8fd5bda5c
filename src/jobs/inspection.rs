//! A quick inspection of a design: its bond, the forces that hold it, and the mistakes in it.
//!
//! There is no search: the tiles are evaluated where their target faces meet, while they slide along
//! each other, and while they are drawn apart along the face's normal. Whether they find each other,
//! only an analysis shows.

mod fits;

pub use fits::{Fit, NEGLIGIBLE};

use nalgebra::Vector2;

use crate::design::Design;
use crate::mates;
use physics::configuration::Configuration;
use physics::potential::{Interaction, MagnetModel};
use physics::problem::{FlushFaces, Problem};

/// Number of gaps at which the pull is computed.
const SAMPLES: usize = 200;
/// Largest gap as a multiple of the largest magnet's length or width.
const FARTHEST: f64 = 5.0;

/// The inspection of a design.
#[derive(Clone, Debug, PartialEq)]
pub struct Inspection {
    /// The configuration in which the target faces coincide.
    pub bound: Configuration,
    /// With the design's magnet model, then with the other model.
    pub models: [Hold; 2],
    /// Whether the moving tile can be drawn straight out of the bond.
    pub comes_straight_out: bool,
    /// That the codes of the target faces are not mates.
    pub unmatched: Option<String>,
    /// Pairs of faces that bind as strongly as the target.
    pub rivals: Vec<FlushFaces>,
    /// The fits of the target faces: the bond, then the deepest wrong ones.
    pub fits: Vec<Fit>,
    /// The largest |U| (J) while the target faces slide along each other.
    pub strongest: f64,
}

/// The strength of the bond with one magnet model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hold {
    /// The model.
    pub model: MagnetModel,
    /// U where the target faces coincide (J).
    pub energy: f64,
    /// Pull at contact along the target face's normal (N), positive where the tiles attract.
    pub contact: f64,
    /// Force along the face (N), counter-clockwise around the fixed tile.
    pub along: f64,
    /// Torque about the moving tile's reference point (N m).
    pub torque: f64,
    /// The largest pull on the way straight out (N): the force needed to separate the tiles like
    /// this.
    pub pull_off: f64,
    /// The gap (m) of the largest pull.
    pub pull_off_gap: f64,
}

impl Inspection {
    /// Inspects a design with a few hundred energies of each model.
    pub fn new(design: &Design) -> Self {
        let problem = design.problem();
        let own = design.interaction.model;
        let other = match own {
            MagnetModel::Dipole => MagnetModel::Cuboid,
            MagnetModel::Cuboid => MagnetModel::Dipole,
        };
        let pulled = |gap: f64| out_of_bond(design, gap);
        let reach = design.pair.fixed.largest_magnet() * FARTHEST;
        let motion = |k: usize| pulled(reach.max(problem.scaled(1e-3)) * k as f64 / 8.0);
        let (fits, strongest) = fits::fits(design, &problem);
        Self {
            bound: design.pair.bound,
            models: [own, other].map(|model| hold(design, model)),
            comes_straight_out: comes_out(&problem, motion),
            unmatched: mates::fault(design, &problem),
            rivals: problem.rivals(),
            fits,
            strongest,
        }
    }

    /// Whether the magnets of the target faces as good as cancel where they coincide.
    pub fn is_negligible(&self) -> bool {
        self.models[0].energy.abs() <= NEGLIGIBLE * self.strongest
    }

    /// Mistakes in the design, as sentences with fixes. The reader's warnings are reported
    /// elsewhere.
    pub fn faults(&self, design: &Design) -> Vec<String> {
        let mut faults = Vec::new();
        let bond = self.models[0];
        let no_magnets = design.pair.fixed.largest_magnet() == 0.0;
        if !no_magnets && bond.energy >= 0.0 {
            faults.push(format!("the target faces repel: {}", mates::remedy(design)));
        } else if !no_magnets && bond.contact <= 0.0 {
            faults.push(
                "the target faces attract each other but are pushed apart at contact: check the \
                 order of the codes and `fit`"
                    .to_owned(),
            );
        }
        if !self.comes_straight_out {
            faults.push(
                "the shapes interlock: the moving tile cannot be pulled straight out of the bond \
                 or pushed straight in; use a draft of 0 or more, or `fit`"
                    .to_owned(),
            );
        }
        faults.extend(self.unmatched.clone());
        faults.extend(rivals(self.rivals.len()));
        faults
    }
}

/// A sentence that other pairs of faces bind as strongly as the target, if any do.
pub fn rivals(count: usize) -> Option<String> {
    match count {
        0 => None,
        1 => Some("1 other pair of faces binds as strongly: give it another code".to_owned()),
        _ => Some(format!(
            "{count} other pairs of faces bind as strongly: give them other codes"
        )),
    }
}

/// The moving tile drawn out of the bond by `gap` (m) along the target face's normal.
pub(crate) fn out_of_bond(design: &Design, gap: f64) -> Configuration {
    pulled(&design.pair.bound, design.pair.target_face().normal(), gap)
}

/// A pose moved by `gap` (m) in a direction.
fn pulled(pose: &Configuration, direction: Vector2<f64>, gap: f64) -> Configuration {
    let out = pose.position() + direction * gap;
    Configuration::new(out.x, out.y, pose.theta)
}

/// The gaps (m) at which the pull is computed.
fn gaps(design: &Design) -> impl Iterator<Item = f64> {
    let reach = design.pair.fixed.largest_magnet() * FARTHEST;
    (0..SAMPLES).map(move |k| reach * k as f64 / (SAMPLES - 1) as f64)
}

/// Whether the straight motion over some configurations is free.
fn comes_out(problem: &Problem, motion: impl Fn(usize) -> Configuration) -> bool {
    (0..8).all(|k| problem.motion_is_free(&motion(k), &motion(k + 1)))
}

fn hold(design: &Design, model: MagnetModel) -> Hold {
    let interaction = Interaction {
        model,
        ..design.interaction.clone()
    };
    let pair = &design.pair;
    let potential = interaction.between(&pair.fixed, &pair.moving).potential;
    let face = pair.target_face();
    let (energy, gradient) = potential.energy_and_gradient(&pair.bound);
    let pull = |gap: f64| {
        let (_, gradient) = potential.energy_and_gradient(&out_of_bond(design, gap));
        gradient.xy().dot(&face.normal())
    };
    let pulls = gaps(design).map(|gap| (gap, pull(gap)));
    let (pull_off_gap, pull_off) = pulls.fold((0.0, f64::NEG_INFINITY), |best, next| {
        if next.1 > best.1 { next } else { best }
    });
    Hold {
        model,
        energy,
        contact: pull(0.0),
        along: -gradient.xy().dot(&face.tangent()),
        torque: -gradient.z,
        pull_off,
        pull_off_gap,
    }
}
