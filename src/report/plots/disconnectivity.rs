//! The disconnectivity graph: which states merge at which energy.
//!
//! Becker and Karplus, J. Chem. Phys. 106, 1495 (1997): the vertical axis is the energy; each
//! state is a line from its minimum up to the lowest saddle over which another can be reached,
//! where their lines join. Copies of a state under a symmetry are one line.

use plotters::style::text_anchor::{HPos, VPos};

use super::marks::{Labels, Mark, Pixel, marker, polyline};
use super::picture::{Area, Picture, PictureError};
use super::scale::EnergyScale;
use super::scene::{Class, Scene};
use super::style::{Axis, GREEN, INK, SMALL, SOFT, Text, chart, pixel, title};
use crate::landscape::{Barrier, Place, StateKind};

const SIZE: (u32, u32) = (1000, 700);
const MOST: usize = 11;

/// A merge tree of classes of states.
#[derive(Clone, Debug, PartialEq)]
pub enum Tree {
    /// A class by its number; `None` for free tiles.
    Leaf { class: Option<usize>, energy: f64 },
    Merge {
        /// Saddle energy (J).
        energy: f64,
        /// Certified bounds of the saddle energy (J).
        bounds: Option<(f64, f64)>,
        children: Box<[Tree; 2]>,
    },
}

impl Tree {
    /// Lowest energy (J) of the tree's states.
    fn lowest(&self) -> f64 {
        match self {
            Self::Leaf { energy, .. } => *energy,
            Self::Merge { children, .. } => children[0].lowest().min(children[1].lowest()),
        }
    }

    fn holds(&self, wanted: Option<usize>) -> bool {
        match self {
            Self::Leaf { class, .. } => *class == wanted,
            Self::Merge { children, .. } => children.iter().any(|child| child.holds(wanted)),
        }
    }

    fn leaves(&self) -> usize {
        match self {
            Self::Leaf { .. } => 1,
            Self::Merge { children, .. } => children.iter().map(Tree::leaves).sum(),
        }
    }
}

/// Joins classes over their barriers, the lowest saddle first. Classes that no barrier joins stay
/// trees of their own.
fn merge(scene: &Scene, classes: &[Class]) -> Vec<Tree> {
    let shown = |place: Place| match place {
        Place::Free => true,
        Place::State(_) => scene
            .class_of(place)
            .is_some_and(|number| classes.iter().any(|class| class.state.class == number)),
    };
    let mut barriers: Vec<&Barrier> = scene
        .barriers
        .iter()
        .filter(|barrier| shown(barrier.from) && shown(barrier.to))
        .collect();
    barriers.sort_by(|a, b| a.saddle_energy.total_cmp(&b.saddle_energy));
    let mut trees: Vec<Tree> = classes
        .iter()
        .map(|class| Tree::Leaf {
            class: Some(class.state.class),
            energy: class.state.energy,
        })
        .collect();
    trees.push(Tree::Leaf {
        class: None,
        energy: 0.0,
    });
    for barrier in barriers {
        let find = |trees: &[Tree], place| {
            let class = scene.class_of(place);
            trees.iter().position(|tree| tree.holds(class))
        };
        let (Some(a), Some(b)) = (find(&trees, barrier.from), find(&trees, barrier.to)) else {
            continue;
        };
        if a == b {
            continue;
        }
        let second = trees.remove(a.max(b));
        let first = trees.remove(a.min(b));
        let mut children = [first, second];
        children.sort_by(|x, y| x.lowest().total_cmp(&y.lowest()));
        trees.push(Tree::Merge {
            energy: barrier.saddle_energy,
            bounds: barrier.lower.zip(barrier.upper),
            children: Box::new(children),
        });
    }
    trees.retain(|tree| {
        !matches!(tree, Tree::Leaf { class: None, .. }) || scene.barriers.is_empty()
    });
    trees.sort_by(|x, y| x.lowest().total_cmp(&y.lowest()));
    trees
}

/// The graph of the lowest classes of states; `None` where there is no state.
pub fn draw(scene: &Scene, scale: &EnergyScale) -> Result<Option<Picture>, PictureError> {
    let all = scene.classes();
    if all.is_empty() {
        return Ok(None);
    }
    let classes = &all[..all.len().min(MOST)];
    let trees = merge(scene, classes);
    let leaves: usize = trees.iter().map(Tree::leaves).sum();
    let (low, high) = extent(&trees, scale);
    Picture::draw(SIZE, |root, _| {
        title(
            root,
            &format!("{}: which states merge at which energy", scene.name),
        )?;
        if all.len() > classes.len() {
            let left_out = format!("{} shallower states not shown", all.len() - classes.len());
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
        let chart = chart(root, [54.0, 20.0, 14.0, 100.0], &x_axis, &y_axis, true)?;
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
            scene,
            scale,
            classes,
            at: &at,
            labels: Labels::new(frame),
            next_leaf: 0,
            merges: Vec::new(),
        };
        for tree in &trees {
            let x = drawing.tree(tree)?;
            let top = tree_energy(tree);
            polyline(root, &[at(x, top), (at(x, top).0, frame[1])], INK, 1.8)?;
        }
        drawing.merge_labels()
    })
    .map(Some)
}

fn tree_energy(tree: &Tree) -> f64 {
    match tree {
        Tree::Leaf { energy, .. } | Tree::Merge { energy, .. } => *energy,
    }
}

/// Positions from below the lowest state's label to above the highest saddle.
fn extent(trees: &[Tree], scale: &EnergyScale) -> (f64, f64) {
    fn highest(tree: &Tree) -> f64 {
        match tree {
            Tree::Leaf { energy, .. } => *energy,
            Tree::Merge { energy, bounds, .. } => bounds.map_or(*energy, |(_, up)| up.max(*energy)),
        }
    }
    let low = trees.iter().map(Tree::lowest).fold(0.0, f64::min);
    let high = trees.iter().map(highest).fold(0.0, f64::max);
    let (low, high) = (scale.position(low), scale.position(high));
    let span = (high - low).max(0.2);
    (low - 0.16 * span, high + 0.14 * span)
}

struct Drawing<'a, 'b> {
    root: &'a Area<'b>,
    scene: &'a Scene<'a>,
    scale: &'a EnergyScale,
    classes: &'a [Class<'a>],
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
                    let line = [(self.at)(x, tree_energy(child)), (self.at)(x, *energy)];
                    polyline(self.root, &line, INK, 1.8)?;
                    self.labels.keep_off_line(&line);
                    ends.push(x);
                }
                let (a, b) = ((self.at)(ends[0], *energy), (self.at)(ends[1], *energy));
                polyline(self.root, &[a, b], INK, 1.8)?;
                self.labels.keep_off_line(&[a, b]);
                let x = (ends[0] + ends[1]) / 2.0;
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
        let class = class.and_then(|number| {
            self.classes
                .iter()
                .find(|class| class.state.class == number)
        });
        let (mark, lines) = match class {
            None => (Mark::Free, vec!["free".to_owned(), "0 J".to_owned()]),
            Some(class) => {
                let name = match class.state.kind {
                    StateKind::Bound => format!("bound {}", class.state.id),
                    StateKind::Misbound => class.state.id.to_string(),
                };
                let mut lines = vec![name, self.scale.label(energy, 3)];
                if class.copies > 1 {
                    lines.push(format!("\u{d7}{}", class.copies));
                }
                (class.state.kind.into(), lines)
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
