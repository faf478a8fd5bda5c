//! How strongly the bond and the traps hold shaken tiles: for the terminal and for scripts.

use std::fmt::Write;

use serde_json::{Value, json};

use super::terminal::write_table;
use super::values::{pose, positive_zero};
use jobs::design::Design;
use physics::kinetics::bond::{Bond, BondError, Docking, Hold, Shaking, TOLERANCE, traps};
use physics::kinetics::well::NO_PLAY;
use physics::landscape::Inventory;
use physics::problem::Problem;
use physics::units::si;

/// What is said of a bond at one shaking.
pub struct BondReport<'a> {
    design: &'a Design,
    shaking: Shaking,
    /// The bond first, then the traps from the deepest on.
    holds: Vec<Held>,
    /// How many kinds of traps are too shallow to hold anything.
    shallow: usize,
    window: [Option<f64>; 2],
    /// Whether the bond has play, but less than contact is known to.
    is_too_cold: bool,
}

/// A state at one shaking.
struct Held {
    name: String,
    pose: [f64; 3],
    energy: f64,
    copies: usize,
    moving_copies: usize,
    level: f64,
    is_cut: bool,
    docking: Docking,
    /// With no more of the basin than lies below half its depth.
    inner: Docking,
    closed: Option<Docking>,
}

impl Held {
    fn new(problem: &Problem, hold: &Hold, shaking: &Shaking) -> Self {
        let basin = hold.well().basin();
        Self {
            name: hold.name.clone(),
            pose: pose(&hold.configuration),
            energy: hold.energy,
            copies: hold.copies,
            moving_copies: hold.moving_copies,
            level: basin.level,
            is_cut: basin.is_cut,
            docking: hold.docking(shaking, TOLERANCE),
            inner: hold.docking_below(shaking, hold.energy / 2.0, TOLERANCE),
            closed: hold.closed_form(problem, shaking),
        }
    }

    /// How far the closed form is off, where there are both.
    fn closed_error(&self) -> Option<f64> {
        let volume = self.docking.volume.value;
        let closed = self.closed.filter(|_| volume > 0.0)?;
        Some(closed.volume.value / volume - 1.0)
    }

    fn json(&self) -> Value {
        let volume = self.docking.volume;
        let closed = self.closed.map(|it| it.volume.value);
        json!({
            "state": self.name,
            "pose": self.pose,
            "energy_J": positive_zero(self.energy),
            "copies": self.copies,
            "moving_copies": self.moving_copies,
            "depth_kT": self.docking.depth,
            "docking_cost_kT": finite(self.docking.cost),
            "ln_K": finite(self.docking.ln_k(1.0)),
            "Z0_m2_rad": volume.value,
            "Z0_error_m2_rad": volume.error,
            // The basin: what can be reached from the state below this energy.
            "basin_below_J": self.level,
            "basin_cut": self.is_cut,
            // What lies below half the state's depth alone: where it differs, K depends on what is
            // counted as bound.
            "docking_cost_half_depth_kT": finite(self.inner.cost),
            "closed_form_Z0_m2_rad": closed,
            "closed_form_error": self.closed_error(),
        })
    }

    fn row(&self) -> [String; 7] {
        [
            self.name.clone(),
            format!("x{}", self.copies),
            si(self.energy, "J", 4),
            format!("{:.2}", self.docking.depth),
            number(self.docking.cost),
            number(self.docking.ln_k(1.0)),
            match self.closed_error() {
                // It holds far below the depth only.
                Some(error) if error.abs() < 10.0 => format!("{:+.1} %", 100.0 * error),
                Some(_) => "useless".to_owned(),
                None => "-".to_owned(),
            },
        ]
    }
}

impl<'a> BondReport<'a> {
    /// Integrates over the bond and the traps of an inventory.
    ///
    /// # Errors
    /// Where there is no bond.
    pub fn new(
        design: &'a Design,
        problem: &Problem,
        inventory: &Inventory,
        shaking: Shaking,
    ) -> Result<Self, BondError> {
        let bond = Bond::new(problem, inventory)?;
        let traps = traps(problem, inventory, shaking.kt);
        let holds = std::iter::once(bond.hold()).chain(&traps);
        Ok(Self {
            design,
            shaking,
            shallow: inventory.kinds().count() - 1 - traps.len(),
            holds: holds
                .map(|hold| Held::new(problem, hold, &shaking))
                .collect(),
            window: bond.window(shaking.coverage),
            is_too_cold: bond.hold().is_too_cold(shaking.kt),
        })
    }

