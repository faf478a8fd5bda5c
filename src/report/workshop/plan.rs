//! Drawings for the cutter, as DXF and as SVG.
//!
//! Lengths in files are in mm. A layer has one purpose, and the layers come in the order of work:
//! what is inside is cut before the part drops out of its sheet. In DXF lines are closed polylines
//! with arcs by their bulges, and circles. In SVG a user unit is a millimetre, a layer is a group,
//! and arcs are the `A` of paths.

use std::fmt::Write;

use nalgebra::Vector2;

use super::plain;
use crate::dxf::{Dxf, Layer};
use jobs::workshop::{Corner, CutPart, Pocket, extent};

/// What happens along a line. The names are those of layers in DXF and groups in SVG.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Work {
    Engrave,
    CutInside,
    CutOutside,
}

/// All layers in the order of work, with distinct colours: by AutoCAD's index, and in SVG.
const WORK: [(Work, Layer, &str); 3] = [
    (Work::Engrave, ("ENGRAVE", 5), "#0072B2"),
    (Work::CutInside, ("CUT_INSIDE", 1), "#D55E00"),
    (Work::CutOutside, ("CUT_OUTSIDE", 7), "#000000"),
];

/// White space around an SVG drawing (mm).
const MARGIN: f64 = 5.0;

/// A shape, in m.
#[derive(Clone)]
enum Figure {
    Closed(Vec<Corner>),
    Circle(Vector2<f64>, f64),
    Line([Vector2<f64>; 2]),
    /// Text, its middle, height and direction (rad).
    Text(String, Vector2<f64>, f64, f64),
}

impl Figure {
    /// The line of a pocket.
    fn of_pocket(pocket: &Pocket) -> Self {
        match pocket.circle() {
            Some((middle, radius)) => Self::Circle(middle, radius),
            None => Self::Closed(pocket.corners.clone()),
        }
    }
}

/// A drawing for the cutter.
#[derive(Clone, Default)]
pub struct Plan {
    shapes: Vec<(Work, Figure)>,
}

impl Plan {
    /// The lines of a part, with the given text for its number; with pockets and their marks, or
    /// without them: a lid.
    pub fn new(part: &CutPart, number: &str, with_pockets: bool) -> Self {
        let mut plan = Self::default();
        let pockets = part.pockets.iter().filter(|_| with_pockets);
        for pocket in pockets.filter(|pocket| !pocket.is_notch) {
            plan.add(Work::CutInside, Figure::of_pocket(pocket));
        }
        let marks = part.marks.pockets.iter().flatten();
        let marks = marks.filter(|_| with_pockets).chain(&part.marks.tile);
        for mark in marks {
            let text = match number {
                "" => mark.text.replace(" #", "").replace('#', ""),
                _ => mark.text.replacen('#', number, 1).replace('#', ""),
            };
            plan.add(
                Work::Engrave,
                Figure::Text(text, mark.middle, mark.height, mark.turn),
            );
            if let Some([tail, tip]) = mark.arrow {
                let back = (tail - tip) * 0.4;
                let aside = Vector2::new(-back.y, back.x) * 0.6;
                for from in [tail, tip + back + aside, tip + back - aside] {
                    plan.add(Work::Engrave, Figure::Line([from, tip]));
                }
            }
        }
        plan.add(Work::CutOutside, Figure::Closed(part.outline.clone()));
        plan
    }

