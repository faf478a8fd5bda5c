//! Pictures of several panels: laid out side by side as the width allows, or each on its own.

use std::sync::Arc;

use plotters::style::text_anchor::{HPos, VPos};

use super::marks::Box4;
use super::picture::{Area, Picture, PictureError, Underlay};
use super::sheet::Sheet;
use super::style::{SMALL, SOFT, TITLE, Text, units};

/// Space above the panels (pixels): with a title, with a note alone, with neither.
const HEADS: [f64; 3] = [50.0, 28.0, 6.0];
/// Space at the sides of a title (pixels).
const SIDE: f64 = 20.0;

/// What tells a panel's height at a width (pixels).
type Height<'a> = Box<dyn Fn(f64) -> f64 + Send + Sync + 'a>;
/// What draws a panel into a rectangle (pixels).
type Drawing<'a> =
    Box<dyn Fn(&Area, &mut Vec<Underlay>, Box4) -> Result<(), PictureError> + Send + Sync + 'a>;

/// A part of a picture that can stand alone.
pub struct Panel<'a> {
    /// What its file is called after the picture's name where it stands alone.
    pub name: String,
    /// Its share of a row's width, as against that of its neighbours.
    pub weight: f64,
    /// The least width (pixels) at which it stands beside another.
    pub least: f64,
    /// Its height at a width (pixels).
    pub height: Height<'a>,
    /// Draws it.
    pub draw: Drawing<'a>,
}

impl<'a> Panel<'a> {
    /// A panel as wide as its neighbours, or alone in its row where it would be narrower than
    /// `least`.
    pub fn new(
        name: impl Into<String>,
        least: f64,
        height: impl Fn(f64) -> f64 + Send + Sync + 'a,
        draw: impl Fn(&Area, &mut Vec<Underlay>, Box4) -> Result<(), PictureError> + Send + Sync + 'a,
    ) -> Self {
        Self {
            name: name.into(),
            weight: 1.0,
            least,
            height: Box::new(height),
            draw: Box::new(draw),
        }
    }

    /// The same with another share of the width.
    pub fn weighing(self, weight: f64) -> Self {
        Self { weight, ..self }
    }
}

/// A picture of panels.
pub struct Composition<'a> {
    /// The stem of its files.
    pub name: String,
    /// What it shows.
    pub title: String,
    /// What it leaves out, if anything.
    pub note: Option<String>,
    /// Width on a screen (pixels).
    pub width: f64,
    /// From left to right, row by row.
    pub panels: Vec<Panel<'a>>,
    /// What explains them all: below them, or below each that stands alone.
    pub key: Option<Panel<'a>>,
}

