//! The room that tiles have to meet on a table of finite size, among other tiles.
//!
//! Points on a well stirred table of area S meet as often as the concentrations `1 / S` say. Tiles
//! have a size: their centres stay away from the rim, and other tiles take room. Two tiles f and m
//! that become the bound pair d among other tiles meet as on a table without both of the area
//!
//! `S' = S_f S_m / (S_d y)`
//!
//! With it detailed balance holds: the constant of the bond is multiplied by `S_d y / (S_f S_m)`.
//! - S_i (m^2) is the area that the rim leaves to body i: `(L - w)(L - h)` on a square of side
//!   `L = sqrt(S)`, where w and h are the body's extents, averaged over all directions.
//! - `y = exp(-(mu_d - mu_f - mu_m) / kT)` is the excess chemical potential of the bound pair over
//!   that of two single tiles in a fluid of hard convex tiles. Scaled particle theory (Reiss, Frisch
//!   and Lebowitz 1959, doi:10.1063/1.1730361; in the plane Boublik 1975,
//!   doi:10.1080/00268977500100211) says for a body of area a and perimeter p among rho tiles per
//!   area, of area A and perimeter P, with `eta = rho A`:
//!   `mu / kT = -ln(1 - eta) + rho P p / (2 pi (1 - eta)) + a q`, where q is the pressure over kT.
//!   The pair's area is that of its two tiles, so the pressure cancels:
//!   `y = exp(rho P (p_f + p_m - p_d) / (2 pi (1 - eta))) / (1 - eta)`.
//!
//! Without other tiles `y = 1`, and on a large table `S' = S`. Pairs in the bond count like two
//! single tiles among the others, so y is somewhat too large once most tiles are bound. The theory
//! is good to a few per cent up to eta of 0.5; tiles that attract each other crowd less evenly.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::Vector2;

use tiles::tile::Pair;

/// Number of directions over a quarter turn.
const DIRECTIONS: usize = 180;

/// A body on a table: its extents along x and y (m) in all directions.
struct Body(Vec<[f64; 2]>);

impl Body {
    fn new(points: &[Vector2<f64>]) -> Self {
        let extents = (0..DIRECTIONS).map(|k| {
            let angle = FRAC_PI_2 * (k as f64 + 0.5) / DIRECTIONS as f64;
            let (sin, cos) = libm::sincos(angle);
            [Vector2::new(cos, sin), Vector2::new(-sin, cos)].map(|along| {
                let heights = points.iter().map(|p| p.dot(&along));
                let ends = heights.fold([f64::INFINITY, f64::NEG_INFINITY], |ends, height| {
                    [ends[0].min(height), ends[1].max(height)]
                });
                ends[1] - ends[0]
            })
        });
        Self(extents.collect())
    }

    /// The mean of a function of both extents.
    fn mean(&self, of: impl Fn([f64; 2]) -> f64) -> f64 {
        self.0.iter().map(|extents| of(*extents)).sum::<f64>() / self.0.len() as f64
    }

    /// The perimeter of its convex hull (m), by Cauchy's formula.
    fn perimeter(&self) -> f64 {
        PI * self.mean(|[w, h]| (w + h) / 2.0)
    }

    /// The area (m^2) for its centre on a square of this side (m).
    fn room(&self, side: f64) -> f64 {
        self.mean(|[w, h]| (side - w).max(0.0) * (side - h).max(0.0))
    }
}

/// The area S' (m^2) in which the tiles of a pair meet on a square table of area `table` (m^2) with
/// `others` other tiles; infinite if the bound pair has no room on it.
pub fn meeting_area(pair: &Pair, table: f64, others: usize) -> f64 {
    let outlines = [&pair.fixed.outline, &pair.moving.outline];
    let placed = outlines[1].vertices().iter();
    let placed = placed.map(|p| pair.bound.transform(*p));
    let bound: Vec<Vector2<f64>> = outlines[0]
        .vertices()
        .iter()
        .copied()
        .chain(placed)
        .collect();
    let single = outlines.map(|outline| Body::new(outline.vertices()));
    let bound = Body::new(&bound);
    let perimeters = single.each_ref().map(Body::perimeter);
    let density = others as f64 / table;
    let mean = |of: [f64; 2]| f64::midpoint(of[0], of[1]);
    let free = 1.0 - density * mean(outlines.map(|outline| outline.area()));
    let less = perimeters[0] + perimeters[1] - bound.perimeter();
    let crowding = libm::exp(density * mean(perimeters) * less / (2.0 * PI * free)) / free;
    let side = table.sqrt();
    single[0].room(side) * single[1].room(side) / (bound.room(side) * crowding)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A polygon of many sides, as a disc.
    fn disc(middle: f64) -> Vec<Vector2<f64>> {
        let corner = |k: usize| {
            let (sin, cos) = libm::sincos(2.0 * PI * k as f64 / 720.0);
            Vector2::new(middle + cos, sin)
        };
        (0..720).map(corner).collect()
    }

    #[test]
    fn the_room_of_a_disc_is_a_smaller_square() {
        let one = Body::new(&disc(0.0));
        assert!((one.room(7.0) - 25.0).abs() < 1e-3);
        assert!((one.perimeter() - 2.0 * PI).abs() < 1e-4);
        assert_eq!(one.room(1.9), 0.0);
        // A needle of length 2: extents 2 |cos| and 2 |sin|, perimeter 4.
        let needle = Body::new(&[Vector2::new(-1.0, 0.0), Vector2::new(1.0, 0.0)]);
        assert!((needle.perimeter() - 4.0).abs() < 1e-4);
        // (L - 2 cos)(L - 2 sin) over a quarter turn: L^2 - 8 L / pi + 4 / pi.
        let expected = 25.0 - 40.0 / PI + 4.0 / PI;
        assert!((needle.room(5.0) - expected).abs() < 1e-4);
    }

    /// Two discs in contact: the exponent has (p_f + p_m - p_d) = 4 pi r - (2 pi r + 4 r).
    #[test]
    fn a_pair_of_discs_in_contact_has_the_hull_of_a_stadium() {
        let points: Vec<_> = disc(-1.0).into_iter().chain(disc(1.0)).collect();
        assert!((Body::new(&points).perimeter() - (2.0 * PI + 4.0)).abs() < 1e-4);
    }
}
