//! The landscape map: the lowest energy over theta at each (x, y), with the fixed tile, the states
//! and the pathways on it, and an enlargement of what lies in front of the target face.

use nalgebra::Vector2;
use plotters::style::text_anchor::{HPos, VPos};

use super::heat::{Interpolated, Key, POLE_KEYS, Range, STATE_KEYS, colour_bar, frame, keys};
use super::labels::{Labels, label_column};
use super::marks::{Box4, Mark, Pixel, View, marker, outline, seamed_line, tile};
use super::picture::{Area, Bitmap, Picture, PictureError, Underlay};
use super::scale::EnergyScale;
use super::scene::Scene;
use super::style::{Axis, FIXED_FILL, INK, LABEL, SMALL, SOFT, Text, chart, title, units};
use crate::configuration::Configuration;
use crate::landscape::StateKind;
use crate::landscape::map::{EnergyMap, Window};
use crate::tile::Pair;
use crate::units::prefix_of;

const WIDTH: f64 = 1000.0;
/// Top of the plots (pixels).
const TOP: f64 = 84.0;
/// Left and right of the two plots (pixels).
const WHOLE: (f64, f64) = (84.0, 604.0);
const TARGET: (f64, f64) = (700.0, 980.0);
/// Below the plots: axes, colour bar, keys (pixels).
const AXES: f64 = 62.0;
const FOOT: f64 = 156.0;
/// Share of the enlargement's width that lies behind the bound position.
const LABELS: f64 = 0.4;
/// Grid points along the longer side of a map.
const SAMPLES: f64 = 160.0;
/// Grid points where outlines have many parts and contact is costly to ask for.
const SAMPLES_OF_MANY_PARTS: f64 = 96.0;
const MANY_PARTS: usize = 200;
/// Orientations at each grid point.
const ORIENTATIONS: usize = 48;
/// Pixels of an embedded image a pixel of the picture.
const IMAGE: f64 = 0.8;
/// Pathways drawn.
const PATHWAYS: usize = 8;
/// Classes of states that are named.
const NAMED: usize = 12;

/// The two maps of the picture.
pub struct Maps {
    /// All around the fixed tile.
    pub whole: EnergyMap,
    /// In front of the target face.
    pub target: EnergyMap,
}

impl Maps {
    pub fn new(scene: &Scene) -> Self {
        let whole = whole_window(scene);
        let target = target_window(scene, plot_height(&whole));
        let [whole, target] =
            [whole, target].map(|window| EnergyMap::new(scene.problem, &window, ORIENTATIONS));
        Self { whole, target }
    }
}

fn whole_window(scene: &Scene) -> Window {
    let half = scene.reach();
    window(scene, Vector2::zeros(), 0.0, half.map(|h| -h), half)
}

/// Away from the target face along x, along it along y, the bound position at the origin; in
/// proportion to the plot. What lies behind the bound position is mostly blocked and leaves room
/// for labels.
fn target_window(scene: &Scene, height: f64) -> Window {
    let face = scene.pair.target_face();
    let normal = face.normal();
    let half = 0.6 * face.length();
    let across = 2.0 * half * (TARGET.1 - TARGET.0) / height;
    window(
        scene,
        scene.pair.bound.position(),
        normal.y.atan2(normal.x),
        [-LABELS * across, -half],
        [(1.0 - LABELS) * across, half],
    )
}

fn window(
    scene: &Scene,
    origin: Vector2<f64>,
    angle: f64,
    low: [f64; 2],
    high: [f64; 2],
) -> Window {
    let Pair { fixed, moving, .. } = scene.pair;
    let samples = if fixed.outline.parts().len() * moving.outline.parts().len() > MANY_PARTS {
        SAMPLES_OF_MANY_PARTS
    } else {
        SAMPLES
    };
    let span = [high[0] - low[0], high[1] - low[1]];
    let longer = span[0].max(span[1]);
    Window {
        origin,
        angle,
        low,
        high,
        samples: span.map(|s| ((samples * s / longer).round() as usize).max(2)),
    }
}

fn plot_height(whole: &Window) -> f64 {
    let [x, y] = [0, 1].map(|k| whole.high[k] - whole.low[k]);
    ((WHOLE.1 - WHOLE.0) * y / x).clamp(320.0, 800.0)
}

