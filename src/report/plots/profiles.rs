//! The energy profile of each main pathway with its barrier marked.

use nalgebra::Vector2;
use ordered_float::OrderedFloat;
use plotters::prelude::Color;
use plotters::style::text_anchor::{HPos, VPos};

use super::composition::{Composition, Panel, part};
use super::labels::Labels;
use super::marks::{Box4, Mark, Pixel, above, marker, polygon, polyline};
use super::picture::{Area, PictureError};
use super::scale::EnergyScale;
use super::scene::Scene;
use super::style::{Axis, BLUE, GREEN, INK, LABEL, SMALL, SOFT, Text, VERMILLION, chart, pixel};
use super::{energy, length};
use crate::csv::{SEEN, table, thinned};
use crate::names::place_name;
use physics::landscape::{Barrier, Place, SaddleBounds};
use physics::units::prefix_of;

const WIDTH: f64 = 1000.0;
const PANEL_HEIGHT: f64 = 306.0;
/// The least width (pixels) of a panel beside another.
const LEAST: f64 = 400.0;
/// Pathways shown.
const MOST: usize = 6;
/// Space around a panel's plot (pixels): top, right, bottom, left.
const MARGIN: [f64; 4] = [48.0, 20.0, 60.0, 80.0];

/// One panel a pathway out of a state; `None` where no pathway is known.
pub fn composed<'a>(scene: &'a Scene, scale: &'a EnergyScale) -> Option<Composition<'a>> {
    let barriers = scene.main_escapes();
    let panel = |barrier: &&'a Barrier| {
        let barrier = *barrier;
        let [from, to] = [barrier.from, barrier.to].map(place_name);
        let draw = move |root: &Area, _: &mut Vec<_>, place| {
            draw_panel(root, place, scene, scale, barrier)
        };
        Panel::new(format!("{from}-{to}"), LEAST, |_| PANEL_HEIGHT, draw)
    };
    let more = match barriers.len().saturating_sub(MOST) {
        0 => None,
        1 => Some("1 way out of a shallower state not shown".to_owned()),
        more => Some(format!("{more} ways out of shallower states not shown")),
    };
    (!barriers.is_empty()).then(|| Composition {
        name: "profiles".to_owned(),
        title: format!("{}: energy along the pathways out", scene.name),
        note: more,
        width: WIDTH,
        panels: barriers.iter().take(MOST).map(panel).collect(),
        key: None,
    })
}

/// The numbers of the picture.
pub fn data(scene: &Scene) -> String {
    let barriers = scene.main_escapes().into_iter().take(MOST);
    let rows = barriers.flat_map(|barrier| {
        let ends = [barrier.from, barrier.to].map(place_name);
        thinned(&barrier.pathway, SEEN)
            .into_iter()
            .map(move |point| {
                let [from, to] = ends.clone();
                vec![from, to, length(point.s), energy(point.energy)]
            })
    });
    table(["from", "to", "s_m", "energy_J"], rows)
}

/// A panel's plot: where its points lie on the picture.
struct PathwayPlot<'a, 'b> {
    root: &'a Area<'b>,
    scene: &'a Scene<'a>,
    scale: &'a EnergyScale,
    barrier: &'a Barrier,
    /// Pixel of a length along the pathway (m) and an energy (J).
    at: &'a dyn Fn(f64, f64) -> Pixel,
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
}

/// The length (m) a panel shows: of an end that lies below the energy `low` (J) nothing.
fn shown_length(barrier: &Barrier, low: f64) -> f64 {
    let path = &barrier.pathway;
    let whole = path[path.len() - 1].s - path[0].s;
    let seen = path.iter().rfind(|p| p.energy >= low);
    let seen = seen.map_or(whole, |p| 1.08 * (p.s - path[0].s));
    seen.min(whole).max(f64::MIN_POSITIVE)
}

