//! Siblings of minima: the same contact of two faces, on all other pairs of faces and mirrored.

use nalgebra::Vector2;
use ordered_float::OrderedFloat;

use tiles::configuration::{Configuration, wrap_angle};
use tiles::parallel;
use tiles::problem::Problem;
use tiles::tile::{Face, face_to_face};

/// Meetings that differ by less than this (m; rad times a tile's size) are the same.
pub(super) const SAME: f64 = 1e-3;
/// Faces turned away from each other by more than this (rad) do not meet.
const TURNED: f64 = 0.8;
/// Guesses with less than this share of the minimum's energy are dropped: faces without the
/// relevant magnets have no such contact, and most pairs of a polygon's faces may be bare.
const LEAST_ENERGY: f64 = 0.1;

/// The position of the moving tile's face relative to the fixed one's: its middle along that face
/// and out of it (m), and its rotation from flush (rad).
#[derive(Clone, Copy, Debug)]
pub(super) struct FacePose {
    pub slide: f64,
    pub gap: f64,
    pub tilt: f64,
    /// Energy of the minimum (J).
    pub energy: f64,
}

impl FacePose {
    fn of(q: &Configuration, energy: f64, fixed: &Face, moving: &Face) -> Self {
        let way = q.transform(moving.middle()) - fixed.middle();
        Self {
            slide: way.dot(&fixed.tangent()),
            gap: way.dot(&fixed.normal()),
            tilt: wrap_angle(q.theta - face_to_face(fixed, moving, 0.0, 0.0).theta),
            energy,
        }
    }

    fn mirrored(self) -> Self {
        Self {
            slide: -self.slide,
            tilt: -self.tilt,
            ..self
        }
    }

    /// The configuration in which two faces meet in this way, drawn apart until the tiles do not
    /// overlap.
    pub fn place(&self, problem: &Problem, fixed: &Face, moving: &Face) -> Configuration {
        let theta = wrap_angle(face_to_face(fixed, moving, 0.0, 0.0).theta + self.tilt);
        let arm = Configuration::new(0.0, 0.0, theta).transform(moving.middle());
        let position = fixed.point(self.slide, self.gap) - arm;
        let at = |p: Vector2<f64>| Configuration::new(p.x, p.y, theta);
        let lift = problem.lift(&at(position), fixed.normal());
        at(position + fixed.normal() * lift)
    }

    fn distance(&self, other: &Self, size: f64) -> f64 {
        let turn = wrap_angle(self.tilt - other.tilt) * size;
        libm::hypot(
            libm::hypot(self.slide - other.slide, self.gap - other.gap),
            turn,
        )
    }
}

/// The expected siblings of some minima, given with their energies (J), including the minima
/// themselves.
pub(super) fn siblings(problem: &Problem, minima: &[(Configuration, f64)]) -> Vec<Configuration> {
    let [of_fixed, of_moving] = problem.faces();
    let size = problem.space.rho;
    let pairs = || {
        of_fixed
            .iter()
            .flat_map(|fixed| of_moving.iter().map(move |moving| (fixed, moving)))
    };
    let mut meetings: Vec<FacePose> = Vec::new();
    for (q, energy) in minima {
        let closest = pairs()
            .map(|(fixed, moving)| FacePose::of(q, *energy, fixed, moving))
            .filter(|meeting| meeting.tilt.abs() < TURNED)
            .min_by_key(|meeting| OrderedFloat(meeting.gap.abs() + size * meeting.tilt.abs()));
        for meeting in closest
            .into_iter()
            .flat_map(|meeting| [meeting, meeting.mirrored()])
        {
            if meetings
                .iter()
                .all(|known| known.distance(&meeting, size) > problem.scaled(SAME))
            {
                meetings.push(meeting);
            }
        }
    }
    let pairs: Vec<(&Face, &Face)> = pairs().collect();
    parallel::flat_map(&pairs, |(fixed, moving)| {
        meetings.iter().filter_map(|meeting| {
            let q = meeting.place(problem, fixed, moving);
            let is_held = problem.energy(&q) < LEAST_ENERGY * meeting.energy;
            (is_held && problem.is_free(&q)).then_some(q)
        })
    })
}
