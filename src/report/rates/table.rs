//! Rates between states and `free`.

use std::fmt::Write;

use nalgebra::DMatrix;
use serde_json::{Value, json};

use super::{
    Motion, NO_BOUNDS, NOT_BOUNDED, NOT_PROVED, ON_THE_MESH, ONE_SIDED, PROVED, Place, SCOPE,
    apart, digits, finite, leaving_set, mean_exit, mean_exit_words, per_second, proved_entry,
    share,
};
use crate::design::Design;
use crate::kinetics::Way;
use crate::kinetics::bond::LEAST_DEPTH;
use crate::kinetics::chain::Chain;
use crate::kinetics::rates::{Leaving, RateSettings, Rates};
use crate::report::terminal::write_table;
use crate::report::values;
use crate::units::{plain, si};

/// Meshes that differ by this share say nothing of a rate.
const UNSETTLED: f64 = 0.5;
/// Upper bounds that are so many times too high by what lies outside of basins are told why.
const MOSTLY: f64 = 1.5;

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
    pub(in crate::report) fn count(&self) -> usize {
        self.places.len() + 1
    }

    pub(in crate::report) fn name(&self, place: usize) -> &str {
        self.places.get(place).map_or("free", |place| &place.name)
    }

    /// Rate (1/s) from one place to another, where anything is known of it.
    pub(in crate::report) fn known_rate(&self, from: usize, to: usize) -> Option<f64> {
        let is_known = self.found.is_known(from, to);
        is_known.then(|| self.rate(from, to))
    }

    /// Rate (1/s) out of a place, where anything is known of it.
    pub(in crate::report) fn known_rate_out(&self, from: usize) -> Option<f64> {
        let is_known = self.found.is_known_out(from);
        is_known.then(|| self.rate_out(from))
    }

    /// A share of time spent in or about a place, where anything is known of it: a basin without a way
    /// may be one between contacts that the mesh has no cell in.
    pub(in crate::report) fn known_share(&self, place: usize, part: f64) -> Option<f64> {
        let is_known = place == self.places.len() || self.found.ways[place] != Way::Lost;
        is_known.then_some(part)
    }

    /// The probability that one place is the first that is reached from another.
    pub(in crate::report) fn first(&self, from: usize, to: usize) -> Option<f64> {
        finite(self.known_rate(from, to)? / self.known_rate_out(from)?)
    }

    /// Rate (1/s) from one place to another, 0 where no way is known.
    pub(in crate::report) fn rate(&self, from: usize, to: usize) -> f64 {
        self.found.finest().rates[from][to] * self.motion.diffusion
    }

    pub(in crate::report) fn rate_out(&self, from: usize) -> f64 {
        (0..self.count()).map(|to| self.rate(from, to)).sum()
    }

    /// How many digits of a rate are known, as far as meshes tell.
    pub(in crate::report) fn digits(&self, from: usize, to: usize) -> usize {
        let spread = finite(self.found.spread(from, to)).unwrap_or(0.0);
        digits(spread.max(self.found.error()))
    }

    /// How many digits of the rate out of a place are known: as many as of the largest that it is made
    /// of.
    pub(in crate::report) fn digits_out(&self, from: usize) -> usize {
        let others = (0..self.count()).filter(|to| *to != from);
        let largest = others.max_by(|a, b| self.rate(from, *a).total_cmp(&self.rate(from, *b)));
        largest.map_or(1, |to| self.digits(from, to))
    }

    /// Bounds (1/s) of the rate from one place to another, where there are any.
    pub(in crate::report) fn bounds(&self, from: usize, to: usize) -> [Option<f64>; 2] {
        self.scaled(
            self.found
                .bounds
                .as_ref()
                .map(|bounds| bounds.rates[from][to]),
        )
    }

    /// Bounds (1/s) of the rate out of a place, where there are any.
    pub(in crate::report) fn bounds_out(&self, from: usize) -> [Option<f64>; 2] {
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
    pub(in crate::report) fn mean_first_passage(&self, from: usize, to: usize) -> f64 {
        let rate = |i: usize, j: usize| self.rate(i, j);
        let chain = Chain::new(DMatrix::from_fn(self.count(), self.count(), rate));
        chain.mean_times(&[to])[from]
    }

    /// Every two places, from and to.
    pub(in crate::report) fn pairs(&self) -> impl Iterator<Item = (usize, usize)> {
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
    pub(in crate::report) fn proved(&self, place: usize) -> Option<&Leaving> {
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
    pub(in crate::report) fn is_to_be_proved(&self) -> bool {
        let certify = self.asked.certify;
        certify.is_some_and(|certify| certify.pieces > 0)
    }

    /// proved.csv, where a proof was asked for: bounds of how each basin is left for any other or
    /// free tiles; empty where there are none.
    pub fn proved_csv(&self) -> Option<String> {
        if !self.is_to_be_proved() {
            return None;
        }
        let mut text =
            "from,set_below_J,others_below_J,free_at_m,mean_exit_lower_s,mean_exit_upper_s,\
                        sets_out_lower_per_s,sets_out_upper_per_s\n"
                .to_owned();
        for (number, place) in self.places.iter().enumerate() {
            let Some(proved) = self.proved(number) else {
                let _ = writeln!(text, "{},,,{},,,,", place.name, self.asked.free_at);
                continue;
            };
            let shown = |end: f64| finite(end).map_or(String::new(), |end| format!("{end:.9e}"));
            let others = (0..self.places.len()).filter(|other| *other != number);
            let others = others.filter_map(|other| Some(shown(self.proved(other)?.end_below)));
            let [least, most] = mean_exit(self.motion, &proved.capacity).map(shown);
            let [lower, upper] = leaving_set(self.motion, &proved.capacity).map(shown);
            let _ = writeln!(
                text,
                "{},{:.9e},{},{},{least},{most},{lower},{upper}",
                place.name,
                proved.capacity.below,
                others.collect::<Vec<_>>().join(" "),
                self.asked.free_at,
            );
        }
        Some(text)
    }

    /// rates.csv: bounds are empty where none are known.
    pub fn rates_csv(&self) -> String {
        let mut text = "from,to,lower_per_s,value_per_s,upper_per_s,spread,first,mean_first_passage_s,from_basin_J,\
                        to_basin_J,free_at_m,bounds_hold\n"
            .to_owned();
        let limit = |place: usize| {
            let below = self.places.get(place).map(|place| place.below);
            below.map_or(String::new(), |below| format!("{below:.9e}"))
        };
        for (from, to) in self.pairs() {
            let [lower, upper] = self
                .bounds(from, to)
                .map(|end| end.map_or(String::new(), |end| format!("{end:.6e}")));
            let shown = |value: Option<f64>| {
                let value = value.filter(|value| value.is_finite());
                value.map_or(String::new(), |value| format!("{value:.6e}"))
            };
            let spread = finite(self.found.spread(from, to));
            let _ = writeln!(
                text,
                "{},{},{lower},{},{upper},{},{},{},{},{},{},{}",
                self.name(from),
                self.name(to),
                shown(self.known_rate(from, to)),
                spread.map_or(String::new(), |spread| format!("{spread:.1e}")),
                shown(self.first(from, to)),
                shown(Some(self.mean_first_passage(from, to))),
                limit(from),
                limit(to),
                self.asked.free_at,
                self.found.bounds.as_ref().map_or("", |_| "on the mesh"),
            );
        }
        text
    }

    /// occupation.csv: shares of all time on the design's table.
    pub fn occupation_csv(&self) -> String {
        let mut text = "place,copies,occupation,energy_J,basin_J,free_at_m,inside\n".to_owned();
        for (number, share) in self.found.finest().occupation.iter().enumerate() {
            let shown = |part: f64| {
                let known = self.known_share(number, part);
                known.map_or(String::new(), |part| format!("{part:.6e}"))
            };
            let (name, inside) = (self.name(number), shown(self.found.inside[number]));
            let share = shown(*share);
            let _ = match self.places.get(number) {
                Some(Place {
                    copies,
                    energy,
                    below,
                    ..
                }) => writeln!(
                    text,
                    "{name},{copies},{share},{energy:.9e},{below:.9e},,{inside}"
                ),
                None => writeln!(text, "{name},,{share},,,{},{inside}", self.asked.free_at),
            };
        }
        text
    }

    /// What was asked, in a line.
    pub(in crate::report) fn headline(&self) -> String {
        let free = self.places.len();
        let [width, height] = self.design.space().half_size.map(|half| 2.0 * half);
        let table = format!("on a table of {width} by {height} m");
        match (self.known_rate(free, 0), self.known_rate_out(0)) {
            (Some(0.0), Some(0.0)) => {
                "no tile ever binds or comes off: contact blocks every way".to_owned()
            }
            (Some(on), Some(off)) => format!(
                "free tiles bind at {} and the bond is left at {}, {table}",
                per_second(on, self.digits(free, 0)),
                per_second(off, self.digits_out(0)),
            ),
            _ => "no way into the bond was found, so that nothing is known of how fast tiles bind or \
                  come off"
                .to_owned(),
        }
    }

    /// The rates in a few lines.
    pub fn summary(&self) -> String {
        let mut text = format!("{}: {}\n", self.design.name, self.headline());
        let _ = writeln!(
            text,
            "  kT = {}, drag {} /s: D = {}",
            si(self.asked.kt, "J", 4),
            self.motion.drag,
            si(self.motion.diffusion, "m²/s", 4),
        );
        let mut rows = vec![vec!["from".to_owned()]];
        rows[0].extend((0..self.count()).map(|to| format!("to {}", self.name(to))));
        rows[0].extend(["occupation", "basin"].map(str::to_owned));
        for from in 0..self.count() {
            let mut row = vec![self.name(from).to_owned()];
            row.extend((0..self.count()).map(|to| match from == to {
                true => "-".to_owned(),
                false => self.known_rate(from, to).map_or("?".to_owned(), |rate| {
                    per_second(rate, self.digits(from, to))
                }),
            }));
            let occupation = self.known_share(from, self.found.finest().occupation[from]);
            row.push(occupation.map_or("?".to_owned(), share));
            row.push(match self.places.get(from) {
                Some(place) => format!("U < {}", si(place.below, "J", 4)),
                None => format!("{} apart", si(self.asked.free_at, "m", 4)),
            });
            rows.push(row);
        }
        write_table(&mut text, &rows);
        let spreads = self.pairs().map(|(i, j)| self.found.spread(i, j));
        let worst = spreads
            .filter(|spread| spread.is_finite())
            .fold(0.0, f64::max);
        let unknowns = self.found.finest().unknowns;
        let _ = match self.found.error() {
            error if error.is_finite() => writeln!(
                text,
                "  the two finest meshes ({unknowns} unknowns) differ by {} % at most; estimated error \
                 of flows {:.1} %",
                plain(100.0 * worst, 2),
                100.0 * error,
            ),
            _ => writeln!(text, "  nothing flows on the mesh ({unknowns} unknowns)"),
        };
        if worst > UNSETTLED {
            let _ = writeln!(
                text,
                "  rates that differ that much are unknown: their spread stands in rates.csv"
            );
        }
        let inside = self.found.inside.iter().enumerate();
        let inside = inside.map(|(place, part)| {
            let known = self.known_share(place, *part);
            format!(
                "{} {}",
                self.name(place),
                known.map_or("?".to_owned(), share)
            )
        });
        let _ = writeln!(
            text,
            "  occupation shares out by committors what lies between; inside alone: {}",
            inside.collect::<Vec<_>>().join(", "),
        );
        let kt = self.asked.kt;
        let shallow = self
            .places
            .iter()
            .filter(|place| -place.energy < LEAST_DEPTH * kt);
        for place in shallow {
            let _ = writeln!(
                text,
                "  {} is less than {LEAST_DEPTH} kT deep and holds nothing: these rates tell how often \
                 its set is passed through",
                place.name
            );
        }
        for (place, way) in self.places.iter().zip(&self.found.ways) {
            if *way != Way::Open {
                let _ = writeln!(text, "  {}: {}", place.name, way.told());
            }
        }
        let Some(bounds) = &self.found.bounds else {
            let _ = writeln!(text, "  {NO_BOUNDS}");
            text.push_str(SCOPE);
            return text;
        };
        if bounds.are_one_sided() {
            let told = (0..self.places.len()).map(|number| {
                let name = self.name(number);
                match self.bounds_out(number)[1] {
                    Some(upper) => format!("{name} at most {}", per_second(upper, 3)),
                    None => format!("{name} unknown"),
                }
            });
            let told = told.collect::<Vec<_>>().join(", ");
            let _ = writeln!(text, "  left: {told};");
            if let Some((name, inside, all)) = self.mostly_outside() {
                let _ = writeln!(
                    text,
                    "  these count as {name}'s time what is spent inside its basin, {} of all, where \
                     its occupation is {}:\n  how much of what lies between places is its own nothing \
                     bounds here",
                    share(inside),
                    share(all),
                );
            }
            let _ = writeln!(text, "  {ONE_SIDED};\n  {ON_THE_MESH}");
            self.tell_proved(&mut text);
            text.push_str(SCOPE);
            return text;
        }
        let wells = self.places.iter().zip(&bounds.leaving);
        let told = wells.map(|(place, ends)| format!("{} {}", place.name, apart(*ends)));
        let _ = writeln!(
            text,
            "  bounds of the rates out are apart by: {}; of every rate in rates.csv;\n  {ON_THE_MESH}",
            told.collect::<Vec<_>>().join(", "),
        );
        self.tell_proved(&mut text);
        text.push_str(SCOPE);
        text
    }

    /// The first basin that has most of its occupation outside of it: its name, what is spent inside,
    /// and the occupation. Upper bounds of rates that count the inside only say little then.
    fn mostly_outside(&self) -> Option<(&str, f64, f64)> {
        let shares = |number: usize| {
            let all = self.found.finest().occupation[number];
            (self.name(number), self.found.inside[number], all)
        };
        let mut places = (0..self.places.len()).map(shares);
        places.find(|(_, inside, all)| MOSTLY * inside < *all)
    }

    /// What is proved, if that was asked for.
    fn tell_proved(&self, text: &mut String) {
        if !self.is_to_be_proved() {
            return;
        }
        let known = |number: usize| Some((&self.places[number], self.proved(number)?));
        let known: Vec<_> = (0..self.places.len()).filter_map(known).collect();
        if known.is_empty() {
            let _ = writeln!(text, "  {NOT_PROVED}");
            return;
        }
        let _ = writeln!(
            text,
            "  {PROVED}: mean time until a tile that leaves a basin\n  for another or free tiles is \
             there:"
        );
        for (place, proved) in &known {
            let _ = writeln!(
                text,
                "    {} (U < {}; as an end U < {}): {}",
                place.name,
                si(proved.capacity.below, "J", 4),
                si(proved.end_below, "J", 4),
                mean_exit_words(self.motion, &proved.capacity),
            );
        }
        if known.len() < self.places.len() {
            let _ = writeln!(text, "    of the others nothing");
        }
    }
}
