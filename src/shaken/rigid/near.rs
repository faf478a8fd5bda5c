//! Two tiles that are near each other, and tiles at the rim: their pull and their contact points.

use nalgebra::Vector2;

use super::World;
use super::margins::Margins;
use super::mover::Mover;
use super::pair::{Pose, Pull, Two, Within, on_the_table};
use tiles::configuration::Configuration;
use tiles::contact::{Contact, ContactPoint, NearPairs, TurnsWith};
use tiles::tile::outline::cross;

/// The motion, in skins, over which a pull counts as the same. A force changes over a magnet's half side l: its
/// error is at most of the order of this over l, 2e-5 for the paper's tile, and the energy's half the square.
const SAME_PULL: f64 = 0.3;
/// The way, as a share of the length over which forces change, from which the change of a force is known well
/// enough to tell how stiff it is.
const RESOLVED: f64 = 1.0 / 300.0;

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
    pub last_room: f64,
    room_at: Configuration,
    /// A pose of the second tile in the first one's frame, and the pull there.
    pulled: Option<(Configuration, Within)>,
    /// By how much the force changed with the last way of some length (N/m).
    pub stiffness: f64,
    /// The last contact points.
    pub held: Vec<Touch>,
    /// The pose of the second tile in the first one's frame that they are of.
    held_at: Configuration,
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
    /// What the normal turns with.
    pub turns_with: TurnsWith,
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
            last_room: f64::NEG_INFINITY,
            room_at: Configuration::new(0.0, 0.0, 0.0),
            pulled: None,
            stiffness: 0.0,
            held: Vec::new(),
            held_at: Configuration::new(0.0, 0.0, 0.0),
            found: None,
        }
    }

    /// The pull of the tiles on each other. Force and torque stay as they are, and the energy changes linearly,
    /// until a point of the second tile has moved by [`SAME_PULL`] relative to the first: tiles that hold each
    /// other move by less.
    pub fn pull(
        &mut self,
        world: &impl World,
        movers: [&Mover; 2],
        poses: [&Pose; 2],
        margins: &Margins,
    ) -> Pull {
        let kinds = movers.map(|it| it.kind);
        let q = poses[0].to(&poses[1].at);
        let mut last = None;
        if let Some((at, (energy, force, torque))) = self.pulled {
            let way = moved(world.contact(kinds), [&at, &q]);
            if way <= SAME_PULL * margins.skin {
                let step = at.step_to(&q);
                let energy = energy - force.dot(&step.xy()) - torque * step.z;
                return on_the_table((energy, force, torque), movers, poses);
            }
            last = Some((way, force));
        }
        let found = world.pull(kinds, &q);
        if let Some((way, force)) = last
            && way > RESOLVED * margins.feature
        {
            self.stiffness = (found.1 - force).norm() / way;
        }
        self.pulled = Some((q, found));
        on_the_table(found, movers, poses)
    }

    /// Forgets the last points of contact: those that follow are of this pose.
    pub fn hold_anew(&mut self, q: Configuration) {
        self.held.clear();
        self.held_at = q;
    }

    /// The largest way (m) of a point of the second tile since the last points of contact.
    pub fn moved_since_held(
        &self,
        world: &impl World,
        q: &Configuration,
        kinds: [usize; 2],
    ) -> f64 {
        moved(world.contact(kinds), [&self.held_at, q])
    }

    /// The last forces (N) at a point, in the first tile's frame.
    pub fn force(&self, at: &Vector2<f64>, margins: &Margins) -> [f64; 2] {
        let same = |it: &&Touch| (it.at - at).norm_squared() < margins.same * margins.same;
        self.held.iter().find(same).map_or([0.0; 2], |it| it.forces)
    }

    /// The force (N) along the contact beyond what friction can stop, of a force on the second tile in
    /// the frame of the first: by the contact point where it is largest. All of it where the points are not
    /// known yet. Negative where friction could stop more.
    pub fn slide(&self, force: Vector2<f64>, friction: f64) -> f64 {
        if self.held.is_empty() {
            return force.norm();
        }
        let along = self.held.iter().map(|touch| {
            let press = -touch.normal.dot(&force);
            cross(touch.normal, force).abs() - friction * press.max(0.0)
        });
        along.fold(f64::NEG_INFINITY, f64::max)
    }

    /// A lower bound of the distance (m) of the tiles, from where it was last looked at.
    pub fn room(&self, world: &impl World, q: &Configuration, kinds: [usize; 2]) -> f64 {
        self.last_room - moved(world.contact(kinds), [&self.room_at, q])
    }

    /// Calls `meet` with each point of contact within a margin (m), and the last forces (N) there.
    pub fn points(
        &mut self,
        world: &impl World,
        q: &Configuration,
        kinds: [usize; 2],
        (margin, margins): (f64, &Margins),
        mut meet: impl FnMut(&ContactPoint, [f64; 2]),
    ) {
        let is_known =
            |(at, seen, _): &(Configuration, f64, Vec<ContactPoint>)| at == q && *seen >= margin;
        if !self.found.as_ref().is_some_and(is_known) {
            if self.room(world, q, kinds) > margin {
                return;
            }
            let contact = world.contact(kinds);
            let seen = margin.max(margins.seen);
            let needed = 1.5 * seen;
            if self.seen - moved(contact, [&self.at, q]) < needed {
                self.seen = needed + margins.ahead;
                self.at = *q;
                self.edges = contact.near(q, self.seen);
            }
            let points = contact.points(q, margin, &self.edges);
            let gaps = |points: &[ContactPoint]| {
                let gaps = points.iter().map(|point| point.gap);
                gaps.fold(seen, f64::min)
            };
            self.room_at = *q;
            if points.is_empty() {
                self.last_room = gaps(&contact.points(q, seen, &self.edges));
                return;
            }
            self.last_room = gaps(&points);
            self.found = Some((*q, margin, points));
        }
        let points = self.found.iter().flat_map(|found| &found.2);
        for point in points.filter(|point| point.gap <= margin) {
            meet(point, self.force(&point.on_moving, margins));
        }
    }
}

/// The largest way (m) of a point of the second tile from one configuration to another.
fn moved(contact: &Contact, [from, to]: [&Configuration; 2]) -> f64 {
    let step = from.step_to(to);
    step.xy().norm() + contact.moving().circumradius() * step.z.abs()
}

/// The corners of a tile within a margin (m) of the rim: position, the rim's normal, and the gap.
pub fn at_rim(
    world: &impl World,
    (mover, pose): (&Mover, &Pose),
    margin: f64,
    found: &mut dyn FnMut(Vector2<f64>, Vector2<f64>, f64),
) {
    let room = rim_room(world, mover);
    if room > margin {
        return;
    }
    for corner in world.corners(mover.kind) {
        let p = pose.transform(*corner);
        for (normal, gap) in world.rim().sides(p).filter(|it| it.1 <= margin) {
            found(p, normal, gap);
        }
    }
}

/// A lower bound of a tile's distance (m) from the rim.
pub fn rim_room(world: &impl World, mover: &Mover) -> f64 {
    world.rim().room(mover.place.xy()) - world.reach(mover.kind)
}
