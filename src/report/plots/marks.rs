//! Marks on pictures: lines, markers, tiles, labels that keep out of each other's way.

use nalgebra::Vector2;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

use super::picture::{Area, PictureError};
use super::style::{BLUE, INK, SOFT, Text, VERMILLION, YELLOW, line, point};
use crate::configuration::Configuration;
use crate::landscape::StateKind;
use crate::tile::{Magnet, Tile};

/// A point (pixels).
pub type Pixel = (f64, f64);
/// A rectangle (pixels): left, top, right, bottom.
pub type Box4 = [f64; 4];

pub fn polyline(
    root: &Area,
    points: &[Pixel],
    colour: impl Color,
    width: f64,
) -> Result<(), PictureError> {
    let points: Vec<_> = points.iter().map(|p| point(*p)).collect();
    if points.len() > 1 {
        root.draw(&PathElement::new(points, line(colour, width)))?;
    }
    Ok(())
}

/// A line with a white seam that sets it off from any ground.
pub fn seamed_line(
    root: &Area,
    points: &[Pixel],
    colour: impl Color,
    width: f64,
) -> Result<(), PictureError> {
    polyline(root, points, WHITE.mix(0.8), width + 2.4)?;
    polyline(root, points, colour, width)
}

pub fn polygon(
    root: &Area,
    points: &[Pixel],
    fill: impl Color,
    outline: Option<(RGBColor, f64)>,
) -> Result<(), PictureError> {
    let corners: Vec<_> = points.iter().map(|p| point(*p)).collect();
    root.draw(&Polygon::new(corners, fill.filled()))?;
    if let Some((colour, width)) = outline {
        let closed: Vec<_> = points.iter().chain(points.first()).copied().collect();
        polyline(root, &closed, colour, width)?;
    }
    Ok(())
}

/// The outline of a rectangle.
pub fn outline(
    root: &Area,
    [left, top, right, bottom]: Box4,
    colour: RGBColor,
) -> Result<(), PictureError> {
    let corners = [
        (left, top),
        (right, top),
        (right, bottom),
        (left, bottom),
        (left, top),
    ];
    polyline(root, &corners, colour, 1.0)
}

/// What a marker stands for; each has a shape and a colour of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    Bound,
    Misbound,
    Free,
    Saddle,
}

impl From<StateKind> for Mark {
    fn from(kind: StateKind) -> Self {
        match kind {
            StateKind::Bound => Self::Bound,
            StateKind::Misbound => Self::Misbound,
        }
    }
}

/// A marker of this radius (pixels): a star, a disc, a square, a cross.
pub fn marker(root: &Area, mark: Mark, (x, y): Pixel, radius: f64) -> Result<(), PictureError> {
    let corners = |angles: &[f64], radii: &[f64]| -> Vec<Pixel> {
        angles
            .iter()
            .zip(radii.iter().cycle())
            .map(|(a, r)| (x + r * radius * a.sin(), y - r * radius * a.cos()))
            .collect()
    };
    let turn = |n: usize| -> Vec<f64> {
        (0..n)
            .map(|k| k as f64 * std::f64::consts::TAU / n as f64)
            .collect()
    };
    let edge = Some((INK, 1.2));
    match mark {
        Mark::Bound => polygon(root, &corners(&turn(10), &[1.35, 0.6]), YELLOW, edge),
        Mark::Misbound => polygon(root, &corners(&turn(20), &[0.85]), WHITE, edge),
        Mark::Free => {
            let square = [(-0.8, -0.8), (0.8, -0.8), (0.8, 0.8), (-0.8, 0.8)]
                .map(|(a, b)| (x + a * radius, y + b * radius));
            polygon(root, &square, RGBColor(200, 200, 200), edge)
        }
        Mark::Saddle => {
            let r = 0.8 * radius;
            for (colour, width) in [(INK, 4.6), (VERMILLION, 2.6)] {
                polyline(root, &[(x - r, y - r), (x + r, y + r)], colour, width)?;
                polyline(root, &[(x - r, y + r), (x + r, y - r)], colour, width)?;
            }
            Ok(())
        }
    }
}

/// How metres of the fixed tile's frame become pixels.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// Pixel of the origin.
    pub origin: Pixel,
    /// Pixels a metre.
    pub scale: f64,
}

impl View {
    pub fn pixel(&self, p: Vector2<f64>) -> Pixel {
        (
            self.origin.0 + p.x * self.scale,
            self.origin.1 - p.y * self.scale,
        )
    }
}

/// A tile at `q` with its magnets, north poles red and south poles blue.
pub fn tile(
    root: &Area,
    view: &View,
    tile: &Tile,
    q: &Configuration,
    fill: impl Color,
) -> Result<(), PictureError> {
    let corners: Vec<_> = tile
        .outline
        .vertices()
        .iter()
        .map(|v| view.pixel(q.transform(*v)))
        .collect();
    polygon(root, &corners, fill, Some((INK, 1.2)))?;
    tile.magnets
        .iter()
        .try_for_each(|magnet| draw_magnet(root, view, magnet, q))
}

