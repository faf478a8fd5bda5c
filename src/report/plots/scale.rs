//! Scales that map energies to positions and colours.

use plotters::coord::ranged1d::{BoldPoints, Ranged};
use plotters::coord::types::RangedCoordf64;

use super::style::minus;
use physics::order::Order;
use physics::units::si;

/// The diverging colour map "vik", attraction blue and repulsion brown, pale at zero: perceptually
/// uniform and safe for colour-blind readers. Every sixteenth of its colours; linear interpolation
/// between them is within 7/255 of the original.
///
/// Source: Crameri, *Scientific colour maps* 8 (2023), doi:10.5281/zenodo.1243862 (MIT licence).
pub const VIK: [[u8; 3]; 17] = [
    [0, 18, 97],
    [2, 43, 113],
    [3, 68, 129],
    [12, 94, 146],
    [47, 124, 166],
    [96, 157, 188],
    [146, 189, 210],
    [197, 219, 229],
    [236, 229, 225],
    [233, 203, 185],
    [220, 171, 143],
    [207, 142, 104],
    [195, 114, 67],
    [179, 83, 31],
    [147, 46, 6],
    [116, 21, 6],
    [89, 0, 8],
];

/// Colour of a position from -1 (most negative) over 0 to 1.
pub fn colour(position: f64) -> [u8; 3] {
    let last = VIK.len() - 1;
    let at = (position.clamp(-1.0, 1.0) + 1.0) / 2.0 * last as f64;
    let below = (at.floor() as usize).min(last - 1);
    let t = at - below as f64;
    std::array::from_fn(|c| {
        let (a, b) = (f64::from(VIK[below][c]), f64::from(VIK[below + 1][c]));
        (a + (b - a) * t).round() as u8
    })
}

/// A symmetric scale of energies, linear about zero and logarithmic beyond: the position of U is
/// `asinh(U / U0) / asinh(Umax / U0)`, in [-1, 1], with `U0 = Umax / 10 000`. Or linear
/// throughout: U / Umax.
///
/// Energies of a pair of tiles span four decades and both signs; zero stays in the middle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnergyScale {
    most: f64,
    is_linear: bool,
}

impl EnergyScale {
    /// Decades between the linear part and the largest energy.
    pub const DECADES: i32 = 4;

    /// A scale that covers `energies` (J); infinite ones are ignored.
    pub fn holding(energies: impl IntoIterator<Item = f64>) -> Self {
        let most = energies
            .into_iter()
            .map(f64::abs)
            .filter(|u| u.is_finite())
            .fold(0.0, f64::max);
        Self {
            most: if most > 0.0 { most } else { 1.0 },
            is_linear: false,
        }
    }

    /// The same energies on a scale that is linear throughout.
    pub fn linear_throughout(self) -> Self {
        Self {
            is_linear: true,
            ..self
        }
    }

    /// The name of an energy axis or colour bar.
    pub fn axis(&self) -> String {
        match self.is_linear {
            true => "energy U".to_owned(),
            false => format!("energy U (log beyond \u{b1}{})", si(self.linear(), "J", 2)),
        }
    }

    /// The largest energy (J).
    pub fn most(&self) -> f64 {
        self.most
    }

    fn linear(&self) -> f64 {
        self.most / 10f64.powi(Self::DECADES)
    }

    pub fn position(&self, energy: f64) -> f64 {
        if self.is_linear {
            return (energy / self.most).clamp(-1.0, 1.0);
        }
        let full = libm::asinh(self.most / self.linear());
        (libm::asinh(energy / self.linear()) / full).clamp(-1.0, 1.0)
    }

    /// Zero and the powers of ten beyond the linear part, between two positions; round numbers on a
    /// linear scale.
    pub fn ticks(&self, low: f64, high: f64) -> Vec<f64> {
        if self.is_linear {
            return round_numbers([low, high].map(|end| end * self.most), 9);
        }
        let top = libm::log10(self.most).floor() as i32;
        let powers = (top - Self::DECADES + 1..=top).map(|k| 10f64.powi(k));
        let mut ticks: Vec<f64> = powers.flat_map(|u| [-u, u]).chain([0.0]).collect();
        ticks.retain(|&u| {
            let position = self.position(u);
            position >= low - 1e-9 && position <= high + 1e-9
        });
        ticks.order_by(f64::total_cmp);
        ticks
    }

    /// The text of a tick.
    pub fn tick(&self, energy: f64) -> String {
        self.label(energy, if self.is_linear { 2 } else { 1 })
    }

    /// An energy with its unit; 0 if it is negligible on this scale.
    pub fn label(&self, energy: f64, digits: usize) -> String {
        if energy.abs() < 1e-3 * self.linear() {
            return "0 J".into();
        }
        minus(&si(energy, "J", digits))
    }
}

/// Evenly spaced round numbers in a range, as plotters finds them, at most the given number.
pub fn round_numbers([low, high]: [f64; 2], most: usize) -> Vec<f64> {
    let mut numbers = RangedCoordf64::from(low..high).key_points(BoldPoints(most));
    // Rounding errors count as zero.
    for number in &mut numbers {
        if number.abs() < 1e-9 * (high - low) {
            *number = 0.0;
        }
    }
    numbers
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_are_odd_ascending_and_fill_the_scale() {
        let scale = EnergyScale::holding([-0.065, 0.002, f64::INFINITY]);
        assert_eq!(scale.position(0.0), 0.0);
        assert_eq!(scale.position(-0.065), -1.0);
        let energies = [1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.06];
        for pair in energies.windows(2) {
            assert!(scale.position(pair[0]) < scale.position(pair[1]));
        }
        for u in energies {
            assert_eq!(scale.position(-u), -scale.position(u));
        }
        // Far from zero the scale is logarithmic.
        let decade = scale.position(1e-2) - scale.position(1e-3);
        let other = scale.position(1e-3) - scale.position(1e-4);
        assert!((decade / other - 1.0).abs() < 0.01);
    }

    #[test]
    fn zero_is_pale_and_the_ends_are_dark() {
        assert_eq!(colour(-1.0), VIK[0]);
        assert_eq!(colour(0.0), VIK[8]);
        assert_eq!(colour(1.0), VIK[16]);
        assert!(colour(0.0).iter().all(|&c| c > 220));
    }

    #[test]
    fn ticks_hold_zero_and_stay_within() {
        let scale = EnergyScale::holding([-0.065]);
        let ticks = scale.ticks(-1.0, 0.3);
        assert!(ticks.contains(&0.0) && ticks.contains(&-0.01));
        assert!(ticks.iter().all(|&u| scale.position(u) <= 0.3));
        assert!(ticks.is_sorted());
    }

    #[test]
    fn a_linear_scale_has_round_ticks_and_no_logarithm() {
        let scale = EnergyScale::holding([-0.065]).linear_throughout();
        assert_eq!(scale.position(-0.0325), -0.5);
        let ticks = scale.ticks(-1.0, 0.1);
        let texts: Vec<String> = ticks.iter().map(|u| scale.label(*u, 1)).collect();
        assert!(texts.contains(&"\u{2212}60 mJ".to_owned()), "{texts:?}");
        assert!((5..10).contains(&texts.len()));
        assert!(!scale.axis().contains("log"));
    }

    #[test]
    fn what_the_scale_cannot_tell_from_zero_is_zero() {
        let scale = EnergyScale::holding([-0.065]);
        assert_eq!(scale.label(-3e-12, 3), "0 J");
        assert_eq!(scale.label(-0.06547, 4), "\u{2212}65.47 mJ");
    }
}
