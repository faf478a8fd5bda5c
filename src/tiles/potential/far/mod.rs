//! Magnets that are far apart: one series for blocks and discs, that lie or stand, in vectors.
//!
//! * [`multipole`]: the series of two magnets and its coefficients at an angle between them;
//! * [`terms`]: its sum for one moving magnet and several fixed ones;
//! * [`derivatives`]: the second and third derivatives of two magnets;
//! * [`rows`]: the sum over two groups of magnets that are alike;
//! * this file: how many terms a distance needs.

pub mod derivatives;
pub mod group;
pub mod multipole;
pub mod rows;
pub mod terms;

use nalgebra::{Complex, Vector2};

use multipole::Multipole;
use terms::STEPS;

/// Energy (J) of two magnets, its gradient by the second one's centre (J/m) and its derivative
/// by the second one's angle about its own centre (J/rad).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PairEnergy {
    /// U (J).
    pub energy: f64,
    /// By the second magnet's centre (J/m).
    pub gradient: Vector2<f64>,
    /// By the second magnet's angle about its own centre (J/rad).
    pub slope: f64,
}

/// A vector of the tiles' plane as a complex number.
pub fn complex(v: Vector2<f64>) -> Complex<f64> {
    Complex::new(v.x, v.y)
}

/// The series of two magnets, and the distances at which it has enough terms.
#[derive(Clone, Debug)]
pub struct FarForm {
    pub series: Multipole,
    /// The squared distances (m^2) beyond which each of [`STEPS`] suffices, for a single pair.
    pub squares: [f64; STEPS.len()],
    /// The same among stronger pairs: row i is for errors of the tolerance times `4^(i - WEAKEST)
    /// near^-3`, near the distance at which the series replaces the faces.
    among: [[f64; STEPS.len()]; ROWS],
}

/// The number of rows of [`FarForm::among`], and the row for pairs at the hand-over itself.
const ROWS: usize = 20;
const WEAKEST: i32 = 15;

impl FarForm {
    /// With errors of `tolerance`, in units of `mu0 m1 m2 / (4 pi r^3)` of a single pair, or of the strongest
    /// of several.
    pub fn new(series: Multipole, tolerance: f64) -> Self {
        // More terms than there are are never reached.
        let each = |of: &dyn Fn(usize) -> f64| STEPS.map(|terms| of(terms.min(series.terms)));
        let squares = each(&|terms| series.radius(terms, tolerance).powi(2));
        let near = squares[STEPS.len() - 1].sqrt();
        let among = std::array::from_fn(|row| {
            let scale = 4f64.powi(row as i32 - WEAKEST) / near.powi(3);
            each(&|terms| series.radius_among(terms, tolerance * scale).powi(2))
        });
        Self {
            series,
            squares,
            among,
        }
    }

    /// That of point dipoles, whose series ends with the first term.
    pub fn of_dipoles(series: Multipole) -> Self {
        Self {
            series,
            squares: [0.0; STEPS.len()],
            among: [[0.0; STEPS.len()]; ROWS],
        }
    }

    /// The squared distances (m^2) beyond which each of [`STEPS`] suffices, if the `m1 m2 / r^3` of
    /// the strongest pair is `strongest` (m^-3) times the product of the pair's own moments.
    #[inline(always)]
    pub fn steps(&self, strongest: f64) -> &[f64; STEPS.len()] {
        let near = self.near();
        let ratio = strongest * near * near.sqrt();
        // The power of two, halved and rounded down, so that no more error than this is allowed.
        let power = (ratio.to_bits() >> 52) as i32 - 1023;
        let row = power.div_euclid(2) + WEAKEST;
        if row < 0 {
            &self.squares
        } else {
            &self.among[(row as usize).min(ROWS - 1)]
        }
    }

    /// How many terms are summed at this squared distance (m^2), given what each number needs.
    #[inline(always)]
    pub fn terms(&self, steps: &[f64; STEPS.len()], square: f64) -> usize {
        let enough = STEPS.iter().zip(steps).find(|(_, least)| square >= **least);
        enough.map_or(self.series.terms, |(terms, _)| *terms)
    }

    /// The squared distance (m^2) below which the faces of a single pair are summed.
    #[inline(always)]
    pub fn near(&self) -> f64 {
        self.squares[STEPS.len() - 1]
    }
}
