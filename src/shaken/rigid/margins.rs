//! The lengths that decide what counts as touching, near or resolved, relative to tiles and magnets.

use tiles::scale::Scale;
use tiles::tile::Tile;

/// The usual step (s), for the paper's tile, for which the limits of steps in contact are stated.
pub const USUAL_STEP: f64 = 2.5e-3;

/// Lengths (m) and the usual step of one table. All but `feature` are stated for the paper's tile,
/// a square of 43 cm, and scaled with the smallest tile ([`Scale`]). `feature` is relative to the
/// magnets, and so is what depends on how fast forces change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Margins {
    /// Outlines are kept apart by this. The force of two blocks changes sign where their pole faces
    /// pass through each other, so tiles must not overlap at all; this changes an energy by the
    /// force times this distance.
    pub skin: f64,
    /// Points with gaps below this, beyond the skin, are in contact.
    pub touched: f64,
    /// Overlaps up to this are rounding.
    pub rounding: f64,
    /// Half the shortest side of a magnet, or a thirtieth of the smallest tile's circumradius if that
    /// is less: forces change over this length.
    pub feature: f64,
    /// The travel of touching tiles in a step: a ninth of `feature`.
    pub travel: f64,
    /// The same at the rim.
    pub rim_travel: f64,
    /// Contact points are searched for within this distance at least: a fifteenth of `feature`.
    pub least: f64,
    /// The same where nothing is near: twice `feature`.
    pub seen: f64,
    /// Edges and corners that may touch are searched for this much farther than needed, and so less
    /// often: 2.7 times `feature`.
    pub ahead: f64,
    /// Contact points closer than this to one of the step before are the same: two thirds of
    /// `feature`.
    pub same: f64,
    /// The step (s) for which the limits of steps in contact are stated.
    pub usual_step: f64,
}

impl Margins {
    /// Those of tiles that move together.
    pub fn of<'a>(tiles: impl Iterator<Item = &'a Tile> + Clone) -> Self {
        let radii = tiles.clone().map(|it| it.outline.circumradius());
        let smallest = radii.fold(f64::INFINITY, f64::min);
        let scale = Scale::of([smallest; 2]);
        let magnets = tiles.flat_map(|it| &it.magnets);
        let sides = magnets.flat_map(|magnet| [magnet.size[0], magnet.size[1]]);
        let feature = 0.5 * sides.fold(scale.length(0.02), f64::min);
        let skin = scale.length(3e-7);
        Self {
            skin,
            touched: skin / 3.0,
            rounding: skin / 100.0,
            feature,
            travel: feature / 9.0,
            rim_travel: feature / 9.0,
            least: feature / 15.0,
            seen: 2.0 * feature,
            ahead: 2.7 * feature,
            same: feature / 1.5,
            usual_step: scale.time(USUAL_STEP),
        }
    }
}
