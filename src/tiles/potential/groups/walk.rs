//! Which groups of two tiles interact as wholes, and which in parts.

use std::ops::Range;

use nalgebra::Vector2;

use super::tree::DipoleGroup;
use crate::configuration::Configuration;

/// How far the dipoles of the moving tile may deviate from the central configuration.
#[derive(Clone, Copy, Debug, Default)]
pub struct Leeway {
    /// The largest distance (m) that the tile moves and angle (rad) that it turns.
    pub travel: f64,
    pub turn: f64,
    /// Groups closer than this many times a group's own leeway are split.
    pub near: f64,
    /// So are groups closer than this (m).
    pub least: f64,
    /// So are groups closer than this many times half the length of the longer one, whose parts are at
    /// too different distances.
    pub lengths: f64,
    /// The magnets of a pair reach this much (m) from their centres, both together.
    pub radii: f64,
}

/// Two interacting groups, as indices of their dipoles in the trees.
#[derive(Clone, Debug)]
pub struct DipoleGroups {
    pub fixed: Range<usize>,
    pub moving: Range<usize>,
    /// If a group is replaced, the product `M1 M2` (A^2 m^4) of the sums of magnitudes, otherwise
    /// 0; and the smallest distance of the two (m).
    pub replaced: f64,
    pub distance: f64,
}

/// All interacting groups of two tiles in a configuration: every pair of dipoles is in exactly one
/// pair of groups.
pub struct Walk<'a> {
    sight: Sight<'a>,
    leeway: Leeway,
    open: Vec<[usize; 2]>,
}

impl<'a> Walk<'a> {
    pub fn new(groups: [&'a [DipoleGroup]; 2], q: &Configuration, leeway: Leeway) -> Self {
        let mut open = Vec::with_capacity(64);
        if groups.iter().all(|groups| !groups.is_empty()) {
            open.push([0, 0]);
        }
        let sight = Sight::new(groups, q);
        Self {
            sight,
            leeway,
            open,
        }
    }
}

/// The groups of two tiles in a configuration.
pub struct Sight<'a> {
    pub groups: [&'a [DipoleGroup]; 2],
    place: Vector2<f64>,
    turn: Vector2<f64>,
}

impl<'a> Sight<'a> {
    pub fn new(groups: [&'a [DipoleGroup]; 2], q: &Configuration) -> Self {
        let (sin, cos) = libm::sincos(q.theta);
        Self {
            groups,
            place: q.position(),
            turn: Vector2::new(cos, sin),
        }
    }

    /// A point of the moving tile's frame in the fixed tile's.
    pub fn place(&self, point: Vector2<f64>) -> Vector2<f64> {
        self.place + self.turned(point)
    }

    fn turned(&self, v: Vector2<f64>) -> Vector2<f64> {
        let (cos, sin) = (self.turn.x, self.turn.y);
        Vector2::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y)
    }

    /// A lower bound of the distance (m) of two groups: in the frame of either box, the distance of
    /// the axis-aligned boxes around both.
    pub fn distance(&self, fixed: &DipoleGroup, moving: &DipoleGroup) -> f64 {
        let way = self.place(moving.centre) - fixed.centre;
        let axis = self.turned(moving.axis);
        let cos = fixed.axis.dot(&axis).abs();
        let sin = fixed.axis.perp(&axis).abs();
        let gap = |axis: Vector2<f64>, own: [f64; 2], other: [f64; 2]| {
            let along = way.dot(&axis).abs() - own[0] - other[0] * cos - other[1] * sin;
            let across = way.perp(&axis).abs() - own[1] - other[0] * sin - other[1] * cos;
            let (along, across) = (along.max(0.0), across.max(0.0));
            along * along + across * across
        };
        let first = gap(fixed.axis, fixed.half, moving.half);
        let second = gap(axis, moving.half, fixed.half);
        // Minus the rounding of places within a few metres.
        (first.max(second).sqrt() * (1.0 - 1e-12) - 1e-15).max(0.0)
    }
}

impl Iterator for Walk<'_> {
    type Item = DipoleGroups;

    fn next(&mut self) -> Option<DipoleGroups> {
        while let Some([f, m]) = self.open.pop() {
            let groups = self.sight.groups;
            let (fixed, moving) = (&groups[0][f], &groups[1][m]);
            let leeway = self.leeway.travel + self.leeway.turn * moving.lever;
            let distance = self.sight.distance(fixed, moving);
            let left = distance - leeway;
            let length = fixed.half[0].max(moving.half[0]);
            let is_far = distance > self.leeway.near * leeway
                && left > self.leeway.least.max(self.leeway.lengths * length);
            let clear = if is_far {
                left - self.leeway.radii
            } else {
                0.0
            };
            let split = match (fixed.at(clear), moving.at(clear)) {
                (Some(first), Some(second)) => {
                    let own = fixed.own == *first && moving.own == *second;
                    return Some(DipoleGroups {
                        fixed: first.clone(),
                        moving: second.clone(),
                        replaced: if own {
                            0.0
                        } else {
                            fixed.magnitude * moving.magnitude
                        },
                        distance: clear,
                    });
                }
                (None, Some(_)) => 0,
                (Some(_), None) => 1,
                (None, None) => usize::from(moving.half[0] > fixed.half[0]),
            };
            if split == 0 {
                self.open
                    .extend(fixed.parts.iter().flatten().map(|part| [*part, m]));
            } else {
                self.open
                    .extend(moving.parts.iter().flatten().map(|part| [f, *part]));
            }
        }
        None
    }
}
