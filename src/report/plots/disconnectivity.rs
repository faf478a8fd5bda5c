//! The disconnectivity graph: which states merge at which energy.
//!
//! Becker and Karplus, J. Chem. Phys. 106, 1495 (1997): the vertical axis is the energy; each
//! state is a line from its minimum up to the lowest saddle over which another can be reached,
//! where their lines join. Copies of a state under a symmetry are one line.

use plotters::style::text_anchor::{HPos, VPos};

use super::labels::Labels;
use super::marks::{Mark, Pixel, marker, polyline};
use super::merge_tree::{Join, Tree, merge};
use super::picture::{Area, Picture, PictureError};
use super::scale::EnergyScale;
use super::scene::Scene;
use super::style::{Axis, GREEN, INK, SMALL, SOFT, Text, chart, pixel, title};
use crate::landscape::{Kind, Place, State};

const SIZE: (u32, u32) = (1000, 700);
/// Classes shown.
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
    let mut kinds = scene.inventory.kinds();
    let is_caged = |kind: Kind| {
        let first = kind.first();
        let escape = scene.inventory.escape_of_kind(scene.problem, first.id);
        tree.holds(Some(first.class)) && escape.is_some_and(|way| way.bounds.caged)
    };
    match tree.holds(None) {
        true => None,
        false if kinds.any(is_caged) => Some("caged, proved"),
        false => Some("no way found"),
    }
}

/// The graph of the lowest classes of states; `None` where there is no state.
pub fn draw(scene: &Scene, scale: &EnergyScale) -> Result<Option<Picture>, PictureError> {
    let all = scene.kinds();
    if all.is_empty() {
        return Ok(None);
    }
    let kinds = &all[..all.len().min(MOST)];
    let trees = merge_tree(scene, kinds, scale);
    let leaves: usize = trees.iter().map(Tree::leaves).sum();
    let (low, high) = extent(&trees, scale);
    Picture::draw(SIZE, |root, _| {
        title(
            root,
            &format!("{}: which states merge at which energy", scene.name),
        )?;
        if all.len() > kinds.len() {
            let left_out = format!("{} shallower states not shown", all.len() - kinds.len());
            Text::new(SMALL).colour(SOFT).write(
                root,
                &left_out,
                (980.0, 22.0),
                (HPos::Right, VPos::Top),
            )?;
        }
        let x_axis = Axis {
            range: 0.0..leaves as f64,
            ticks: Vec::new(),
            name: String::new(),
        };
        let y_axis = Axis {
            range: low..high,
            ticks: scale
                .ticks(low, high)
                .into_iter()
                .map(|u| {
                    let text = if u == 0.0 {
                        "0".into()
                    } else {
                        scale.label(u, 1)
                    };
                    (scale.position(u), text)
                })
                .collect(),
            name: "energy U".into(),
        };
        let chart = chart(root, [54.0, 20.0, 46.0, 100.0], &x_axis, &y_axis, true)?;
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
        };
        drawing.labels.keep_off_line(&[left, right]);
        for tree in &trees {
            let x = drawing.tree(tree)?;
            let top = tree.energy();
            let end = (at(x, top).0, frame[1]);
            polyline(root, &[at(x, top), end], INK, 1.8)?;
            if let Some(why) = why_apart(scene, tree) {
                let beside = (end.0 + 6.0, end.1 + 8.0);
                let font = Text::new(SMALL).colour(SOFT);
                font.write(root, why, beside, (HPos::Left, VPos::Center))?;
            }
        }
        drawing.merge_labels()?;
        let mut key = "each line a kind of state: its letter, its energy, \u{d7} the copies of it \
            that symmetry makes"
            .to_owned();
        if scene.barriers().any(|b| b.bounds.both().is_some()) {
            key.push_str("; green: certified bounds");
        }
        Text::new(SMALL).colour(SOFT).write(
            root,
            &key,
            (100.0, f64::from(SIZE.1) - 24.0),
            (HPos::Left, VPos::Center),
        )
    })
    .map(Some)
}

