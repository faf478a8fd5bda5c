//! Suggests an inset for magnets that stick out.

use super::blocks::{block, breaks_through, overlap, sticks_out};
use super::build::BuiltTile;
use physics::bisection::bisected;
use physics::tile::Magnet;

/// Number of insets tried between the surface and the far side of a tile.
const TRIED: usize = 120;
/// Rounding of the suggestion: a tenth of a millimetre, or finer if that overshoots.
const STEPS: [f64; 2] = [1e-4, 1e-6];

/// Suggests a replacement for an inset (m) with which magnets stick out: the nearest one that is
/// valid for all of them, on both tiles. `None` if there is none.
pub(super) fn fix(built: &[BuiltTile; 2], inset: f64) -> Option<String> {
    let all: Vec<_> = built.iter().map(|tile| Shifted::new(tile, inset)).collect();
    let sound = |to: f64| all.iter().all(|tile| tile.sits(to - inset));
    let across = built.iter().map(|tile| tile.tile.outline.circumradius());
    let largest = 2.0 * across.fold(0.0, f64::max);
    let tried = (0..=TRIED).map(|k| largest * k as f64 / TRIED as f64);
    let nearest = tried
        .filter(|&to| sound(to))
        .min_by(|a, b| (a - inset).abs().total_cmp(&(b - inset).abs()))?;
    // The valid one closest to the invalid one.
    let [right, _] = bisected(nearest, inset, 30, sound);
    let raised = right > inset;
    let rounded = STEPS.into_iter().map(|step| match raised {
        // Not 0.00320001 for 0.0032.
        true => tidy((right / step - 1e-4).ceil() * step),
        false => tidy((right / step + 1e-4).floor() * step),
    });
    let to = rounded
        .chain([right])
        .find(|&to| sound(to) && all.iter().all(|tile| tile.apart(to - inset)))?;
    let every_lower = (0..=TRIED).map(|k| to * k as f64 / TRIED as f64).all(sound);
    Some(match raised {
        true => format!("raise `inset` to {to} m, which is enough for all magnets"),
        false if every_lower => format!(
            "lower `inset`: any value from 0 to {to} m fits all \
            magnets"
        ),
        false => format!("lower `inset` to {to} m, which is enough for all magnets"),
    })
}

/// Rounds off the last bits of a product: 0.0032, not 0.0032000000000000003.
fn tidy(value: f64) -> f64 {
    format!("{value:.9}").parse().unwrap_or(value)
}

/// The magnets of a tile that share one inset and are moved together, and the others.
struct Shifted<'a> {
    built: &'a BuiltTile,
    moved: Vec<&'a Magnet>,
    others: Vec<&'a Magnet>,
}

impl<'a> Shifted<'a> {
    fn new(built: &'a BuiltTile, inset: f64) -> Self {
        let magnets = built.tile.magnets.iter().zip(&built.placings);
        let (moved, others): (Vec<_>, Vec<_>) =
            magnets.partition(|(_, placing)| placing.inset == inset);
        let magnets = |all: Vec<(&'a Magnet, _)>| all.into_iter().map(|(magnet, _)| magnet);
        Self {
            built,
            moved: magnets(moved).collect(),
            others: magnets(others).collect(),
        }
    }

    /// The magnets, `deeper` (m) behind their surfaces.
    fn magnets(&self, deeper: f64) -> impl Iterator<Item = Magnet> {
        self.moved.iter().map(move |&magnet| {
            let normal = self.built.tile.faces[magnet.face].normal();
            Magnet {
                position: magnet.position - normal * deeper,
                ..magnet.clone()
            }
        })
    }

    /// Whether all are inside the tile.
    fn sits(&self, deeper: f64) -> bool {
        let sits = |magnet: &Magnet| {
            !sticks_out(self.built, magnet) && !breaks_through(self.built, magnet)
        };
        self.magnets(deeper).all(|magnet| sits(&magnet))
    }

    /// Whether none overlaps another.
    fn apart(&self, deeper: f64) -> bool {
        let moved: Vec<_> = self.magnets(deeper).map(|magnet| block(&magnet)).collect();
        let others: Vec<_> = self.others.iter().map(|magnet| block(magnet)).collect();
        moved.iter().enumerate().all(|(i, one)| {
            let mut rest = moved[..i].iter().chain(&others);
            rest.all(|other| !overlap(one, other))
        })
    }
}
