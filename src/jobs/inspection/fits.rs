//! The fits of the target faces, and the forces that end each.
//!
//! The moving tile slides along the target face, always in contact: each minimum of the energy on
//! this way is a fit. The bond is where the faces coincide; all others are wrong. Fits of other pairs
//! of faces, and fits in which the tiles are turned, only an analysis finds.
//!
//! The forces are those of the magnets; friction adds to the sliding force.

use nalgebra::Vector2;

use super::{gaps, pulled};
use crate::design::Design;
use physics::configuration::Configuration;
use physics::order::Order;
use physics::problem::Problem;

/// Number of wrong fits that are listed, the deepest.
const LISTED: usize = 4;
/// Least and largest number of poses on the way along the face.
const POSES: [f64; 2] = [400.0, 4000.0];
/// Poses per length or width of the largest magnet.
const PER_MAGNET: f64 = 16.0;
/// Halvings of the distance to a minimum.
const HALVINGS: usize = 30;
/// Energies and forces below this share of the strongest count as none: the magnets cancel.
pub const NEGLIGIBLE: f64 = 1e-3;
/// Fits whose energies differ by less than this share are mirror images.
const SAME: f64 = 1e-6;

/// One way in which the target faces fit, and what ends it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// How far (m) the moving tile has slid from the bond, counter-clockwise around the fixed tile.
    pub slid: f64,
    /// Whether the mirror image, slid as far the other way, is as deep.
    pub is_mirrored: bool,
    /// The pose.
    pub pose: Configuration,
    /// U (J).
    pub energy: f64,
    /// The largest pull on the way straight off (N).
    pub pull_off: f64,
    /// The largest force (N) against a slide along the face in the easier direction, until the
    /// energy falls again; `None` where the shapes block both.
    pub slide: Option<f64>,
    /// The torque (N m) with which the magnets resist tilting the tile off about the easier end of
    /// the contact, as it begins.
    pub tilt: f64,
}

/// All fits, the bond first (of very many magnets only the bond), and the largest |U| (J) while the tile slides: the strength of the
/// magnets.
pub fn fits(design: &Design, problem: &Problem) -> (Vec<Fit>, f64) {
    let way = Way::new(design, problem);
    let bond = fit(&way, 0.0);
    if problem.is_expensive() {
        return (vec![bond], bond.energy.abs());
    }
    let poses: Vec<Configuration> = (-way.steps..=way.steps).map(|k| way.touching(k)).collect();
    let energies = problem.energies(&poses);
    let strongest = energies
        .iter()
        .fold(bond.energy.abs(), |most, u| most.max(u.abs()));
    let is_minimum = |u: &[f64]| u[1] < -NEGLIGIBLE * strongest && u[1] <= u[0] && u[1] < u[2];
    let minima = energies.windows(3).zip(1 - way.steps..);
    let minima = minima.filter(|(u, _)| is_minimum(u));
    let places = minima.map(|(_, k)| way.lowest(k as f64 * way.step));
    // The bond is among them, where it is a minimum.
    let places = places.filter(|slid| slid.abs() > way.magnet / 2.0);
    let mut wrong: Vec<Fit> = places.map(|slid| fit(&way, slid)).collect();
    wrong.order_by(|a, b| a.energy.total_cmp(&b.energy));
    let mut kept: Vec<Fit> = Vec::new();
    for fit in wrong {
        let is_image = |other: &&mut Fit| {
            (other.energy - fit.energy).abs() <= SAME * fit.energy.abs()
                && (other.slid + fit.slid).abs() <= way.step
        };
        match kept.iter_mut().find(is_image) {
            Some(other) => (other.is_mirrored, other.slid) = (true, other.slid.abs()),
            None => kept.push(fit),
        }
    }
    kept.truncate(LISTED);
    (std::iter::once(bond).chain(kept).collect(), strongest)
}

/// The way of the moving tile along the target face.
struct Way<'a> {
    design: &'a Design,
    problem: &'a Problem,
    /// Length or width of the largest magnet (m).
    magnet: f64,
    /// The distance of neighbouring poses (m), and their number to either side.
    step: f64,
    steps: i32,
}

