//! The medium of a picture: a screen, or print at a given width and text size.

use super::style::SMALL;

/// Millimetres in a point of print.
const POINT: f64 = 25.4 / 72.0;
/// Dots per millimetre of print: 600 per inch.
const DOTS_A_MILLIMETRE: f64 = 600.0 / 25.4;
/// The greatest height (mm) on a page of A4.
const TALLEST: f64 = 240.0;
/// Narrower layouts (pixels) have no room for axes and labels.
const NARROWEST: f64 = 360.0;
/// Wider ones only waste paper (pixels).
const WIDEST: f64 = 2400.0;

/// The layout of pictures.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sheet {
    /// Width of the layout (pixels); `None` for each picture's own width.
    width: Option<f64>,
    /// Millimetres per pixel of the layout; `None` for a screen.
    pixel: Option<f64>,
    /// Whether each panel is a separate picture.
    pub(super) separate: bool,
    /// Whether bitmaps are omitted.
    pub(super) vectors_only: bool,
}

impl Sheet {
    /// Each picture at its own width in pixels, with its title.
    pub const SCREEN: Self = Self {
        width: None,
        pixel: None,
        separate: false,
        vectors_only: false,
    };

    /// The same for a phone's screen, without bitmaps.
    pub const PHONE: Self = Self {
        width: Some(NARROWEST),
        vectors_only: true,
        ..Self::SCREEN
    };

    /// Pictures as on a screen, also as PDF with the given size of a pixel in mm.
    pub const fn of_pixels(millimetres: f64) -> Self {
        Self {
            pixel: Some(millimetres),
            ..Self::SCREEN
        }
    }

    /// Pictures `width` mm wide with text of `font` points, without titles (figures have captions),
    /// also as PDF.
    ///
    /// # Errors
    /// The smallest and the largest width (mm) for text of this size, if the width is outside.
    pub fn for_print(width: f64, font: f64) -> Result<Self, [f64; 2]> {
        let pixel = font * POINT / SMALL.size;
        let limits = [NARROWEST * pixel, WIDEST * pixel];
        if !(limits[0]..=limits[1]).contains(&width) {
            return Err(limits);
        }
        // Whole pixels: the width is exact, the text size changes by at most a thousandth.
        let pixels = (width / pixel).round();
        Ok(Self {
            width: Some(pixels),
            pixel: Some(width / pixels),
            ..Self::SCREEN
        })
    }

    /// The same with each panel as a separate picture.
    #[must_use]
    pub fn with_panels_apart(self) -> Self {
        Self {
            separate: true,
            ..self
        }
    }

    /// The same without bitmaps.
    #[must_use]
    pub fn without_bitmaps(self) -> Self {
        Self {
            vectors_only: true,
            ..self
        }
    }

    /// The width of a picture (pixels) that has `width` on a screen.
    pub(super) fn width(&self, width: f64) -> f64 {
        self.width.unwrap_or(width)
    }

    /// Whether titles are drawn.
    pub(crate) fn is_titled(&self) -> bool {
        self.width.is_none() || self.pixel.is_none()
    }

    /// Millimetres per pixel of the layout; `None` on a screen.
    pub(super) fn millimetres(&self) -> Option<f64> {
        self.pixel
    }

    /// The greatest height (pixels) that a page has room for; a screen scrolls.
    pub(super) fn tallest(&self) -> f64 {
        self.pixel.map_or(f64::INFINITY, |pixel| TALLEST / pixel)
    }

    /// Dots of the bitmap per pixel of the layout.
    pub(super) fn dots(&self) -> f64 {
        self.pixel.map_or(1.0, |pixel| pixel * DOTS_A_MILLIMETRE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_as_high_as_it_was_asked_for() {
        let sheet = Sheet::for_print(85.0, 7.0).unwrap();
        let pixel = sheet.millimetres().unwrap();
        assert!((SMALL.size * pixel / POINT - 7.0).abs() < 0.01);
        assert!((sheet.width(1000.0) * pixel - 85.0).abs() < 1e-9);
        assert_eq!(Sheet::SCREEN.width(1000.0), 1000.0);
        let page = Sheet::of_pixels(0.18);
        assert!(page.width(1000.0) == 1000.0 && page.is_titled());
    }

    #[test]
    fn a_width_without_room_is_refused_with_the_least_that_has() {
        let [least, _] = Sheet::for_print(20.0, 8.0).unwrap_err();
        assert!(Sheet::for_print(least, 8.0).is_ok());
        assert!(Sheet::for_print(0.999 * least, 8.0).is_err());
        assert!(Sheet::for_print(f64::NAN, 8.0).is_err());
    }
}
