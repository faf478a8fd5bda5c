//! Paths of shapes and of lettering, which pixels and PDF are drawn from.

use plotters::style::text_anchor::{HPos, VPos};
use plotters::style::{FontStyle, FontTransform};
use plotters_backend::{BackendColor, BackendTextStyle};
use tiny_skia::{Path, PathBuilder, Rect, Transform};
use ttf_parser::{Face, GlyphId, OutlineBuilder};

/// Text of this size in plotters is set with a font of the size divided by this.
pub const PLOTTERS_FONT_SCALE: f64 = 1.24;

/// What draws paths, given in drawing units with y downwards.
pub trait Painter {
    /// Fills the inside of a path that has been transformed.
    fn fill(&mut self, path: &Path, colour: BackendColor, transform: Transform);

    /// Draws along a path, `width` units wide, with round joins and butt ends.
    fn stroke(&mut self, path: &Path, colour: BackendColor, width: u32);
}

/// A line through points; closed, a polygon.
pub fn polyline(points: &[(i32, i32)], closed: bool) -> Option<Path> {
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

/// The font that is part of the program.
pub struct Lettering {
    regular: Face<'static>,
    bold: Face<'static>,
}

impl Lettering {
    /// `None` if the font cannot be read.
    pub fn new() -> Option<Self> {
        Some(Self {
            regular: Face::parse(notosans::REGULAR_TTF, 0).ok()?,
            bold: Face::parse(notosans::BOLD_TTF, 0).ok()?,
        })
    }

    /// The outline of a text about the anchor `pos`, and what takes it to its place, where plotters'
    /// SVG backend has it.
    pub fn outline<S: BackendTextStyle>(
        &self,
        text: &str,
        style: &S,
        pos: (i32, i32),
    ) -> Option<(Path, Transform)> {
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
        let transform = Transform::from_translate(pos.0 as f32, pos.1 as f32)
            .pre_concat(Transform::from_rotate(turn))
            .pre_translate(dx, dy)
            .pre_scale(scale, -scale);
        Some((outline(face, text)?, transform))
    }
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
