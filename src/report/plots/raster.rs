//! Shapes and text as pixels, with smooth edges.

use plotters::style::text_anchor::{HPos, VPos};
use plotters::style::{FontStyle, FontTransform};
use plotters_backend::{BackendColor, BackendTextStyle};
use tiny_skia::{
    Color, FillRule, FilterQuality, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap,
    PixmapPaint, Rect, Stroke, Transform,
};
use ttf_parser::{Face, GlyphId, OutlineBuilder};

/// Text of this size in plotters is set with a font of the size divided by this.
pub const PLOTTERS_FONT_SCALE: f64 = 1.24;

/// A pixmap drawn on in units of a fraction of a pixel.
pub struct Raster {
    pixmap: Pixmap,
    transform: Transform,
    regular: Face<'static>,
    bold: Face<'static>,
}

impl Raster {
    /// A transparent pixmap of `width` by `height` pixels; `None` if either is 0 or the font
    /// cannot be read.
    pub fn new(width: u32, height: u32, units_per_pixel: u32) -> Option<Self> {
        let scale = 1.0 / units_per_pixel as f32;
        Some(Self {
            pixmap: Pixmap::new(width, height)?,
            transform: Transform::from_scale(scale, scale),
            regular: Face::parse(notosans::REGULAR_TTF, 0).ok()?,
            bold: Face::parse(notosans::BOLD_TTF, 0).ok()?,
        })
    }

    pub fn into_pixmap(self) -> Pixmap {
        self.pixmap
    }

    pub fn fill_polygon(&mut self, points: &[(i32, i32)], color: BackendColor) {
        if let Some(path) = polyline(points, true) {
            self.fill(&path, color, self.transform);
        }
    }

    pub fn stroke_polyline(&mut self, points: &[(i32, i32)], color: BackendColor, width: u32) {
        if let Some(path) = polyline(points, false) {
            self.stroke(&path, color, width);
        }
    }

    pub fn rectangle(
        &mut self,
        (x0, y0): (i32, i32),
        (x1, y1): (i32, i32),
        color: BackendColor,
        stroke: Option<u32>,
    ) {
        let corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0)];
        match stroke {
            Some(width) => self.stroke_polyline(&corners, color, width),
            None => self.fill_polygon(&corners, color),
        }
    }

    pub fn circle(
        &mut self,
        (x, y): (i32, i32),
        radius: u32,
        color: BackendColor,
        stroke: Option<u32>,
    ) {
        let Some(path) = PathBuilder::from_circle(x as f32, y as f32, radius as f32) else {
            return;
        };
        match stroke {
            Some(width) => self.stroke(&path, color, width),
            None => self.fill(&path, color, self.transform),
        }
    }

    /// Text about the anchor `pos`, placed as plotters' SVG backend places it.
    pub fn text<S: BackendTextStyle>(&mut self, text: &str, style: &S, pos: (i32, i32)) {
        let bold = matches!(style.style(), FontStyle::Bold);
        let face = if bold { &self.bold } else { &self.regular };
        let em = (style.size() / PLOTTERS_FONT_SCALE) as f32;
        let scale = em / f32::from(face.units_per_em());
        let ex = f32::from(face.x_height().unwrap_or(500)) * scale;
        let width = advance(face, text) * scale;
        let anchor = style.anchor();
        let dx = match anchor.h_pos {
            HPos::Left => 0.0,
            HPos::Center => -width / 2.0,
            HPos::Right => -width,
        };
        let dy = match anchor.v_pos {
            VPos::Top => 0.76 * em,
            VPos::Center => 0.5 * ex,
            VPos::Bottom => -0.5 * ex,
        };
        let turn = match style.transform() {
            FontTransform::Rotate90 => 90.0,
            FontTransform::Rotate180 => 180.0,
            FontTransform::Rotate270 => 270.0,
            _ => 0.0,
        };
        let Some(path) = outline(face, text) else {
            return;
        };
        let transform = self
            .transform
            .pre_translate(pos.0 as f32, pos.1 as f32)
            .pre_concat(Transform::from_rotate(turn))
            .pre_translate(dx, dy)
            .pre_scale(scale, -scale);
        self.fill(&path, style.color(), transform);
    }

    fn fill(&mut self, path: &Path, color: BackendColor, transform: Transform) {
        let paint = paint(color);
        self.pixmap
            .fill_path(path, &paint, FillRule::Winding, transform, None);
    }

    fn stroke(&mut self, path: &Path, color: BackendColor, width: u32) {
        let stroke = Stroke {
            width: width as f32,
            line_join: LineJoin::Round,
            line_cap: LineCap::Butt,
            ..Stroke::default()
        };
        self.pixmap
            .stroke_path(path, &paint(color), &stroke, self.transform, None);
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

/// Width of a text in em.
pub fn text_width(text: &str, bold: bool) -> f64 {
    let data = if bold {
        notosans::BOLD_TTF
    } else {
        notosans::REGULAR_TTF
    };
    Face::parse(data, 0).map_or(0.6 * text.chars().count() as f64, |face| {
        f64::from(advance(&face, text)) / f64::from(face.units_per_em())
    })
}

fn paint(color: BackendColor) -> Paint<'static> {
    let (r, g, b) = color.rgb;
    let mut paint = Paint {
        anti_alias: true,
        ..Paint::default()
    };
    let mut color_and_alpha = Color::from_rgba8(r, g, b, 255);
    color_and_alpha.set_alpha(color.alpha as f32);
    paint.set_color(color_and_alpha);
    paint
}