pub fn draw(scene: &Scene, maps: &Maps, scale: &EnergyScale) -> Result<Picture, PictureError> {
    let energies = [&maps.whole, &maps.target]
        .into_iter()
        .flat_map(|map| map.lowest.values.iter().flatten())
        .map(|sample| sample.energy);
    let range = Range::of(scale, energies);
    let bottom = TOP + plot_height(&maps.whole.window);
    let height = bottom + AXES + FOOT;
    Picture::draw((WIDTH as u32, height as u32), |root, underlays| {
        title(root, &format!("{}: lowest energy over θ", scene.name))?;
        let plots = [
            Plot {
                map: &maps.whole,
                place: [WHOLE.0, TOP, WHOLE.1, bottom],
                heading: "all around the fixed tile",
                axes: ["x", "y"],
            },
            Plot {
                map: &maps.target,
                place: [TARGET.0, TOP, TARGET.1, bottom],
                heading: "in front of the target face",
                axes: ["away from bound", "along the face"],
            },
        ];
        for plot in &plots {
            plot.draw(root, underlays, scale, &range)?;
        }
        let [whole, target] = plots.map(|plot| plot.view());
        let origin = Configuration::new(0.0, 0.0, 0.0);
        tile(root, &whole.0, &scene.pair.fixed, &origin, FIXED_FILL)?;
        for (view, place) in [whole, target] {
            pathways(root, &view, scene, place)?;
            states(root, &view, scene, place)?;
        }
        name_states(root, scene, scale, whole, target)?;

        let top = bottom + AXES + 24.0;
        let bar = [WHOLE.0, top, WIDTH - 20.0, top + 20.0];
        colour_bar(root, underlays, scale, &range, bar)?;
        let top = top + 72.0;
        let mut left = WHOLE.0;
        let marks = [
            (Key::Mark(Mark::Saddle), "saddle"),
            (Key::Pathway, "pathway out"),
        ];
        let blocked = [(Key::Blocked, "tiles would overlap")];
        for column in [&STATE_KEYS[..], &marks, &POLE_KEYS, &blocked] {
            keys(root, underlays, (left, top), column)?;
            left += 220.0;
        }
        let left_out = scene.kinds().len().saturating_sub(NAMED);
        if left_out > 0 {
            let text = format!("{left_out} shallower kinds of state not named");
            let at = (WIDTH - 20.0, 24.0);
            Text::new(SMALL)
                .colour(SOFT)
                .write(root, &text, at, (HPos::Right, VPos::Top))?;
        }
        Ok(())
    })
}

struct Plot<'a> {
    map: &'a EnergyMap,
    place: Box4,
    heading: &'a str,
    axes: [&'a str; 2],
}

impl Plot<'_> {
    fn draw(
        &self,
        root: &Area,
        underlays: &mut Vec<Underlay>,
        scale: &EnergyScale,
        range: &Range,
    ) -> Result<(), PictureError> {
        let [left, top, right, bottom] = self.place;
        let window = &self.map.window;
        let longer = (0..2)
            .flat_map(|k| [window.low[k].abs(), window.high[k].abs()])
            .fold(0.0, f64::max);
        // Just below a power of a thousand still counts as the smaller unit: 1000 mm, not 1 m.
        let (unit, prefix) = prefix_of(0.999 * longer);
        let [x, y] = [0, 1].map(|k| {
            let range = window.low[k] / unit..window.high[k] / unit;
            let count = if k == 0 && right - left < 400.0 { 5 } else { 9 };
            Axis::linear(range, count, format!("{} ({prefix}m)", self.axes[k]))
        });
        let (area, _) = root.split_horizontally(units(right));
        let (_, area) = area.split_horizontally(units(left - WHOLE.0));
        let (area, _) = area.split_vertically(units(bottom + AXES));
        let margin = [top, 0.0, AXES, WHOLE.0];
        let chart = chart(&area, margin, &x, &y, false)?;
        let [x, y] = [x, y].map(|axis| [axis.range.start, axis.range.end]);
        let frame = frame(&chart, &x, &y);
        debug_assert!((frame[0] - left).abs() < 1.0 && (frame[3] - bottom).abs() < 1.0);
        underlays.push(Underlay {
            bitmap: self.image(scale, range),
            rectangle: frame.map(units),
        });
        outline(root, frame, INK)?;
        Text::new(LABEL).bold().write(
            root,
            self.heading,
            (left, top - 10.0),
            (HPos::Left, VPos::Bottom),
        )
    }

    fn image(&self, scale: &EnergyScale, range: &Range) -> Bitmap {
        let [left, top, right, bottom] = self.place;
        let size = [right - left, bottom - top].map(|side| (IMAGE * side).round() as usize);
        let interpolated = Interpolated::new(&self.map.lowest, scale);
        range.bitmap((size[0], size[1]), |u, v| {
            let border_distance = interpolated
                .corners(u, v)
                .map(|(i, w)| w * self.map.border_distance[i]);
            if border_distance.iter().sum::<f64>() < 0.0 {
                return None;
            }
            interpolated.position(u, v).map(|(position, _)| position)
        })
    }

    fn view(&self) -> (View, Box4) {
        let [left, _, right, bottom] = self.place;
        let window = &self.map.window;
        let scale = (right - left) / (window.high[0] - window.low[0]);
        let view = View {
            origin: (left - window.low[0] * scale, bottom + window.low[1] * scale),
            scale,
            centre: window.origin,
            turn: -window.angle,
        };
        (view, self.place)
    }
}

