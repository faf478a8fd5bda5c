//! Rates between states and `free` as CSV.

use std::fmt::Write;

use super::{Place, Table, finite, leaving_set, mean_exit};

impl Table<'_> {
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
}