fn draw_panel(
    root: &Area,
    place: Box4,
    scene: &Scene,
    scale: &EnergyScale,
    barrier: &Barrier,
) -> Result<(), PictureError> {
    let path = &barrier.pathway;
    let (low, high) = shown_energies(barrier);
    let start = path[0].s;
    let length = shown_length(barrier, low);
    // Just below a power of a thousand still counts as the smaller unit: 1000 mm, not 1 m.
    let (joule, prefix) = prefix_of(0.999 * low.abs().max(high.abs()));
    let (metre, metre_prefix) = prefix_of(0.999 * length);
    let name = format!("length of the pathway ({metre_prefix}m)");
    let x_axis = Axis::linear(0.0..length / metre, 7, name);
    let name = format!("energy U ({prefix}J)");
    let y_axis = Axis::linear(low / joule..high / joule, 6, name);
    let area = part(root, place);
    let chart = chart(&area, MARGIN, &x_axis, &y_axis, true)?;
    let at = |s: f64, energy: f64| pixel(&chart, (s - start) / metre, energy / joule);
    let (corner, opposite) = (at(start, high), at(start + length, low));
    PathwayPlot {
        root,
        scene,
        scale,
        barrier,
        at: &at,
        left: corner.0,
        top: corner.1,
        right: opposite.0,
        bottom: opposite.1,
    }
    .draw()
}

/// The energies (J) a panel shows: zero, the saddle with its bounds and the start for certain; of
/// an end that lies far below the start only the beginning of the fall.
fn shown_energies(barrier: &Barrier) -> (f64, f64) {
    let energies = || barrier.pathway.iter().map(|p| p.energy);
    let SaddleBounds { lower, upper, .. } = barrier.bounds;
    let high = energies().fold(
        upper.unwrap_or(0.0).max(barrier.saddle_energy).max(0.0),
        f64::max,
    );
    let lowest = energies().fold(lower.unwrap_or(0.0).min(0.0), f64::min);
    let start = barrier.pathway[0].energy.min(0.0);
    let climb = high - start;
    let low = if climb > 0.0 && start - lowest > 1.5 * climb {
        start - 0.45 * climb
    } else {
        lowest
    };
    let span = (high - low).max(f64::MIN_POSITIVE);
    (low - 0.06 * span, high + 0.16 * span)
}

impl PathwayPlot<'_, '_> {
    fn draw(&self) -> Result<(), PictureError> {
        let barrier = self.barrier;
        let names = [barrier.from, barrier.to].map(|place| self.scene.name_of(place));
        Text::new(LABEL).bold().write(
            self.root,
            &format!("{} \u{2192} {}", names[0], names[1]),
            (self.left, self.top - 25.0),
            (HPos::Left, VPos::Bottom),
        )?;
        self.bounds()?;
        let zero = (self.at)(0.0, 0.0).1;
        polyline(
            self.root,
            &[(self.left, zero), (self.right, zero)],
            INK,
            1.6,
        )?;

        let curve: Vec<Pixel> = barrier
            .pathway
            .iter()
            .map(|p| (self.at)(p.s, p.energy))
            .collect();
        let pieces = above(&curve, self.bottom);
        for piece in &pieces {
            polyline(self.root, piece, BLUE, 2.4)?;
        }
        let frame = [
            self.left + 2.0,
            self.top + 2.0,
            self.right - 2.0,
            self.bottom - 2.0,
        ];
        let mut labels = Labels::new(frame);
        for piece in &pieces {
            labels.keep_off_line(piece);
        }
        labels.keep_off_line(&[(self.left, zero), (self.right, zero)]);
        self.barrier(&mut labels)?;
        self.ends(&mut labels, &curve)
    }

