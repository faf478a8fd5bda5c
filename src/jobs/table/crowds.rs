//! The kinds of tiles of a design or of a tile set.

use std::sync::Arc;

use crate::Refused;
use crate::assembly::axis::Met;
use crate::assembly::{Assembly, designs};
use crate::design::Design;
use physics::configuration::ConfigurationSpace;
use physics::dynamics::docking::MatchRule;
use physics::potential::Interaction;
use physics::potential::shielding::Shields;
use physics::problem::Problem;
use physics::table::{Crowd, Kind, Rim};
use physics::tile::{Pair, Tile};

/// Largest number of tiles on a table.
pub(super) const MOST_TILES: usize = 100_000;

/// Pairs' energies are cut off below this share of the bond's depth.
const CUT_OFF: f64 = 1e-4;

/// The kinds of tiles of designs, and their other names.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Named {
    /// For each design, the kind of its fixed and of its moving tile: the same if they are equal.
    pub kinds: Vec<[usize; 2]>,
    /// Names by which start files may call kinds.
    pub aliases: Vec<(String, usize)>,
}

impl Named {
    /// The kind of a tile without a name, if all are equal: in different frames, that of the fixed one.
    pub fn only(&self) -> Option<usize> {
        let mut aliases = self.aliases.iter();
        let tile = aliases
            .find(|it| it.0 == "tile")
            .filter(|_| self.kinds.len() == 1);
        tile.map(|it| it.1)
    }
}

/// The tiles of a design as the kinds `fixed` and `moving`, or as the one kind `tile` if they are
/// equal; for several designs `NAME fixed` and so on, on the first design's table. All tiles interact
/// with each other, including those of one kind and of different designs. Bonds are all contacts
/// equal to the target between a design's own tiles.
///
/// # Errors
/// If there is no design, models differ, or forces are not gradients of energies.
pub fn of_designs(designs: &[Design]) -> Result<(Crowd, Named), String> {
    let first = designs.first().ok_or("there is no design")?;
    let (model, rule) = (first.interaction.model, first.interaction.shields.rule);
    for other in designs {
        if other.interaction.model != model || other.interaction.shields.rule != rule {
            return Err(format!(
                "{} and {} have different models of magnets or shields, which cannot share a table: give \
                 --model, or both designs the same [potential] and [shield]",
                first.name, other.name
            ));
        }
    }
    let problems: Vec<Problem> = designs.iter().map(Design::problem).collect();
    let mut kinds: Vec<Kind> = Vec::new();
    // The design of each kind, and which of its tiles it is.
    let mut origins: Vec<(usize, usize)> = Vec::new();
    let mut named = Named::default();
    for (number, design) in designs.iter().enumerate() {
        let called = |kind: &str| match designs.len() {
            1 => kind.to_owned(),
            _ => format!("{} {kind}", design.name),
        };
        let before = kinds.len();
        let is_one = design.is_of_one_kind();
        let tiles = [&design.pair.fixed, &design.pair.moving];
        let names = if is_one {
            &["tile"][..]
        } else {
            &["fixed", "moving"]
        };
        for (which, name) in names.iter().enumerate() {
            kinds.push(Kind::new(called(name), tiles[which].clone()));
            origins.push((number, which));
        }
        let own = [before, before + usize::from(!is_one)];
        let aliases = ["fixed", "moving"].into_iter().zip(own);
        let tile = (is_one || problems[number].exchange.is_some()).then_some(("tile", before));
        let aliases = aliases.chain(tile);
        named
            .aliases
            .extend(aliases.map(|(name, kind)| (called(name), kind)));
        named.kinds.push(own);
    }
    let of_kind = |kind: usize| {
        let (design, which) = origins[kind];
        let shields = &designs[design].interaction.shields;
        match which {
            0 => shields.fixed.clone(),
            _ => shields.moving.clone(),
        }
    };
    let interaction = |one: usize, other: usize| Interaction {
        shields: Shields {
            rule,
            fixed: of_kind(one),
            moving: of_kind(other),
        },
        ..first.interaction.clone()
    };
    let bonds = |one: usize, other: usize| {
        let ((design, first), (of_other, second)) = (origins[one], origins[other]);
        let problem = &problems[design];
        let pair = &designs[design].pair;
        let tiles = [first, second].map(|which| [&pair.fixed, &pair.moving][which]);
        let rule = match (first, second) {
            _ if design != of_other => return Vec::new(),
            _ if named.kinds[design] == [one, one] => MatchRule::of_equals(problem),
            (0, 1) => MatchRule::new(problem, None),
            // What binds as the target does, with the faces of one tile alone.
            _ if pair.only => return Vec::new(),
            _ => MatchRule::between(problem, tiles),
        };
        let rules = rule.into_iter();
        rules.filter(|rule| rule.poses().next().is_some()).collect()
    };
    let depths = problems.iter().map(Problem::depth);
    let tolerance = CUT_OFF * depths.fold(f64::INFINITY, f64::min);
    let half = problems[0].space.half_size;
    let rim = match first.is_round {
        true => Rim::Disc(half[0]),
        false => Rim::Rectangle(half),
    };
    let crowd = Crowd::new(kinds, rim, tolerance, &interaction, bonds);
    Ok((crowd.map_err(|error| error.to_string())?, named))
}

