//! A finished picture: the same drawing as SVG, as PNG and, for print, as PDF.

use std::fmt::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use plotters::prelude::SVGBackend;
use tiny_skia::{
    Color, FillRule, FilterQuality, LineJoin, Paint, Pixmap, PixmapPaint, PremultipliedColorU8,
    Stroke, Transform,
};

use super::canvas::{Bitmap, Canvas, Spot};
use super::font::FAMILY;
use super::pdf;
use super::recorder::Mark;
use super::sheet::Sheet;
use super::style::UNITS;

/// A drawing as SVG and, if wanted, as PNG and PDF.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// A complete document.
    pub svg: String,
    /// A complete file; `None` without bitmaps.
    pub png: Option<Vec<u8>>,
    /// A complete file; only for print.
    pub pdf: Option<Vec<u8>>,
}

/// Why a picture could not be drawn.
#[derive(Debug, thiserror::Error)]
pub enum PictureError {
    /// The drawing failed.
    #[error("could not lay out a picture: {0}")]
    Layout(String),
    /// The bitmap could not be encoded.
    #[error("could not write a picture as PNG: {0}")]
    Png(#[from] png::EncodingError),
    /// Drawing panicked.
    #[error(
        "could not draw a picture ({0}): this is a bug of tilebind; all other results are \
        complete"
    )]
    Fault(String),
}

impl Picture {
    /// A canvas on white.
    ///
    /// # Errors
    /// If something could not be drawn, there is no such bitmap or it cannot be encoded.
    pub(super) fn new(sheet: &Sheet, title: &str, canvas: &Canvas) -> Result<Self, PictureError> {
        let shapes = &canvas.shapes().map_err(PictureError::Layout)?[..];
        let bitmap = || png(canvas, shapes, sheet.dots() / UNITS);
        let print = |pixel| pdf::page(title, canvas, shapes, pixel / UNITS);
        Ok(Self {
            svg: svg(canvas, shapes, sheet.millimetres())?,
            png: (!sheet.vectors_only).then(bitmap).transpose()?,
            pdf: sheet.millimetres().map(print),
        })
    }
}

/// The output of plotters with a custom header (size in pixels or mm, coordinates in units, round
/// joins), images beneath and tooltip regions above. Writing to a string cannot fail.
fn svg(canvas: &Canvas, shapes: &[Mark], millimetres: Option<f64>) -> Result<String, PictureError> {
    let size = canvas.root.dim_in_pixel();
    let mut elements = String::new();
    let mut backend = SVGBackend::with_string(&mut elements, size);
    for shape in shapes {
        let drawn = shape.draw(&mut backend);
        drawn.map_err(|why| PictureError::Layout(why.to_string()))?;
    }
    drop(backend);
    let body = elements.split_once('>').map_or("", |(_, body)| body);
    // Attributes that all elements share are written once.
    let body = body
        .trim_start()
        .trim_end_matches("</svg>\n")
        .replace(" opacity=\"1\"", "")
        .replace(&format!(" font-family=\"{FAMILY}\""), "");
    let [across, down] = [size.0, size.1].map(|side| match millimetres {
        Some(pixel) => format!("{:.3}mm", f64::from(side) / UNITS * pixel),
        None => (f64::from(side) / UNITS).to_string(),
    });
    let mut document = format!(
        "<svg width=\"{across}\" height=\"{down}\" viewBox=\"0 0 {} {}\" \
         stroke-linejoin=\"round\" font-family=\"{FAMILY}\" xmlns=\"http://www.w3.org/2000/svg\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#FFFFFF\"/>\n",
        size.0, size.1,
    );
    for (bitmap, [left, top, right, bottom]) in &canvas.images {
        let _ = writeln!(
            document,
            "<image x=\"{left}\" y=\"{top}\" width=\"{}\" height=\"{}\" \
             preserveAspectRatio=\"none\" href=\"data:image/png;base64,{}\"/>",
            right - left,
            bottom - top,
            STANDARD.encode(indexed_png(bitmap)?)
        );
    }
    document.push_str(&body);
    for (corners, Spot { title, kind, value }) in &canvas.spots {
        let corners = corners.iter().map(|(x, y)| format!("{x},{y}"));
        let _ = writeln!(
            document,
            "<polygon data-{kind}=\"{value}\" opacity=\"0\" points=\"{}\"><title>{}</title>\
             </polygon>",
            corners.collect::<Vec<_>>().join(" "),
            title.replace('&', "&amp;").replace('<', "&lt;"),
        );
    }
    document.push_str("</svg>\n");
    Ok(document)
}

