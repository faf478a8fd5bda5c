//! Rates between states and `free` in a few lines.

use std::fmt::Write;

use super::{
    NO_BOUNDS, NOT_PROVED, ON_THE_MESH, ONE_SIDED, PROVED, SCOPE, Table, apart, mean_exit_words,
    outwards, per_second, share,
};
use crate::terminal::write_table;
use physics::kinetics::Way;
use physics::kinetics::bond::LEAST_DEPTH;
use physics::units::{plain, si};

/// Meshes that differ by this share say nothing of a rate.
const UNSETTLED: f64 = 0.5;
/// Upper bounds that are so many times too high by what lies outside of basins are told why.
const MOSTLY: f64 = 1.5;

impl Table<'_> {
    /// What was asked, in a line.
    pub(crate) fn headline(&self) -> String {
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
        if (0..self.places.len()).all(|number| self.bounds_out(number)[1] == Some(0.0)) {
            // That contact blocks every way is proved apart from any mesh.
            text.push_str(SCOPE);
            return text;
        }
        if bounds.are_one_sided() {
            let told = (0..self.places.len()).map(|number| {
                let name = self.name(number);
                match self.bounds_out(number)[1] {
                    Some(0.0) => format!("{name} never"),
                    Some(upper) => {
                        format!(
                            "{name} at most {}",
                            per_second(outwards([0.0, upper])[1], 3)
                        )
                    }
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
