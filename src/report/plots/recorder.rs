//! A plotters backend that records a drawing, from which all its file formats are made.
//!
//! The bitmap backend of plotters needs system fonts for text and has little anti-aliasing.

use std::convert::Infallible;

use plotters::style::text_anchor::{HPos, VPos};
use plotters::style::{FontDesc, FontFamily, FontStyle, RGBAColor, ShapeStyle, TextStyle};
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingBackend, DrawingErrorKind,
    FontTransform,
};
use tiny_skia::{Path, PathBuilder, Transform};

use super::font;
use super::style::{FONT_SCALE, UNITS};

type Outcome<E = Infallible> = Result<(), DrawingErrorKind<E>>;

/// A shape drawn by plotters; all lengths in drawing units.
pub enum Mark {
    Line(Vec<BackendCoord>, ShapeStyle),
    Area(Vec<BackendCoord>, ShapeStyle),
    Circle(BackendCoord, u32, ShapeStyle),
    Words(String, TextStyle<'static>, BackendCoord),
}

impl Mark {
    /// Draws it on another backend.
    pub fn draw<B: DrawingBackend>(&self, backend: &mut B) -> Outcome<B::ErrorType> {
        match self {
            Self::Line(points, style) => backend.draw_path(points.iter().copied(), style),
            Self::Area(corners, style) => backend.fill_polygon(corners.iter().copied(), style),
            Self::Circle(centre, radius, style) => {
                backend.draw_circle(*centre, *radius, style, style.filled)
            }
            Self::Words(text, style, at) => backend.draw_text(text, style, *at),
        }
    }

    /// Its colour, and the width (units) of its line unless it is filled.
    pub fn paint(&self) -> (BackendColor, Option<u32>) {
        match self {
            Self::Line(_, style) | Self::Area(_, style) | Self::Circle(_, _, style) => {
                let width = (!style.filled).then_some(style.stroke_width);
                (style.color(), width)
            }
            Self::Words(_, style, _) => (style.color, None),
        }
    }

    /// Its path, and the transform to its position.
    pub fn path(&self) -> Option<(Path, Transform)> {
        let float = |(x, y): BackendCoord| (x as f32, y as f32);
        let (points, is_closed) = match self {
            Self::Line(points, _) => (points, false),
            Self::Area(corners, _) => (corners, true),
            Self::Circle(centre, radius, _) => {
                let (x, y) = float(*centre);
                let circle = PathBuilder::from_circle(x, y, *radius as f32)?;
                return Some((circle, Transform::identity()));
            }
            Self::Words(text, style, at) => return lettering(text, style, float(*at)),
        };
        let mut builder = PathBuilder::new();
        for (k, (x, y)) in points.iter().copied().map(float).enumerate() {
            match k {
                0 => builder.move_to(x, y),
                _ => builder.line_to(x, y),
            }
        }
        if is_closed {
            builder.close();
        }
        Some((builder.finish()?, Transform::identity()))
    }
}

/// A text at the position of plotters' SVG backend.
fn lettering(text: &str, style: &TextStyle, (x, y): (f32, f32)) -> Option<(Path, Transform)> {
    let bold = is_bold(style);
    let (path, ex) = font::outline(text, bold)?;
    let left = match style.pos.h_pos {
        HPos::Left => 0.0,
        HPos::Center => -0.5 * font::width(text, bold),
        HPos::Right => -font::width(text, bold),
    };
    let foot = match style.pos.v_pos {
        VPos::Top => 0.76,
        VPos::Center => 0.5 * ex,
        VPos::Bottom => -0.5 * ex,
    };
    let size = (style.size() / FONT_SCALE) as f32;
    let turn = match style.font.get_transform() {
        FontTransform::Rotate270 => 270.0,
        _ => 0.0,
    };
    let transform = Transform::from_translate(x, y)
        .pre_concat(Transform::from_rotate(turn))
        .pre_scale(size, size)
        .pre_translate(left as f32, foot as f32);
    Some((path, transform))
}

fn is_bold<S: BackendTextStyle>(style: &S) -> bool {
    matches!(style.style(), FontStyle::Bold)
}

/// Records shapes in drawing order.
pub struct Recorder {
    /// Units.
    pub size: (u32, u32),
    pub shapes: Vec<Mark>,
}

impl Recorder {
    /// Records a shape with this style, unless it is invisible.
    fn keep<S: BackendStyle>(
        &mut self,
        style: &S,
        filled: bool,
        shape: impl FnOnce(ShapeStyle) -> Mark,
    ) -> Outcome {
        let BackendColor { alpha, rgb } = style.color();
        if alpha > 0.0 {
            self.shapes.push(shape(ShapeStyle {
                color: RGBAColor(rgb.0, rgb.1, rgb.2, alpha),
                filled,
                stroke_width: style.stroke_width(),
            }));
        }
        Ok(())
    }
}

fn apart(a: BackendCoord, b: BackendCoord) -> f64 {
    libm::hypot(f64::from(a.0 - b.0), f64::from(a.1 - b.1))
}

impl DrawingBackend for Recorder {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        self.size
    }

