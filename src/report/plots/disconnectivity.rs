//! The disconnectivity graph: which states merge at which energy.
//!
//! Becker and Karplus, J. Chem. Phys. 106, 1495 (1997): the vertical axis is the energy; each
//! state is a line from its minimum up to the lowest saddle over which another can be reached,
//! where their lines join. Copies of a state under a symmetry are one line.

use super::axes::{Axis, Plot, Spacing};
use super::canvas::{Box4, Canvas, Pixel, Spot, corners};
use super::composition::{Composition, Panel, left_out, remark};
use super::decimals::energy;
use super::labels::Labels;
use super::marks::{Mark, marker};
use super::merge_tree::{Join, Tree, merge};
use super::scale::EnergyScale;
use super::scene::Scene;
use super::sheet::Sheet;
use super::style::{Anchor, GREEN, INK, SMALL, SOFT};
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
/// Largest number of classes shown, and on a page.
const MOST: usize = 11;
const MOST_ON_PAGE: usize = 24;

/// The merge tree of the classes, with free tiles at U = 0.
fn merge_tree(scene: &Scene, kinds: &[Kind], scale: &EnergyScale) -> Vec<Tree> {
    let leaf = |state: &State| (Some(state.class), state.energy);
    let mut leaves: Vec<_> = kinds.iter().map(|kind| leaf(kind.first())).collect();
    leaves.push((None, 0.0));
    let joins = scene.barriers().filter_map(|barrier| {
        let end = |place: Place| match place {
            Place::Free => Some(None),
            Place::State(_) => Some(Some(scene.class_of(place)?)),
        };
        // Tiles far apart have U = 0, so no path to them has a lower maximum energy.
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

/// Why no path leads from a tree to `free`; `None` for the tree that contains `free`.
fn why_apart(scene: &Scene, tree: &Tree) -> Option<&'static str> {
    let mut kinds = scene.catalogue.kinds();
    let is_caged = |kind: Kind| {
        let first = kind.first();
        let escape = scene.catalogue.escape_of_kind(scene.problem, first.id);
        tree.holds(Some(first.class)) && escape.is_some_and(|way| way.bounds.caged)
    };
    match tree.holds(None) {
        true => None,
        false if kinds.any(is_caged) => Some("caged, proved"),
        false => Some("no path found"),
    }
}

/// The number of kinds of states for which there is room.
fn room(sheet: &Sheet) -> usize {
    let plot = sheet.width(WIDTH) - MARGIN[1] - MARGIN[3];
    // One more line is for free tiles.
    ((plot / LEAF) as usize - 1).min(MOST)
}

/// The graph of the lowest classes of states, as far as there is room, with its numbers; `None` if
/// there is no state.
pub fn composed<'a>(
    scene: &'a Scene,
    sheet: &Sheet,
    scale: EnergyScale,
    name: &str,
) -> Option<(Composition<'a>, String)> {
    let all = scene.kinds();
    let kinds = all[..all.len().min(room(sheet))].to_vec();
    if kinds.is_empty() {
        return None;
    }
    let mut key = "each line is a kind of state: letter, energy, \u{d7} number of symmetric copies"
        .to_owned();
    if scene.barriers().any(|b| b.bounds.both().is_some()) {
        key.push_str("; green: proved bounds of the energy at which lines join");
    }
    let data = lines(scene, &kinds, &scale);
    let graph = Composition {
        name: name.to_owned(),
        title: format!("{}: energies at which states merge", scene.name),
        note: left_out(all.len(), kinds.len(), "not shown"),
        width: WIDTH,
        panels: vec![panel(scene, kinds, scale)],
        keys: vec![remark(key)],
    };
    Some((graph, data))
}

fn panel<'a>(scene: &'a Scene, kinds: Vec<Kind<'a>>, scale: EnergyScale) -> Panel<'a> {
    let height = |width: f64| HEIGHTS[usize::from(width < 0.7 * WIDTH)];
    Panel::alone(height, move |canvas, place| {
        Graph::draw(canvas, place, scene, &kinds, &scale);
    })
}

/// The graph for a page, with as many classes of states as a page shows: an SVG document.
pub fn on_page(scene: &Scene, scale: EnergyScale) -> Option<String> {
    let mut kinds = scene.kinds();
    kinds.truncate(MOST_ON_PAGE);
    // A browser's letters can be wider.
    let width = MARGIN[1] + MARGIN[3] + 1.15 * LEAF * (kinds.len() + 1) as f64;
    let graph = Composition {
        width: width.max(560.0),
        panels: vec![panel(scene, kinds, scale)],
        ..Composition::default()
    };
    let drawn = graph.draw(&Sheet::SCREEN.without_bitmaps()).ok()?;
    drawn.into_iter().next().map(|(_, picture)| picture.svg)
}

/// Each line of the graph of some kinds of states with its foot, and the energy and line at which
/// it joins another.
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

/// A row for each line below a tree's top, with the states below it.
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

/// The range of positions, from below the lowest state's label, which takes a share of the height,
/// to above the highest saddle.
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

/// A graph under construction.
struct Graph<'a> {
    scene: &'a Scene<'a>,
    scale: &'a EnergyScale,
    kinds: &'a [Kind<'a>],
    plot: Plot,
    labels: Labels,
    /// Number of states drawn so far.
    next_leaf: usize,
    /// The points where two lines join, and the saddle energies.
    merges: Vec<(Pixel, f64)>,
    /// The states' markers and their positions.
    feet: Vec<(Mark, Pixel)>,
}

