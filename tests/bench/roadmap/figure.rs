//! A picture of the roadmap's growth: wall time and memory over milestones.

use std::error::Error;
use std::path::Path;

use plotters::prelude::*;

const WIDTH: u32 = 1000;
const HEIGHT: u32 = 420;
const COLOURS: [RGBColor; 2] = [RGBColor(0, 114, 178), RGBColor(213, 94, 0)];

/// A series: its name and its points (milestones, wall time (s), peak memory (MB)).
type Series = (&'static str, Vec<[f64; 3]>);

/// Draws a table, as `--scale` prints it, to a file of the same name that ends in `.svg`.
pub fn draw(table: &Path) -> Result<(), Box<dyn Error>> {
    let series = read(&std::fs::read_to_string(table)?)?;
    let file = table.with_extension("svg");
    let root = SVGBackend::new(&file, (WIDTH, HEIGHT)).into_drawing_area();
    root.fill(&WHITE)?;
    let panels = root.split_evenly((1, 2));
    panel(&panels[0], "wall time on two cores (s)", &series, 1)?;
    panel(&panels[1], "peak memory (MB)", &series, 2)?;
    root.present()?;
    Ok(())
}

fn read(text: &str) -> Result<[Series; 2], Box<dyn Error>> {
    let mut series = [
        ("default neighbours", Vec::new()),
        ("12 neighbours", Vec::new()),
    ];
    for line in text.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let [kind, milestones, _, a, b, c, _, memory] = cells[..] else {
            return Err(format!("no row of a table: {line}").into());
        };
        let seconds = a.parse::<f64>()? + b.parse::<f64>()? + c.parse::<f64>()?;
        series[usize::from(kind.ends_with("fixed"))].1.push([
            milestones.parse()?,
            seconds,
            memory.parse()?,
        ]);
    }
    Ok(series)
}

fn panel(
    area: &DrawingArea<SVGBackend, plotters::coord::Shift>,
    heading: &str,
    series: &[Series],
    column: usize,
) -> Result<(), Box<dyn Error>> {
    let points = || series.iter().flat_map(|(_, points)| points);
    let range = |k: usize| {
        let values = || points().map(|point| point[k]);
        let low = values().fold(f64::INFINITY, f64::min);
        (low / 1.5..values().fold(0.0, f64::max) * 1.5).log_scale()
    };
    let mut chart = ChartBuilder::on(area)
        .caption(heading, ("sans-serif", 17))
        .margin(16)
        .x_label_area_size(42)
        .y_label_area_size(64)
        .build_cartesian_2d(range(0), range(column))?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .x_desc("milestones")
        .x_label_formatter(&|n| format!("{n:e}"))
        .y_label_formatter(&|value| value.to_string())
        .label_style(("sans-serif", 14))
        .draw()?;
    for ((name, points), colour) in series.iter().zip(COLOURS) {
        let along = || points.iter().map(|point| (point[0], point[column]));
        chart
            .draw_series(LineSeries::new(along(), colour.stroke_width(2)))?
            .label(*name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 20, y)], colour.stroke_width(2)));
        chart.draw_series(along().map(|at| Circle::new(at, 4, colour.filled())))?;
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperLeft)
        .label_font(("sans-serif", 14))
        .draw()?;
    Ok(())
}
