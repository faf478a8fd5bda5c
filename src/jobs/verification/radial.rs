//! The energy of two discs that stand, which depends on their distance alone: polynomials in its
//! square, between which it is found once.
//!
//! Neither the energies nor their bounds are proved: the polynomials are tried at five places of each
//! piece, and how far their derivatives are off is assumed.

use super::faces::ChargedFace;
use super::interval::Interval;
use super::stacks;

/// Coefficients of each polynomial.
const TERMS: usize = 12;
/// The greatest distance has this many times the square of that at which the discs touch.
const FARTHEST: f64 = 1e5;
/// Ends of a piece have squares in this ratio, at most.
const RATIO: f64 = 1.5;
/// Largest error, as a share of the energy of discs that touch.
const ERROR: f64 = 1e-8;
/// A piece is halved this often, at most.
const HALVINGS: u8 = 10;
/// What the polynomials' derivatives are off by, as a share.
const BESIDE: f64 = 1e-3;

/// Energies by the square of the distance.
pub(super) struct Radial {
    pieces: Vec<Piece>,
}

/// Over squares from `low` to `high`, a polynomial of what goes from -1 to 1 there.
struct Piece {
    low: f64,
    high: f64,
    terms: [f64; TERMS],
}

impl Radial {
    /// Two discs with these pole faces, both about the same place.
    pub fn new(first: &[ChargedFace; 2], second: &[ChargedFace; 2]) -> Self {
        let touch = (first[0].half[0] + second[0].half[0]).powi(2);
        let of = |square: f64| energy(first, second, square.sqrt());
        let allowed = ERROR * of(touch).abs();
        let mut pieces = Vec::new();
        // Discs that touch may be nearer by rounding.
        let mut low = touch * (1.0 - 1e-9);
        while low < FARTHEST * touch {
            pieces.extend(fitted(&of, [low, low * RATIO], allowed, HALVINGS));
            low *= RATIO;
        }
        Self { pieces }
    }

    /// The energy at a square of the distance; `None` where it is not known.
    pub fn at(&self, square: f64) -> Option<f64> {
        let piece = &self.pieces[self.first(square)?];
        Some(piece.at(square))
    }

    /// The piece with a square.
    fn first(&self, square: f64) -> Option<usize> {
        let number = self.pieces.partition_point(|it| it.high < square);
        let is_there = self.pieces.get(number).is_some_and(|it| it.low <= square);
        is_there.then_some(number)
    }

    /// The energy and its first two derivatives by the square, over squares; anything where they are not
    /// known.
    pub fn over(&self, squares: Interval) -> [Interval; 3] {
        let ends = [self.first(squares.low), self.first(squares.high)];
        let [Some(first), Some(last)] = ends else {
            return [Interval::new(f64::NEG_INFINITY, f64::INFINITY); 3];
        };
        let pieces = self.pieces[first..=last].iter().map(|it| it.over(squares));
        let both = |a: Interval, b: Interval| Interval::new(a.low.min(b.low), a.high.max(b.high));
        let joined = |a: [Interval; 3], b: [Interval; 3]| [0, 1, 2].map(|k| both(a[k], b[k]));
        let nothing = Interval::new(f64::INFINITY, f64::NEG_INFINITY);
        pieces.fold([nothing; 3], joined)
    }
}

/// The energy of two discs at a distance: faces of one sign are as high as each other, or differ as the
/// discs do; those of two signs are across the mid-plane.
fn energy(first: &[ChargedFace; 2], second: &[ChargedFace; 2], distance: f64) -> f64 {
    let at = |it: &ChargedFace, x: f64| it.moved([x, 0.0]);
    let of = |a: &ChargedFace, b: &ChargedFace| {
        let [a, b] = [at(a, 0.0), at(b, distance)];
        let size = a.area() * b.area() / (distance + 2.0 * (a.half[0] + b.half[0]));
        a.charge * b.charge * stacks::adaptive(&a, &b, 1e-10 * size)
    };
    2.0 * (of(&first[0], &second[0]) + of(&first[0], &second[1]))
}

/// Pieces from one square to another.
fn fitted(of: &impl Fn(f64) -> f64, [low, high]: [f64; 2], allowed: f64, left: u8) -> Vec<Piece> {
    let piece = Piece::through(of, low, high);
    let between = [-0.99, -0.6, 0.1, 0.55, 0.97];
    let between = between.map(|u| 0.5 * (low + high) + 0.5 * u * (high - low));
    let is_near = |square: &f64| (piece.at(*square) - of(*square)).abs() <= allowed;
    if left == 0 || between.iter().all(is_near) {
        return vec![piece];
    }
    let middle = 0.5 * (low + high);
    let mut all = fitted(of, [low, middle], allowed, left - 1);
    all.extend(fitted(of, [middle, high], allowed, left - 1));
    all
}