/// The tiles of a set as kinds with their names, on a table of the given size (m). Bonds are those
/// of every two tiles that meet in the assembly.
///
/// # Errors
/// If a tile meets no other, or forces are not gradients of energies.
pub fn of_assembly(assembly: &Assembly, table: [f64; 2]) -> Result<Crowd, Refused> {
    let types = &assembly.built.set.tiles;
    let met: Vec<Met> = designs::named(assembly)
        .into_iter()
        .map(|it| it.1)
        .collect();
    let mut pairs = Vec::new();
    for (name, text) in designs::all(assembly) {
        pairs.push(Design::parse(&text, &name)?);
    }
    let mut tiles: Vec<Option<Tile>> = vec![None; types.len()];
    for ((first, _, second), design) in met.iter().zip(&pairs) {
        tiles[*first].get_or_insert_with(|| design.pair.fixed.clone());
        tiles[*second].get_or_insert_with(|| design.pair.moving.clone());
    }
    let lone = tiles.iter().position(Option::is_none);
    if let Some(lone) = lone.or(pairs.is_empty().then_some(0)) {
        let name = types.get(lone).map_or("", |it| it.name.as_str());
        let message =
            format!("the tile `{name}` meets no other tile in the assembly, so it has no bonds");
        return Err(message.into());
    }
    let kinds = types.iter().zip(tiles.into_iter().flatten());
    let kinds = kinds
        .map(|(it, tile)| Kind::new(it.name.clone(), tile))
        .collect();
    let interaction = pairs[0].interaction.clone();
    let depths = pairs.iter().map(|design| design.problem().depth());
    let tolerance = CUT_OFF * depths.fold(f64::INFINITY, f64::min);
    let bonds = |i: usize, j: usize| {
        let mut rules = Vec::new();
        for ((first, _, second), design) in met.iter().zip(&pairs) {
            if (*first, *second) == (i, j) {
                rules.extend(MatchRule::new(&design.problem(), None));
            }
            if (*second, *first) == (i, j) {
                rules.extend(MatchRule::new(&turned(design), None));
            }
        }
        rules
    };
    let rim = Rim::Rectangle(table.map(|size| 0.5 * size));
    let crowd = Crowd::new(kinds, rim, tolerance, &|_, _| interaction.clone(), bonds);
    crowd.map_err(|error| error.to_string().into())
}

/// The problem of a design with the fixed and the moving tile exchanged.
fn turned(design: &Design) -> Problem {
    let pair = &design.pair;
    let turned = Pair {
        fixed: pair.moving.clone(),
        moving: pair.fixed.clone(),
        target: (pair.target.1, pair.target.0),
        bound: pair.bound.inverse(),
        only: pair.only,
    };
    let shields = &design.interaction.shields;
    let interaction = Interaction {
        shields: Shields {
            rule: shields.rule,
            fixed: shields.moving.clone(),
            moving: shields.fixed.clone(),
        },
        ..design.interaction.clone()
    };
    let space = ConfigurationSpace {
        rho: turned.moving.radius_of_gyration(),
        ..design.space()
    };
    Problem::new(space, Arc::new(turned), &interaction)
}