    fn ensure_prepared(&mut self) -> Outcome {
        Ok(())
    }

    fn present(&mut self) -> Outcome {
        Ok(())
    }

    fn draw_pixel(&mut self, point: BackendCoord, color: BackendColor) -> Outcome {
        self.draw_rect(point, (point.0 + 1, point.1 + 1), &color, true)
    }

    fn draw_line<S: BackendStyle>(
        &mut self,
        from: BackendCoord,
        to: BackendCoord,
        style: &S,
    ) -> Outcome {
        self.draw_path([from, to], style)
    }

    fn draw_rect<S: BackendStyle>(
        &mut self,
        (left, top): BackendCoord,
        (right, bottom): BackendCoord,
        style: &S,
        fill: bool,
    ) -> Outcome {
        let corners = [(left, top), (right, top), (right, bottom), (left, bottom)];
        match fill {
            true => self.fill_polygon(corners, style),
            false => self.draw_path(corners.into_iter().chain([(left, top)]), style),
        }
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        path: I,
        style: &S,
    ) -> Outcome {
        let mut path: Vec<BackendCoord> = path.into_iter().collect();
        let Some(last) = path.pop() else {
            return Ok(());
        };
        // Points that are indistinguishable only enlarge the file.
        let mut kept: Vec<BackendCoord> = Vec::new();
        for point in path {
            if kept
                .last()
                .is_none_or(|known| apart(*known, point) > 0.5 * UNITS)
            {
                kept.push(point);
            }
        }
        kept.push(last);
        if kept.len() < 2 {
            return Ok(());
        }
        self.keep(style, false, |style| Mark::Line(kept, style))
    }

    fn draw_circle<S: BackendStyle>(
        &mut self,
        center: BackendCoord,
        radius: u32,
        style: &S,
        fill: bool,
    ) -> Outcome {
        self.keep(style, fill, |style| Mark::Circle(center, radius, style))
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        path: I,
        style: &S,
    ) -> Outcome {
        let corners = path.into_iter().collect();
        self.keep(style, true, |style| Mark::Area(corners, style))
    }

    fn draw_text<S: BackendTextStyle>(
        &mut self,
        text: &str,
        style: &S,
        pos: BackendCoord,
    ) -> Outcome {
        let font = FontDesc::new(FontFamily::Name(font::FAMILY), style.size(), style.style());
        let style = TextStyle {
            font: font.transform(style.transform()),
            color: style.color(),
            pos: style.anchor(),
        };
        self.shapes.push(Mark::Words(text.to_owned(), style, pos));
        Ok(())
    }

    fn estimate_text_size<S: BackendTextStyle>(
        &self,
        text: &str,
        style: &S,
    ) -> Result<(u32, u32), DrawingErrorKind<Infallible>> {
        let em = style.size() / FONT_SCALE;
        Ok(((em * font::width(text, is_bold(style))) as u32, em as u32))
    }
}
