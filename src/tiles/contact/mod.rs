//! Contact of two tiles: overlap, distance, whether a motion is free, and the local constraints on
//! a motion.
//!
//! A configuration is *free* where the interiors of the two outlines are disjoint. Flush mates
//! touch along whole faces, so free is decided with a tolerance: an overlap no deeper than
//! [`Contact::touch`] counts as touching.

mod admissible;
pub mod cells;
mod constraint;
mod distance;
mod halving;
mod lift;
pub mod matching;
mod motion;
mod nearest_free;
mod points;
mod shape;
mod stretch;
mod tree;

pub use admissible::closest_admissible;
pub use constraint::{Constraint, EdgeOf, Touch};
pub use halving::Halves;
pub use motion::Known;
pub use points::{ContactPoint, NearPairs, TurnsWith};

use nalgebra::{Rotation2, Vector2};

use self::shape::SearchedOutline;
use crate::configuration::Configuration;
use crate::scale::Scale;
use crate::tile::Outline;
use crate::tile::outline::ConvexPart;

/// Overlaps up to this depth (m, for the paper's tile; for others see [`Contact::touch`]) count as
/// touching: far above rounding errors (1e-15 m), far below anything relevant to an energy (1e-9 m
/// times 100 N is 1e-7 J).
pub const TOUCH: f64 = 1e-9;

/// The two outlines of a pair of tiles.
#[derive(Clone)]
pub struct Contact {
    fixed: SearchedOutline,
    moving: SearchedOutline,
    scale: Scale,
}

impl Contact {
    /// For a fixed and a moving outline, each in its own tile's frame (m).
    pub fn new(fixed: &Outline, moving: &Outline) -> Self {
        Self {
            fixed: SearchedOutline::new(fixed),
            moving: SearchedOutline::new(moving),
            scale: Scale::of([fixed.circumradius(), moving.circumradius()]),
        }
    }

    /// The size of the tiles.
    #[inline]
    pub fn scale(&self) -> Scale {
        self.scale
    }

    /// A length (m) stated for the paper's tile, scaled to these tiles ([`Scale`]).
    #[inline]
    pub fn scaled(&self, told: f64) -> f64 {
        self.scale.length(told)
    }

    /// Overlaps up to this depth (m) count as touching.
    #[inline]
    pub fn touch(&self) -> f64 {
        self.scaled(TOUCH)
    }

    /// The outline of the fixed tile.
    #[inline]
    pub fn fixed(&self) -> &Outline {
        &self.fixed.outline
    }

    /// The outline of the moving tile, in its own frame.
    #[inline]
    pub fn moving(&self) -> &Outline {
        &self.moving.outline
    }

    /// Signed clearance (m): the distance of the two outlines if they are apart, otherwise minus
    /// the depth of the deepest overlap of two of their convex parts.
    pub fn clearance(&self, q: &Configuration) -> f64 {
        let depth = self.overlap_depth(q);
        if depth > 0.0 {
            return -depth;
        }
        self.distance(q, [0.0, f64::INFINITY])
    }

    /// A cheap lower bound of the clearance (m) from the outlines' circles and convex hulls;
    /// useless (but still correct) if the hulls overlap.
    pub fn clearance_bound(&self, q: &Configuration) -> f64 {
        let circles =
            q.position().norm() - self.fixed().circumradius() - self.moving().circumradius();
        if circles > 0.0 {
            return circles;
        }
        let hulls = separation(&self.fixed.hull, &self.moving.hull, &Placement::of(q));
        if hulls >= 0.0 {
            hulls
        } else {
            f64::NEG_INFINITY
        }
    }

    /// Whether the tiles overlap nowhere deeper than [`Contact::touch`].
    pub fn is_free(&self, q: &Configuration) -> bool {
        self.overlaps_at_most(q, self.touch())
    }

    /// Whether the outlines' circles or convex hulls prove that the clearance is at least `least`
    /// (m).
    pub fn is_clear_by(&self, q: &Configuration, least: f64) -> bool {
        self.unless_clear_by(q, least).is_none()
    }

    /// The placement of the moving tile, unless circles or hulls prove it.
    fn unless_clear_by(&self, q: &Configuration, least: f64) -> Option<Placement> {
        let clear = least + self.fixed().circumradius() + self.moving().circumradius();
        if clear <= 0.0 || q.position().norm_squared() >= clear * clear {
            return None;
        }
        let at = Placement::of(q);
        (!separated(&self.fixed.hull, &self.moving.hull, &at, least)).then_some(at)
    }

    /// Whether no convex part of a tile lies deeper than `depth` (m) inside one of the other's.
    pub fn overlaps_at_most(&self, q: &Configuration, depth: f64) -> bool {
        self.unless_clear_by(q, 0.0).is_none_or(|at| {
            separated(&self.fixed.core, &self.moving.core, &at, -depth)
                && self.parts_overlap_at_most(&at, depth)
        })
    }

    /// The same, part by part.
    fn parts_overlap_at_most(&self, at: &Placement, depth: f64) -> bool {
        self.close_parts(at, |fixed, moving| {
            separated(fixed, moving, &Placement::none(), -depth)
        })
    }

