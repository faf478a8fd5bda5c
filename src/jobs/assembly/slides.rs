//! Slid contacts, which models of tile assembly leave out: faces that bind shifted by some places.
//!
//! A tile of the engines stands in its place or not at all. A magnetic one that comes along a face
//! runs, flush and overdamped, down to the nearest slide at which it holds. Of all slides by whole
//! places this counts how many lead to the aligned meeting and how many to a slid one.

use super::Built;
use physics::words::{Lags, Rules, Word};

/// Where two faces hold, slid.
#[derive(Clone, Debug, PartialEq)]
pub struct Slid {
    /// The faces.
    pub faces: [usize; 2],
    /// The deepest slid meeting that holds: places that the second face lies farther along the
    /// first one (counter-clockwise), and energy (J).
    pub deepest: Option<(i32, f64)>,
    /// Shares of slides that lead to the aligned meeting, and to slid ones that hold.
    pub captured: [f64; 2],
}

impl Slid {
    /// Of two faces with their words.
    pub fn of(lags: &Lags, rules: &Rules, faces: [usize; 2], [first, second]: [Word; 2]) -> Self {
        // Energies (J) over slides, from the most clockwise one on.
        let middle = usize::from(rules.slides()) * (first.places() - 1);
        let slide = |k: usize| k as i32 - middle as i32;
        let profile: Vec<f64> = (0..=2 * middle)
            .map(|k| rules.energy_at(lags, first, second, slide(k)))
            .collect();
        let at = |k: usize| profile[k];
        let mut ends = [0; 2];
        let mut deepest: Option<(i32, f64)> = None;
        for start in 0..profile.len() {
            let mut here = start;
            loop {
                let low = here.saturating_sub(1);
                let high = (here + 1).min(profile.len() - 1);
                let next = if at(low) < at(high) { low } else { high };
                if at(next) >= at(here) {
                    break;
                }
                here = next;
            }
            if at(here) >= 0.0 {
                continue;
            }
            ends[usize::from(here != middle)] += 1;
            if here != middle && deepest.is_none_or(|(_, energy)| at(here) < energy) {
                deepest = Some((slide(here), at(here)));
            }
        }
        let all = profile.len() as f64;
        Self {
            faces,
            deepest,
            captured: ends.map(|count| f64::from(count) / all),
        }
    }

    /// The energy (J) of the deepest meeting; 0 of none.
    pub fn energy(&self) -> f64 {
        self.deepest.map_or(0.0, |it| it.1)
    }
}

/// What may be asked of slid meetings.
#[derive(Clone, Copy, Debug)]
pub struct Summary {
    /// The deepest of them (J).
    pub deepest: f64,
    /// Pairs of faces that one slid meeting holds against Gmc, of so many.
    pub holding: usize,
    /// See there.
    pub pairs: usize,
    /// Of a word and its mate: the mean share of slides that lead to slid meetings among those that
    /// lead anywhere.
    pub share: f64,
}

/// What there is to know of all pairs of faces, slid.
pub fn summary(built: &Built, slides: &[Slid]) -> Option<Summary> {
    let n = built.matrix.words.len();
    let deepest = slides.iter().map(Slid::energy).reduce(f64::min)?;
    let holds = |slid: &&Slid| -slid.energy() / built.shaking.kt > built.gmc;
    let own = slides.iter().filter(|it| it.faces[1] - it.faces[0] == n);
    let shares = own.map(|it| it.captured[1] / (it.captured[0] + it.captured[1]));
    Some(Summary {
        deepest,
        holding: slides.iter().filter(holds).count(),
        pairs: slides.len(),
        share: shares.sum::<f64>() / n as f64,
    })
}