    /// The certified bounds of the saddle energy as a band with its figures.
    fn bounds(&self) -> Result<(), PictureError> {
        let Some((lower, upper)) = self.barrier.bounds.both() else {
            return Ok(());
        };
        let top = (self.at)(0.0, upper).1;
        let bottom = (self.at)(0.0, lower).1.max(top + 2.0);
        let band = [
            (self.left, top),
            (self.right, top),
            (self.right, bottom),
            (self.left, bottom),
        ];
        polygon(self.root, &band, GREEN.mix(0.35), None)?;
        let [lower, upper] = [lower, upper].map(|u| self.scale.label(u, 4));
        Text::new(SMALL).colour(GREEN).write(
            self.root,
            &format!("certified {lower} to {upper}"),
            (self.left, self.top - 7.0),
            (HPos::Left, VPos::Bottom),
        )
    }

    /// The saddle, and an arrow from the start's energy up to it.
    fn barrier(&self, labels: &mut Labels) -> Result<(), PictureError> {
        let barrier = self.barrier;
        let path = &barrier.pathway;
        let Some(top) = path.iter().max_by_key(|p| OrderedFloat(p.energy)) else {
            return Ok(());
        };
        let saddle = (self.at)(top.s, barrier.saddle_energy);
        let foot = (self.at)(top.s, barrier.from_energy);
        let start = (self.at)(path[0].s, barrier.from_energy);
        polyline(self.root, &[start, foot], SOFT, 0.8)?;
        if foot.1 - saddle.1 > 12.0 {
            let (x, y) = saddle;
            polyline(self.root, &[saddle, foot], VERMILLION, 1.6)?;
            polyline(
                self.root,
                &[(x - 4.5, y + 15.0), (x, y + 7.0), (x + 4.5, y + 15.0)],
                VERMILLION,
                1.6,
            )?;
            labels.keep_off_line(&[saddle, foot]);
        }
        marker(self.root, Mark::Saddle, saddle, 5.0)?;
        labels.keep_off(saddle, 6.0);
        let text = format!("saddle {}", self.scale.label(barrier.saddle_energy, 4));
        labels.place(
            self.root,
            &text,
            Text::new(SMALL),
            saddle,
            Vector2::new(0.3, -1.0),
        )?;
        let text = format!("barrier {}", self.scale.label(barrier.forward(), 4));
        let middle = (foot.0, (foot.1 + saddle.1) / 2.0);
        let font = Text::new(SMALL).bold().colour(VERMILLION);
        labels.place(self.root, &text, font, middle, Vector2::new(1.0, 0.0))
    }

    /// Both ends by name and energy; an end below the panel is named where the curve leaves it.
    fn ends(&self, labels: &mut Labels, curve: &[Pixel]) -> Result<(), PictureError> {
        let barrier = self.barrier;
        // A way to `free` ends where the tiles are apart, not where the energy is zero.
        let name = |place: Place, energy: f64| match place {
            Place::Free => "free: U \u{2192} 0".to_owned(),
            _ => format!(
                "{} {}",
                self.scene.name_of(place),
                self.scale.label(energy, 4)
            ),
        };
        let font = Text::new(SMALL);
        marker(self.root, self.scene.mark_of(barrier.from), curve[0], 6.5)?;
        labels.keep_off(curve[0], 7.0);
        let text = name(barrier.from, barrier.from_energy);
        labels.place(self.root, &text, font, curve[0], Vector2::new(0.8, 0.6))?;

        let end = curve[curve.len() - 1];
        let text = name(barrier.to, barrier.to_energy);
        if end.1 <= self.bottom {
            marker(self.root, self.scene.mark_of(barrier.to), end, 6.5)?;
            labels.keep_off(end, 7.0);
            labels.place(self.root, &text, font, end, Vector2::new(-0.8, -0.3))
        } else {
            let text = format!("\u{2193} {text}");
            let seen = curve.iter().rfind(|p| p.1 <= self.bottom - 12.0);
            let exit = seen.copied().unwrap_or((end.0, self.bottom - 12.0));
            labels.place(self.root, &text, font, exit, Vector2::new(-1.0, 0.0))
        }
    }
}
