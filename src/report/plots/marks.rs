//! Marks in pictures: states, saddles and tiles.

use nalgebra::{Rotation2, Vector2};
use plotters::style::{RGBColor, WHITE};

use super::axes::Plot;
use super::canvas::{Box4, Canvas, Pixel, around, middle};
use super::style::{Anchor, BLUE, FIXED_FILL, INK, MOVING_FILL, Text, VERMILLION, YELLOW};
use physics::configuration::Configuration;
use physics::landscape::StateKind;
use physics::tile::magnet::Standing;
use physics::tile::{Magnet, Pair, Tile, outline};

/// The pose of the fixed tile.
pub const ORIGIN: Configuration = Configuration::new(0.0, 0.0, 0.0);

/// The meaning of a marker; each has its own shape and colour.
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
pub fn marker(canvas: &mut Canvas, mark: Mark, at: Pixel, radius: f64) {
    match mark {
        Mark::Bond => canvas.outlined(&around(at, 10, &[1.35 * radius, 0.6 * radius]), YELLOW),
        Mark::Trap => canvas.outlined(&around(at, 20, &[0.85 * radius]), WHITE),
        Mark::Free => {
            let (r, grey) = (0.8 * radius, RGBColor(200, 200, 200));
            let corners = [(-r, -r), (r, -r), (r, r), (-r, r)];
            canvas.outlined(&corners.map(|(x, y)| (at.0 + x, at.1 + y)), grey);
        }
        Mark::Saddle => {
            canvas.cross(at, 0.8 * radius, INK, 4.6);
            canvas.cross(at, 0.8 * radius, VERMILLION, 2.6);
        }
    }
}

/// The transform from the fixed tile's frame (m) to pixels.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// The point (m) drawn at `origin`.
    pub centre: Vector2<f64>,
    /// The pixel of `centre`.
    pub origin: Pixel,
    /// Angle (rad) by which the plane is rotated on the picture.
    pub turn: f64,
    /// Pixels per metre.
    pub scale: f64,
}

/// The corners of the smallest rectangle (m) that contains both tiles in the given poses of the
/// moving one.
pub fn extent<'a>(
    pair: &Pair,
    poses: impl IntoIterator<Item = &'a Configuration>,
) -> [Vector2<f64>; 2] {
    let moving = poses.into_iter().map(|q| (&pair.moving, *q));
    let placed = [(&pair.fixed, ORIGIN)].into_iter().chain(moving);
    outline::extent(placed.flat_map(|(tile, q)| {
        let corners = tile.outline.vertices().iter();
        corners.map(move |corner| q.transform(*corner))
    }))
}

impl View {
    /// The plane of a plot whose axes are in metres, as wide as `width` (m).
    pub fn plotted(plot: &Plot, width: f64) -> Self {
        Self {
            centre: Vector2::zeros(),
            origin: plot.at(0.0, 0.0),
            turn: 0.0,
            scale: (plot.frame[2] - plot.frame[0]) / width,
        }
    }

    /// A view in which a rectangle (m) fills a rectangle of the picture.
    pub fn filling([left, top, right, bottom]: Box4, [low, high]: [Vector2<f64>; 2]) -> Self {
        let size = high - low;
        Self {
            centre: (low + high) / 2.0,
            origin: middle([left, top, right, bottom]),
            turn: 0.0,
            scale: ((right - left) / size.x).min((bottom - top) / size.y),
        }
    }

    pub fn pixel(&self, p: Vector2<f64>) -> Pixel {
        let p = Rotation2::new(self.turn) * (p - self.centre) * self.scale;
        (self.origin.0 + p.x, self.origin.1 - p.y)
    }

    /// Draws both tiles, the moving one at `q`.
    pub fn tiles(&self, canvas: &mut Canvas, pair: &Pair, q: &Configuration) {
        self.tile(canvas, &pair.fixed, &ORIGIN, FIXED_FILL);
        self.tile(canvas, &pair.moving, q, MOVING_FILL);
    }

    /// Draws a tile at `q` with its magnets, north poles red and south poles blue.
    pub fn tile(&self, canvas: &mut Canvas, tile: &Tile, q: &Configuration, fill: RGBColor) {
        let corners = tile.outline.vertices().iter();
        let corners: Vec<_> = corners.map(|v| self.pixel(q.transform(*v))).collect();
        canvas.outlined(&corners, fill);
        for magnet in &tile.magnets {
            self.magnet(canvas, magnet, q);
        }
    }

    /// A magnet's block with coloured poles, and their letters if there is room. Blocks too small
    /// to see are enlarged around the same outer pole.
    fn magnet(&self, canvas: &mut Canvas, magnet: &Magnet, q: &Configuration) {
        let axis = Vector2::new(libm::cos(magnet.angle), libm::sin(magnet.angle));
        let across = Vector2::new(-axis.y, axis.x);
        let least = 5.0 / self.scale;
        let [half_length, half_width] = [0, 1].map(|k| magnet.size[k].max(least) / 2.0);
        let corner = |a: f64, b: f64| {
            let local = magnet.position + axis * (a * half_length) + across * (b * half_width);
            self.pixel(q.transform(local))
        };
        if let Some(stands) = magnet.form.stands {
            let (colour, letter) = match stands {
                Standing::Up => (VERMILLION, "U"),
                Standing::Down => (BLUE, "D"),
            };
            let shown = Magnet {
                size: magnet.size.map(|side| side.max(least)),
                ..magnet.clone()
            };
            let rim: Vec<_> = shown
                .outline()
                .iter()
                .map(|p| self.pixel(q.transform(*p)))
                .collect();
            canvas.area(&rim, colour);
            let size = (half_width * self.scale * 1.2).min(14.0);
            if size >= 9.0 {
                let font = Text::of(size).bold().colour(WHITE);
                canvas.write(font, letter, corner(0.0, 0.0), Anchor::Middle);
            }
            return;
        }
        for (pole, colour, letter) in [(1.0, VERMILLION, "N"), (-1.0, BLUE, "S")] {
            let block = [(0.0, -1.0), (pole, -1.0), (pole, 1.0), (0.0, 1.0)];
            canvas.area(&block.map(|(a, b)| corner(a, b)), colour);
            let size = (half_length.min(2.0 * half_width) * self.scale * 0.9).min(14.0);
            if size >= 9.0 {
                let font = Text::of(size).bold().colour(WHITE);
                canvas.write(font, letter, corner(0.5 * pole, 0.0), Anchor::Middle);
            }
        }
    }
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