impl<'a> Graph<'a> {
    fn draw(
        canvas: &mut Canvas,
        place: Box4,
        scene: &'a Scene<'a>,
        kinds: &'a [Kind<'a>],
        scale: &'a EnergyScale,
    ) {
        let trees = merge_tree(scene, kinds, scale);
        let height = place[3] - place[1] - MARGIN[0] - MARGIN[2];
        let (low, high) = extent(&trees, scale, LABEL / height);
        let label = |energy: f64| match energy {
            0.0 => "0".into(),
            _ => scale.tick(energy),
        };
        let marks = scale.ticks(low, high).into_iter();
        let y = Axis {
            spacing: Spacing::Energies(*scale),
            ends: [low, high],
            marks: marks.map(|u| (scale.position(u), label(u))).collect(),
            name: scale.axis(),
        };
        let leaves = trees.iter().map(Tree::leaves).sum();
        let plot = Plot::new(canvas, place, MARGIN, [Axis::places(leaves), y], true);
        let [_, top, right, _] = plot.frame;
        let mut graph = Graph {
            scene,
            scale,
            kinds,
            labels: Labels::new(plot.frame),
            plot,
            next_leaf: 0,
            merges: Vec::new(),
            feet: Vec::new(),
        };
        let zero = graph.plot.level(0.0);
        graph.line(canvas, &zero, 1.6);
        for tree in &trees {
            let x = graph.tree(canvas, tree);
            let at = graph.plot.at(x, tree.energy());
            graph.line(canvas, &[at, (at.0, top)], 1.8);
            if let Some(why) = why_apart(scene, tree) {
                let font = SMALL.colour(SOFT);
                let wide = font.width(why);
                // To the left of its line if there is no room to the right.
                let left = match at.0 + 6.0 + wide <= right {
                    true => at.0 + 6.0,
                    false => at.0 - 6.0 - wide,
                };
                let beside = (left, top + 8.0);
                canvas.write(font, why, beside, Anchor::Left);
                graph
                    .labels
                    .keep_off_line(&[beside, (left + wide, beside.1)]);
            }
        }
        graph.finish(canvas);
    }

    /// A line that labels avoid.
    fn line(&mut self, canvas: &mut Canvas, points: &[Pixel], width: f64) {
        canvas.line(points, INK, width);
        self.labels.keep_off_line(points);
    }

    /// Draws a tree up to its own energy and returns its x position.
    fn tree(&mut self, canvas: &mut Canvas, tree: &Tree) -> f64 {
        let (energy, bounds, children) = match tree {
            Tree::Leaf { class, energy } => return self.leaf(canvas, *class, *energy),
            Tree::Merge {
                energy,
                bounds,
                children,
            } => (*energy, bounds, children),
        };
        let mut ends = Vec::new();
        for child in children {
            let x = self.tree(canvas, child);
            let line = [child.energy(), energy].map(|energy| self.plot.at(x, energy));
            self.line(canvas, &line, 1.8);
            ends.push(x);
        }
        let (first, last) = (ends[0], ends[ends.len() - 1]);
        let bar = [first, last].map(|x| self.plot.at(x, energy));
        self.line(canvas, &bar, 1.8);
        let x = (first + last) / 2.0;
        if let Some((lower, upper)) = *bounds {
            let ends = [lower, upper].map(|energy| self.plot.at(x, energy));
            canvas.line(&ends, GREEN, 3.0);
            self.labels.keep_off_line(&ends);
            for (x, y) in ends {
                canvas.line(&[(x - 8.0, y), (x + 8.0, y)], GREEN, 3.0);
            }
        }
        self.merges.push((self.plot.at(x, energy), energy));
        x
    }

    fn leaf(&mut self, canvas: &mut Canvas, class: Option<usize>, energy: f64) -> f64 {
        let x = self.next_leaf as f64 + 0.5;
        self.next_leaf += 1;
        let foot = self.plot.at(x, energy);
        let kind = class.and_then(|class| {
            let mut kinds = self.kinds.iter();
            kinds.find(|kind| kind.first().class == class)
        });
        let (mark, id, lines) = match kind {
            None => (
                Mark::Free,
                "free".to_owned(),
                vec!["free".to_owned(), "0 J".to_owned()],
            ),
            Some(kind) => {
                let first = kind.first();
                let name = self.scene.name_of(Place::State(first.id));
                let mut lines = vec![name, self.scale.label(energy, 3)];
                if kind.copies() > 1 {
                    lines.push(format!("\u{d7}{}", kind.copies()));
                }
                (first.kind.into(), first.id.to_string(), lines)
            }
        };
        self.feet.push((mark, foot));
        self.labels.keep_off(foot, 8.0);
        for (k, text) in lines.iter().enumerate() {
            let y = foot.1 + 13.0 + 17.0 * k as f64;
            canvas.note(text, (foot.0, y), Anchor::Top);
            self.labels.keep_off((foot.0, y + 8.0), 32.0);
        }
        let half = LEAF / 2.0;
        let below = foot.1 + 13.0 + 17.0 * lines.len() as f64;
        let place = [foot.0 - half, foot.1 - 12.0, foot.0 + half, below];
        let spot = Spot {
            title: lines.join(" "),
            kind: "state",
            value: id,
        };
        canvas.spot(&corners(place), spot);
        x
    }

    /// Draws the markers on top of the lines, and the energies at which lines join, without
    /// overlaps.
    fn finish(mut self, canvas: &mut Canvas) {
        for (mark, foot) in self.feet {
            marker(canvas, mark, foot, 7.0);
        }
        for (place, energy) in self.merges {
            let text = self.scale.label(energy, 3);
            let above = nalgebra::Vector2::new(0.3, -1.0);
            self.labels
                .place(canvas, &text, SMALL.colour(SOFT), place, above);
        }
    }
}