/// An animated PNG of pictures of one size, played for ever; `delay` is the time (s) of each.
///
/// # Errors
/// If something could not be drawn or encoded.
pub(super) fn animated(
    count: usize,
    delay: f64,
    canvases: impl Iterator<Item = Canvas>,
) -> Result<Vec<u8>, PictureError> {
    let mut bytes = Vec::new();
    let mut canvases = canvases.map(|canvas| {
        let shapes = canvas.shapes().map_err(PictureError::Layout)?;
        pixels(&canvas, &shapes, 1.0 / UNITS)
    });
    let Some(first) = canvases.next() else {
        return Ok(bytes);
    };
    let (size, first) = first?;
    let mut encoder = png::Encoder::new(&mut bytes, size[0], size[1]);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_filter(png::Filter::NoFilter);
    encoder.set_deflate_compression(png::DeflateCompression::Level(3));
    encoder.set_animated(count as u32, 0)?;
    let milliseconds = (1e3 * delay).round().clamp(1.0, f64::from(u16::MAX)) as u16;
    encoder.set_frame_delay(milliseconds, 1000)?;
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&first)?;
    for next in canvases {
        writer.write_image_data(&next?.1)?;
    }
    writer.finish()?;
    Ok(bytes)
}

/// The bitmap with a number of dots per unit, anti-aliased.
fn png(canvas: &Canvas, shapes: &[Mark], dots: f64) -> Result<Vec<u8>, PictureError> {
    let ([width, height], rgb) = pixels(canvas, shapes, dots)?;
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    // For drawings with few colours, filters and longer searches take time and do not reduce the
    // size.
    encoder.set_filter(png::Filter::NoFilter);
    encoder.set_deflate_compression(png::DeflateCompression::Level(3));
    encoder.write_header()?.write_image_data(&rgb)?;
    Ok(bytes)
}

/// Width and height in pixels, and the pixels' red, green and blue.
fn pixels(
    canvas: &Canvas,
    shapes: &[Mark],
    dots: f64,
) -> Result<([u32; 2], Vec<u8>), PictureError> {
    let size = canvas.root.dim_in_pixel();
    let [width, height] = [size.0, size.1].map(|side| (f64::from(side) * dots).round() as u32);
    let none = || PictureError::Layout(format!("no {width} x {height} pixels"));
    let mut page = Pixmap::new(width, height).ok_or_else(none)?;
    page.fill(Color::WHITE);
    let scaled = Transform::from_scale(dots as f32, dots as f32);
    for (bitmap, place) in &canvas.images {
        stretched(&mut page, bitmap, *place, scaled);
    }
    for shape in shapes {
        let Some((path, transform)) = shape.path() else {
            continue;
        };
        let (colour, width) = shape.paint();
        let (r, g, b) = colour.rgb;
        let mut paint = Paint::default();
        paint.set_color_rgba8(r, g, b, (255.0 * colour.alpha).round() as u8);
        let transform = scaled.pre_concat(transform);
        match width {
            Some(width) => {
                let stroke = Stroke {
                    width: width as f32,
                    line_join: LineJoin::Round,
                    ..Stroke::default()
                };
                page.stroke_path(&path, &paint, &stroke, transform, None);
            }
            None => page.fill_path(&path, &paint, FillRule::Winding, transform, None),
        }
    }
    let rgb: Vec<u8> = page
        .pixels()
        .iter()
        .flat_map(|p| [p.red(), p.green(), p.blue()])
        .collect();
    Ok(([width, height], rgb))
}

/// Draws an image stretched over a rectangle.
fn stretched(page: &mut Pixmap, bitmap: &Bitmap, place: [i32; 4], scaled: Transform) {
    let size = [bitmap.width, bitmap.pixels.len() / bitmap.width];
    let Some(mut image) = Pixmap::new(size[0] as u32, size[1] as u32) else {
        return;
    };
    for (pixel, &index) in image.pixels_mut().iter_mut().zip(&bitmap.pixels) {
        let [r, g, b] = bitmap.palette[index as usize];
        *pixel = PremultipliedColorU8::from_rgba(r, g, b, 255).unwrap_or(*pixel);
    }
    let [left, top, right, bottom] = place.map(|c| c as f32);
    let [across, down] = [
        (right - left) / size[0] as f32,
        (bottom - top) / size[1] as f32,
    ];
    let transform = scaled.pre_translate(left, top).pre_scale(across, down);
    let paint = PixmapPaint {
        quality: FilterQuality::Bilinear,
        ..PixmapPaint::default()
    };
    page.draw_pixmap(0, 0, image.as_ref(), &paint, transform, None);
}

fn indexed_png(bitmap: &Bitmap) -> Result<Vec<u8>, png::EncodingError> {
    let height = bitmap.pixels.len() / bitmap.width;
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, bitmap.width as u32, height as u32);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_palette(bitmap.palette.concat());
    encoder.set_compression(png::Compression::Balanced);
    encoder.write_header()?.write_image_data(&bitmap.pixels)?;
    Ok(bytes)
}
