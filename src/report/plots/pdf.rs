//! Paths as a PDF of one page, for print.
//!
//! Text is drawn by its outlines, as the pixels are, so that nothing need be embedded and nothing
//! is substituted; the file holds no date, and the same drawing gives the same bytes.

use std::collections::BTreeSet;

use pdf_writer::types::LineJoinStyle;
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref, TextStr};
use plotters_backend::BackendColor;
use tiny_skia::{Path, PathSegment, Point, Transform};

use super::picture::{Bitmap, Underlay};
use super::shapes::Painter;
use crate::packing::deflated;

/// Points of print in a millimetre.
const POINTS_A_MILLIMETRE: f64 = 72.0 / 25.4;
/// The page's objects; images and degrees of transparency come after.
const CATALOG: i32 = 1;
const PAGES: i32 = 2;
const PAGE: i32 = 3;
const CONTENT: i32 = 4;
const INFO: i32 = 5;
const FIRST: i32 = 6;

/// A drawing in the making.
pub struct PdfPage {
    content: Content,
    /// Degrees of opacity in use, in percent.
    opacities: BTreeSet<u32>,
}

impl PdfPage {
    pub fn new() -> Self {
        let mut content = Content::new();
        content.set_line_join(LineJoinStyle::RoundJoin);
        Self {
            content,
            opacities: BTreeSet::new(),
        }
    }

    fn trace(&mut self, path: &Path, transform: Transform) {
        let at = |mut point: Point| {
            transform.map_point(&mut point);
            // Tenths of a unit are a hundredth of a pixel.
            [point.x, point.y].map(|c| (10.0 * c).round() / 10.0)
        };
        let mut last = [0.0; 2];
        for segment in path.segments() {
            let end = match segment {
                PathSegment::MoveTo(p) | PathSegment::LineTo(p) => Some(at(p)),
                PathSegment::QuadTo(_, p) | PathSegment::CubicTo(_, _, p) => Some(at(p)),
                PathSegment::Close => None,
            };
            match (segment, end) {
                (PathSegment::MoveTo(_), Some([x, y])) => self.content.move_to(x, y),
                (PathSegment::LineTo(_), Some([x, y])) => self.content.line_to(x, y),
                (PathSegment::QuadTo(control, _), Some([x, y])) => {
                    let control = at(control);
                    // The same parabola as a cubic.
                    let toward = |from: [f32; 2]| {
                        [0, 1].map(|k| from[k] + 2.0 / 3.0 * (control[k] - from[k]))
                    };
                    let ([a, b], [c, d]) = (toward(last), toward([x, y]));
                    self.content.cubic_to(a, b, c, d, x, y)
                }
                (PathSegment::CubicTo(first, second, _), Some([x, y])) => {
                    let ([a, b], [c, d]) = (at(first), at(second));
                    self.content.cubic_to(a, b, c, d, x, y)
                }
                _ => self.content.close_path(),
            };
            last = end.unwrap_or(last);
        }
    }

    /// Draws in a colour, which may be transparent.
    fn coloured(&mut self, colour: BackendColor, draw: impl FnOnce(&mut Self)) {
        let opacity = (100.0 * colour.alpha).round() as u32;
        if opacity == 0 {
            return;
        }
        let (r, g, b) = colour.rgb;
        let [r, g, b] = [r, g, b].map(|c| f32::from(c) / 255.0);
        if opacity < 100 {
            self.opacities.insert(opacity);
            self.content.save_state();
            self.content
                .set_parameters(Name(opacity_name(opacity).as_bytes()));
        }
        self.content.set_fill_rgb(r, g, b);
        self.content.set_stroke_rgb(r, g, b);
        draw(self);
        if opacity < 100 {
            self.content.restore_state();
        }
    }

    /// The file: the drawing of `size` units over its bitmaps, a unit being so many mm.
    pub fn finish(
        self,
        title: &str,
        underlays: &[Underlay],
        size: (u32, u32),
        millimetres: f64,
    ) -> Vec<u8> {
        let scale = (millimetres * POINTS_A_MILLIMETRE) as f32;
        let [width, height] = [size.0, size.1].map(|side| side as f32 * scale);
        let mut pdf = Pdf::new();
        let reference = Ref::new;
        pdf.catalog(reference(CATALOG)).pages(reference(PAGES));
        pdf.pages(reference(PAGES)).kids([reference(PAGE)]).count(1);
        pdf.document_info(reference(INFO))
            .title(TextStr(title))
            .producer(TextStr(concat!("tilebind ", env!("CARGO_PKG_VERSION"))));
        let image = |k: usize| (reference(FIRST + k as i32), format!("I{k}"));
        let opacity = |k: usize| reference(FIRST + (underlays.len() + k) as i32);

        let mut page = pdf.page(reference(PAGE));
        page.parent(reference(PAGES))
            .media_box(Rect::new(0.0, 0.0, width, height))
            .contents(reference(CONTENT));
        let mut resources = page.resources();
        let mut images = resources.x_objects();
        for k in 0..underlays.len() {
            let (id, name) = image(k);
            images.pair(Name(name.as_bytes()), id);
        }
        images.finish();
        let mut states = resources.ext_g_states();
        for (k, percent) in self.opacities.iter().enumerate() {
            states.pair(Name(opacity_name(*percent).as_bytes()), opacity(k));
        }
        states.finish();
        resources.finish();
        page.finish();

        let mut ground = Content::new();
        // Units with y downwards.
        ground.transform([scale, 0.0, 0.0, -scale, 0.0, height]);
        for (k, underlay) in underlays.iter().enumerate() {
            let [left, top, right, bottom] = underlay.rectangle.map(|c| c as f32);
            ground.save_state();
            ground.transform([right - left, 0.0, 0.0, top - bottom, left, bottom]);
            ground.x_object(Name(image(k).1.as_bytes()));
            ground.restore_state();
            write_image(&mut pdf, image(k).0, &underlay.bitmap);
        }
        for (k, percent) in self.opacities.iter().enumerate() {
            let alpha = *percent as f32 / 100.0;
            pdf.ext_graphics(opacity(k))
                .non_stroking_alpha(alpha)
                .stroking_alpha(alpha);
        }
        let content = [&ground.finish()[..], b"\n", &self.content.finish()[..]].concat();
        pdf.stream(reference(CONTENT), &deflated(&content))
            .filter(Filter::FlateDecode);
        pdf.finish()
    }
}

fn opacity_name(percent: u32) -> String {
    format!("A{percent}")
}

fn write_image(pdf: &mut Pdf, id: Ref, bitmap: &Bitmap) {
    let data = deflated(&bitmap.pixels);
    let mut image = pdf.image_xobject(id, &data);
    image.filter(Filter::FlateDecode);
    image.width(bitmap.width as i32);
    image.height((bitmap.pixels.len() / bitmap.width) as i32);
    let last = bitmap.palette.len() as i32 - 1;
    image
        .color_space()
        .indexed(Name(b"DeviceRGB"), last, &bitmap.palette.concat());
    image.bits_per_component(8);
}

impl Painter for PdfPage {
    fn fill(&mut self, path: &Path, colour: BackendColor, transform: Transform) {
        self.coloured(colour, |page| {
            page.trace(path, transform);
            page.content.fill_nonzero();
        });
    }

    fn stroke(&mut self, path: &Path, colour: BackendColor, width: u32) {
        self.coloured(colour, |page| {
            page.content.set_line_width(width as f32);
            page.trace(path, Transform::identity());
            page.content.stroke();
        });
    }
}
