//! The roadmap seen from above: milestones and the motions between neighbours, by what they cost.

use ordered_float::OrderedFloat;
use plotters::style::RGBColor;

use super::axes::{Axis, Plot};
use super::canvas::Canvas;
use super::composition::{Composition, Panel, remark};
use super::decimals::{Decimals, energy};
use super::heat::Range;
use super::key::{STATES, key};
use super::marks::{ORIGIN, View, marker};
use super::picture::PictureError;
use super::scale::{EnergyScale, colour};
use super::style::{FIXED_FILL, INK};
use super::{Figure, Scene, Sheet};
use crate::csv::table;
use nalgebra::Vector2;
use physics::order::Order;
use physics::roadmap::{Edge, Roadmap, RoadmapSettings};

const WIDTH: f64 = 860.0;
/// Space around the plot (pixels): top, right, bottom, left.
const MARGIN: [f64; 4] = [10.0, 24.0, 62.0, 84.0];
/// Milestones and neighbours of each at most: more could not be told apart.
const MOST: [usize; 2] = [300, 6];

/// The first milestones of a roadmap with the motions between the nearest of them.
///
/// # Errors
/// See [`PictureError`].
pub fn draw(
    scene: &Scene,
    settings: &RoadmapSettings,
    sheet: &Sheet,
) -> Result<Figure, PictureError> {
    let first = Roadmap::first(scene.problem, settings, MOST);
    let (points, mut edges) = (&first.milestones, first.edges);
    // The cheapest lie on top.
    edges.order_by_key(|edge| std::cmp::Reverse(OrderedFloat(edge.costs.peak)));
    let peaks = || edges.iter().map(|edge| edge.costs.peak);
    let scale = EnergyScale::holding(peaks().chain(scene.states().iter().map(|it| it.energy)));
    let range = Range::of(&scale, peaks());
    let ends = |edge: &Edge| [edge.from, edge.to].map(|end| points[end as usize].q);
    let [x, y] = scene.problem.space.map_half_size();
    let wide = |width: f64| width - MARGIN[1] - MARGIN[3];
    let height = move |width| MARGIN[0] + wide(width) * y / x + MARGIN[2];
    let panel = Panel::alone(height, |canvas: &mut Canvas, place| {
        let axes = [("x (m)", x), ("y (m)", y)];
        let axes = axes.map(|(name, end)| Axis::even([-end, end], 1.0, 7, name));
        let plot = Plot::new(canvas, place, MARGIN, axes, false);
        let view = View::plotted(&plot, 2.0 * x);
        view.tile(canvas, &scene.pair.fixed, &ORIGIN, FIXED_FILL);
        let seen = |p: &Vector2<f64>| p.x.abs() <= x && p.y.abs() <= y;
        for edge in &edges {
            let line = ends(edge).map(|q| q.position());
            if line.iter().all(seen) {
                let [r, g, b] = colour(scale.position(edge.costs.peak));
                canvas.line(&line.map(|p| view.pixel(p)), RGBColor(r, g, b), 1.2);
            }
        }
        for p in points.iter().map(|it| it.q.position()).filter(seen) {
            let (x, y) = view.pixel(p);
            canvas.block([x - 1.2, y - 1.2, x + 1.2, y + 1.2], INK);
        }
        for state in scene.states() {
            let at = view.pixel(state.configuration.position());
            marker(canvas, state.kind.into(), at, 5.0);
        }
    });
    let said = format!(
        "the first {} of {} milestones, each joined to its {} nearest neighbours where the straight \
         motion is free; colour: highest energy on the way; orientations are not shown",
        points.len(),
        settings.milestones.count,
        settings.neighbours.min(MOST[1])
    );
    let composition = Composition {
        name: "roadmap".to_owned(),
        title: format!("{}: roadmap from above", scene.name),
        width: WIDTH,
        panels: vec![panel],
        keys: vec![range.bar(&scale), key(STATES), remark(said)],
        ..Composition::default()
    };
    let decimals = Decimals::of(scene.pair);
    let rows = edges.iter().map(|edge| {
        let ends = ends(edge).into_iter();
        let ends = ends.flat_map(|q| decimals.pose(q.to_array()));
        ends.chain([energy(edge.costs.peak)]).collect::<Vec<_>>()
    });
    let head = [
        "from_x_m",
        "from_y_m",
        "from_theta_rad",
        "to_x_m",
        "to_y_m",
        "to_theta_rad",
        "peak_J",
    ];
    Figure::new(&composition, sheet, table(head, rows))
}
