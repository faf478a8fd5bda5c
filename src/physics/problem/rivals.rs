//! Faces that bind besides the intended ones.

use super::Problem;
use crate::configuration::Configuration;
use crate::tile::face_to_face;

/// Two faces count as binding as strongly as the target from this fraction of its energy on.
const AS_STRONG: f64 = 0.95;
/// Configurations closer than this (m, metric of the space) are the same meeting.
const SAME: f64 = 1e-6;

/// Two faces, set flush against each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meeting {
    /// Which face of the fixed tile, which of the moving one.
    pub faces: (usize, usize),
    /// The configuration of the moving tile.
    pub configuration: Configuration,
    /// U there (J).
    pub energy: f64,
}

impl Problem {
    /// The pairs of faces that unintentionally bind as strongly as the target: flush against each
    /// other, pushed out into contact if their shapes overlap, they have at least 0.95 of the
    /// bond's energy. Images of the target under a symmetry are not included. Slid and tilted
    /// contacts are not considered.
    pub fn rivals(&self) -> Vec<Meeting> {
        let Some(pair) = &self.pair else {
            return Vec::new();
        };
        let potential = self.potential();
        let bond = potential.energy(&pair.bound);
        if bond >= 0.0 {
            return Vec::new();
        }
        let wanted: Vec<_> = self
            .symmetries
            .iter()
            .map(|s| s.apply(&pair.bound))
            .collect();
        let [fixed, moving] = self.faces();
        let pairs = (0..fixed.len()).flat_map(|f| (0..moving.len()).map(move |m| (f, m)));
        let meetings = pairs.map(|(f, m)| {
            let flush = face_to_face(&fixed[f], &moving[m], 0.0, 0.0);
            let lift = self.lift(&flush, fixed[f].normal());
            let position = flush.position() + fixed[f].normal() * lift;
            let configuration = Configuration::new(position.x, position.y, flush.theta);
            Meeting {
                faces: (f, m),
                configuration,
                energy: potential.energy(&configuration),
            }
        });
        let is_wanted = |meeting: &Meeting| {
            let distance = |q: &Configuration| self.space.distance(q, &meeting.configuration);
            meeting.faces == pair.target || wanted.iter().any(|q| distance(q) < self.scaled(SAME))
        };
        let is_strong = |meeting: &Meeting| {
            meeting.energy <= AS_STRONG * bond && self.is_free(&meeting.configuration)
        };
        meetings
            .filter(|meeting| is_strong(meeting) && !is_wanted(meeting))
            .collect()
    }
}
