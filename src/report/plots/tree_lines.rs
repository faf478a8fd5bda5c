//! The lines and labels of a disconnectivity graph.

use plotters::style::text_anchor::{HPos, VPos};

use super::labels::Labels;
use super::marks::{Mark, Pixel, marker, polyline};
use super::merge_tree::Tree;
use super::picture::{Area, PictureError};
use super::scale::EnergyScale;
use super::scene::Scene;
use super::style::{GREEN, INK, SMALL, SOFT, Text};
use physics::landscape::{Kind, Place};

/// A graph in the making.
pub struct Drawing<'a, 'b> {
    pub root: &'a Area<'b>,
    pub scale: &'a EnergyScale,
    pub scene: &'a Scene<'a>,
    pub kinds: &'a [Kind<'a>],
    /// The place of an energy (J) at a leaf's place.
    pub at: &'a dyn Fn(f64, f64) -> Pixel,
    pub labels: Labels,
    /// How many states were drawn.
    pub next_leaf: usize,
    /// Where two lines join, and the saddle energy there.
    pub merges: Vec<(Pixel, f64)>,
    /// The states' markers and where they stand.
    pub feet: Vec<(Mark, Pixel)>,
}

impl Drawing<'_, '_> {
    /// Draws a tree up to its own energy and gives the x it stands at.
    pub fn tree(&mut self, tree: &Tree) -> Result<f64, PictureError> {
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

    fn error_bar(&mut self, x: f64, (lower, upper): (f64, f64)) -> Result<(), PictureError> {
        let (bottom, top) = ((self.at)(x, lower), (self.at)(x, upper));
        polyline(self.root, &[bottom, top], GREEN, 3.0)?;
        self.labels.keep_off_line(&[bottom, top]);
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
        self.feet.push((mark, foot));
        self.labels.keep_off(foot, 8.0);
        for (k, text) in lines.iter().enumerate() {
            let y = foot.1 + 13.0 + 17.0 * k as f64;
            Text::new(SMALL).write(self.root, text, (foot.0, y), (HPos::Center, VPos::Top))?;
            self.labels.keep_off((foot.0, y + 8.0), 32.0);
        }
        Ok(x)
    }

    /// What lies on top of the lines, and the energies at which they join, clear of all of them.
    pub fn finish(&mut self) -> Result<(), PictureError> {
        for (mark, foot) in &self.feet {
            marker(self.root, *mark, *foot, 7.0)?;
        }
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
