//! The energy profile of each main pathway with its barrier marked.

use nalgebra::Vector2;
use ordered_float::OrderedFloat;

use plotters::style::Color;

use super::axes::{Axis, Plot};
use super::canvas::{Box4, Canvas, Pixel};
use super::composition::{Composition, Panel};
use super::decimals::{Decimals, energy};
use super::labels::Labels;
use super::marks::{Mark, above, marker};
use super::scale::EnergyScale;
use super::scene::Scene;
use super::style::{Anchor, BLUE, GREEN, INK, LABEL, SMALL, SOFT, VERMILLION};
use crate::csv::{SEEN, table, thinned};
use crate::names::place_name;
use physics::landscape::{Barrier, Place, SaddleBounds};

const WIDTH: f64 = 1000.0;
const PANEL_HEIGHT: f64 = 306.0;
/// The least width (pixels) of a panel beside another.
const LEAST: f64 = 400.0;
/// Number of pathways shown.
const MOST: usize = 6;
/// Space around a panel's plot (pixels): top, right, bottom, left.
const MARGIN: [f64; 4] = [48.0, 20.0, 60.0, 80.0];

/// One panel per pathway out of a state; `None` if no pathway is known.
pub fn composed<'a>(scene: &'a Scene, scale: &'a EnergyScale) -> Option<Composition<'a>> {
    let barriers = scene.main_escapes();
    let panel = |barrier: &&'a Barrier| {
        let barrier = *barrier;
        let [from, to] = [barrier.from, barrier.to].map(place_name);
        let draw =
            move |canvas: &mut Canvas, place| Profile::draw(canvas, place, scene, scale, barrier);
        Panel::new(format!("{from}-{to}"), LEAST, |_| PANEL_HEIGHT, draw)
    };
    let note = match barriers.len().saturating_sub(MOST) {
        0 => String::new(),
        1 => "1 path out of a shallower state not shown".to_owned(),
        more => format!("{more} paths out of shallower states not shown"),
    };
    (!barriers.is_empty()).then(|| Composition {
        name: "profiles".to_owned(),
        title: format!("{}: energy along the pathways out", scene.name),
        note,
        width: WIDTH,
        panels: barriers.iter().take(MOST).map(panel).collect(),
        ..Composition::default()
    })
}

/// The numbers of the picture.
pub fn data(scene: &Scene, decimals: Decimals) -> String {
    let barriers = scene.main_escapes().into_iter().take(MOST);
    let rows = barriers.flat_map(|barrier| {
        let ends = [barrier.from, barrier.to].map(place_name);
        thinned(&barrier.pathway, SEEN)
            .into_iter()
            .map(move |point| {
                let [from, to] = ends.clone();
                vec![from, to, decimals.length(point.s), energy(point.energy)]
            })
    });
    table(["from", "to", "s_m", "energy_J"], rows)
}

/// The length (m) that a panel shows, without the part of an end below the energy `low` (J).
fn shown_length(barrier: &Barrier, low: f64) -> f64 {
    let path = &barrier.pathway;
    let whole = path[path.len() - 1].s - path[0].s;
    let seen = path.iter().rfind(|p| p.energy >= low);
    let seen = seen.map_or(whole, |p| 1.08 * (p.s - path[0].s));
    seen.min(whole).max(f64::MIN_POSITIVE)
}

/// The energies (J) that a panel shows: always zero, the saddle with its bounds and the start; of
/// an end far below the start only the beginning of the descent.
fn shown_energies(barrier: &Barrier) -> [f64; 2] {
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
    [low - 0.06 * span, high + 0.16 * span]
}

/// The profile of a pathway under construction.
struct Profile<'a> {
    scene: &'a Scene<'a>,
    scale: &'a EnergyScale,
    barrier: &'a Barrier,
    plot: Plot,
    labels: Labels,
}

impl<'a> Profile<'a> {
    fn draw(
        canvas: &mut Canvas,
        place: Box4,
        scene: &'a Scene,
        scale: &'a EnergyScale,
        barrier: &'a Barrier,
    ) {
        let range = shown_energies(barrier);
        let along = [0.0, shown_length(barrier, range[0])];
        let axes = [
            Axis::quantity(along, "m", 7, "length of the pathway"),
            Axis::quantity(range, "J", 6, "energy U"),
        ];
        let plot = Plot::new(canvas, place, MARGIN, axes, true);
        let [left, top, right, bottom] = plot.frame;
        let names = [barrier.from, barrier.to].map(|place| scene.name_of(place));
        let heading = format!("{} \u{2192} {}", names[0], names[1]);
        canvas.write(
            LABEL.bold(),
            &heading,
            (left, top - 25.0),
            Anchor::BottomLeft,
        );
        let labels = Labels::new([left + 2.0, top + 2.0, right - 2.0, bottom - 2.0]);
        let mut profile = Profile {
            scene,
            scale,
            barrier,
            plot,
            labels,
        };
        profile.bounds(canvas);
        let zero = profile.plot.level(0.0);
        canvas.line(&zero, INK, 1.6);
        let path = barrier.pathway.iter();
        let curve: Vec<Pixel> = path.map(|p| profile.at(p.s, p.energy)).collect();
        let pieces = above(&curve, bottom);
        for piece in &pieces {
            canvas.line(piece, BLUE, 2.4);
            profile.labels.keep_off_line(piece);
        }
        profile.labels.keep_off_line(&zero);
        profile.saddle(canvas);
        profile.ends(canvas, &curve);
    }

