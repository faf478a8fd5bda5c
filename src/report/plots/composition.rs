//! Pictures of several panels: side by side as the width allows, or each in its own file.

use super::canvas::{Box4, Canvas};
use super::picture::{Picture, PictureError};
use super::sheet::Sheet;
use super::style::{Anchor, SMALL, SOFT, TITLE, Text};

/// Space above the panels (pixels): with a title, with a note alone, with neither.
const HEADS: [f64; 3] = [50.0, 28.0, 6.0];
/// Space at the sides of a title (pixels).
const SIDE: f64 = 20.0;
/// Height of a line of a title (pixels), and how far a title is made smaller to fit into one.
const LINE: f64 = 26.0;
const SMALLEST: f64 = 0.75;

/// A function that draws a panel into a rectangle (pixels).
type Draw<'a> = dyn Fn(&mut Canvas, Box4) + Send + Sync + 'a;

/// A part of a picture that can stand alone.
pub struct Panel<'a> {
    /// The suffix of its file name if it is written alone.
    pub name: String,
    /// Its relative width within a row.
    pub weight: f64,
    /// Smallest width (pixels) at which it is placed beside another.
    pub least: f64,
    /// Its height at a width (pixels).
    pub height: Box<dyn Fn(f64) -> f64 + Send + Sync + 'a>,
    /// Draws it.
    pub draw: Box<Draw<'a>>,
}

impl<'a> Panel<'a> {
    /// A panel as wide as its neighbours, or alone in its row if it would be narrower than `least`.
    pub fn new(
        name: impl Into<String>,
        least: f64,
        height: impl Fn(f64) -> f64 + Send + Sync + 'a,
        draw: impl Fn(&mut Canvas, Box4) + Send + Sync + 'a,
    ) -> Self {
        Self {
            name: name.into(),
            weight: 1.0,
            least,
            height: Box::new(height),
            draw: Box::new(draw),
        }
    }

    /// A panel without neighbours.
    pub fn alone(
        height: impl Fn(f64) -> f64 + Send + Sync + 'a,
        draw: impl Fn(&mut Canvas, Box4) + Send + Sync + 'a,
    ) -> Self {
        Self::new("", 0.0, height, draw)
    }

    /// Sets its relative width.
    pub fn weighing(self, weight: f64) -> Self {
        Self { weight, ..self }
    }
}

/// A picture of panels.
#[derive(Default)]
pub struct Composition<'a> {
    /// The stem of its files.
    pub name: String,
    /// The title.
    pub title: String,
    /// A note on what it omits; may be empty.
    pub note: String,
    /// Width on a screen (pixels).
    pub width: f64,
    /// From left to right, row by row.
    pub panels: Vec<Panel<'a>>,
    /// The keys: below all panels, or below each panel that is written alone.
    pub keys: Vec<Panel<'a>>,
}

impl Composition<'_> {
    /// The picture, or those of its panels, by the stems of their files.
    ///
    /// # Errors
    /// See [`PictureError`].
    pub fn draw(&self, sheet: &Sheet) -> Result<Vec<(String, Picture)>, PictureError> {
        if sheet.separate && self.panels.len() > 1 {
            let stem = |panel: &Panel| format!("{}-{}", self.name, panel.name);
            let alone = |panel| Ok((stem(panel), self.draw_of(sheet, &[panel])?));
            return self.panels.iter().map(alone).collect();
        }
        let pages = self.pages(sheet).into_iter().zip(1..);
        let drawn = pages.map(|(panels, number)| {
            let stem = match number {
                1 => self.name.clone(),
                _ => format!("{}-{number}", self.name),
            };
            Ok((stem, self.draw_of(sheet, &panels)?))
        });
        drawn.collect()
    }

    /// The panels of the picture, or of each of several where one would be too high for a page.
    fn pages(&self, sheet: &Sheet) -> Vec<Vec<&Panel<'_>>> {
        let all: Vec<&Panel> = self.panels.iter().collect();
        let width = sheet.width(self.width);
        let keys: f64 = self.keys.iter().map(|key| (key.height)(width)).sum();
        let room = sheet.tallest() - HEADS[0] - keys;
        let (mut pages, mut used) = (vec![Vec::new()], 0.0);
        for row in rows(&all, width) {
            let high = tallest(&row);
            if used > 0.0 && used + high > room {
                pages.push(Vec::new());
                used = 0.0;
            }
            used += high;
            let page = pages.pop().unwrap_or_default();
            let row = row.into_iter().map(|(panel, _)| panel);
            pages.push(page.into_iter().chain(row).collect());
        }
        pages
    }

    fn draw_of(&self, sheet: &Sheet, panels: &[&Panel]) -> Result<Picture, PictureError> {
        let width = sheet.width(self.width);
        let mut top = match sheet.is_titled() && !self.title.is_empty() {
            true => HEADS[0] + LINE * (self.title_lines(width).len() - 1) as f64,
            false => HEADS[1 + usize::from(self.note.is_empty())],
        };
        let mut places: Vec<(&Panel, Box4)> = Vec::new();
        for row in rows(panels, width) {
            let tallest = tallest(&row);
            let mut left = 0.0;
            for (panel, wide) in row {
                places.push((panel, [left, top, left + wide, top + tallest]));
                left += wide;
            }
            top += tallest;
        }
        for key in &self.keys {
            let height = (key.height)(width);
            places.push((key, [0.0, top, width, top + height]));
            top += height;
        }
        let mut canvas = Canvas::new([width, top].map(f64::ceil));
        self.head(&mut canvas, sheet, width);
        for (panel, place) in places {
            (panel.draw)(&mut canvas, place);
        }
        Picture::new(sheet, &self.title, &canvas)
    }

    /// Room for the title (pixels): a browser's bold letters may be a sixth wider.
    fn title_room(&self, width: f64) -> f64 {
        0.92 * (width - 2.0 * SIDE - 1.1 * SMALL.width(&self.note))
    }

    /// The title, in several lines where it would become too small in one.
    fn title_lines(&self, width: f64) -> Vec<String> {
        let (large, room) = (TITLE.bold(), self.title_room(width));
        match large.room(&self.title) * SMALLEST > room {
            true => large.lines(&self.title, room),
            false => vec![self.title.clone()],
        }
    }

    fn head(&self, canvas: &mut Canvas, sheet: &Sheet, width: f64) {
        let font = SMALL.colour(SOFT);
        if !sheet.is_titled() || self.title.is_empty() {
            let font = font.within(width - 2.0 * SIDE, &self.note);
            return canvas.write(font, &self.note, (SIDE, 8.0), Anchor::TopLeft);
        }
        let room = self.title_room(width);
        for (k, line) in self.title_lines(width).iter().enumerate() {
            let at = (SIDE, 16.0 + LINE * k as f64);
            canvas.write(TITLE.bold().within(room, line), line, at, Anchor::TopLeft);
        }
        canvas.write(font, &self.note, (width - SIDE, 22.0), Anchor::TopRight);
    }
}

