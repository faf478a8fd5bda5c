//! The font embedded in the program.

use std::sync::LazyLock;

use tiny_skia::{Path, PathBuilder, Transform};
use ttf_parser::{Face, GlyphId, OutlineBuilder};

/// Fonts of about the width that labels are laid out for; the last one is the browser's default.
pub const FAMILY: &str = "Noto Sans, Helvetica, Arial, sans-serif";

/// Regular and bold.
static FACES: LazyLock<[Face; 2]> = LazyLock::new(|| {
    [notosans::REGULAR_TTF, notosans::BOLD_TTF]
        .map(|data| Face::parse(data, 0).expect("the font is part of the program"))
});

fn glyph(face: &Face, letter: char) -> (GlyphId, f32) {
    let glyph = face.glyph_index(letter).unwrap_or(GlyphId(0));
    (glyph, face.glyph_hor_advance(glyph).unwrap_or(0).into())
}

/// Width of a text in em.
pub fn width(text: &str, bold: bool) -> f64 {
    let face = &FACES[usize::from(bold)];
    let advance: f32 = text.chars().map(|letter| glyph(face, letter).1).sum();
    f64::from(advance) / f64::from(face.units_per_em())
}

/// The outline of a text in em, x to the right from its start and y down from its baseline, and the
/// height of a small letter.
pub fn outline(text: &str, bold: bool) -> Option<(Path, f64)> {
    let face = &FACES[usize::from(bold)];
    let mut pen = Pen {
        builder: PathBuilder::new(),
        x: 0.0,
    };
    for letter in text.chars() {
        let (glyph, advance) = glyph(face, letter);
        face.outline_glyph(glyph, &mut pen);
        pen.x += advance;
    }
    let em = f32::from(face.units_per_em());
    let ex = f64::from(face.x_height().unwrap_or(500)) / f64::from(em);
    let scale = Transform::from_scale(1.0 / em, -1.0 / em);
    Some((pen.builder.finish()?.transform(scale)?, ex))
}

/// Collects the outlines of letters in font units, y upwards.
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