/// A magnet's block, its two poles in colour, with their letters where there is room. Blocks too
/// small to see are drawn larger, about the same outer pole.
fn draw_magnet(
    root: &Area,
    view: &View,
    magnet: &Magnet,
    q: &Configuration,
) -> Result<(), PictureError> {
    let axis = Vector2::new(magnet.angle.cos(), magnet.angle.sin());
    let across = Vector2::new(-axis.y, axis.x);
    let least = 5.0 / view.scale;
    let half_length = magnet.size[0].max(least) / 2.0;
    let half_width = magnet.size[1].max(least) / 2.0;
    let corner = |a: f64, b: f64| {
        let local = magnet.position + axis * (a * half_length) + across * (b * half_width);
        view.pixel(q.transform(local))
    };
    for (pole, colour, letter) in [(1.0, VERMILLION, "N"), (-1.0, BLUE, "S")] {
        let block = [
            corner(0.0, -1.0),
            corner(pole, -1.0),
            corner(pole, 1.0),
            corner(0.0, 1.0),
        ];
        polygon(root, &block, colour, None)?;
        let size = (half_length.min(2.0 * half_width) * view.scale * 0.9).min(14.0);
        if size >= 9.0 {
            Text::new(size).bold().colour(WHITE).write(
                root,
                letter,
                corner(0.5 * pole, 0.0),
                (HPos::Center, VPos::Center),
            )?;
        }
    }
    Ok(())
}

/// Places labels beside what they name so that none covers another or a marker.
pub struct Labels {
    within: Box4,
    taken: Vec<Box4>,
}

impl Labels {
    pub fn new(within: Box4) -> Self {
        Self {
            within,
            taken: Vec::new(),
        }
    }

    /// Keeps labels off a disc.
    pub fn keep_off(&mut self, (x, y): Pixel, radius: f64) {
        self.taken
            .push([x - radius, y - radius, x + radius, y + radius]);
    }

    /// Keeps labels off a line.
    pub fn keep_off_line(&mut self, points: &[Pixel]) {
        for pair in points.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            let steps = ((a.0 - b.0).hypot(a.1 - b.1) / 5.0).ceil().max(1.0);
            for k in 0..=steps as usize {
                let t = k as f64 / steps;
                self.keep_off((a.0 + (b.0 - a.0) * t, a.1 + (b.1 - a.1) * t), 2.0);
            }
        }
    }

    /// Writes `text` near `anchor`, joined to it by a thin line where it is not beside it. Leaves
    /// it out where there is no room near.
    pub fn place(
        &mut self,
        root: &Area,
        text: &str,
        font: Text,
        anchor: Pixel,
        outwards: Vector2<f64>,
    ) -> Result<(), PictureError> {
        // Fonts other than the measured one may be a tenth wider.
        let (width, height) = (1.08 * font.width(text) + 6.0, 1.25 * font.size + 2.0);
        let Some(place) = self.free_place(anchor, width, height, outwards) else {
            return Ok(());
        };
        self.taken.push(place);
        let [left, top, right, bottom] = place;
        let nearest = (anchor.0.clamp(left, right), anchor.1.clamp(top, bottom));
        if (nearest.0 - anchor.0).hypot(nearest.1 - anchor.1) > 14.0 {
            polyline(root, &[anchor, nearest], WHITE.mix(0.7), 2.4)?;
            polyline(root, &[anchor, nearest], SOFT, 1.0)?;
        }
        let ground = [(left, top), (right, top), (right, bottom), (left, bottom)];
        polygon(root, &ground, WHITE.mix(0.82), None)?;
        let middle = ((left + right) / 2.0, (top + bottom) / 2.0);
        font.write(root, text, middle, (HPos::Center, VPos::Center))
    }

    /// The nearest free place, those in the direction `outwards` first.
    fn free_place(
        &self,
        (x, y): Pixel,
        width: f64,
        height: f64,
        outwards: Vector2<f64>,
    ) -> Option<Box4> {
        let directions = 16;
        let mut candidates = Vec::new();
        for ring in 0..7 {
            for k in 0..directions {
                let angle = k as f64 * std::f64::consts::TAU / directions as f64;
                let (dx, dy) = (angle.cos(), angle.sin());
                let away = 1.0 - (dx * outwards.x + dy * outwards.y);
                let reach = 11.0 + 16.0 * ring as f64;
                let centre = (
                    x + dx * (reach + width / 2.0),
                    y + dy * (reach + height / 2.0),
                );
                let place = [
                    centre.0 - width / 2.0,
                    centre.1 - height / 2.0,
                    centre.0 + width / 2.0,
                    centre.1 + height / 2.0,
                ];
                candidates.push((reach + 24.0 * away, place));
            }
        }
        candidates.sort_by(|a, b| a.0.total_cmp(&b.0));
        candidates
            .into_iter()
            .map(|(_, place)| place)
            .find(|place| self.is_free(place))
    }

    fn is_free(&self, [left, top, right, bottom]: &Box4) -> bool {
        let [l, t, r, b] = &self.within;
        let inside = left >= l && top >= t && right <= r && bottom <= b;
        inside
            && self
                .taken
                .iter()
                .all(|[l, t, r, b]| right <= l || r <= left || bottom <= t || b <= top)
    }
}
