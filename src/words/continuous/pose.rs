//! The strongest attraction of two flat faces of equal length in contact, by point dipoles, lying or
//! upright.
//!
//! The fixed face lies along y, its outward normal along x; the moving one is turned by `tilt`
//! about its midpoint, which lies `slide` along the fixed one, and is moved towards it until a
//! corner of one touches the other.

use std::cell::Cell;

use super::{SpacedWord, Wanted};
use tiles::order::Order;
use tiles::units::MU0_OVER_4PI;

/// Tilts (rad) to evaluate, in both directions.
const TILTS: [f64; 6] = [0.01, 0.02, 0.04, 0.08, 0.16, 0.32];
/// Refinement: steps of slide (in lengths of a face) and tilt (rad), and how often they are halved.
const STEPS: [f64; 2] = [2e-3 / 0.43, 4e-3];
const HALVINGS: usize = 4;
/// Slides closer together than this fraction of two facing dipoles' distance are not both evaluated:
/// the energy of two is lower between them by at most a hundredth.
const THINNED: f64 = 0.1;

/// Energies of two faces of given magnets.
pub(super) struct Meetings {
    /// `mu0 m^2 / 4 pi` (J m^3).
    strength: f64,
    /// Depth of a magnet's centre behind its face (m).
    depth: f64,
    face: f64,
    /// Whether the dipoles are upright.
    stands: bool,
    /// Smaller slides (m) of a word and its mate are not wrong.
    own_slope: f64,
    /// Pairs of magnets evaluated, to count work.
    pub pairs: Cell<u64>,
}

impl Meetings {
    pub fn new(wanted: &Wanted) -> Self {
        Self {
            strength: MU0_OVER_4PI * wanted.bar.moment * wanted.bar.moment,
            depth: wanted.bar.inset + wanted.bar.size[0] / 2.0,
            face: wanted.face,
            stands: wanted.bar.form.stands.is_some(),
            own_slope: wanted.bar.pitch / 2.0,
            pairs: Cell::new(0),
        }
    }

    /// The depth (J) of the bond of a word and its mate, flush.
    pub fn bond(&self, word: &SpacedWord) -> f64 {
        -self.energy(word, &word.mate(), 0.0, 0.0).unwrap_or(0.0)
    }

    /// The strongest attraction (J) of two faces over poses in contact, 0 if none attracts; away
    /// from the bond if the second is the first one's `own` mate.
    pub fn strongest(&self, first: &SpacedWord, second: &SpacedWord, own: bool) -> f64 {
        let wrong = |slide: f64| !own || slide.abs() >= self.own_slope;
        let mut best = (0.0, [0.0, 0.0]);
        let tilts = TILTS.iter().flat_map(|tilt| [*tilt, -tilt]);
        for tilt in std::iter::once(0.0).chain(tilts) {
            for slide in self.slides(first, second, tilt) {
                if wrong(slide)
                    && let Some(energy) = self.energy(first, second, slide, tilt)
                    && energy < best.0
                {
                    best = (energy, [slide, tilt]);
                }
            }
        }
        if best.0 < 0.0 {
            self.polish(first, second, &wrong, &mut best);
        }
        -best.0
    }

    /// The slides (m) at a tilt (rad) at which two magnets that attract face each other. Like poles of
    /// lying magnets attract most beside each other, at twice the distance of their dipoles: by 0.018
    /// of the attraction of opposite ones.
    fn slides(&self, first: &SpacedWord, second: &SpacedWord, tilt: f64) -> Vec<f64> {
        let (sin, cos) = libm::sincos(tilt);
        let mut slides = Vec::with_capacity(2 * first.magnets.len() * second.magnets.len());
        for (at, pole) in &first.magnets {
            for (other, other_pole) in &second.magnets {
                let facing = at - (self.depth * sin - other * cos);
                if pole != other_pole {
                    slides.push(facing);
                } else if !self.stands {
                    slides.extend([facing - 4.0 * self.depth, facing + 4.0 * self.depth]);
                }
            }
        }
        slides.order_by(f64::total_cmp);
        let mut last = f64::NEG_INFINITY;
        slides.retain(|slide| {
            let apart = slide - last > THINNED * 2.0 * self.depth;
            if apart {
                last = *slide;
            }
            apart
        });
        slides
    }

    fn polish(
        &self,
        first: &SpacedWord,
        second: &SpacedWord,
        wrong: &dyn Fn(f64) -> bool,
        best: &mut (f64, [f64; 2]),
    ) {
        let steps = [STEPS[0] * self.face, STEPS[1]];
        let mut share = 1.0;
        for _ in 0..HALVINGS {
            for axis in 0..2 {
                for sign in [1.0, -1.0] {
                    let mut there = best.1;
                    there[axis] += sign * share * steps[axis];
                    if let Some(energy) = self.energy(first, second, there[0], there[1])
                        && energy < best.0
                        && wrong(there[0])
                    {
                        *best = (energy, there);
                    }
                }
            }
            share /= 2.0;
        }
    }

    /// The energy (J) of two faces in contact; `None` if they pass by each other.
    fn energy(
        &self,
        first: &SpacedWord,
        second: &SpacedWord,
        slide: f64,
        tilt: f64,
    ) -> Option<f64> {
        let (sin, cos) = libm::sincos(tilt);
        let out = self.contact(slide, sin, cos)?;
        self.pairs
            .set(self.pairs.get() + (first.magnets.len() * second.magnets.len()) as u64);
        let mut energy = 0.0;
        for (other, other_pole) in &second.magnets {
            let x = out + self.depth * cos + other * sin + self.depth;
            let y = slide + self.depth * sin - other * cos;
            for (at, pole) in &first.magnets {
                let dy = y - at;
                let square = x * x + dy * dy;
                let along = match self.stands {
                    true => 1.0,
                    false => 3.0 * x * (cos * x + sin * dy) / square - cos,
                };
                energy += f64::from(pole * other_pole) * along / (square * square.sqrt());
            }
        }
        Some(self.strength * energy)
    }

    /// How far (m) out the midpoint of the moving face lies in contact.
    fn contact(&self, slide: f64, sin: f64, cos: f64) -> Option<f64> {
        let half = self.face / 2.0;
        if sin == 0.0 {
            return (slide.abs() < self.face).then_some(0.0);
        }
        // The corner that leads, along the fixed face, in the direction in which it lies.
        let side = sin.signum();
        let corner = side * slide + half * cos;
        if corner < -half {
            return None;
        }
        if corner <= half {
            return Some(half * sin.abs());
        }
        // The fixed face's corner touches the moving face.
        let along = side * slide - half;
        (along.abs() <= half * cos).then_some(-along * sin.abs() / cos)
    }
}