impl Composition<'_> {
    /// The picture, or those of its panels, by the stems of their files.
    ///
    /// # Errors
    /// See [`PictureError`].
    pub fn draw(&self, sheet: &Sheet) -> Result<Vec<(String, Picture)>, PictureError> {
        if !sheet.separate || self.panels.len() < 2 {
            let all: Vec<&Panel> = self.panels.iter().collect();
            return Ok(vec![(self.name.clone(), self.draw_of(sheet, &all)?)]);
        }
        let alone = |panel| Ok((self.stem(panel), self.draw_of(sheet, &[panel])?));
        self.panels.iter().map(alone).collect()
    }

    fn stem(&self, panel: &Panel) -> String {
        format!("{}-{}", self.name, panel.name)
    }

    fn draw_of(&self, sheet: &Sheet, panels: &[&Panel]) -> Result<Picture, PictureError> {
        let width = sheet.width(self.width);
        let mut top = match (sheet.is_titled(), &self.note) {
            (true, _) => HEADS[0],
            (false, Some(_)) => HEADS[1],
            (false, None) => HEADS[2],
        };
        let mut places: Vec<(&Panel, Box4)> = Vec::new();
        for row in rows(panels, width) {
            let height = |(panel, wide): &(&Panel, f64)| (panel.height)(*wide);
            let tallest = row.iter().map(height).fold(0.0, f64::max);
            let mut left = 0.0;
            for (panel, wide) in row {
                places.push((panel, [left, top, left + wide, top + tallest]));
                left += wide;
            }
            top += tallest;
        }
        if let Some(key) = &self.key {
            let height = (key.height)(width);
            places.push((key, [0.0, top, width, top + height]));
            top += height;
        }
        let size = (width.ceil() as u32, top.ceil() as u32);
        Picture::draw(sheet, &self.title, size, |root, underlays| {
            self.head(root, sheet, width)?;
            places
                .iter()
                .try_for_each(|(panel, place)| (panel.draw)(root, underlays, *place))
        })
    }

    fn head(&self, root: &Area, sheet: &Sheet, width: f64) -> Result<(), PictureError> {
        let font = Text::new(SMALL).colour(SOFT);
        let note = self.note.as_deref().unwrap_or_default();
        if !sheet.is_titled() {
            return font.write(root, note, (SIDE, 8.0), (HPos::Left, VPos::Top));
        }
        let room = width - 2.0 * SIDE - 1.1 * font.width(note);
        let mut large = Text::new(TITLE).bold();
        // Smaller where there is no room; a browser's bold letters may be a sixth wider.
        large.size *= (room / (1.17 * large.width(&self.title)).max(1.0)).min(1.0);
        large.write(root, &self.title, (SIDE, 16.0), (HPos::Left, VPos::Top))?;
        font.write(root, note, (width - SIDE, 22.0), (HPos::Right, VPos::Top))
    }
}

/// Rows of panels with their widths (pixels): as many side by side as have room. A last row that is
/// shorter than the others does not make its panels wider.
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

/// What is said where a picture has room for the `most` lowest of so many kinds of states.
pub fn left_out(kinds: usize, most: usize, how: &str) -> Option<String> {
    match kinds.saturating_sub(most) {
        0 => None,
        1 => Some(format!("1 shallower kind of state {how}")),
        more => Some(format!("{more} shallower kinds of state {how}")),
    }
}

/// Lines of a text that fit a width (pixels).
fn lines(font: Text, text: &str, width: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if 1.08 * font.width(&format!("{line} {word}")) <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// Two panels, one below the other, as one.
pub fn stacked<'a>(upper: Panel<'a>, lower: Panel<'a>) -> Panel<'a> {
    let (first, second) = (upper.height, lower.height);
    let first = Arc::new(first);
    let whole = {
        let first = Arc::clone(&first);
        move |width| first(width) + second(width)
    };
    let (name, least) = (upper.name, upper.least);
    Panel::new(
        name,
        least,
        whole,
        move |root, underlays, [left, top, right, bottom]| {
            let middle = top + first(right - left);
            (upper.draw)(root, underlays, [left, top, right, middle])?;
            (lower.draw)(root, underlays, [left, middle, right, bottom])
        },
    )
}

/// What is said below a picture, in as many lines as it takes.
pub fn remark<'a>(text: String) -> Panel<'a> {
    const FONT: Text = Text::new(SMALL).colour(SOFT);
    const LINE: f64 = 18.0;
    let broken = move |width: f64| lines(FONT, &text, width - 2.0 * SIDE);
    let height = {
        let broken = broken.clone();
        move |width| LINE * broken(width).len() as f64 + 14.0
    };
    Panel::new("", 0.0, height, move |root, _, [left, top, right, _]| {
        for (k, line) in broken(right - left).iter().enumerate() {
            let at = (left + SIDE, top + 4.0 + LINE * k as f64);
            FONT.write(root, line, at, (HPos::Left, VPos::Top))?;
        }
        Ok(())
    })
}

/// The part of a picture within a rectangle (pixels).
pub fn part<'a>(root: &Area<'a>, [left, top, right, bottom]: Box4) -> Area<'a> {
    let corner = (units(left), units(top));
    root.clone()
        .shrink(corner, (units(right) - corner.0, units(bottom) - corner.1))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn panel(least: f64) -> Panel<'static> {
        Panel::new("", least, |width| width, |_, _, _| Ok(()))
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
