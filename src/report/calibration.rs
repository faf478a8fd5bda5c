//! A calibration of shields for people and for programs.

use std::fmt::Write;

use serde_json::{Value, json};

use super::json;
use jobs::calibration::bonds::{PairTimes, Times};
use jobs::calibration::distances::DistanceFit;
use jobs::calibration::{Calibration, QUANTITIES, Residuals};
use jobs::design::Design;
use physics::dynamics::docking::OnRate;
use physics::kinetics::Bond;
use physics::units::si;

/// The constants of a shield: name in a design file, unit.
const CONSTANTS: [(&str, &str); 4] = [
    ("attenuation", ""),
    ("length", " m"),
    ("width", ""),
    ("front_gain", ""),
];
/// Keys of the measured quantities.
const KEYS: [&str; 4] = ["energy_J", "force_x_N", "force_y_N", "torque_Nm"];

fn values(calibration: &Calibration) -> [f64; 4] {
    let shield = calibration.shield;
    [
        shield.attenuation,
        shield.length,
        shield.width,
        shield.front_gain,
    ]
}

/// What a calibration found, with the lines for a design file.
pub fn summary(design: &Design, calibration: &Calibration) -> String {
    let (fitted, held_out) = (&calibration.fitted, &calibration.held_out);
    let rows = |part: &Residuals| {
        let bare = part.rows - part.with_iron;
        format!("{} rows with iron and {bare} without", part.with_iron)
    };
    let mut text = format!(
        "{}, magnets as {}s: fitted to {}; held out: {}\n\n[shield]\n",
        design.name,
        design.interaction.model.name(),
        rows(fitted),
        rows(held_out),
    );
    let constants = values(calibration).into_iter().zip(CONSTANTS);
    for ((value, (name, unit)), error) in constants.zip(calibration.standard_errors) {
        // By the logarithm, a constant is known only if its error is smaller than itself.
        let error = if error < value {
            format!("+- {error:.1e}{unit}")
        } else {
            "these rows do not tell it".to_owned()
        };
        let _ = writeln!(text, "{:<28}# {error}", format!("{name} = {value:.4}"));
    }
    let _ = writeln!(text, "\n{}", strength(calibration));
    if !calibration.settled {
        let steps = calibration.steps;
        let _ = writeln!(
            text,
            "the fit had not settled after {steps} steps: its constants are not to be trusted"
        );
    }
    let _ = writeln!(
        text,
        "\nroot mean square of measured minus modelled, and relative to that of the measured:"
    );
    let _ = writeln!(text, "{:<16}{:<24}held out", "", "fitted");
    for (k, (name, unit)) in QUANTITIES.iter().enumerate() {
        if fitted.rms[k].is_some() || held_out.rms[k].is_some() {
            let [a, b] = [fitted, held_out].map(|part| residual(part, k, unit));
            let _ = writeln!(text, "{name:<16}{a:<24}{b}");
        }
    }
    text
}

fn strength(calibration: &Calibration) -> String {
    if calibration.fitted.rows == calibration.fitted.with_iron {
        return "no rows without iron: the magnets are taken to be as strong as the design says"
            .to_owned();
    }
    let strength = calibration.strength;
    format!(
        "without iron the measured values are {strength:.4} times the model's: multiply the \
         magnets' remanence or moment by {:.4}",
        strength.sqrt()
    )
}

fn residual(part: &Residuals, k: usize, unit: &str) -> String {
    match part.rms[k].zip(part.relative[k]) {
        Some((rms, relative)) => format!("{} ({:.2} %)", si(rms, unit, 3), 100.0 * relative),
        None => "none".to_owned(),
    }
}

/// The same as JSON.
pub fn json(design: &Design, calibration: &Calibration) -> String {
    let [attenuation, length, width, front_gain] = values(calibration);
    let errors = calibration.standard_errors;
    json::text(&json!({
        "tilebind": env!("CARGO_PKG_VERSION"),
        "design": {"name": design.name, "sha256": design.sha256},
        "model": design.interaction.model.name(),
        "shield": {
            "attenuation": attenuation, "length_m": length, "width": width,
            "front_gain": front_gain,
        },
        "standard_errors": {
            "attenuation": errors[0], "length_m": errors[1], "width": errors[2],
            "front_gain": errors[3],
        },
        "strength": calibration.strength,
        "fitted": residuals(&calibration.fitted),
        "held_out": residuals(&calibration.held_out),
        "steps": calibration.steps,
        "settled": calibration.settled,
    }))
}

fn residuals(part: &Residuals) -> Value {
    let by_quantity = |values: &[Option<f64>; 4]| -> Value {
        let entries = KEYS.iter().zip(values);
        entries.map(|(key, value)| (*key, json!(value))).collect()
    };
    json!({
        "rows": part.rows,
        "rows_with_iron": part.with_iron,
        "rms": by_quantity(&part.rms),
        "relative": by_quantity(&part.relative),
    })
}

/// kT as pairs that bind and part tell it.
#[derive(Clone, Debug)]
pub struct KtFit {
    times: PairTimes,
    area: f64,
    /// kT (J); `None` where no kT fits.
    kt: Option<f64>,
    /// Its 95 % interval; an end is `None` where nothing bounds it.
    interval: [Option<f64>; 2],
}

