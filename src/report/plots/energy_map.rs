//! The landscape map: the lowest energy over theta at each (x, y), with the fixed tile, the states
//! and the pathways on it.

use nalgebra::Vector2;
use plotters::style::text_anchor::{HPos, VPos};

use super::heat::{Interpolated, Key, POLE_KEYS, Range, STATE_KEYS, colour_bar, frame, keys};
use super::marks::{Box4, Labels, Mark, Pixel, View, marker, outline, seamed_line, tile};
use super::picture::{Area, Bitmap, Picture, PictureError, Underlay};
use super::scale::EnergyScale;
use super::scene::Scene;
use super::style::{Axis, FIXED_FILL, INK, SMALL, SOFT, Text, chart, pixel, title, units};
use crate::configuration::Configuration;
use crate::landscape::StateKind;
use crate::landscape::map::EnergyMap;

const WIDTH: u32 = 1000;
/// Space around the plot (pixels): top, right, bottom, left.
const MARGIN: [f64; 4] = [54.0, 220.0, 62.0, 84.0];
/// Pixels of the embedded image along the longer side.
const IMAGE: f64 = 480.0;
/// Classes of states that are named.
const NAMED: usize = 9;

pub fn draw(scene: &Scene, map: &EnergyMap, scale: &EnergyScale) -> Result<Picture, PictureError> {
    let (x, y) = (&map.lowest.x, &map.lowest.y);
    let span = (x[x.len() - 1] - x[0], y[y.len() - 1] - y[0]);
    let plot_width = f64::from(WIDTH) - MARGIN[1] - MARGIN[3];
    let plot_height = (plot_width * span.1 / span.0).max(680.0);
    let height = (plot_height + MARGIN[0] + MARGIN[2]) as u32;
    let energies = map.lowest.values.iter().flatten().map(|s| s.energy);
    let range = Range::of(scale, energies);
    Picture::draw((WIDTH, height), |root, underlays| {
        title(root, &format!("{}: lowest energy over θ", scene.name))?;
        let axis = |values: &[f64], name: &str| {
            Axis::linear(values[0]..values[values.len() - 1], 10, name)
        };
        let (x_axis, y_axis) = (axis(x, "x (m)"), axis(y, "y (m)"));
        let chart = chart(root, MARGIN, &x_axis, &y_axis, false)?;
        let frame = frame(&chart, x, y);
        underlays.push(Underlay {
            bitmap: image(map, scale, &range, span),
            rectangle: frame.map(units),
        });
        outline(root, frame, INK)?;
        let view = View {
            origin: pixel(&chart, 0.0, 0.0),
            scale: plot_width / span.0,
        };
        let origin = Configuration::new(0.0, 0.0, 0.0);
        tile(root, &view, scene.pair.fixed, &origin, FIXED_FILL)?;
        pathways(root, &view, scene, frame)?;
        states(root, &view, scene, frame)?;

        let left = f64::from(WIDTH) - MARGIN[1] + 28.0;
        let bar = [left, MARGIN[0] + 28.0, left + 22.0, 330.0];
        colour_bar(root, underlays, scale, &range, bar)?;
        let mut entries = STATE_KEYS.to_vec();
        entries.push((Key::Mark(Mark::Saddle), "saddle"));
        entries.push((Key::Pathway, "pathway out"));
        entries.push((Key::Blocked, "tiles would overlap"));
        entries.extend(POLE_KEYS);
        let y = keys(root, underlays, (left, 364.0), &entries)?;
        list(root, scene, scale, (left, y + 8.0))
    })
}

fn image(map: &EnergyMap, scale: &EnergyScale, range: &Range, span: (f64, f64)) -> Bitmap {
    let longer = span.0.max(span.1);
    let pixels = |side: f64| (IMAGE * side / longer).round().max(1.0) as usize;
    let interpolated = Interpolated::new(&map.lowest, scale);
    range.bitmap((pixels(span.0), pixels(span.1)), |u, v| {
        let room = interpolated.corners(u, v).map(|(i, w)| w * map.room[i]);
        if room.iter().sum::<f64>() < 0.0 {
            return None;
        }
        interpolated.position(u, v).map(|(position, _)| position)
    })
}

fn pathways(root: &Area, view: &View, scene: &Scene, frame: Box4) -> Result<(), PictureError> {
    for barrier in scene.escapes() {
        let points: Vec<_> = barrier
            .pathway
            .iter()
            .map(|p| view.pixel(p.configuration.position()))
            .collect();
        for piece in points.split(|p| !inside(frame, *p)) {
            seamed_line(root, piece, INK, 1.8)?;
        }
    }
    for barrier in scene.escapes() {
        let saddle = view.pixel(barrier.saddle.position());
        if inside(frame, saddle) {
            marker(root, Mark::Saddle, saddle, 5.0)?;
        }
    }
    Ok(())
}

fn inside([left, top, right, bottom]: Box4, (x, y): Pixel) -> bool {
    x >= left && x <= right && y >= top && y <= bottom
}

/// All states as markers, one a place; each class numbered at its copy nearest to the target.
fn states(root: &Area, view: &View, scene: &Scene, frame: Box4) -> Result<(), PictureError> {
    let mut labels = Labels::new(frame);
    let mut drawn: Vec<Pixel> = Vec::new();
    // Bound states last, on top.
    let mut states: Vec<_> = scene.states.iter().collect();
    states.sort_by_key(|state| state.kind == StateKind::Bound);
    for state in states {
        let at = view.pixel(state.configuration.position());
        let repeated = drawn.iter().any(|p| (p.0 - at.0).hypot(p.1 - at.1) < 1.0);
        if inside(frame, at) && !repeated {
            marker(root, state.kind.into(), at, 6.5)?;
            labels.keep_off(at, 6.5);
            drawn.push(at);
        }
    }
    for class in scene.classes().iter().take(NAMED) {
        let place = class.state.configuration.position();
        let at = view.pixel(place);
        let inwards = Vector2::new(-place.x, place.y).normalize();
        let font = Text::new(SMALL).bold();
        labels.place(root, &class.state.id.to_string(), font, at, inwards)?;
    }
    Ok(())
}

/// The numbers on the map with their energies.
fn list(
    root: &Area,
    scene: &Scene,
    scale: &EnergyScale,
    (left, top): Pixel,
) -> Result<(), PictureError> {
    let classes = scene.classes();
    let columns = [left + 30.0, left + 112.0, left + 124.0];
    let mut y = top;
    let write = |text: &str, x: f64, y: f64, side: HPos, font: Text| {
        font.write(root, text, (x, y), (side, VPos::Center))
    };
    for class in classes.iter().take(NAMED) {
        let number = class.state.id.to_string();
        write(&number, columns[0], y, HPos::Right, Text::new(SMALL).bold())?;
        let energy = scale.label(class.state.energy, 3);
        write(&energy, columns[1], y, HPos::Right, Text::new(SMALL))?;
        if class.copies > 1 {
            let copies = format!("\u{d7}{}", class.copies);
            let font = Text::new(SMALL).colour(SOFT);
            write(&copies, columns[2], y, HPos::Left, font)?;
        }
        y += 19.0;
    }
    if classes.len() > NAMED {
        let more = format!("and {} more", classes.len() - NAMED);
        write(&more, left, y, HPos::Left, Text::new(SMALL).colour(SOFT))?;
    }
    Ok(())
}
