//! A finished picture: the same drawing as SVG, as PNG and, for print, as PDF.

use std::fmt::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use tiny_skia::{
    Color, FillRule, FilterQuality, LineJoin, Paint, Pixmap, PixmapPaint, PremultipliedColorU8,
    Stroke, Transform,
};

use super::canvas::{Bitmap, Box4, Canvas, Pixel, Shape, Spot, Words};
use super::font::FAMILY;
use super::pdf;
use super::sheet::Sheet;
use super::style::Colour;

/// A drawing as SVG and, if wanted, as PNG and PDF.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// A whole document.
    pub svg: String,
    /// A whole file; unless there are to be no bitmaps.
    pub png: Option<Vec<u8>>,
    /// A whole file; for print only.
    pub pdf: Option<Vec<u8>>,
}

/// Why a picture could not be drawn.
#[derive(Debug, thiserror::Error)]
pub enum PictureError {
    /// The drawing failed.
    #[error("could not lay out a picture: no {} x {} pixels", .0[0], .0[1])]
    Layout([u32; 2]),
    /// The bitmap could not be encoded.
    #[error("could not write a picture as PNG: {0}")]
    Png(#[from] png::EncodingError),
}

impl Picture {
    /// A canvas of so many whole pixels, on white.
    ///
    /// # Errors
    /// Where there is no such bitmap or it cannot be encoded.
    pub(super) fn new(
        sheet: &Sheet,
        title: &str,
        size: [f64; 2],
        canvas: &Canvas,
    ) -> Result<Self, PictureError> {
        let bitmap = || png(size, canvas, sheet.dots());
        Ok(Self {
            svg: svg(size, canvas, sheet.millimetres())?,
            png: (!sheet.vectors_only).then(bitmap).transpose()?,
            pdf: sheet
                .millimetres()
                .map(|pixel| pdf::page(title, size, canvas, pixel)),
        })
    }
}

/// Writing to a string cannot fail.
fn svg(size: [f64; 2], canvas: &Canvas, millimetres: Option<f64>) -> Result<String, PictureError> {
    let [across, down] = size.map(|side| match millimetres {
        Some(pixel) => format!("{:.3}mm", side * pixel),
        None => side.to_string(),
    });
    let mut document = format!(
        "<svg width=\"{across}\" height=\"{down}\" viewBox=\"0 0 {} {}\" \
         stroke-linejoin=\"round\" font-family=\"{FAMILY}\" xmlns=\"http://www.w3.org/2000/svg\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#FFFFFF\"/>\n",
        size[0], size[1],
    );
    for shape in &canvas.shapes {
        let _ = match shape {
            Shape::Line(points, colour, width) => writeln!(
                document,
                "<polyline fill=\"none\" {} stroke-width=\"{width}\" points=\"{}\"/>",
                painted("stroke", *colour),
                listed(points),
            ),
            Shape::Area(corners, fill) => writeln!(
                document,
                "<polygon {} points=\"{}\"/>",
                painted("fill", *fill),
                listed(corners)
            ),
            Shape::Words(words) => writeln!(document, "{}", written(words)),
            Shape::Spot(corners, Spot { title, kind, value }) => writeln!(
                document,
                "<polygon data-{kind}=\"{value}\" opacity=\"0\" points=\"{}\"><title>{}</title>\
                 </polygon>",
                listed(corners),
                escaped(title),
            ),
            Shape::Image(bitmap, [left, top, right, bottom]) => writeln!(
                document,
                "<image x=\"{left}\" y=\"{top}\" width=\"{:.1}\" height=\"{:.1}\" \
                 preserveAspectRatio=\"none\" href=\"data:image/png;base64,{}\"/>",
                right - left,
                bottom - top,
                STANDARD.encode(indexed_png(bitmap)?)
            ),
        };
    }
    document.push_str("</svg>\n");
    Ok(document)
}

/// The attributes of a colour.
fn painted(name: &str, Colour { rgb, opacity }: Colour) -> String {
    let [r, g, b] = rgb;
    let opacity = match opacity {
        1.0 => String::new(),
        opacity => format!(" opacity=\"{opacity}\""),
    };
    format!("{name}=\"#{r:02X}{g:02X}{b:02X}\"{opacity}")
}

fn listed(points: &[Pixel]) -> String {
    let points = points.iter().map(|(x, y)| format!("{x},{y}"));
    points.collect::<Vec<_>>().join(" ")
}

fn written(words: &Words) -> String {
    let ((x, y), font) = (words.at, words.font);
    let (across, down) = words.anchor.place();
    format!(
        "<text x=\"{x}\" y=\"{y}\" dy=\"{}\" text-anchor=\"{}\" font-size=\"{:.4}\" {}{}{}>{}</text>",
        ["0.76em", "0.5ex", "-0.5ex"][down],
        ["start", "middle", "end"][across],
        font.size,
        painted("fill", font.colour),
        if font.bold {
            " font-weight=\"bold\""
        } else {
            ""
        },
        match words.upwards {
            true => format!(" transform=\"rotate(270, {x}, {y})\""),
            false => String::new(),
        },
        escaped(&words.text),
    )
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;")
}

/// So many dots a pixel, with smooth edges.
fn png(size: [f64; 2], canvas: &Canvas, dots: f64) -> Result<Vec<u8>, PictureError> {
    let [width, height] = size.map(|side| (side * dots).round() as u32);
    let mut page = Pixmap::new(width, height).ok_or(PictureError::Layout([width, height]))?;
    page.fill(Color::WHITE);
    let scaled = Transform::from_scale(dots as f32, dots as f32);
    for shape in &canvas.shapes {
        let paint = |Colour {
                         rgb: [r, g, b],
                         opacity,
                     }| {
            let mut paint = Paint::default();
            let mut colour = Color::from_rgba8(r, g, b, 255);
            colour.set_alpha(opacity as f32);
            paint.set_color(colour);
            paint
        };
        let fill = match shape {
            Shape::Spot(..) => continue,
            Shape::Image(bitmap, place) => {
                stretched(&mut page, bitmap, *place, scaled);
                continue;
            }
            Shape::Line(_, colour, width) => {
                let stroke = Stroke {
                    width: *width as f32,
                    line_join: LineJoin::Round,
                    ..Stroke::default()
                };
                if let Some((path, _)) = shape.path() {
                    page.stroke_path(&path, &paint(*colour), &stroke, scaled, None);
                }
                continue;
            }
            Shape::Area(_, fill) => *fill,
            Shape::Words(words) => words.font.colour,
        };
        if let Some((path, transform)) = shape.path() {
            let transform = scaled.pre_concat(transform);
            page.fill_path(&path, &paint(fill), FillRule::Winding, transform, None);
        }
    }
    let rgb: Vec<u8> = page
        .pixels()
        .iter()
        .flat_map(|p| [p.red(), p.green(), p.blue()])
        .collect();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    // Drawings, of few colours: filters and longer searches take time and make them no smaller.
    encoder.set_filter(png::Filter::NoFilter);
    encoder.set_deflate_compression(png::DeflateCompression::Level(3));
    encoder.write_header()?.write_image_data(&rgb)?;
    Ok(bytes)
}

/// Draws an image stretched over a rectangle.
fn stretched(page: &mut Pixmap, bitmap: &Bitmap, place: Box4, scaled: Transform) {
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