fn polyline(points: &[(i32, i32)], closed: bool) -> Option<Path> {
    // A horizontal or vertical bar no wider than nothing has no area; anything else goes through.
    let (first, rest) = points.split_first()?;
    if let (true, [a, b, c, _, _]) = (closed, points)
        && a.1 == b.1
        && b.0 == c.0
    {
        let rect = Rect::from_ltrb(
            a.0.min(c.0) as f32,
            a.1.min(c.1) as f32,
            a.0.max(c.0) as f32,
            a.1.max(c.1) as f32,
        )?;
        return Some(PathBuilder::from_rect(rect));
    }
    let mut builder = PathBuilder::new();
    builder.move_to(first.0 as f32, first.1 as f32);
    for point in rest {
        builder.line_to(point.0 as f32, point.1 as f32);
    }
    if closed {
        builder.close();
    }
    builder.finish()
}

fn glyphs<'a>(face: &'a Face, text: &'a str) -> impl Iterator<Item = (GlyphId, f32)> + 'a {
    let mut pen = 0.0;
    text.chars().map(move |c| {
        let glyph = face.glyph_index(c).unwrap_or(GlyphId(0));
        let at = pen;
        pen += f32::from(face.glyph_hor_advance(glyph).unwrap_or(0));
        (glyph, at)
    })
}

/// Width of a text in font units.
fn advance(face: &Face, text: &str) -> f32 {
    text.chars()
        .map(|c| face.glyph_index(c).unwrap_or(GlyphId(0)))
        .map(|glyph| f32::from(face.glyph_hor_advance(glyph).unwrap_or(0)))
        .sum()
}

/// The outline of a text, in font units, y upwards.
fn outline(face: &Face, text: &str) -> Option<Path> {
    let mut pen = Pen {
        builder: PathBuilder::new(),
        x: 0.0,
    };
    for (glyph, at) in glyphs(face, text) {
        pen.x = at;
        face.outline_glyph(glyph, &mut pen);
    }
    pen.builder.finish()
}

struct Pen {
    builder: PathBuilder,
    x: f32,
}

impl OutlineBuilder for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.builder.move_to(self.x + x, y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.builder.line_to(self.x + x, y);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.builder.quad_to(self.x + x1, y1, self.x + x, y);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.builder
            .cubic_to(self.x + x1, y1, self.x + x2, y2, self.x + x, y);
    }

    fn close(&mut self) {
        self.builder.close();
    }
}