impl Piece {
    /// Through Chebyshev's places.
    fn through(of: &impl Fn(f64) -> f64, low: f64, high: f64) -> Self {
        const COUNT: f64 = TERMS as f64;
        let angle = |k: usize| std::f64::consts::PI * (k as f64 + 0.5) / COUNT;
        let value = |k: usize| of(0.5 * (low + high) + 0.5 * (high - low) * libm::cos(angle(k)));
        let values: [f64; TERMS] = std::array::from_fn(value);
        // Chebyshev's polynomials one by one, by their recurrence.
        let [mut before, mut now] = [[0.0; TERMS]; 2];
        now[0] = 1.0;
        let mut terms = [0.0; TERMS];
        for degree in 0..TERMS {
            let cosine = |k: usize| libm::cos(degree as f64 * angle(k));
            let sum: f64 = (0..TERMS).map(|k| values[k] * cosine(k)).sum();
            let share = sum * if degree == 0 { 1.0 } else { 2.0 } / COUNT;
            for (term, of_this) in terms.iter_mut().zip(now) {
                *term += share * of_this;
            }
            let twice = if degree == 0 { 1.0 } else { 2.0 };
            let next: [f64; TERMS] = std::array::from_fn(|k| {
                let raised = if k == 0 { 0.0 } else { now[k - 1] };
                twice * raised - before[k]
            });
            (before, now) = (now, next);
        }
        Self { low, high, terms }
    }

    fn half(&self) -> f64 {
        0.5 * (self.high - self.low)
    }

    fn place(&self, square: f64) -> f64 {
        (square - 0.5 * (self.low + self.high)) / self.half()
    }

    fn at(&self, square: f64) -> f64 {
        let u = self.place(square);
        self.terms
            .iter()
            .rev()
            .fold(0.0, |sum, term| sum * u + term)
    }

    /// Taylor's polynomial about the middle of its part of these squares.
    fn over(&self, squares: Interval) -> [Interval; 3] {
        let [from, to] = [squares.low.max(self.low), squares.high.min(self.high)];
        let (middle, reach) = (
            self.place(0.5 * (from + to)),
            0.5 * (to - from) / self.half() * (1.0 + 1e-12) + 1e-15,
        );
        let mut terms = self.terms;
        for lowest in 0..TERMS {
            for k in (lowest..TERMS - 1).rev() {
                terms[k] += middle * terms[k + 1];
            }
        }
        let mut derivatives = [Interval::of(0.0); 3];
        for (order, derivative) in derivatives.iter_mut().enumerate() {
            // Of each power the factor that its derivative has.
            let factor = |k: usize| (0..order).map(|it| (k - it) as f64).product::<f64>();
            let scale = (0..order).map(|_| 1.0 / self.half()).product::<f64>();
            let middle = scale * factor(order) * terms[order];
            let mut power = 1.0;
            let mut beside = BESIDE * middle.abs();
            for (k, term) in terms.iter().enumerate().skip(order + 1) {
                power *= reach;
                beside += scale * factor(k) * term.abs() * power;
            }
            *derivative = Interval::new(middle - beside, middle + beside);
        }
        derivatives
    }
}

#[cfg(test)]
mod tests {
    use super::super::charges;
    use super::super::faces::Outline;
    use super::*;

    fn disc(radius: f64, height: f64) -> [ChargedFace; 2] {
        let place = |sign: f64| ([0.0; 2], Some(0.5 * sign * height));
        [1.0, -1.0]
            .map(|sign| ChargedFace::new(Outline::Disc, place(sign), [1.0, 0.0], [radius; 2], sign))
    }

    #[test]
    fn energies_and_derivatives_are_those_of_the_faces() {
        let (first, second) = (disc(2.5, 3.0), disc(4.0, 2.0));
        let table = Radial::new(&first, &second);
        let direct = |square: f64| {
            let moved = second.each_ref().map(|it| it.moved([square.sqrt(), 0.0]));
            let pairs = first.iter().flat_map(|a| moved.iter().map(move |b| (a, b)));
            pairs.map(|(a, b)| charges::energy(a, b)).sum::<f64>()
        };
        let scale = direct(42.25).abs();
        assert!(table.at(42.0).is_none() && table.at(1e9).is_none());
        for square in [42.25, 42.3, 45.0, 60.0, 100.0, 400.0, 1e4] {
            let found = table.at(square).expect("a piece");
            let off = (found - direct(square)).abs() / scale;
            assert!(off < 1e-6, "{square}: {off:e}");
            let h = 1e-3 * square;
            let range = Interval::new(square, square + 2.0 * h);
            let [value, slope, bend] = table.over(range);
            let at = |k: f64| table.at(square + k * h).expect("a piece");
            let holds = |range: Interval, x: f64| {
                let by = 2e-3 * x.abs();
                assert!(
                    range.low - by <= x && x <= range.high + by,
                    "{square}: {range:?} {x}"
                );
            };
            holds(value, at(1.0));
            holds(slope, (at(2.0) - at(0.0)) / (2.0 * h));
            if square > 42.25 {
                holds(bend, (at(2.0) - 2.0 * at(1.0) + at(0.0)) / (h * h));
            }
        }
    }
}