    /// The outline to engrave or print, and magnets with their letters at full size.
    pub fn check(part: &CutPart) -> Self {
        let mut plan = Self::default();
        plan.add(Work::CutOutside, Figure::Closed(part.outline.clone()));
        for pocket in &part.pockets {
            plan.add(Work::CutInside, Figure::of_pocket(pocket));
            let [low, high] = extent(&pocket.corners);
            let reach = (high[0] - low[0]).min(high[1] - low[1]);
            let (north, pole) = (pocket.north, pocket.pole.letter().to_string());
            if pocket.pole.stands() {
                plan.add(
                    Work::Engrave,
                    Figure::Text(pole, pocket.middle, 0.6 * reach, 0.0),
                );
                continue;
            }
            for (letter, side) in [("N", 0.5), ("S", -0.5)] {
                let height = (0.8 * north.norm()).min(0.6 * reach);
                let at = pocket.middle + north * side;
                plan.add(
                    Work::Engrave,
                    Figure::Text(letter.to_owned(), at, height, 0.0),
                );
            }
        }
        // What is engraved on the tile itself identifies pockets here, too.
        for mark in part.marks.pockets.iter().flatten() {
            plan.add(
                Work::Engrave,
                Figure::Text(mark.text.clone(), mark.middle, mark.height, mark.turn),
            );
        }
        plan
    }

    /// Adds a text.
    pub fn text(&mut self, text: &str, middle: [f64; 2], height: f64) {
        let shape = Figure::Text(text.to_owned(), Vector2::from(middle), height, 0.0);
        self.add(Work::Engrave, shape);
    }

    /// Adds a horizontal bar of a length (m) with its ends marked.
    pub fn bar(&mut self, [x, y]: [f64; 2], length: f64) {
        let end = Vector2::new(0.0, length / 40.0);
        let [left, right] = [Vector2::new(x, y), Vector2::new(x + length, y)];
        for line in [
            [left, right],
            [left - end, left + end],
            [right - end, right + end],
        ] {
            self.add(Work::Engrave, Figure::Line(line));
        }
    }

    fn add(&mut self, work: Work, shape: Figure) {
        self.shapes.push((work, shape));
    }

    /// Appends another drawing.
    pub fn append(&mut self, other: Self) {
        self.shapes.extend(other.shapes);
    }

    /// The drawing, perhaps turned by a quarter turn, with the lower left corner of its extent here
    /// (m).
    pub fn placed(mut self, corner: [f64; 2], turned: bool) -> Self {
        let turn = |p: Vector2<f64>| if turned { Vector2::new(-p.y, p.x) } else { p };
        self.map(
            &turn,
            if turned {
                std::f64::consts::FRAC_PI_2
            } else {
                0.0
            },
        );
        let [low, _] = self.extent();
        let shift = Vector2::from(corner) - Vector2::from(low);
        self.map(&|p| p + shift, 0.0);
        self
    }

    fn map(&mut self, place: &dyn Fn(Vector2<f64>) -> Vector2<f64>, turn: f64) {
        for (_, shape) in &mut self.shapes {
            match shape {
                Figure::Closed(corners) => {
                    for corner in corners {
                        corner.point = place(corner.point);
                    }
                }
                Figure::Line(ends) => *ends = ends.map(place),
                Figure::Circle(middle, _) => *middle = place(*middle),
                Figure::Text(_, middle, _, own) => {
                    *middle = place(*middle);
                    *own += turn;
                }
            }
        }
    }

    /// The extent of its closed lines (m).
    pub fn extent(&self) -> [[f64; 2]; 2] {
        let closed = self.shapes.iter().filter_map(|(_, shape)| match shape {
            Figure::Closed(corners) => Some(extent(corners)),
            _ => None,
        });
        let none = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        closed.fold(none, |[low, high], [a, b]| {
            let both = |k: usize| (low[k].min(a[k]), high[k].max(b[k]));
            let [x, y] = [both(0), both(1)];
            [[x.0, y.0], [x.1, y.1]]
        })
    }

    /// Its shapes, layer by layer.
    fn layered(&self) -> impl Iterator<Item = (usize, impl Iterator<Item = &Figure>)> {
        WORK.iter().enumerate().map(|(k, (work, ..))| {
            let own = self.shapes.iter().filter(move |shape| shape.0 == *work);
            (k, own.map(|shape| &shape.1))
        })
    }

