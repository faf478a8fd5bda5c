//! Paths as pixels, with smooth edges.

use plotters_backend::BackendColor;
use tiny_skia::{
    Color, FillRule, FilterQuality, LineCap, LineJoin, Paint, Path, Pixmap, PixmapPaint, Stroke,
    Transform,
};

use super::shapes::Painter;

/// A pixmap drawn on in units of a fraction of a pixel.
pub struct Raster {
    pixmap: Pixmap,
    /// Units to pixels.
    transform: Transform,
}

impl Raster {
    /// A transparent pixmap of `width` by `height` pixels; `None` if either is 0.
    pub fn new(width: u32, height: u32, units_per_pixel: f64) -> Option<Self> {
        let scale = (1.0 / units_per_pixel) as f32;
        Some(Self {
            pixmap: Pixmap::new(width, height)?,
            transform: Transform::from_scale(scale, scale),
        })
    }

    pub fn into_pixmap(self) -> Pixmap {
        self.pixmap
    }
}

impl Painter for Raster {
    fn fill(&mut self, path: &Path, colour: BackendColor, transform: Transform) {
        let transform = self.transform.pre_concat(transform);
        let (paint, rule) = (paint(colour), FillRule::Winding);
        self.pixmap.fill_path(path, &paint, rule, transform, None);
    }

    fn stroke(&mut self, path: &Path, colour: BackendColor, width: u32) {
        let stroke = Stroke {
            width: width as f32,
            line_join: LineJoin::Round,
            line_cap: LineCap::Butt,
            ..Stroke::default()
        };
        self.pixmap
            .stroke_path(path, &paint(colour), &stroke, self.transform, None);
    }
}

/// Draws `image` stretched over a rectangle (pixels: x, y, width, height).
pub fn draw_stretched(onto: &mut Pixmap, image: &Pixmap, rectangle: [f32; 4]) {
    let [x, y, width, height] = rectangle;
    let transform =
        Transform::from_scale(width / image.width() as f32, height / image.height() as f32)
            .post_translate(x, y);
    let paint = PixmapPaint {
        quality: FilterQuality::Bilinear,
        ..PixmapPaint::default()
    };
    onto.draw_pixmap(0, 0, image.as_ref(), &paint, transform, None);
}

fn paint(colour: BackendColor) -> Paint<'static> {
    let (r, g, b) = colour.rgb;
    let mut paint = Paint {
        anti_alias: true,
        ..Paint::default()
    };
    let mut color_and_alpha = Color::from_rgba8(r, g, b, 255);
    color_and_alpha.set_alpha(colour.alpha as f32);
    paint.set_color(color_and_alpha);
    paint
}
