//! A finished picture: the same drawing as SVG and as PNG.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use plotters::coord::Shift;
use plotters::prelude::{DrawingArea, DrawingAreaErrorKind, IntoDrawingArea};
use std::fmt::Write;
use tiny_skia::{Color, Pixmap, PixmapPaint, PremultipliedColorU8, Transform};

use super::canvas::Canvas;
use super::raster::{Raster, draw_stretched};
use super::style::FAMILY;

/// Drawing units per pixel. plotters places everything on whole units; tenths of a pixel keep
/// gentle slopes smooth.
pub const UNITS: u32 = 10;

/// What is drawn on, in [`UNITS`] of a pixel.
pub type Area<'a> = DrawingArea<Canvas<'a>, Shift>;

/// A drawing as SVG and as PNG.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// A whole document.
    pub svg: String,
    /// A whole file.
    pub png: Vec<u8>,
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
        (width, height): (u32, u32),
        drawing: impl FnOnce(&Area, &mut Vec<Underlay>) -> Result<(), PictureError>,
    ) -> Result<Self, PictureError> {
        let mut raster = Raster::new(width, height, UNITS)
            .ok_or_else(|| PictureError::Layout(format!("no {width} x {height} pixels")))?;
        let mut elements = String::new();
        let mut underlays = Vec::new();
        {
            let size = (width * UNITS, height * UNITS);
            let area = Canvas::new(&mut elements, &mut raster, size).into_drawing_area();
            drawing(&area, &mut underlays)?;
            area.present()?;
        }
        Ok(Self {
            svg: svg(&elements, &underlays, width, height)?,
            png: png(&raster.into_pixmap(), &underlays)?,
        })
    }
}

/// The SVG document: plotters' elements with a head of our own (size in pixels, coordinates in
/// units, round joins) and the bitmaps beneath them.
fn svg(
    elements: &str,
    underlays: &[Underlay],
    width: u32,
    height: u32,
) -> Result<String, PictureError> {
    let body = elements.split_once('>').map_or("", |(_, body)| body);
    // What all elements share is said once.
    let body = body
        .replace(" opacity=\"1\"", "")
        .replace(&format!(" font-family=\"{FAMILY}\""), "");
    let mut document = format!(
        "<svg width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {} {}\" \
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

fn png(drawing: &Pixmap, underlays: &[Underlay]) -> Result<Vec<u8>, PictureError> {
    let mut page = drawing.clone();
    page.fill(Color::WHITE);
    for underlay in underlays {
        if let Some(image) = pixmap(&underlay.bitmap) {
            let [left, top, right, bottom] = underlay.rectangle.map(|c| c as f32 / UNITS as f32);
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
    encoder.set_compression(png::Compression::High);
    encoder.write_header()?.write_image_data(&bitmap.pixels)?;
    Ok(bytes)
}
