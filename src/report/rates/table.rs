//! Rates between states and `free`.

use nalgebra::DMatrix;
use serde_json::{Value, json};

use super::{Motion, NOT_BOUNDED, Place, digits, digits_between, finite, proved_entry};
use crate::values;
use jobs::design::Design;
use physics::kinetics::Way;
use physics::kinetics::chain::Chain;
use physics::kinetics::map::Map;
use physics::kinetics::rates::{Leaving, RateSettings, Rates};

/// Rates between states and `free`.
pub struct Table<'a> {
    /// The design.
    pub design: &'a Design,
    /// What was asked.
    pub asked: &'a RateSettings,
    /// The motion.
    pub motion: &'a Motion,
    /// The states, in the order of the basins asked for.
    pub places: &'a [Place],
    /// What was found.
    pub found: &'a Rates,
}

impl Table<'_> {
    pub(crate) fn count(&self) -> usize {
        self.places.len() + 1
    }

    pub(crate) fn name(&self, place: usize) -> &str {
        self.places.get(place).map_or("free", |place| &place.name)
    }

    /// The map of the committor, where tiles come to the bond at all.
    pub(crate) fn map(&self) -> Option<&Map> {
        let bind = self.known_rate(self.places.len(), 0)?;
        self.found.map.as_ref().filter(|_| bind > 0.0)
    }

    /// Rate (1/s) from one place to another, where anything is known of it.
    pub(crate) fn known_rate(&self, from: usize, to: usize) -> Option<f64> {
        let is_known = self.found.is_known(from, to);
        is_known.then(|| self.rate(from, to))
    }

    /// Rate (1/s) out of a place, where anything is known of it.
    pub(crate) fn known_rate_out(&self, from: usize) -> Option<f64> {
        let is_known = self.found.is_known_out(from);
        is_known.then(|| self.rate_out(from))
    }

    /// A share of time spent in or about a place, where anything is known of it: a basin without a way
    /// may be one between contacts that the mesh has no cell in.
    pub(crate) fn known_share(&self, place: usize, part: f64) -> Option<f64> {
        let is_known = place == self.places.len() || self.found.ways[place] != Way::Lost;
        is_known.then_some(part)
    }

    /// The probability that one place is the first that is reached from another.
    pub(crate) fn first(&self, from: usize, to: usize) -> Option<f64> {
        finite(self.known_rate(from, to)? / self.known_rate_out(from)?)
    }

    /// Rate (1/s) from one place to another, 0 where no way is known.
    pub(crate) fn rate(&self, from: usize, to: usize) -> f64 {
        self.found.finest().rates[from][to] * self.motion.diffusion
    }

    pub(crate) fn rate_out(&self, from: usize) -> f64 {
        (0..self.count()).map(|to| self.rate(from, to)).sum()
    }

    /// How many digits of a rate are known, as far as meshes tell; or as many as keep it between its
    /// bounds.
    pub(crate) fn digits(&self, from: usize, to: usize) -> usize {
        let spread = finite(self.found.spread(from, to)).unwrap_or(0.0);
        let known = digits(spread.max(self.found.error()));
        digits_between(self.rate(from, to), known, self.bounds(from, to))
    }

    /// How many digits of the rate out of a place are known: as many as of the largest that it is made
    /// of.
    pub(crate) fn digits_out(&self, from: usize) -> usize {
        let others = (0..self.count()).filter(|to| *to != from);
        let largest = others.max_by(|a, b| self.rate(from, *a).total_cmp(&self.rate(from, *b)));
        let known = largest.map_or(1, |to| self.digits(from, to));
        digits_between(self.rate_out(from), known, self.bounds_out(from))
    }

    /// Bounds (1/s) of the rate from one place to another, where there are any.
    pub(crate) fn bounds(&self, from: usize, to: usize) -> [Option<f64>; 2] {
        self.scaled(
            self.found
                .bounds
                .as_ref()
                .map(|bounds| bounds.rates[from][to]),
        )
    }

    /// Bounds (1/s) of the rate out of a place, where there are any.
    pub(crate) fn bounds_out(&self, from: usize) -> [Option<f64>; 2] {
        self.scaled(
            self.found
                .bounds
                .as_ref()
                .map(|bounds| bounds.leaving[from]),
        )
    }

    /// Bounds (1/s), those that say anything: of what is 0 from below none is known, unless it is
    /// 0 altogether.
    fn scaled(&self, bounds: Option<[f64; 2]>) -> [Option<f64>; 2] {
        let scaled = |end: f64| finite(end * self.motion.diffusion);
        let [lower, upper] = bounds.map_or([None; 2], |ends| ends.map(scaled));
        [
            lower.filter(|lower| *lower > 0.0 || upper == Some(0.0)),
            upper,
        ]
    }

    /// The mean time (s) from one place to another, by whatever way; a tile that is anywhere else
    /// does not count.
    pub(crate) fn mean_first_passage(&self, from: usize, to: usize) -> f64 {
        let rate = |i: usize, j: usize| self.rate(i, j);
        let chain = Chain::new(DMatrix::from_fn(self.count(), self.count(), rate));
        chain.mean_times(&[to])[from]
    }

    /// Every two places, from and to.
    pub(crate) fn pairs(&self) -> impl Iterator<Item = (usize, usize)> {
        let count = self.count();
        (0..count).flat_map(move |i| (0..count).filter(move |j| *j != i).map(move |j| (i, j)))
    }

    /// All of it as an object.
    pub fn entry(&self) -> Value {
        let finest = self.found.finest();
        let place = |number: usize| {
            let own = self.places.get(number);
            json!({
                "name": self.name(number),
                "pose": own.map(|place| values::pose(&place.at)),
                "energy_J": own.map(|place| place.energy),
                "basin_energy_J": own.map(|place| place.below),
                "free_at_m": own.is_none().then_some(self.asked.free_at),
                "copies": own.map(|place| place.copies),
                "occupation": self.known_share(number, finest.occupation[number]),
                "inside": self.known_share(number, self.found.inside[number]),
                "way_out": self.found.ways.get(number).map(|way| way.name()),
                "mean_exit_s": self.known_rate_out(number).and_then(|rate| finite(1.0 / rate)),
                "leaving_per_s": self.known_rate_out(number),
                "leaving_bounds_per_s": self.bounds_out(number),
                "proved": own.map(|_| self.proved_entry(number)),
            })
        };
        let rate = |(from, to): (usize, usize)| {
            let [lower, upper] = self.bounds(from, to);
            json!({
                "from": self.name(from),
                "to": self.name(to),
                "lower_per_s": lower,
                "value_per_s": self.known_rate(from, to),
                "upper_per_s": upper,
                "mean_first_passage_s": finite(self.mean_first_passage(from, to)),
                "first": self.first(from, to),
                "spread": finite(self.found.spread(from, to)),
            })
        };
        json!({
            "diffusion_m2_s": self.motion.diffusion,
            "kt_J": self.asked.kt,
            "drag_per_s": self.motion.drag,
            "places": (0..self.count()).map(place).collect::<Vec<_>>(),
            "rates": self.pairs().map(rate).collect::<Vec<_>>(),
            // Proved are the inequalities, not the integrals over cells.
            "bounds_hold": self.found.bounds.as_ref().map(|_| "on the mesh"),
            "bounds_leave_out": self.found.bounds.as_ref().map(|_| NOT_BOUNDED),
            "mesh": {
                "unknowns": finest.unknowns,
                "of_basins": finite(finest.of_rims).filter(|_| self.found.error().is_finite()),
                "error": finite(self.found.error()),
            },
        })
    }

    /// What is proved of how a basin is left.
    pub(crate) fn proved(&self, place: usize) -> Option<&Leaving> {
        self.found.proved[place].as_ref()
    }

    fn proved_entry(&self, place: usize) -> Value {
        let proved = self.proved(place);
        let mut entry = proved_entry(self.motion, proved.map(|proved| &proved.capacity));
        if let Some(proved) = proved {
            entry["end_below_J"] = json!(proved.end_below);
        }
        entry
    }

    /// Whether a proof was asked for.
    pub(crate) fn is_to_be_proved(&self) -> bool {
        let certify = self.asked.certify;
        certify.is_some_and(|certify| certify.pieces > 0)
    }
}