/// The height of a row of panels with their widths (pixels).
fn tallest(row: &[(&Panel, f64)]) -> f64 {
    let height = |(panel, wide): &(&Panel, f64)| (panel.height)(*wide);
    row.iter().map(height).fold(0.0, f64::max)
}

/// Rows of panels with their widths (pixels): as many side by side as there is room for. Panels of
/// an incomplete last row are not widened.
fn rows<'a>(panels: &[&'a Panel<'a>], width: f64) -> Vec<Vec<(&'a Panel<'a>, f64)>> {
    let mut rows: Vec<Vec<&Panel>> = Vec::new();
    let mut room = 0.0;
    for panel in panels {
        match rows.last_mut() {
            Some(row) if room >= panel.least => row.push(panel),
            _ => {
                rows.push(vec![panel]);
                room = width;
            }
        }
        room -= panel.least;
    }
    let weight = |row: &Vec<&Panel>| row.iter().map(|panel| panel.weight).sum::<f64>();
    let alone = rows.iter().all(|row| row.len() == 1);
    let most = rows.iter().map(weight).fold(0.0, f64::max);
    let wide = |panel: &'a Panel<'a>| match alone {
        true => (panel, width),
        false => (panel, width * panel.weight / most),
    };
    let widths = |row: Vec<&'a Panel<'a>>| row.into_iter().map(wide).collect();
    rows.into_iter().map(widths).collect()
}

/// The note of a picture that only has room for the `most` lowest kinds of states.
pub fn left_out(kinds: usize, most: usize, how: &str) -> String {
    match kinds.saturating_sub(most) {
        0 => String::new(),
        1 => format!("1 shallower kind of state {how}"),
        more => format!("{more} shallower kinds of state {how}"),
    }
}

/// A remark below a picture, wrapped to lines.
pub fn remark<'a>(text: String) -> Panel<'a> {
    const FONT: Text = SMALL.colour(SOFT);
    const LINE: f64 = 18.0;
    let lines = move |width: f64| FONT.lines(&text, width - 2.0 * SIDE);
    let broken = lines.clone();
    let height = move |width| match broken(width).len() {
        0 => 0.0,
        count => LINE * count as f64 + 14.0,
    };
    Panel::alone(height, move |canvas, [left, top, right, _]| {
        for (k, line) in lines(right - left).iter().enumerate() {
            let at = (left + SIDE, top + 4.0 + LINE * k as f64);
            canvas.write(FONT, line, at, Anchor::TopLeft);
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn panel(least: f64) -> Panel<'static> {
        Panel::new("", least, |width| width, |_, _| {})
    }

    #[test]
    fn panels_stand_side_by_side_where_there_is_room() {
        let panels: Vec<Panel> = (0..5).map(|_| panel(300.0)).collect();
        let panels: Vec<&Panel> = panels.iter().collect();
        let widths = |width| -> Vec<Vec<f64>> {
            let rows = rows(&panels, width);
            let widths = |row: Vec<(&Panel, f64)>| row.into_iter().map(|(_, w)| w).collect();
            rows.into_iter().map(widths).collect()
        };
        assert_eq!(widths(400.0), vec![vec![400.0]; 5]);
        let expected = [vec![350.0; 2], vec![350.0; 2], vec![350.0; 1]];
        assert_eq!(widths(700.0), expected);
    }
}
