//! A plotters backend that draws the same picture twice: as SVG text and as pixels.
//!
//! plotters' own bitmap backend has no text without system fonts and little smoothing; here each
//! drawing call goes to plotters' SVG backend and to a [`Raster`].

use std::io::Error;

use plotters::prelude::SVGBackend;
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingBackend, DrawingErrorKind,
    FontStyle,
};

use super::raster::{PLOTTERS_FONT_SCALE, Raster, text_width};

type Outcome = Result<(), DrawingErrorKind<Error>>;

pub struct Canvas<'a> {
    svg: SVGBackend<'a>,
    raster: &'a mut Raster,
}

impl<'a> Canvas<'a> {
    /// A canvas of `size` drawing units that appends to `svg`.
    pub fn new(svg: &'a mut String, raster: &'a mut Raster, size: (u32, u32)) -> Self {
        Self {
            svg: SVGBackend::with_string(svg, size),
            raster,
        }
    }
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
        self.raster
            .rectangle(point, (point.0 + 1, point.1 + 1), color, None);
        self.svg.draw_pixel(point, color)
    }

    fn draw_line<S: BackendStyle>(
        &mut self,
        from: BackendCoord,
        to: BackendCoord,
        style: &S,
    ) -> Outcome {
        self.raster
            .stroke_polyline(&[from, to], style.color(), style.stroke_width());
        self.svg.draw_line(from, to, style)
    }

    fn draw_rect<S: BackendStyle>(
        &mut self,
        upper_left: BackendCoord,
        bottom_right: BackendCoord,
        style: &S,
        fill: bool,
    ) -> Outcome {
        let stroke = (!fill).then(|| style.stroke_width());
        self.raster
            .rectangle(upper_left, bottom_right, style.color(), stroke);
        self.svg.draw_rect(upper_left, bottom_right, style, fill)
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        path: I,
        style: &S,
    ) -> Outcome {
        let points: Vec<_> = path.into_iter().collect();
        self.raster
            .stroke_polyline(&points, style.color(), style.stroke_width());
        self.svg.draw_path(points, style)
    }

    fn draw_circle<S: BackendStyle>(
        &mut self,
        center: BackendCoord,
        radius: u32,
        style: &S,
        fill: bool,
    ) -> Outcome {
        let stroke = (!fill).then(|| style.stroke_width());
        self.raster.circle(center, radius, style.color(), stroke);
        self.svg.draw_circle(center, radius, style, fill)
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        path: I,
        style: &S,
    ) -> Outcome {
        let points: Vec<_> = path.into_iter().collect();
        self.raster.fill_polygon(&points, style.color());
        self.svg.fill_polygon(points, style)
    }

    fn draw_text<S: BackendTextStyle>(
        &mut self,
        text: &str,
        style: &S,
        pos: BackendCoord,
    ) -> Outcome {
        self.raster.text(text, style, pos);
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
