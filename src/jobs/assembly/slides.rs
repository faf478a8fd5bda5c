//! What models of tile assembly leave out: faces that hold slid by some places.
//!
//! A tile of the engines stands in its place or not at all. A magnetic one that comes along a face
//! runs, flush and overdamped, down to the nearest slide at which it holds. Of all slides by whole
//! places this counts how many lead to the aligned meeting and how many to a slid one.

use super::Built;
use physics::words::{Lags, Rules, Word};

/// Where two faces hold, slid.
#[derive(Clone, Debug, PartialEq)]
pub struct Slid {
    /// The deepest slid meeting that holds: places that the second face lies farther along the
    /// first one (counter-clockwise), and energy (J).
    pub deepest: Option<(i32, f64)>,
    /// Shares of slides that lead to the aligned meeting, and to slid ones that hold.
    pub captured: [f64; 2],
}

impl Slid {
    /// Of two faces.
    pub fn of(lags: &Lags, rules: &Rules, first: Word, second: Word) -> Self {
        let profile = profile(lags, rules, first, second);
        let middle = profile.len() / 2;
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
                deepest = Some((here as i32 - middle as i32, at(here)));
            }
        }
        let all = profile.len().max(1) as f64;
        Self {
            deepest,
            captured: ends.map(|count| f64::from(count) / all),
        }
    }
}

/// Energies (J) over slides, from the most clockwise one on.
fn profile(lags: &Lags, rules: &Rules, first: Word, second: Word) -> Vec<f64> {
    let last = first.places() as i32 - 1;
    let slides = if rules.slides() { last } else { 0 };
    let energy = |slide: i32| rules.energy_at(lags, first, second, slide);
    (-slides..=slides).map(energy).collect()
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
pub fn summary(built: &Built, slides: &[(usize, usize, Slid)]) -> Option<Summary> {
    let n = built.matrix.words.len();
    let depth = |slid: &Slid| slid.deepest.map_or(0.0, |it| it.1);
    let deepest = slides
        .iter()
        .map(|(_, _, slid)| depth(slid))
        .reduce(f64::min)?;
    let holds = |slid: &Slid| -depth(slid) / built.shaking.kt > built.gmc;
    let own = slides.iter().filter(|(i, j, _)| j - i == n);
    let shares = own.map(|(_, _, it)| it.captured[1] / (it.captured[0] + it.captured[1]));
    Some(Summary {
        deepest,
        holding: slides.iter().filter(|it| holds(&it.2)).count(),
        pairs: slides.len(),
        share: shares.sum::<f64>() / n as f64,
    })
}
