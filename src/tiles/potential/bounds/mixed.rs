//! Bounds of the sum of the energies of magnets that lie flat and of those that stand upright (no magnet
//! of one kind acts on one of the other), each pair by the bounds that are made for its kind.

use super::bodies::{SeriesOfKinds, depth};
use super::near::SLACK;
use super::upright::RadialLaws;
use super::{
    BodyBounds, BoxedBounds, CellBounds, CuboidBounds, DipoleBounds, Enclosure, UprightBounds,
    one_by_one,
};
use crate::cell::Cell;
use crate::configuration::Configuration;
use crate::potential::MagnetModel;
use crate::potential::bodies::Body;
use crate::scale::Scale;
use crate::tile::magnet::Shape;
use crate::tile::{Magnet, Tile};

/// Cell bounds of the interaction energy of two tiles whose magnets lie or stand.
pub struct MixedBounds {
    parts: Vec<BoxedBounds>,
}

/// What the bounds of pairs of the same kinds share.
#[derive(Default)]
struct Known {
    laws: RadialLaws,
    series: SeriesOfKinds,
}

/// Whether a magnet lies and is a block.
fn is_lying_block(magnet: &Magnet) -> bool {
    magnet.form.stands.is_none() && magnet.form.shape == Shape::Block
}

/// Whether a pair of magnets that both lie or both stand has bounds of its own: of blocks that lie, and of
/// discs that stand.
fn is_usual(first: &Body, second: &Body) -> bool {
    let usual = if first.stands {
        Shape::Disc
    } else {
        Shape::Block
    };
    first.shape == usual && second.shape == usual
}

impl MixedBounds {
    /// Whether there are bounds for these magnets: any but blocks that lie must stay apart as long as
    /// the tiles do, unless all are point dipoles.
    pub fn exist(model: MagnetModel, tiles: [&Tile; 2]) -> bool {
        let slack = Scale::of(tiles.map(|tile| tile.outline.circumradius())).length(SLACK);
        let stay_apart = |stands: bool| {
            let both = tiles.map(|tile| only(tile, |it| it.form.stands.is_some() == stands));
            let all = || both.iter().flat_map(|tile| &tile.magnets);
            let room = |tile: &Tile| {
                let depths = tile.magnets.iter().map(|magnet| depth(magnet, tile));
                depths.fold(f64::INFINITY, f64::min)
            };
            all().all(is_lying_block) || both.iter().map(room).sum::<f64>() >= -slack
        };
        model == MagnetModel::Dipole || stay_apart(true) && stay_apart(false)
    }

    /// Their bounds, if they [exist](Self::exist).
    pub fn new(model: MagnetModel, fixed: &Tile, moving: &Tile) -> Self {
        Self::with(&mut Known::default(), model, fixed, moving)
    }

    fn with(known: &mut Known, model: MagnetModel, fixed: &Tile, moving: &Tile) -> Self {
        let both = |kind: &dyn Fn(&Magnet) -> bool| {
            let tiles = [fixed, moving].map(|tile| only(tile, kind));
            let none = tiles.iter().any(|tile| tile.magnets.is_empty());
            (!none).then_some(tiles)
        };
        let (mut parts, is_dipole): (Vec<BoxedBounds>, _) =
            (Vec::new(), model == MagnetModel::Dipole);
        let lies = |it: &Magnet| it.form.stands.is_none();
        if let Some([a, b]) = both(&|it| lies(it) && (is_dipole || is_lying_block(it))) {
            parts.push(match model {
                MagnetModel::Dipole => Box::new(DipoleBounds::new(&a, &b)),
                MagnetModel::Cuboid => Box::new(CuboidBounds::new(&a, &b)),
            });
        }
        if let Some([a, b]) = both(&|it| !lies(it) && (is_dipole || it.is_round())) {
            parts.push(Box::new(UprightBounds::new(model, &a, &b, &mut known.laws)));
        }
        let bodies = |tile: &Tile| tile.magnets.iter().map(Body::from).collect::<Vec<_>>();
        let (first, second) = (bodies(fixed), bodies(moving));
        let is_left = |a: &Body, b: &Body| a.stands == b.stands && !is_usual(a, b);
        if !is_dipole && first.iter().any(|a| second.iter().any(|b| is_left(a, b))) {
            let bounds = BodyBounds::new(fixed, moving, is_usual, &mut known.series);
            parts.push(Box::new(bounds));
        }
        Self { parts }
    }

    /// The bounds of every single pair of magnets, those of the first moving one first.
    pub(super) fn of_pairs(model: MagnetModel, fixed: &Tile, moving: &Tile) -> Vec<Self> {
        let [first, second] = [fixed, moving].map(one_by_one);
        let pairs = second
            .iter()
            .flat_map(|b| first.iter().map(move |a| (a, b)));
        let mut known = Known::default();
        pairs
            .map(|(a, b)| Self::with(&mut known, model, a, b))
            .collect()
    }
}

/// A tile with the magnets of a kind.
fn only(tile: &Tile, kind: impl Fn(&Magnet) -> bool) -> Tile {
    let mut tile = tile.clone();
    tile.magnets.retain(kind);
    tile
}

impl CellBounds for MixedBounds {
    fn enclose(&self, cell: &Cell) -> Enclosure {
        let mut out = Enclosure::default();
        for part in &self.parts {
            let known = part.enclose(cell);
            out.add(&known, part.work_of(&known));
        }
        out
    }

    fn energy(&self, q: &Configuration) -> f64 {
        self.parts.iter().map(|part| part.energy(q)).sum()
    }

    fn work(&self) -> u64 {
        self.parts.iter().map(|part| part.work()).sum()
    }
}
