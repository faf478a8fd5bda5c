//! The page of rates.

use serde_json::{Value, json};

use super::{Column, Fact, Page, Table as Sorted, illustrations, rate_charts};
use crate::rates::{
    AtKt, FAR, NOT_PROVED, PROVED, Place, Table, mean_exit_ends, outwards, per_second, share,
};
use physics::units::{duration, si};

impl Page {
    /// The page of rates between states and `free`.
    pub fn of_rates(table: &Table, over_kt: &[AtKt]) -> Self {
        let fact = |name: &str, value: String, note: String| Fact {
            name: name.to_owned(),
            value,
            note,
        };
        let shown = |rate: Option<f64>, digits: usize| match rate {
            Some(rate) => per_second(rate, digits),
            None => "?".to_owned(),
        };
        let free = table.places.len();
        let mut facts = vec![
            fact(
                "free tiles bind",
                shown(table.known_rate(free, 0), table.digits(free, 0)),
                "to A, by any way".to_owned(),
            ),
            fact(
                "kT",
                si(table.asked.kt, "J", 3),
                format!("drag {} /s", table.motion.drag),
            ),
            fact(
                "free",
                format!("{} apart", si(table.asked.free_at, "m", 3)),
                "centres".to_owned(),
            ),
        ];
        for (number, place) in table.places.iter().enumerate() {
            let note = match table.bounds_out(number) {
                [_, Some(0.0)] => "contact blocks every way".to_owned(),
                [Some(lower), Some(upper)] => {
                    let [lower, upper] = outwards([lower, upper]).map(|end| per_second(end, 3));
                    format!("between {lower} and {upper}")
                }
                [_, Some(upper)] => format!("at most {}", per_second(outwards([0.0, upper])[1], 3)),
                _ => "no bounds".to_owned(),
            };
            let name = format!("{} is left", place.name);
            facts.insert(
                number,
                fact(
                    &name,
                    shown(table.known_rate_out(number), table.digits_out(number)),
                    note,
                ),
            );
        }
        let pictures = rate_charts::all(table, over_kt);
        let mut tables = vec![of_pairs(table), of_places(table)];
        if table.is_to_be_proved() {
            tables.insert(1, of_proofs(table));
        }
        Self {
            subtitle: table.headline(),
            facts,
            pictures: illustrations(pictures),
            tables,
            origin: format!(
                "tilebind {}; {} magnets; overdamped motion at drag {} per s, reflected by contact; \
                 bounds hold on the mesh, what its integrals are off by is not in them; no kT where \
                 drag is less than 50 per s or knocks take energy",
                env!("CARGO_PKG_VERSION"),
                table.design.interaction.model.name(),
                table.motion.drag,
            ),
            ..Self::titled(format!("Rates of {}", table.design.name))
        }
    }
}

fn column(name: &str, unit: &'static str) -> Column {
    Column {
        meaning: "",
        name: name.to_owned(),
        unit,
    }
}

fn sorted(title: &str, note: &str, columns: Vec<Column>, rows: Vec<Vec<Value>>) -> Sorted {
    Sorted {
        title: title.to_owned(),
        note: note.to_owned(),
        columns,
        rows,
        states: Vec::new(),
        paths: Vec::new(),
    }
}

fn of_pairs(table: &Table) -> Sorted {
    let shown = |rate: Option<f64>, digits: usize| match rate {
        Some(rate) => json!([rate, per_second(rate, digits)]),
        None => Value::Null,
    };
    let row = |(from, to): (usize, usize)| {
        let [lower, upper] = table.bounds(from, to);
        let lower = lower.map(|lower| outwards([lower, lower])[0]);
        let upper = upper.map(|upper| outwards([upper, upper])[1]);
        let digits = table.digits(from, to);
        let time = table.mean_first_passage(from, to);
        vec![
            json!(table.name(from)),
            json!(table.name(to)),
            shown(lower, 3),
            shown(table.known_rate(from, to), digits),
            shown(upper, 3),
            json!(table.first(from, to)),
            match time.is_finite() {
                true => json!([time, duration(time, digits)]),
                false => Value::Null,
            },
        ]
    };
    let columns = vec![
        column("from", ""),
        column("to", ""),
        column("at least", ""),
        column("rate", ""),
        column("at most", ""),
        column("comes first", "%"),
        column("mean first passage", ""),
    ];
    let rows = table.pairs().map(row).collect();
    sorted("Rates", "from a basin or free to another", columns, rows)
}

/// What is proved of how basins are left, beside what the mesh has.
fn of_proofs(table: &Table) -> Sorted {
    let shown =
        |end: Option<(f64, String)>| end.map_or(Value::Null, |(time, words)| json!([time, words]));
    let below = |limit: f64| json!([limit, format!("U < {}", si(limit, "J", 4))]);
    let row = |(number, place): (usize, &Place)| {
        let leaving = table.proved(number);
        let ends = leaving.map(|it| mean_exit_ends(table.motion, &it.capacity));
        let [least, most] = ends.unwrap_or_default().map(shown);
        let time = table.known_rate_out(number).map(|rate| 1.0 / rate);
        let time = time.map(|time| (time, duration(time, table.digits_out(number))));
        vec![
            json!(place.name),
            least,
            shown(time),
            most,
            leaving.map_or(Value::Null, |it| below(it.capacity.below)),
            leaving.map_or(Value::Null, |it| below(it.end_below)),
        ]
    };
    let rows: Vec<_> = table.places.iter().enumerate().map(row).collect();
    let columns = vec![
        column("from", ""),
        column("proved: at least", ""),
        column("on the mesh", ""),
        column("proved: at most", ""),
        column("its set", ""),
        column("as an end", ""),
    ];
    let is_known = |number: usize| table.proved(number).is_some();
    let note = match (0..table.places.len()).any(is_known) {
        true => format!(
            "{PROVED}: mean time until a tile that leaves a basin for another or free tiles is \
             there; no upper bound where it would be {FAR} times the lower one or more"
        ),
        false => NOT_PROVED.replace("\n ", ""),
    };
    sorted("Proved", &note, columns, rows)
}

fn of_places(table: &Table) -> Sorted {
    let occupation = &table.found.finest().occupation;
    let row = |(number, part): (usize, &f64)| {
        let own = table.places.get(number);
        vec![
            json!(table.name(number)),
            json!(own.map(|place| place.copies)),
            table
                .known_share(number, *part)
                .map_or(Value::Null, |part| json!([part, share(part)])),
            json!(own.map(|place| place.energy)),
            match own {
                Some(place) => json!([place.below, format!("U < {}", si(place.below, "J", 4))]),
                None => json!([0.0, format!("{} apart", si(table.asked.free_at, "m", 4))]),
            },
        ]
    };
    let columns = vec![
        column("place", ""),
        column("copies", ""),
        column("share of all time", ""),
        column("energy", "J"),
        column("its set", ""),
    ];
    let rows = occupation.iter().enumerate().map(row).collect();
    sorted(
        "Places and occupation",
        "a set of configurations",
        columns,
        rows,
    )
}
