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
use physics::table::{Crowd, Kind};
use physics::tile::{Pair, Tile};

/// Pairs' energies are cut off below this share of the bond's depth.
const CUT_OFF: f64 = 1e-4;

/// The fixed and the moving tile of a design as the kinds `fixed` and `moving`; for several designs
/// `NAME fixed` and `NAME moving`, on the first design's table. All tiles interact with each other,
/// including those of one kind and of different designs. Bonds are those between a design's own two
/// tiles.
///
/// # Errors
/// If there is no design, models differ, or forces are not gradients of energies.
pub fn of_designs(designs: &[Design]) -> Result<Crowd, String> {
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
    let named = |design: &Design, kind: &str| match designs.len() {
        1 => kind.to_owned(),
        _ => format!("{} {kind}", design.name),
    };
    let kinds = designs.iter().flat_map(|design| {
        let (fixed, moving) = (design.pair.fixed.clone(), design.pair.moving.clone());
        [("fixed", fixed), ("moving", moving)]
            .map(|(kind, tile)| Kind::new(named(design, kind), tile))
    });
    let of_kind = |kind: usize| {
        let shields = &designs[kind / 2].interaction.shields;
        match kind % 2 {
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
    let bonds = |one: usize, other: usize| match one.is_multiple_of(2) && other == one + 1 {
        true => MatchRule::new(&problems[one / 2], None)
            .into_iter()
            .collect(),
        false => Vec::new(),
    };
    let depths = problems.iter().map(Problem::depth);
    let tolerance = CUT_OFF * depths.fold(f64::INFINITY, f64::min);
    let half = problems[0].space.half_size;
    let crowd = Crowd::new(kinds.collect(), half, tolerance, &interaction, bonds);
    crowd.map_err(|error| error.to_string())
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
    let half = table.map(|size| 0.5 * size);
    let crowd = Crowd::new(kinds, half, tolerance, &|_, _| interaction.clone(), bonds);
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