/// Positions from below the lowest state's label to above the highest saddle.
fn extent(trees: &[Tree], scale: &EnergyScale) -> (f64, f64) {
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
    (low - 0.16 * span, high + 0.14 * span)
}

struct Drawing<'a, 'b> {
    root: &'a Area<'b>,
    scale: &'a EnergyScale,
    scene: &'a Scene<'a>,
    kinds: &'a [Kind<'a>],
    at: &'a dyn Fn(f64, f64) -> Pixel,
    labels: Labels,
    next_leaf: usize,
    /// Where two lines join, and the saddle energy there.
    merges: Vec<(Pixel, f64)>,
}

impl Drawing<'_, '_> {
    /// Draws a tree up to its own energy and gives the x it stands at.
    fn tree(&mut self, tree: &Tree) -> Result<f64, PictureError> {
        match tree {
            Tree::Leaf { class, energy } => self.leaf(*class, *energy),
            Tree::Merge {
                energy,
                bounds,
                children,
            } => {
                let mut ends = Vec::new();
                for child in children.iter() {
                    let x = self.tree(child)?;
                    let line = [(self.at)(x, child.energy()), (self.at)(x, *energy)];
                    polyline(self.root, &line, INK, 1.8)?;
                    self.labels.keep_off_line(&line);
                    ends.push(x);
                }
                let (first, last) = (ends[0], ends[ends.len() - 1]);
                let bar = [(self.at)(first, *energy), (self.at)(last, *energy)];
                polyline(self.root, &bar, INK, 1.8)?;
                self.labels.keep_off_line(&bar);
                let x = (first + last) / 2.0;
                if let Some(bounds) = bounds {
                    self.error_bar(x, *bounds)?;
                }
                self.merges.push(((self.at)(x, *energy), *energy));
                Ok(x)
            }
        }
    }

    fn error_bar(&self, x: f64, (lower, upper): (f64, f64)) -> Result<(), PictureError> {
        let (bottom, top) = ((self.at)(x, lower), (self.at)(x, upper));
        polyline(self.root, &[bottom, top], GREEN, 3.0)?;
        for (cx, cy) in [bottom, top] {
            polyline(self.root, &[(cx - 8.0, cy), (cx + 8.0, cy)], GREEN, 3.0)?;
        }
        Ok(())
    }

    fn leaf(&mut self, class: Option<usize>, energy: f64) -> Result<f64, PictureError> {
        let x = self.next_leaf as f64 + 0.5;
        self.next_leaf += 1;
        let foot = (self.at)(x, energy);
        let kind = class.and_then(|class| {
            let mut kinds = self.kinds.iter();
            kinds.find(|kind| kind.first().class == class)
        });
        let (mark, lines) = match kind {
            None => (Mark::Free, vec!["free".to_owned(), "0 J".to_owned()]),
            Some(kind) => {
                let first = kind.first();
                let name = self.scene.name_of(Place::State(first.id));
                let mut lines = vec![name, self.scale.label(energy, 3)];
                if kind.copies() > 1 {
                    lines.push(format!("\u{d7}{}", kind.copies()));
                }
                (first.kind.into(), lines)
            }
        };
        marker(self.root, mark, foot, 7.0)?;
        self.labels.keep_off(foot, 8.0);
        for (k, text) in lines.iter().enumerate() {
            let y = foot.1 + 13.0 + 17.0 * k as f64;
            Text::new(SMALL).write(self.root, text, (foot.0, y), (HPos::Center, VPos::Top))?;
            self.labels.keep_off((foot.0, y + 8.0), 32.0);
        }
        Ok(x)
    }

    fn merge_labels(&mut self) -> Result<(), PictureError> {
        for (place, energy) in std::mem::take(&mut self.merges) {
            let text = self.scale.label(energy, 3);
            let above = nalgebra::Vector2::new(0.3, -1.0);
            self.labels.place(
                self.root,
                &text,
                Text::new(SMALL).colour(SOFT),
                place,
                above,
            )?;
        }
        Ok(())
    }
}
