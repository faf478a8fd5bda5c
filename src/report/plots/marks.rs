//! Marks on pictures: lines, markers, tiles, labels that keep out of each other's way.

use nalgebra::{Rotation2, Vector2};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

use super::picture::{Area, PictureError};
use super::style::{BLUE, INK, Text, VERMILLION, YELLOW, line, point};
use physics::configuration::Configuration;
use physics::landscape::StateKind;
use physics::tile::{Magnet, Tile};

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
    let Some((last, rest)) = points.split_last() else {
        return Ok(());
    };
    // Points too close together to be seen apart only make the file longer.
    let mut kept: Vec<Pixel> = Vec::with_capacity(points.len());
    for p in rest {
        if kept
            .last()
            .is_none_or(|k| libm::hypot(k.0 - p.0, k.1 - p.1) > 0.5)
        {
            kept.push(*p);
        }
    }
    kept.push(*last);
    if kept.len() > 1 {
        let points: Vec<_> = kept.into_iter().map(point).collect();
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
    Bond,
    Trap,
    Free,
    Saddle,
}

impl From<StateKind> for Mark {
    fn from(kind: StateKind) -> Self {
        match kind {
            StateKind::Bond => Self::Bond,
            StateKind::Trap => Self::Trap,
        }
    }
}

/// A marker of this radius (pixels): a star, a disc, a square, a cross.
pub fn marker(root: &Area, mark: Mark, (x, y): Pixel, radius: f64) -> Result<(), PictureError> {
    let corners = |angles: &[f64], radii: &[f64]| -> Vec<Pixel> {
        angles
            .iter()
            .zip(radii.iter().cycle())
            .map(|(a, r)| {
                (
                    x + r * radius * libm::sin(*a),
                    y - r * radius * libm::cos(*a),
                )
            })
            .collect()
    };
    let turn = |n: usize| -> Vec<f64> {
        (0..n)
            .map(|k| k as f64 * std::f64::consts::TAU / n as f64)
            .collect()
    };
    let edge = Some((INK, 1.2));
    match mark {
        Mark::Bond => polygon(root, &corners(&turn(10), &[1.35, 0.6]), YELLOW, edge),
        Mark::Trap => polygon(root, &corners(&turn(20), &[0.85]), WHITE, edge),
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
    /// The point (m) that is drawn at `origin`.
    pub centre: Vector2<f64>,
    /// The pixel of `centre`.
    pub origin: Pixel,
    /// Angle (rad) by which the plane is turned on the picture.
    pub turn: f64,
    /// Pixels a metre.
    pub scale: f64,
}

impl View {
    pub fn pixel(&self, p: Vector2<f64>) -> Pixel {
        let p = Rotation2::new(self.turn) * (p - self.centre) * self.scale;
        (self.origin.0 + p.x, self.origin.1 - p.y)
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
    let axis = Vector2::new(libm::cos(magnet.angle), libm::sin(magnet.angle));
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

/// The pieces of a curve above the height `floor` (pixels grow downwards).
pub fn above(curve: &[Pixel], floor: f64) -> Vec<Vec<Pixel>> {
    let mut pieces = Vec::new();
    let mut piece: Vec<Pixel> = Vec::new();
    for pair in curve.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let crossing = || {
            let t = (floor - a.1) / (b.1 - a.1);
            (a.0 + (b.0 - a.0) * t, floor)
        };
        if piece.is_empty() && a.1 <= floor {
            piece.push(a);
        }
        match (a.1 <= floor, b.1 <= floor) {
            (true, true) => piece.push(b),
            (true, false) => {
                piece.push(crossing());
                pieces.push(std::mem::take(&mut piece));
            }
            (false, true) => piece = vec![crossing(), b],
            (false, false) => {}
        }
    }
    if !piece.is_empty() {
        pieces.push(piece);
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::above;

    #[test]
    fn a_curve_is_cut_where_it_dips_below_the_floor() {
        let curve = [(0.0, 0.0), (1.0, 8.0), (2.0, 12.0), (3.0, 8.0), (4.0, 12.0)];
        let first = vec![(0.0, 0.0), (1.0, 8.0), (1.5, 10.0)];
        let second = vec![(2.5, 10.0), (3.0, 8.0), (3.5, 10.0)];
        assert_eq!(above(&curve, 10.0), [first, second]);
    }

    #[test]
    fn a_curve_above_the_floor_stays_whole() {
        let curve = [(0.0, 0.0), (1.0, 8.0), (2.0, 3.0)];
        assert_eq!(above(&curve, 10.0), [curve.to_vec()]);
    }
}