    /// Whether the tiles overlap nowhere deeper than [`Contact::touch`] with this rotation and
    /// position of the moving one, and how far (m) it can be translated with the same answer: 0 if
    /// neither the convex hulls nor the largest parts determine it.
    pub fn is_free_turned(&self, rotation: Rotation2<f64>, position: Vector2<f64>) -> (bool, f64) {
        let at = Placement { rotation, position };
        let apart = separation(&self.fixed.hull, &self.moving.hull, &at);
        if apart >= 0.0 {
            return (true, apart);
        }
        let deep = -self.touch() - separation(&self.fixed.core, &self.moving.core, &at);
        if deep > 0.0 {
            return (false, deep);
        }
        (self.parts_overlap_at_most(&at, self.touch()), 0.0)
    }

    /// Depth (m) of the deepest overlap of two convex parts; at most 0 if there is none.
    fn overlap_depth(&self, q: &Configuration) -> f64 {
        let mut deepest: f64 = 0.0;
        let Some(at) = self.unless_clear_by(q, 0.0) else {
            return deepest;
        };
        self.close_parts(&at, |fixed, moving| {
            deepest = deepest.max(-separation(fixed, moving, &Placement::none()));
            true
        });
        deepest
    }

    /// Whether `holds` for every two convex parts of the fixed and the moving tile whose boxes
    /// overlap; stops at the first pair for which it does not.
    fn close_parts(
        &self,
        at: &Placement,
        mut holds: impl FnMut(&ConvexPart, &ConvexPart) -> bool,
    ) -> bool {
        let Placement { rotation, position } = *at;
        let mut part = ConvexPart::default();
        let mut placed = None;
        self.fixed.parts.near_pairs(
            &self.moving.parts,
            &|p| position + rotation * p,
            &|_| 0.0,
            &mut |i, j| {
                let bounds = match placed {
                    Some((k, bounds)) if k == j => bounds,
                    _ => {
                        part.place(&self.moving().parts()[j], &rotation, &position);
                        placed.insert((j, part.bounds())).1
                    }
                };
                bounds.apart(&self.fixed.bounds[i]) || holds(&self.fixed().parts()[i], &part)
            },
        )
    }
}

/// Largest separation (m) of two convex polygons, the second one placed, over the normals of their
/// edges: at most their distance if they are apart, minus the overlap's depth otherwise (separating
/// axis theorem).
pub fn separation(fixed: &ConvexPart, moving: &ConvexPart, at: &Placement) -> f64 {
    let by_fixed = fixed.edges().map(|(point, normal)| {
        support(moving, &at.direction(normal)) + normal.dot(&(at.position - point))
    });
    let by_moving = moving.edges().map(|(point, normal)| {
        let world = at.rotation * normal;
        support(fixed, &world) - world.dot(&at.position) - normal.dot(point)
    });
    by_fixed.chain(by_moving).fold(f64::NEG_INFINITY, f64::max)
}

/// Whether the separation is at least `least` (m); stops at the first edge that proves it, and at
/// each edge at the first point that does not.
fn separated(fixed: &ConvexPart, moving: &ConvexPart, at: &Placement, least: f64) -> bool {
    let by_fixed = |(point, normal): (&Vector2<f64>, &Vector2<f64>)| {
        let direction = at.direction(normal);
        let level = normal.dot(&(at.position - point));
        moving
            .points
            .iter()
            .all(|p| direction.dot(p) + level >= least)
    };
    let by_moving = |(point, normal): (&Vector2<f64>, &Vector2<f64>)| {
        let world = at.rotation * normal;
        let level = -world.dot(&at.position) - normal.dot(point);
        fixed.points.iter().all(|x| world.dot(x) + level >= least)
    };
    let [(inside_moving, moving_radius), (inside_fixed, fixed_radius)] = [moving.disc, fixed.disc];
    let inside_moving = at.position + at.rotation * inside_moving;
    let inside_fixed = at.direction(&(inside_fixed - at.position));
    fixed
        .edges_off([inside_moving], moving_radius, least)
        .any(by_fixed)
        || moving
            .edges_off([inside_fixed], fixed_radius, least)
            .any(by_moving)
}

/// The placement of a convex part. Other points are transformed into its frame, so that the part
/// itself need not be moved.
#[derive(Clone, Copy, Debug)]
pub struct Placement {
    rotation: Rotation2<f64>,
    position: Vector2<f64>,
}

impl Placement {
    /// The placement of a part of the moving tile, given in its frame.
    pub fn of(q: &Configuration) -> Self {
        Self {
            rotation: q.rotation(),
            position: q.position(),
        }
    }

    /// The identity, for a part given in place.
    pub fn none() -> Self {
        Self {
            rotation: Rotation2::identity(),
            position: Vector2::zeros(),
        }
    }

    /// The inverse placement.
    fn inverse(&self) -> Self {
        let rotation = self.rotation.inverse();
        Self {
            rotation,
            position: rotation * -self.position,
        }
    }

    /// The map of points of the part to their positions.
    fn place(&self) -> impl Fn(Vector2<f64>) -> Vector2<f64> {
        let Self { rotation, position } = *self;
        move |p| position + rotation * p
    }

    /// A direction in the part's frame.
    fn direction(&self, d: &Vector2<f64>) -> Vector2<f64> {
        self.rotation.inverse_transform_vector(d)
    }
}

/// Least coordinate of a polygon along a direction.
fn support(part: &ConvexPart, direction: &Vector2<f64>) -> f64 {
    part.points
        .iter()
        .map(|p| direction.dot(p))
        .fold(f64::INFINITY, f64::min)
}