    /// The drawing as DXF.
    pub fn dxf(&self) -> String {
        let mut dxf = Dxf::new(&WORK.map(|(_, layer, _)| layer));
        for (k, shapes) in self.layered() {
            let layer = WORK[k].1.0;
            for shape in shapes {
                match shape {
                    Figure::Closed(corners) => dxf.closed_line(layer, corners),
                    Figure::Circle(middle, radius) => dxf.circle(layer, *middle, *radius),
                    Figure::Line(ends) => dxf.line(layer, *ends),
                    Figure::Text(text, middle, height, turn) => {
                        dxf.text(layer, *middle, (*height, *turn), text);
                    }
                }
            }
        }
        dxf.finish()
    }

    /// The drawing as SVG, seen from above: y upwards becomes downwards. It shows the given
    /// rectangle (m), or itself with a margin.
    pub fn svg(&self, frame: Option<[[f64; 2]; 2]>) -> String {
        let mm = |corners: [[f64; 2]; 2]| corners.map(|corner| corner.map(|x| 1e3 * x));
        let [low, high] = match frame {
            Some(frame) => mm(frame),
            None => {
                let [low, high] = mm(self.extent());
                [low.map(|x| x - MARGIN), high.map(|x| x + MARGIN)]
            }
        };
        let spot = |p: &Vector2<f64>| [1e3 * p.x - low[0], high[1] - 1e3 * p.y].map(number);
        let path = |corners: &[Corner]| {
            let mut d = format!("M{}", spot(&corners[0].point).join(" "));
            let nexts = corners.iter().cycle().skip(1);
            for (k, (corner, next)) in corners.iter().zip(nexts).enumerate() {
                let end = spot(&next.point).join(" ");
                let _ = match corner.arc(next) {
                    // Counter-clockwise remains so on paper, where y points down.
                    Some((radius, large)) => {
                        let (large, sweep) = (u8::from(large), u8::from(corner.bulge < 0.0));
                        let radius = number(1e3 * radius);
                        write!(d, "A{radius} {radius} 0 {large} {sweep} {end}")
                    }
                    None if k + 1 == corners.len() => Ok(()),
                    None => write!(d, "L{end}"),
                };
            }
            d + "Z"
        };
        let [width, height] = [0, 1].map(|k| number(high[k] - low[k]));
        let mut text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}mm\" height=\"{height}mm\" \
             viewBox=\"0 0 {width} {height}\" fill=\"none\" stroke-width=\"0.1\">\n"
        );
        for (k, shapes) in self.layered() {
            let (_, (name, _), colour) = WORK[k];
            let _ = writeln!(text, "<g id=\"{name}\" stroke=\"{colour}\">");
            for shape in shapes {
                let _ = match shape {
                    Figure::Closed(corners) => writeln!(text, "<path d=\"{}\"/>", path(corners)),
                    Figure::Circle(middle, radius) => {
                        let [x, y] = spot(middle);
                        let radius = number(1e3 * radius);
                        writeln!(text, "<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\"/>")
                    }
                    Figure::Line(ends) => {
                        let [from, to] = ends.map(|end| spot(&end).join(" "));
                        writeln!(text, "<path d=\"M{from}L{to}\"/>")
                    }
                    Figure::Text(words, middle, height, turn) => {
                        let [x, y] = spot(middle);
                        let (size, turn) = (plain(*height), number(-turn.to_degrees()));
                        let words = words.replace('&', "&amp;").replace('<', "&lt;");
                        writeln!(
                            text,
                            "<text transform=\"translate({x} {y}) rotate({turn})\" \
                             font-size=\"{size}\" font-family=\"sans-serif\" fill=\"{colour}\" \
                             stroke=\"none\" text-anchor=\"middle\" \
                             dominant-baseline=\"central\">{words}</text>"
                        )
                    }
                };
            }
            text += "</g>\n";
        }
        text + "</svg>\n"
    }
}

/// A number of mm to a nanometre.
fn number(x: f64) -> String {
    let text = format!("{:.6}", x + 0.0);
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" {
        "0".to_owned()
    } else {
        text.to_owned()
    }
}