impl<'a> Way<'a> {
    fn new(design: &'a Design, problem: &'a Problem) -> Self {
        let pair = &design.pair;
        let moving = &pair.moving.faces[pair.target.1];
        let reach = (pair.target_face().length() + moving.length()) / 2.0;
        let magnet = pair
            .fixed
            .largest_magnet()
            .max(pair.moving.largest_magnet());
        let poses = (PER_MAGNET * reach / magnet).clamp(POSES[0], POSES[1]);
        Self {
            design,
            problem,
            magnet,
            step: reach / poses.ceil(),
            steps: poses.ceil() as i32,
        }
    }

    /// The bound pose slid along the face, whether it is free or not.
    fn slid(&self, slid: f64) -> Configuration {
        let pair = &self.design.pair;
        let at = pair.bound.position() + pair.target_face().tangent() * slid;
        Configuration::new(at.x, at.y, pair.bound.theta)
    }

    /// The same, drawn off until the shapes touch.
    fn touching_at(&self, slid: f64) -> Configuration {
        let q = self.slid(slid);
        let normal = self.design.pair.target_face().normal();
        let off = q.position() + normal * self.problem.lift(&q, normal);
        Configuration::new(off.x, off.y, q.theta)
    }

    fn touching(&self, k: i32) -> Configuration {
        self.touching_at(f64::from(k) * self.step)
    }

    /// The place of the minimum next to a place.
    fn lowest(&self, slid: f64) -> f64 {
        let energy = |slid: f64| self.problem.energy(&self.touching_at(slid));
        let (mut best, mut least, mut step) = (slid, energy(slid), self.step / 2.0);
        for _ in 0..HALVINGS {
            let sides = [best - step, best + step].map(|at| (at, energy(at)));
            match sides.into_iter().find(|(_, u)| *u < least) {
                Some(better) => (best, least) = better,
                None => step /= 2.0,
            }
        }
        best
    }

    /// The largest force against a slide from a pose in one direction (1 or -1), until the energy
    /// falls again; `None` where the shapes are in the way at once.
    fn resistance(&self, from: &Configuration, direction: f64) -> Option<f64> {
        let tangent = self.design.pair.target_face().tangent() * direction;
        let mut most = 0.0;
        for k in 1..=2 * self.steps {
            let at = from.position() + tangent * (f64::from(k) * self.step);
            let q = Configuration::new(at.x, at.y, from.theta);
            if !self.problem.is_free(&q) {
                return (k > 1).then_some(most);
            }
            let (_, gradient) = self.problem.energy_and_gradient(&q);
            let against = gradient.xy().dot(&tangent);
            if against < 0.0 && most > 0.0 {
                break;
            }
            most = f64::max(most, against);
        }
        Some(most)
    }
}

fn fit(way: &Way, slid: f64) -> Fit {
    let (design, problem) = (way.design, way.problem);
    let pose = match slid {
        0.0 => design.pair.bound,
        slid => way.touching_at(slid),
    };
    let (energy, gradient) = problem.energy_and_gradient(&pose);
    let normal = design.pair.target_face().normal();
    let pull = |gap: f64| {
        let (_, gradient) = problem.energy_and_gradient(&pulled(&pose, normal, gap));
        gradient.xy().dot(&normal)
    };
    let [low, high] = ends(design, &pose);
    // Turning counter-clockwise about the far end opens the contact, clockwise about the near one.
    let about = |end: Vector2<f64>| {
        let arm = pose.position() - end;
        gradient.z + gradient.y * arm.x - gradient.x * arm.y
    };
    let slides = [-1.0, 1.0].map(|direction| way.resistance(&pose, direction));
    Fit {
        slid,
        is_mirrored: false,
        pose,
        energy,
        pull_off: gaps(design).map(pull).fold(f64::NEG_INFINITY, f64::max),
        slide: slides.into_iter().flatten().reduce(f64::min),
        tilt: f64::min(about(high), -about(low)),
    }
}

/// The ends of the length over which the target faces' base lines lie side by side, in the order
/// of the fixed tile's corners.
fn ends(design: &Design, pose: &Configuration) -> [Vector2<f64>; 2] {
    let pair = &design.pair;
    let (fixed, moving) = (pair.target_face(), &pair.moving.faces[pair.target.1]);
    let place = |corner| (pose.transform(corner) - fixed.middle()).dot(&fixed.tangent());
    let half = fixed.length() / 2.0;
    // The faces run against each other.
    let [low, high] = [place(moving.end).max(-half), place(moving.start).min(half)];
    [low.min(high), high].map(|s| fixed.point(s, 0.0))
}