fn pathways(root: &Area, view: &View, scene: &Scene, frame: Box4) -> Result<(), PictureError> {
    for barrier in scene.main_escapes().into_iter().take(PATHWAYS) {
        let points: Vec<_> = barrier
            .pathway
            .iter()
            .map(|p| view.pixel(p.configuration.position()))
            .collect();
        for piece in points.split(|p| !inside(frame, *p)) {
            seamed_line(root, piece, INK, 1.8)?;
        }
    }
    for barrier in scene.main_escapes().into_iter().take(PATHWAYS) {
        let saddle = view.pixel(barrier.saddle.position());
        let last = barrier.pathway.last().map(|p| p.configuration);
        if inside(frame, saddle) && last != Some(barrier.saddle) {
            marker(root, Mark::Saddle, saddle, 5.0)?;
        }
    }
    Ok(())
}

fn inside([left, top, right, bottom]: Box4, (x, y): Pixel) -> bool {
    x >= left && x <= right && y >= top && y <= bottom
}

/// All states as markers, one a place.
fn states(root: &Area, view: &View, scene: &Scene, frame: Box4) -> Result<(), PictureError> {
    let mut drawn: Vec<Pixel> = Vec::new();
    // Bound states last, on top.
    let mut states: Vec<_> = scene.states().iter().collect();
    states.sort_by_key(|state| state.kind == StateKind::Bond);
    for state in states {
        let at = view.pixel(state.configuration.position());
        let repeated = drawn.iter().any(|p| (p.0 - at.0).hypot(p.1 - at.1) < 1.0);
        if inside(frame, at) && !repeated {
            marker(root, state.kind.into(), at, 6.5)?;
            drawn.push(at);
        }
    }
    Ok(())
}

/// Names each class of states at its copy nearest to the target: in a column beside the states on
/// the enlargement, and where that does not hold them, on the whole map.
fn name_states(
    root: &Area,
    scene: &Scene,
    scale: &EnergyScale,
    (whole, whole_frame): (View, Box4),
    (target, target_frame): (View, Box4),
) -> Result<(), PictureError> {
    let font = Text::new(SMALL);
    let mut labels = Labels::new(whole_frame);
    for state in scene.states() {
        labels.keep_off(whole.pixel(state.configuration.position()), 6.5);
    }
    let mut column = Vec::new();
    for kind in scene.kinds().iter().take(NAMED) {
        let state = kind.first();
        let place = state.configuration.position();
        let energy = scale.label(state.energy, 3);
        let text = format!("{}: {energy}", scene.letters(kind));
        let (enlarged, at) = (target.pixel(place), whole.pixel(place));
        if inside(target_frame, enlarged) {
            column.push((enlarged, text));
        } else if inside(whole_frame, at) {
            let outwards = Vector2::new(place.x, -place.y).normalize();
            labels.place(root, &text, font, at, outwards)?;
        }
    }
    label_column(root, font, target_frame, column)
}
