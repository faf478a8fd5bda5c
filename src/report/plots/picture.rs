//! A finished picture: the same drawing as SVG, as PNG and, for print, as PDF.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use plotters::coord::Shift;
use plotters::prelude::{DrawingArea, DrawingAreaErrorKind, IntoDrawingArea};
use std::fmt::Write;
use tiny_skia::{Color, Pixmap, PixmapPaint, PremultipliedColorU8, Transform};

use super::canvas::Canvas;
use super::pdf::PdfPage;
use super::raster::{Raster, draw_stretched};
use super::shapes::{Lettering, Painter};
use super::sheet::Sheet;
use super::style::FAMILY;

/// Drawing units per pixel. plotters places everything on whole units; tenths of a pixel keep
/// gentle slopes smooth.
pub const UNITS: u32 = 10;

/// What is drawn on, in [`UNITS`] of a pixel.
pub type Area<'a> = DrawingArea<Canvas<'a>, Shift>;

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
    #[error("could not lay out a picture: {0}")]
    Layout(String),
    /// The bitmap could not be encoded.
    #[error("could not write a picture as PNG: {0}")]
    Png(#[from] png::EncodingError),
}

impl<E: std::error::Error + Send + Sync> From<DrawingAreaErrorKind<E>> for PictureError {
    fn from(error: DrawingAreaErrorKind<E>) -> Self {
        Self::Layout(error.to_string())
    }
}

/// An image with a palette, its first row at the top.
#[derive(Clone, Debug)]
pub struct Bitmap {
    pub width: usize,
    pub palette: Vec<[u8; 3]>,
    /// One palette index a pixel.
    pub pixels: Vec<u8>,
}

/// A bitmap and where it lies beneath the drawing (units: left, top, right, bottom).
pub struct Underlay {
    pub bitmap: Bitmap,
    pub rectangle: [i32; 4],
}

impl Picture {
    /// Draws a picture of `width` by `height` pixels on white. `drawing` may leave bitmaps to lie
    /// beneath all else.
    ///
    /// # Errors
    /// Where plotters cannot lay the drawing out or the PNG cannot be encoded.
    pub fn draw(
        sheet: &Sheet,
        title: &str,
        (width, height): (u32, u32),
        drawing: impl FnOnce(&Area, &mut Vec<Underlay>) -> Result<(), PictureError>,
    ) -> Result<Self, PictureError> {
        let unit = f64::from(UNITS);
        // Pixels of the PNG a unit.
        let fine = sheet.dots() / unit;
        let size = (width * UNITS, height * UNITS);
        let pixels = [size.0, size.1].map(|side| (f64::from(side) * fine).round() as u32);
        let none = || PictureError::Layout(format!("no {width} x {height} pixels"));
        let raster = || Raster::new(pixels[0], pixels[1], 1.0 / fine).ok_or_else(none);
        let mut raster = (!sheet.vectors_only).then(raster).transpose()?;
        let lettering = Lettering::new().ok_or_else(|| PictureError::Layout("no font".into()))?;
        let mut pdf = sheet.millimetres().map(|_| PdfPage::new());
        let mut elements = String::new();
        let mut underlays = Vec::new();
        {
            let mut painters: Vec<&mut dyn Painter> = Vec::new();
            painters.extend(raster.as_mut().map(|raster| raster as &mut dyn Painter));
            painters.extend(pdf.as_mut().map(|page| page as &mut dyn Painter));
            let canvas = Canvas::new(&mut elements, painters, lettering, size);
            let area = canvas.into_drawing_area();
            drawing(&area, &mut underlays)?;
            area.present()?;
        }
        let millimetres = sheet.millimetres();
        Ok(Self {
            svg: svg(&elements, &underlays, (width, height), millimetres)?,
            png: raster
                .map(|raster| png(&raster.into_pixmap(), &underlays, fine))
                .transpose()?,
            pdf: pdf.zip(millimetres).map(|(page, millimetres)| {
                page.finish(title, &underlays, size, millimetres / unit)
            }),
        })
    }
}

/// The SVG document: plotters' elements with a head of our own (size in pixels or mm, coordinates in
/// units, round joins) and the bitmaps beneath them.
fn svg(
    elements: &str,
    underlays: &[Underlay],
    (width, height): (u32, u32),
    millimetres: Option<f64>,
) -> Result<String, PictureError> {
    let body = elements.split_once('>').map_or("", |(_, body)| body);
    // What all elements share is said once.
    let body = body
        .replace(" opacity=\"1\"", "")
        .replace(&format!(" font-family=\"{FAMILY}\""), "");
    let [across, down] = [width, height].map(|side| match millimetres {
        Some(pixel) => format!("{:.3}mm", f64::from(side) * pixel),
        None => side.to_string(),
    });
    let mut document = format!(
        "<svg width=\"{across}\" height=\"{down}\" viewBox=\"0 0 {} {}\" \
         stroke-linejoin=\"round\" font-family=\"{FAMILY}\" xmlns=\"http://www.w3.org/2000/svg\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#FFFFFF\"/>",
        width * UNITS,
        height * UNITS,
    );
    for underlay in underlays {
        let [left, top, right, bottom] = underlay.rectangle;
        let data = STANDARD.encode(indexed_png(&underlay.bitmap)?);
        // Writing to a string cannot fail.
        let _ = write!(
            document,
            "\n<image x=\"{left}\" y=\"{top}\" width=\"{}\" height=\"{}\" \
             preserveAspectRatio=\"none\" href=\"data:image/png;base64,{data}\"/>",
            right - left,
            bottom - top,
        );
    }
    document.push_str(&body);
    Ok(document)
}

/// `fine`: pixels a unit.
fn png(drawing: &Pixmap, underlays: &[Underlay], fine: f64) -> Result<Vec<u8>, PictureError> {
    let mut page = drawing.clone();
    page.fill(Color::WHITE);
    for underlay in underlays {
        if let Some(image) = pixmap(&underlay.bitmap) {
            let [left, top, right, bottom] = underlay.rectangle.map(|c| c as f32 * fine as f32);
            draw_stretched(&mut page, &image, [left, top, right - left, bottom - top]);
        }
    }
    let paint = PixmapPaint::default();
    page.draw_pixmap(0, 0, drawing.as_ref(), &paint, Transform::identity(), None);
    let rgb: Vec<u8> = page
        .pixels()
        .iter()
        .flat_map(|p| [p.red(), p.green(), p.blue()])
        .collect();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, page.width(), page.height());
    encoder.set_color(png::ColorType::Rgb);
    // Drawings, of few colours: filters and longer searches take time and make them no smaller.
    encoder.set_filter(png::Filter::NoFilter);
    encoder.set_deflate_compression(png::DeflateCompression::Level(3));
    encoder.write_header()?.write_image_data(&rgb)?;
    Ok(bytes)
}

fn pixmap(bitmap: &Bitmap) -> Option<Pixmap> {
    let height = bitmap.pixels.len() / bitmap.width;
    let mut pixmap = Pixmap::new(bitmap.width as u32, height as u32)?;
    for (pixel, &index) in pixmap.pixels_mut().iter_mut().zip(&bitmap.pixels) {
        let [r, g, b] = bitmap.palette[index as usize];
        *pixel = PremultipliedColorU8::from_rgba(r, g, b, 255)?;
    }
    Some(pixmap)
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
