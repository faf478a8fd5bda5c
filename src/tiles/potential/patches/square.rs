//! A square of the plane, and the sources near it.

use std::fmt::Debug;

use nalgebra::Vector2;

/// Largest number of sources near a square: as many as the widest vectors hold.
pub const NEAR: usize = 8;

/// Polynomials are made for a square wider by this factor: near the rim of its square, a
/// polynomial's second derivative amplifies the rounding of the values by `n^4 / 3`, but here only
/// by about `5 n^2`.
const WIDER: f64 = 1.125;

/// What makes a field.
pub trait Source: Clone + Debug {
    /// What is kept of the field in a square, empty until it is used.
    type Kept: Clone + Debug + Default;

    /// How far it reaches from the reference point (m).
    fn reach(&self) -> f64;

    /// A lower bound of its distance from a square with a centre and half a side (m).
    fn distance(&self, centre: Vector2<f64>, half: f64) -> f64;
}

/// Which sources count as near a square.
#[derive(Clone, Copy, Debug)]
pub struct Rule {
    /// The field is needed this far beyond the square (m).
    pub more: f64,
    /// Sources are near that are closer to the square in which the field is needed than half its
    /// side divided by this.
    pub farthest: f64,
    /// Squares whose half side (m) is smaller are not halved.
    pub smallest: f64,
}

/// A square and the sources near it.
#[derive(Clone, Debug)]
pub struct Square {
    pub centre: Vector2<f64>,
    /// Half its side (m).
    pub half: f64,
    /// Their indices, ascending.
    pub near: Vec<u32>,
}

impl Rule {
    /// Half the side (m) of the square in which the field is needed for one of half the side
    /// `half`.
    pub fn wide(&self, half: f64) -> f64 {
        WIDER * half + self.more
    }

    /// The smallest distance (m) from that square of sources that are not near.
    pub fn nearest(&self, half: f64) -> f64 {
        self.wide(half) / self.farthest
    }
}

impl Square {
    /// The square around a centre, with half its side (m); only these candidates may be near it.
    pub fn around<S: Source>(
        centre: Vector2<f64>,
        half: f64,
        (sources, rule): (&[S], &Rule),
        candidates: &[u32],
    ) -> Self {
        let wide = rule.wide(half);
        let nearest = rule.nearest(half) * (1.0 + 1e-12);
        let is_near = |number: &&u32| sources[**number as usize].distance(centre, wide) < nearest;
        Self {
            centre,
            half,
            near: candidates.iter().filter(is_near).copied().collect(),
        }
    }

    /// One of the four quarters. Sources not near the whole are not near the quarter.
    pub fn quarter<S: Source>(&self, at: [usize; 2], field: (&[S], &Rule)) -> Self {
        let half = self.half / 2.0;
        let offset = at.map(|k| if k == 0 { -half } else { half });
        let centre = self.centre + Vector2::from(offset);
        Self::around(centre, half, field, &self.near)
    }

    /// The sources that are not near.
    pub fn far<S: Source>(&self, sources: &[S]) -> Vec<S> {
        let mut near = self.near.iter().copied().peekable();
        let numbered = (0..).zip(sources);
        let far = numbered
            .filter_map(|(number, source)| near.next_if_eq(&number).is_none().then_some(source));
        far.cloned().collect()
    }
}

/// The distance of a point from a square with a centre and half a side (m).
pub fn distance(point: Vector2<f64>, centre: Vector2<f64>, half: f64) -> f64 {
    let way = (point - centre).abs();
    way.map(|s| (s - half).max(0.0)).norm()
}
