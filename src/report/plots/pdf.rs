//! A drawing as a PDF of one page, for print.
//!
//! Text is drawn by its outlines, as in bitmaps, so that no font needs to be embedded or is
//! substituted. The file contains no date, and the same drawing gives the same bytes.

use std::collections::BTreeSet;

use pdf_writer::types::LineJoinStyle;
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref, TextStr};
use tiny_skia::{Path, PathSegment, Point, Transform};

use super::canvas::{Bitmap, Canvas};
use super::recorder::Mark;
use crate::packing::deflated;

/// Points per millimetre.
const POINTS_A_MILLIMETRE: f64 = 72.0 / 25.4;
/// The page's objects; images and degrees of transparency come after.
const CATALOG: i32 = 1;
const PAGES: i32 = 2;
const PAGE: i32 = 3;
const CONTENT: i32 = 4;
const INFO: i32 = 5;
const FIRST: i32 = 6;

/// The file of a canvas, with the size of a unit in mm.
pub fn page(title: &str, canvas: &Canvas, shapes: &[Mark], millimetres: f64) -> Vec<u8> {
    let scale = (millimetres * POINTS_A_MILLIMETRE) as f32;
    let size = canvas.root.dim_in_pixel();
    let [width, height] = [size.0, size.1].map(|side| side as f32 * scale);
    let mut content = Content::new();
    // Units with y downwards.
    content.transform([scale, 0.0, 0.0, -scale, 0.0, height]);
    content.set_line_join(LineJoinStyle::RoundJoin);
    let (images, mut opacities) = (&canvas.images, BTreeSet::new());
    for (k, (_, place)) in images.iter().enumerate() {
        let [left, top, right, bottom] = place.map(|c| c as f32);
        content.save_state();
        content.transform([right - left, 0.0, 0.0, top - bottom, left, bottom]);
        content.x_object(Name(image_name(k).as_bytes()));
        content.restore_state();
    }
    for shape in shapes {
        paint(&mut content, &mut opacities, shape);
    }

    let mut pdf = Pdf::new();
    let reference = Ref::new;
    pdf.catalog(reference(CATALOG)).pages(reference(PAGES));
    pdf.pages(reference(PAGES)).kids([reference(PAGE)]).count(1);
    pdf.document_info(reference(INFO))
        .title(TextStr(title))
        .producer(TextStr(concat!("tilebind ", env!("CARGO_PKG_VERSION"))));
    let image = |k: usize| reference(FIRST + k as i32);
    let opacity = |k: usize| reference(FIRST + (images.len() + k) as i32);
    let mut page = pdf.page(reference(PAGE));
    page.parent(reference(PAGES))
        .media_box(Rect::new(0.0, 0.0, width, height))
        .contents(reference(CONTENT));
    let mut resources = page.resources();
    let mut named = resources.x_objects();
    for k in 0..images.len() {
        named.pair(Name(image_name(k).as_bytes()), image(k));
    }
    named.finish();
    let mut states = resources.ext_g_states();
    for (k, percent) in opacities.iter().enumerate() {
        states.pair(Name(opacity_name(*percent).as_bytes()), opacity(k));
    }
    states.finish();
    resources.finish();
    page.finish();
    for (k, (bitmap, _)) in images.iter().enumerate() {
        write_image(&mut pdf, image(k), bitmap);
    }
    for (k, percent) in opacities.iter().enumerate() {
        let alpha = *percent as f32 / 100.0;
        pdf.ext_graphics(opacity(k))
            .non_stroking_alpha(alpha)
            .stroking_alpha(alpha);
    }
    pdf.stream(reference(CONTENT), &deflated(&content.finish()))
        .filter(Filter::FlateDecode);
    pdf.finish()
}

/// Draws a shape; `opacities` are the degrees in use, in percent.
fn paint(content: &mut Content, opacities: &mut BTreeSet<u32>, shape: &Mark) {
    let (colour, width) = shape.paint();
    let opacity = (100.0 * colour.alpha).round() as u32;
    let Some((path, transform)) = shape.path().filter(|_| opacity > 0) else {
        return;
    };
    let (r, g, b) = colour.rgb;
    let [r, g, b] = [r, g, b].map(|c| f32::from(c) / 255.0);
    if opacity < 100 {
        opacities.insert(opacity);
        content.save_state();
        content.set_parameters(Name(opacity_name(opacity).as_bytes()));
    }
    content.set_fill_rgb(r, g, b);
    content.set_stroke_rgb(r, g, b);
    if let Some(width) = width {
        content.set_line_width(width as f32);
    }
    trace(content, &path, transform);
    match width {
        Some(_) => content.stroke(),
        None => content.fill_nonzero(),
    };
    if opacity < 100 {
        content.restore_state();
    }
}

fn trace(content: &mut Content, path: &Path, transform: Transform) {
    let at = |mut point: Point| {
        transform.map_point(&mut point);
        // A tenth of a unit is a hundredth of a pixel.
        [point.x, point.y].map(|c| (10.0 * c).round() / 10.0)
    };
    let mut last = [0.0; 2];
    for segment in path.segments() {
        let end = match segment {
            PathSegment::MoveTo(p) | PathSegment::LineTo(p) => at(p),
            PathSegment::QuadTo(_, p) | PathSegment::CubicTo(_, _, p) => at(p),
            PathSegment::Close => last,
        };
        let [x, y] = end;
        match segment {
            PathSegment::MoveTo(_) => content.move_to(x, y),
            PathSegment::LineTo(_) => content.line_to(x, y),
            PathSegment::QuadTo(control, _) => {
                let control = at(control);
                // The same parabola as a cubic.
                let toward =
                    |from: [f32; 2]| [0, 1].map(|k| from[k] + 2.0 / 3.0 * (control[k] - from[k]));
                let ([a, b], [c, d]) = (toward(last), toward(end));
                content.cubic_to(a, b, c, d, x, y)
            }
            PathSegment::CubicTo(first, second, _) => {
                let ([a, b], [c, d]) = (at(first), at(second));
                content.cubic_to(a, b, c, d, x, y)
            }
            PathSegment::Close => content.close_path(),
        };
        last = end;
    }
}

fn image_name(number: usize) -> String {
    format!("I{number}")
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