    /// The position of a length along the pathway (m) and an energy (J).
    fn at(&self, s: f64, energy: f64) -> Pixel {
        self.plot.at(s - self.barrier.pathway[0].s, energy)
    }

    /// The certified bounds of the barrier as a band at the saddle, with their figures.
    fn bounds(&self, canvas: &mut Canvas) {
        let (saddle, barrier) = (self.barrier.bounds.both(), self.barrier.certified());
        let Some(((lower, upper), climbs)) = saddle.zip(barrier) else {
            return;
        };
        let [(left, top), (right, _)] = self.plot.level(upper);
        let bottom = self.plot.level(lower)[0].1.max(top + 2.0);
        canvas.block([left, top, right, bottom], GREEN.mix(0.35));
        let [lower, upper] = [climbs.0, climbs.1].map(|u| self.scale.label(u, 4));
        let text = format!("certified {lower} to {upper}");
        let at = (left, self.plot.frame[1] - 7.0);
        canvas.write(SMALL.colour(GREEN), &text, at, Anchor::BottomLeft);
    }

    /// The saddle, and an arrow from the start's energy up to it.
    fn saddle(&mut self, canvas: &mut Canvas) {
        let barrier = self.barrier;
        let path = &barrier.pathway;
        let Some(top) = path.iter().max_by_key(|p| OrderedFloat(p.energy)) else {
            return;
        };
        let saddle = self.at(top.s, barrier.saddle_energy);
        let foot = self.at(top.s, barrier.from_energy);
        canvas.line(&[self.at(path[0].s, barrier.from_energy), foot], SOFT, 0.8);
        if foot.1 - saddle.1 > 12.0 {
            let (x, y) = saddle;
            let head = [(x - 4.5, y + 15.0), (x, y + 7.0), (x + 4.5, y + 15.0)];
            canvas.line(&[saddle, foot], VERMILLION, 1.6);
            canvas.line(&head, VERMILLION, 1.6);
            self.labels.keep_off_line(&[saddle, foot]);
        }
        marker(canvas, Mark::Saddle, saddle, 5.0);
        self.labels.keep_off(saddle, 6.0);
        let text = format!("saddle {}", self.scale.label(barrier.saddle_energy, 4));
        self.labels
            .place(canvas, &text, SMALL, saddle, Vector2::new(0.3, -1.0));
        let text = format!("barrier {}", self.scale.label(barrier.forward(), 4));
        let middle = (foot.0, (foot.1 + saddle.1) / 2.0);
        let font = SMALL.bold().colour(VERMILLION);
        self.labels
            .place(canvas, &text, font, middle, Vector2::new(1.0, 0.0));
    }

    /// Both ends by name and energy; an end below the panel is named where the curve leaves it.
    fn ends(&mut self, canvas: &mut Canvas, curve: &[Pixel]) {
        let barrier = self.barrier;
        // A path to `free` ends where the tiles are apart, not where the energy is zero.
        let name = |place: Place, energy: f64| match place {
            Place::Free => "free: U \u{2192} 0".to_owned(),
            _ => format!(
                "{} {}",
                self.scene.name_of(place),
                self.scale.label(energy, 4)
            ),
        };
        let text = name(barrier.from, barrier.from_energy);
        let far = name(barrier.to, barrier.to_energy);
        marker(canvas, self.scene.mark_of(barrier.from), curve[0], 6.5);
        self.labels.keep_off(curve[0], 7.0);
        self.labels
            .place(canvas, &text, SMALL, curve[0], Vector2::new(0.8, 0.6));
        let (end, bottom) = (curve[curve.len() - 1], self.plot.frame[3]);
        if end.1 <= bottom {
            marker(canvas, self.scene.mark_of(barrier.to), end, 6.5);
            self.labels.keep_off(end, 7.0);
            self.labels
                .place(canvas, &far, SMALL, end, Vector2::new(-0.8, -0.3));
        } else {
            let text = format!("\u{2193} {far}");
            let seen = curve.iter().rfind(|p| p.1 <= bottom - 12.0);
            let exit = seen.copied().unwrap_or((end.0, bottom - 12.0));
            self.labels
                .place(canvas, &text, SMALL, exit, Vector2::new(-1.0, 0.0));
        }
    }
}