impl KtFit {
    /// Fits kT to intervals of pairs that have an area (m^2) for themselves.
    pub fn new(times: &PairTimes, bond: &Bond, area: f64) -> Self {
        let (odds, [low, high]) = times.log_odds();
        // The longer tiles are bound, the colder they are.
        let [kt, least, most] = [odds, high, low].map(|odds| bond.kt_of_odds(odds, area));
        Self {
            times: times.clone(),
            area,
            kt,
            interval: [least, most],
        }
    }

    /// The sentence that answers, and how far the intervals are exponential.
    pub fn summary(&self, design: &Design) -> String {
        let energy = |kt: Option<f64>| kt.map_or("?".to_owned(), |kt| si(kt, "J", 3));
        let (bound, apart) = (&self.times.bound, &self.times.apart);
        let mut text = match self.kt {
            Some(_) => format!(
                "{}: pairs bind and part as at kT = {} (95 % interval: {} to {})\n",
                design.name,
                energy(self.kt),
                energy(self.interval[0]),
                energy(self.interval[1])
            ),
            None => format!(
                "{}: at no kT would pairs bind and part so (bond of 2 to 120 kT)\n",
                design.name
            ),
        };
        let _ = writeln!(
            text,
            "measured: bound for {} in the mean of {} times, apart for {} in the mean of {}; the pair had {} m² \
             for itself\nthe interval has the scatter of these times in it, not what the energies are off by",
            si(bound.mean(), "s", 3),
            bound.whole.len(),
            si(apart.mean(), "s", 3),
            apart.whole.len(),
            self.area
        );
        for (name, times) in [("bound", bound), ("apart", apart)] {
            let _ = match times.statistic() {
                None => writeln!(
                    text,
                    "times {name} that were cut off: {}; they count with what was seen of them, and whether \
                     these times are exponential is not tested",
                    times.cut.len()
                ),
                Some(statistic) if statistic > OnRate::CRITICAL => writeln!(
                    text,
                    "the times {name} are not exponential (statistic {statistic:.2} above {}): one \
                     kT does not tell of them",
                    OnRate::CRITICAL
                ),
                Some(_) => Ok(()),
            };
        }
        text
    }

    /// The same as JSON.
    pub fn json(&self, design: &Design) -> String {
        let kind = |times: &Times| {
            json!({
                "count": times.whole.len(),
                "cut_off": times.cut.len(),
                "mean_s": times.mean(),
                "statistic": times.statistic(),
            })
        };
        json::text(&json!({
            "tilebind": env!("CARGO_PKG_VERSION"),
            "design": {"name": design.name, "sha256": design.sha256},
            "model": design.interaction.model.name(),
            "kT_J": self.kt,
            "kT_interval_J": self.interval,
            "area_m2": self.area,
            "bound": kind(&self.times.bound),
            "apart": kind(&self.times.apart),
            "critical": OnRate::CRITICAL,
        }))
    }
}

/// The sentence that answers, of a fit to distances, and whether one kT tells of them at all.
pub fn distances_summary(design: &Design, found: &DistanceFit) -> String {
    let energy = |kt: Option<f64>| kt.map_or("?".to_owned(), |kt| si(kt, "J", 3));
    let [low, high] = found.interval.map(energy);
    let mut text = match found.kt {
        Some(_) => format!(
            "{}: pairs are as far apart as at kT = {} (95 % interval: {low} to {high})\n",
            design.name,
            energy(found.kt),
        ),
        None => format!(
            "{}: of a bond of 0.5 to 60 kT, an end fits these distances best ({low} to {high}, \
             95 %)\n",
            design.name
        ),
    };
    let _ = writeln!(
        text,
        "{} distances up to {}, {} beyond are left out; the distribution is known to {:.1} points",
        found.count,
        si(found.within, "m", 3),
        found.beyond,
        100.0 * found.error,
    );
    if let Some((statistic, freedom)) = found.pearson
        && statistic > critical(freedom)
    {
        let _ = writeln!(
            text,
            "these are not the distances of equilibrium at one kT: Pearson's statistic of \
             {statistic:.1} is above {:.1}",
            critical(freedom)
        );
    }
    text
}

/// The same as JSON.
pub fn distances_json(design: &Design, found: &DistanceFit) -> String {
    let (statistic, freedom) = found.pearson.unzip();
    json::text(&json!({
        "tilebind": env!("CARGO_PKG_VERSION"),
        "design": {"name": design.name, "sha256": design.sha256},
        "model": design.interaction.model.name(),
        "kT_J": found.kt,
        "kT_interval_J": found.interval,
        "distances": {
            "count": found.count,
            "beyond": found.beyond,
            "within_m": found.within,
            "distribution_error": found.error,
            "statistic": statistic,
            "degrees_of_freedom": freedom,
            "critical": freedom.map(critical),
        },
    }))
}

/// The quantile of 95 % of chi-square (Wilson and Hilferty 1931, doi:10.1073/pnas.17.12.684).
fn critical(freedom: usize) -> f64 {
    let part = 2.0 / (9.0 * freedom.max(1) as f64);
    freedom as f64 * (1.0 - part + 1.645 * part.sqrt()).powi(3)
}
