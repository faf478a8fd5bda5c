//! Two tiles that are near each other, and tiles at the rim: their pull and their contact points.

use nalgebra::{Vector2, Vector3};

use super::crowd::Crowd;
use super::margins::Margins;
use super::mover::Mover;
use super::pair::{Pose, Pull, Two, pull};
use crate::configuration::Configuration;
use crate::contact::{ContactPoint, NearPairs};
use crate::tile::outline::cross;

/// Two tiles that are near each other, with the state of their contact.
#[derive(Debug)]
pub struct NearPair {
    pub two: Two,
    /// Whether the tiles may touch, or attract or repel each other too strongly for the step of the
    /// table: they are in one island then.
    pub is_tied: bool,
    edges: NearPairs,
    /// The distance (m) from `at` that `edges` cover.
    seen: f64,
    at: Configuration,
    /// The tiles are apart by at least this (m) at `room_at`.
    pub room: f64,
    room_at: Configuration,
    /// The last places of both tiles, and their pull there.
    pulled: Option<([Vector3<f64>; 2], Pull)>,
    /// The last contact points.
    pub held: Vec<Touch>,
    /// The last points, with the pose and the margin (m) that they are of.
    found: Option<(Configuration, f64, Vec<ContactPoint>)>,
}

/// A contact point of the last step, in the frame of the first tile.
#[derive(Clone, Copy, Debug)]
pub struct Touch {
    /// Its position (m).
    pub at: Vector2<f64>,
    /// The normal, from the first tile to the second.
    pub normal: Vector2<f64>,
    /// The forces (N) along normal and tangent.
    pub forces: [f64; 2],
}

impl NearPair {
    pub fn new(two: Two) -> Self {
        Self {
            two,
            is_tied: true,
            edges: NearPairs::default(),
            seen: f64::NEG_INFINITY,
            at: Configuration::new(0.0, 0.0, 0.0),
            room: f64::NEG_INFINITY,
            room_at: Configuration::new(0.0, 0.0, 0.0),
            pulled: None,
            held: Vec::new(),
            found: None,
        }
    }

    /// The pull of the tiles on each other, which is known from the end of the last step unless one
    /// has moved since.
    pub fn pull(&mut self, crowd: &Crowd, movers: [&Mover; 2], poses: [&Pose; 2]) -> Pull {
        let places = movers.map(|mover| mover.place);
        match self.pulled {
            Some((at, known)) if at == places => known,
            _ => {
                let couple = crowd.couple(movers[0].kind, movers[1].kind).0;
                let found = pull(couple, movers, poses);
                self.pulled = Some((places, found));
                found
            }
        }
    }

    /// The last forces (N) at a point, in the first tile's frame.
    pub fn force(&self, at: &Vector2<f64>, margins: &Margins) -> [f64; 2] {
        let same = |it: &&Touch| (it.at - at).norm_squared() < margins.same * margins.same;
        self.held.iter().find(same).map_or([0.0; 2], |it| it.forces)
    }

    /// The force (N) along the contact that friction cannot stop, of a force on the second tile in
    /// the frame of the first: by the contact point where it is largest.
    pub fn slide(&self, force: Vector2<f64>, friction: f64) -> f64 {
        let along = self.held.iter().map(|touch| {
            let press = -touch.normal.dot(&force);
            cross(touch.normal, force).abs() - friction * press.max(0.0)
        });
        along.fold(0.0, f64::max)
    }

    /// The points of contact within a margin (m), if there may be any.
    pub fn points(
        &mut self,
        crowd: &Crowd,
        q: &Configuration,
        kinds: [usize; 2],
        (margin, margins): (f64, &Margins),
    ) -> Vec<ContactPoint> {
        let within = |points: &[ContactPoint]| {
            let close = points.iter().filter(|point| point.gap <= margin);
            close.copied().collect()
        };
        if let Some((at, seen, points)) = &self.found
            && at == q
            && *seen >= margin
        {
            return within(points);
        }
        let contact = &crowd.couple(kinds[0], kinds[1]).0.contact;
        let radius = contact.moving().circumradius();
        let moved = |from: &Configuration| {
            let step = from.step_to(q);
            step.xy().norm() + radius * step.z.abs()
        };
        if self.room - moved(&self.room_at) > margin {
            return Vec::new();
        }
        let seen = margin.max(margins.seen);
        let needed = 1.5 * seen;
        if self.seen - moved(&self.at) < needed {
            self.seen = needed + margins.ahead;
            self.at = *q;
            self.edges = contact.near(q, self.seen);
        }
        let mut points = contact.points(q, margin, &self.edges);
        let close = within(&points);
        if points.is_empty() {
            points = contact.points(q, seen, &self.edges);
        } else {
            self.found = Some((*q, margin, points.clone()));
        }
        self.room = points.iter().map(|point| point.gap).fold(seen, f64::min);
        self.room_at = *q;
        close
    }
}
/// The corners of a tile within a margin (m) of the rim: position, the rim's normal, and the gap.
pub fn at_rim(
    crowd: &Crowd,
    (mover, pose): (&Mover, &Pose),
    margin: f64,
    found: &mut dyn FnMut(Vector2<f64>, Vector2<f64>, f64),
) {
    let kind = &crowd.kinds[mover.kind];
    let room = rim_room(crowd, mover);
    if room > margin {
        return;
    }
    for corner in kind.tile.outline.vertices() {
        let p = pose.transform(*corner);
        for (normal, gap) in crowd.rim.sides(p).filter(|it| it.1 <= margin) {
            found(p, normal, gap);
        }
    }
}

/// A lower bound of a tile's distance (m) from the rim.
pub fn rim_room(crowd: &Crowd, mover: &Mover) -> f64 {
    crowd.rim.room(mover.place.xy()) - crowd.kinds[mover.kind].reach
}
