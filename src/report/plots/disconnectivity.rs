//! The disconnectivity graph: which states merge at which energy.
//!
//! Becker and Karplus, J. Chem. Phys. 106, 1495 (1997): the vertical axis is the energy; each
//! state is a line from its minimum up to the lowest saddle over which another can be reached,
//! where their lines join. Copies of a state under a symmetry are one line.

use plotters::style::text_anchor::{HPos, VPos};

use super::composition::{Composition, Panel, left_out, part, remark};
use super::energy;
use super::labels::Labels;
use super::marks::{Box4, polyline};
use super::merge_tree::{Join, Tree, merge};
use super::picture::{Area, PictureError};
use super::scale::EnergyScale;
use super::scene::Scene;
use super::sheet::Sheet;
use super::style::{Axis, INK, SMALL, SOFT, Text, chart, pixel};
use super::tree_lines::Drawing;
use crate::csv::table;
use physics::landscape::{Kind, Place, State};

const WIDTH: f64 = 1000.0;
/// Height (pixels) on wide and on narrow sheets.
const HEIGHTS: [f64; 2] = [606.0, 470.0];
/// Space around the plot (pixels): top, right, bottom, left.
const MARGIN: [f64; 4] = [6.0, 20.0, 14.0, 100.0];
/// Width of a state's label (pixels).
const LEAF: f64 = 62.0;
/// Height of a state's label with the marker above it (pixels).
const LABEL: f64 = 84.0;
/// Classes shown at most.
const MOST: usize = 11;

/// The merge tree of the classes, with free tiles at U = 0.
pub fn merge_tree(scene: &Scene, kinds: &[Kind], scale: &EnergyScale) -> Vec<Tree> {
    let leaf = |state: &State| (Some(state.class), state.energy);
    let mut leaves: Vec<_> = kinds.iter().map(|kind| leaf(kind.first())).collect();
    leaves.push((None, 0.0));
    let joins = scene.barriers().filter_map(|barrier| {
        let end = |place: Place| match place {
            Place::Free => Some(None),
            Place::State(_) => Some(Some(scene.class_of(place)?)),
        };
        // Tiles far apart have U = 0, and no way to them has a lower highest energy.
        let least = if [barrier.from, barrier.to].contains(&Place::Free) {
            0.0
        } else {
            f64::NEG_INFINITY
        };
        let bounds = barrier.bounds.both();
        Some(Join {
            ends: [end(barrier.from)?, end(barrier.to)?],
            energy: barrier.saddle_energy.max(least),
            bounds: bounds.map(|(lower, upper)| (lower.max(least), upper.max(least))),
        })
    });
    merge(leaves, joins.collect(), scale)
}

/// Why no way leads from a tree to `free`; `None` for the tree that holds `free`.
pub fn why_apart(scene: &Scene, tree: &Tree) -> Option<&'static str> {
    let mut kinds = scene.catalogue.kinds();
    let is_caged = |kind: Kind| {
        let first = kind.first();
        let escape = scene.catalogue.escape_of_kind(scene.problem, first.id);
        tree.holds(Some(first.class)) && escape.is_some_and(|way| way.bounds.caged)
    };
    match tree.holds(None) {
        true => None,
        false if kinds.any(is_caged) => Some("caged, proved"),
        false => Some("no way found"),
    }
}

/// How many of the lowest kinds of states have room.
fn room(sheet: &Sheet) -> usize {
    let plot = sheet.width(WIDTH) - MARGIN[1] - MARGIN[3];
    // One more line is for free tiles.
    ((plot / LEAF) as usize - 1).min(MOST)
}

/// The graph of the lowest classes of states; `None` where there is no state.
pub fn composed<'a>(
    scene: &'a Scene,
    sheet: &Sheet,
    scale: EnergyScale,
    name: &str,
) -> Option<Composition<'a>> {
    let all = scene.kinds();
    if all.is_empty() {
        return None;
    }
    let kinds = all[..all.len().min(room(sheet))].to_vec();
    let trees = merge_tree(scene, &kinds, &scale);
    let mut key = "each line a kind of state: its letter, its energy, \u{d7} the copies of it \
        that symmetry makes"
        .to_owned();
    if scene.barriers().any(|b| b.bounds.both().is_some()) {
        key.push_str("; green: certified bounds");
    }
    let height = |width: f64| HEIGHTS[usize::from(width < 0.7 * WIDTH)];
    Some(Composition {
        name: name.to_owned(),
        title: format!("{}: which states merge at which energy", scene.name),
        note: left_out(all.len(), kinds.len(), "not shown"),
        width: WIDTH,
        panels: vec![Panel::new("", 0.0, height, move |root, _, place| {
            graph(root, place, scene, &kinds, &trees, &scale)
        })],
        key: Some(remark(key)),
    })
}

/// The numbers of the picture: each line with its foot, and where it joins which other.
pub fn data(scene: &Scene, sheet: &Sheet, scale: &EnergyScale) -> String {
    let kinds = scene.kinds();
    lines(scene, &kinds[..kinds.len().min(room(sheet))], scale)
}

