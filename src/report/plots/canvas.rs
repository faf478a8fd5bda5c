//! A plotters backend that draws the same picture several times: as SVG text, as pixels, as PDF.
//!
//! plotters' own bitmap backend has no text without system fonts and little smoothing; here each
//! drawing call goes to plotters' SVG backend and, as paths, to each [`Painter`].

use std::io::Error;

use plotters::prelude::SVGBackend;
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingBackend, DrawingErrorKind,
    FontStyle,
};
use tiny_skia::{Path, PathBuilder, Transform};

use super::shapes::{Lettering, PLOTTERS_FONT_SCALE, Painter, polyline, text_width};

type Outcome = Result<(), DrawingErrorKind<Error>>;

pub struct Canvas<'a> {
    svg: SVGBackend<'a>,
    painters: Vec<&'a mut dyn Painter>,
    lettering: Lettering,
}

impl<'a> Canvas<'a> {
    /// A canvas of `size` drawing units that appends to `svg`.
    pub fn new(
        svg: &'a mut String,
        painters: Vec<&'a mut dyn Painter>,
        lettering: Lettering,
        size: (u32, u32),
    ) -> Self {
        Self {
            svg: SVGBackend::with_string(svg, size),
            painters,
            lettering,
        }
    }

    fn fill(&mut self, path: Option<Path>, colour: BackendColor) {
        if let Some(path) = path {
            for painter in &mut self.painters {
                painter.fill(&path, colour, Transform::identity());
            }
        }
    }

    /// Along the path, `width` units wide, or all of its inside.
    fn paint(&mut self, path: Option<Path>, colour: BackendColor, width: Option<u32>) {
        match (path, width) {
            (Some(path), Some(width)) => {
                for painter in &mut self.painters {
                    painter.stroke(&path, colour, width);
                }
            }
            (path, _) => self.fill(path, colour),
        }
    }
}

/// The corners of a rectangle, the first one twice.
fn corners((x0, y0): BackendCoord, (x1, y1): BackendCoord) -> [BackendCoord; 5] {
    [(x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0)]
}

impl DrawingBackend for Canvas<'_> {
    type ErrorType = Error;

    fn get_size(&self) -> (u32, u32) {
        self.svg.get_size()
    }

    fn ensure_prepared(&mut self) -> Outcome {
        self.svg.ensure_prepared()
    }

    fn present(&mut self) -> Outcome {
        self.svg.present()
    }

    fn draw_pixel(&mut self, point: BackendCoord, color: BackendColor) -> Outcome {
        let square = corners(point, (point.0 + 1, point.1 + 1));
        self.fill(polyline(&square, true), color);
        self.svg.draw_pixel(point, color)
    }

    fn draw_line<S: BackendStyle>(
        &mut self,
        from: BackendCoord,
        to: BackendCoord,
        style: &S,
    ) -> Outcome {
        let path = polyline(&[from, to], false);
        self.paint(path, style.color(), Some(style.stroke_width()));
        self.svg.draw_line(from, to, style)
    }

    fn draw_rect<S: BackendStyle>(
        &mut self,
        upper_left: BackendCoord,
        bottom_right: BackendCoord,
        style: &S,
        fill: bool,
    ) -> Outcome {
        let path = polyline(&corners(upper_left, bottom_right), fill);
        let width = (!fill).then(|| style.stroke_width());
        self.paint(path, style.color(), width);
        self.svg.draw_rect(upper_left, bottom_right, style, fill)
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        path: I,
        style: &S,
    ) -> Outcome {
        let points: Vec<_> = path.into_iter().collect();
        let path = polyline(&points, false);
        self.paint(path, style.color(), Some(style.stroke_width()));
        self.svg.draw_path(points, style)
    }

    fn draw_circle<S: BackendStyle>(
        &mut self,
        center: BackendCoord,
        radius: u32,
        style: &S,
        fill: bool,
    ) -> Outcome {
        let path = PathBuilder::from_circle(center.0 as f32, center.1 as f32, radius as f32);
        let width = (!fill).then(|| style.stroke_width());
        self.paint(path, style.color(), width);
        self.svg.draw_circle(center, radius, style, fill)
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        path: I,
        style: &S,
    ) -> Outcome {
        let points: Vec<_> = path.into_iter().collect();
        self.fill(polyline(&points, true), style.color());
        self.svg.fill_polygon(points, style)
    }

    fn draw_text<S: BackendTextStyle>(
        &mut self,
        text: &str,
        style: &S,
        pos: BackendCoord,
    ) -> Outcome {
        if let Some((path, transform)) = self.lettering.outline(text, style, pos) {
            for painter in &mut self.painters {
                painter.fill(&path, style.color(), transform);
            }
        }
        self.svg.draw_text(text, style, pos)
    }

    fn estimate_text_size<S: BackendTextStyle>(
        &self,
        text: &str,
        style: &S,
    ) -> Result<(u32, u32), DrawingErrorKind<Error>> {
        let em = style.size() / PLOTTERS_FONT_SCALE;
        let bold = matches!(style.style(), FontStyle::Bold);
        Ok(((em * text_width(text, bold)) as u32, em as u32))
    }
}