    /// What `--json` prints.
    pub fn json(&self) -> Value {
        let Self {
            design,
            shaking,
            window,
            ..
        } = self;
        let bond = &self.holds[0];
        let area = design.pair.moving.outline.area();
        let mut value = json!({
            "tilebind": env!("CARGO_PKG_VERSION"),
            "design": { "name": design.name, "sha256": design.sha256 },
            "model": design.interaction.model.name(),
            "kT_J": shaking.kt,
            "coverage": shaking.coverage,
            "tile_area_m2": area,
            "tiles_per_m2": shaking.coverage / area,
            "bond_kT": bond.docking.depth,
            "docking_cost_kT": finite(bond.docking.cost),
            "ln_K": finite(bond.docking.ln_k(1.0)),
            "docking_cost_error_kT": bond.docking.volume.relative_error(),
            // kT (J) between which two bonds closed by one docking hold and one alone does not;
            // null where there is no such end.
            "two_hold_one_does_not_J": window,
            "two_hold_one_does_not_bond_kT": window.map(|kt| kt.map(|kt| -bond.energy / kt)),
            "bond": bond.json(),
        });
        // Kinds of traps that are left out: less than 2 kT deep, they hold nothing.
        value["shallow_traps"] = self.shallow.into();
        value["traps"] = self.holds[1..].iter().map(Held::json).collect();
        value
    }

    /// The sentence that answers.
    pub fn headline(&self) -> String {
        let bond = &self.holds[0];
        let name = &self.design.name;
        let at = format!(
            "at kT = {} and {} coverage",
            si(self.shaking.kt, "J", 4),
            percent(self.shaking.coverage)
        );
        if self.is_too_cold {
            return format!(
                "{name}: {at} tiles move by less than {} in the bond, which is closer than contact \
                 is known: choose a larger --kt",
                si(NO_PLAY, "m", 2)
            );
        }
        if bond.docking.cost.is_infinite() {
            return format!("{name}: {at} the bond has no play at all: shaken tiles never find it");
        }
        let ln_k = bond.docking.ln_k(1.0);
        let verdict = match ln_k >= 0.0 {
            true => "one bond holds",
            false if bond.docking.ln_k(2.0) >= 0.0 => "one bond does not hold, two together do",
            false => "neither one bond holds nor two together",
        };
        format!("{name} {at}: {verdict} (ln K = {ln_k:.2} for one)")
    }

    /// What the terminal is told.
    pub fn summary(&self) -> String {
        let bond = &self.holds[0];
        let mut text = format!("{}\n", self.headline());
        text.push_str(&match self.window {
            [Some(low), Some(high)] => format!(
                "two bonds closed by one docking hold and one alone does not from kT = {} to {} \
                 (bond of {:.1} to {:.1} kT)\n",
                si(low, "J", 3),
                si(high, "J", 3),
                -bond.energy / low,
                -bond.energy / high
            ),
            _ => "no shaking was found at which two bonds hold and one alone does not\n".to_owned(),
        });
        text.push('\n');
        let head = [
            "state",
            "copies",
            "energy",
            "depth",
            "docking",
            "ln K",
            "closed form",
        ];
        let mut rows = vec![head.map(str::to_owned)];
        rows.extend(self.holds.iter().map(Held::row));
        write_table(&mut text, &rows);
        text.push_str(
            "(depth and cost of docking in kT; closed form: how far the corner formula is off)\n",
        );
        if self.shallow > 0 {
            let _ = writeln!(
                text,
                "{} more kinds of trap are less than 2 kT deep",
                self.shallow
            );
        }
        let blurred: Vec<&str> = self
            .holds
            .iter()
            .filter(|held| held.inner.cost - held.docking.cost > 0.1)
            .map(|held| &held.name[..])
            .collect();
        if !blurred.is_empty() {
            let _ = writeln!(
                text,
                "in {} shaken tiles are often more than half way out: K depends on what is \
                 counted as held, here all that is reached below the lowest pass, and below a \
                 hundredth of the depth",
                blurred.join(", ")
            );
        }
        text
    }
}

/// Null for what is not finite.
fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

fn number(value: f64) -> String {
    match value.is_finite() {
        true => format!("{value:.2}"),
        false => "-".to_owned(),
    }
}

fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    match percent >= 1.0 {
        true => format!("{percent:.0} %"),
        false => format!("{percent:.2} %"),
    }
}