/// The same of some kinds of states.
pub fn lines(scene: &Scene, kinds: &[Kind], scale: &EnergyScale) -> String {
    let mut rows = Vec::new();
    for tree in merge_tree(scene, kinds, scale) {
        branches(&tree, scene, kinds, &mut rows);
        if tree.leaves() == 1 {
            rows.push(branch(&tree, scene, kinds, None));
        }
    }
    let head = [
        "states",
        "energy_J",
        "copies",
        "joins_at_J",
        "lower_J",
        "upper_J",
    ];
    table(head, rows)
}

/// A row for each line below a tree's top, with the states that hang on it.
fn branches(tree: &Tree, scene: &Scene, kinds: &[Kind], rows: &mut Vec<Vec<String>>) {
    let Tree::Merge {
        energy,
        bounds,
        children,
    } = tree
    else {
        return;
    };
    for child in children {
        branches(child, scene, kinds, rows);
        rows.push(branch(child, scene, kinds, Some((*energy, *bounds))));
    }
}

fn branch(
    tree: &Tree,
    scene: &Scene,
    kinds: &[Kind],
    joins: Option<(f64, Option<(f64, f64)>)>,
) -> Vec<String> {
    let kind = |class| kinds.iter().find(|kind| Some(kind.first().class) == class);
    let names: Vec<String> = tree
        .classes()
        .into_iter()
        .map(|class| kind(class).map_or_else(|| "free".to_owned(), |kind| scene.letters(kind)))
        .collect();
    let copies = match tree {
        Tree::Leaf { class, .. } => kind(*class).map_or(1, Kind::copies).to_string(),
        Tree::Merge { .. } => String::new(),
    };
    let bound = |get: fn((f64, f64)) -> f64| {
        let bounds = joins.and_then(|(_, bounds)| bounds);
        bounds.map(|bounds| energy(get(bounds))).unwrap_or_default()
    };
    vec![
        names.join(" "),
        energy(tree.energy()),
        copies,
        joins.map(|(at, _)| energy(at)).unwrap_or_default(),
        bound(|(lower, _)| lower),
        bound(|(_, upper)| upper),
    ]
}

fn graph(
    root: &Area,
    place: Box4,
    scene: &Scene,
    kinds: &[Kind],
    trees: &[Tree],
    scale: &EnergyScale,
) -> Result<(), PictureError> {
    let leaves: usize = trees.iter().map(Tree::leaves).sum();
    let height = place[3] - place[1] - MARGIN[0] - MARGIN[2];
    let (low, high) = extent(trees, scale, LABEL / height);
    let x_axis = Axis {
        range: 0.0..leaves as f64,
        ticks: Vec::new(),
        name: String::new(),
    };
    let label = |energy: f64| match energy {
        0.0 => "0".into(),
        _ => scale.tick(energy),
    };
    let ticks = scale.ticks(low, high).into_iter();
    let y_axis = Axis {
        range: low..high,
        ticks: ticks.map(|u| (scale.position(u), label(u))).collect(),
        name: scale.axis(),
    };
    let area = part(root, place);
    let chart = chart(&area, MARGIN, &x_axis, &y_axis, true)?;
    let at = |x: f64, energy: f64| pixel(&chart, x, scale.position(energy));
    let (left, right) = (at(0.0, 0.0), at(leaves as f64, 0.0));
    polyline(root, &[left, right], INK, 1.6)?;
    let frame = [
        left.0,
        pixel(&chart, 0.0, high).1,
        right.0,
        pixel(&chart, 0.0, low).1,
    ];
    let mut drawing = Drawing {
        root,
        scale,
        scene,
        kinds,
        at: &at,
        labels: Labels::new(frame),
        next_leaf: 0,
        merges: Vec::new(),
        feet: Vec::new(),
    };
    drawing.labels.keep_off_line(&[left, right]);
    for tree in trees {
        let x = drawing.tree(tree)?;
        let top = tree.energy();
        let end = (at(x, top).0, frame[1]);
        polyline(root, &[at(x, top), end], INK, 1.8)?;
        drawing.labels.keep_off_line(&[at(x, top), end]);
        if let Some(why) = why_apart(scene, tree) {
            let font = Text::new(SMALL).colour(SOFT);
            let wide = font.width(why);
            // To the left of its line where there is no room to the right.
            let beside = match end.0 + 6.0 + wide <= right.0 {
                true => (end.0 + 6.0, end.1 + 8.0),
                false => (end.0 - 6.0 - wide, end.1 + 8.0),
            };
            font.write(root, why, beside, (HPos::Left, VPos::Center))?;
            drawing
                .labels
                .keep_off_line(&[beside, (beside.0 + wide, beside.1)]);
        }
    }
    drawing.finish()
}

/// Positions from below the lowest state's label, which takes that share of the height, to above the
/// highest saddle.
fn extent(trees: &[Tree], scale: &EnergyScale, label: f64) -> (f64, f64) {
    let highest = |tree: &Tree| match tree {
        Tree::Merge {
            energy,
            bounds: Some((_, upper)),
            ..
        } => upper.max(*energy),
        other => other.energy(),
    };
    let low = trees.iter().map(Tree::lowest).fold(0.0, f64::min);
    let high = trees.iter().map(highest).fold(0.0, f64::max);
    let (low, high) = (scale.position(low), scale.position(high));
    let span = (high - low).max(0.2);
    let whole = 1.14 * span / (1.0 - label);
    (low - label * whole, high + 0.14 * span)
}
