//! Comparisons of designs as documents.

use std::fmt::Write;

use serde_json::{Map, Value, json};

use crate::assessments::{capture_settings, checked, merge, numbers, quantities, tables, views};
use crate::document::{Document, Drawing, Entries, Table, rows};
use crate::figures::{WHY_NOT_HEAD_ON, cell, misses_head_on};
use crate::files::{PAGE, REPORT};
use crate::plots::{Figure, PictureError, Sheet, ranking as picture};
use jobs::comparison::quantity::{CERTIFIED, NOT_HEAD_ON, QUANTITIES, placed};
use jobs::comparison::{Assessment, Quantity, Thoroughness, capture_range, ranking};
use jobs::output::Command;
use physics::landscape::minimax::Ordering;
use physics::units::{counted, share_to};

/// The files of the command.
pub const FILES: Command = Command {
    name: "compare",
    files: &[REPORT, PAGE, "compare.csv", "compare.md"],
    pictures: &["ranking"],
};

/// Designs in the order of a ranking.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// Best first.
    pub designs: Vec<Assessment>,
    /// The figure of the ranking.
    pub by: &'static Quantity,
    /// The settings of the assessments.
    pub settings: Thoroughness,
}

impl Comparison {
    /// Designs ranked by a figure.
    pub fn new(designs: &[Assessment], by: &'static Quantity, settings: Thoroughness) -> Self {
        let order = ranking::ranked_for_use(designs, by);
        Self {
            designs: order.into_iter().map(|i| designs[i].clone()).collect(),
            by,
            settings,
        }
    }

    /// The document of the comparison.
    pub fn document(&self) -> Document<'_> {
        let seed = self.designs.first().map_or(0, |first| first.seed);
        let mut document = Document {
            title: format!("Comparison of {} designs", self.designs.len()),
            answer: self.headline(),
            entries: self.entries(),
            pictures: vec![Drawing::new(
                format!("Ranked by {}", self.by.label),
                |sheet| self.picture(sheet),
            )],
            notes: self.notes(),
            origin: format!("seed {seed}"),
            ..Document::default()
        };
        let markdown = document.markdown();
        document
            .beside
            .insert("compare.md".to_owned(), markdown.into_bytes());
        document
    }

    /// Its picture.
    ///
    /// # Errors
    /// See [`PictureError`].
    pub fn picture(&self, sheet: &Sheet) -> Result<Figure, PictureError> {
        picture::draw(&self.designs, self.by, self.table().csv(), sheet)
    }

    fn entries(&self) -> Entries {
        let mut all = Entries::default()
            .data("tilebind", env!("CARGO_PKG_VERSION"))
            .data("ranked_by", self.by.key)
            .data("settings", &self.settings)
            .data("capture_range", capture_settings())
            .data("designs", self.designs())
            .data("certified_order", self.proved())
            .table(self.table());
        for number in 0..tables() {
            let named = rows(&self.designs).shown("design", "best first", |one| self.name(one));
            all = all.table(views(named, number, |one| Some(one)).table("").in_view());
        }
        for (name, one, told) in self.firsts() {
            all = all.fact("", name, one).in_view().noted(told);
        }
        all.table(self.orders())
    }

    /// The headline: which design is best, and of how many.
    fn headline(&self) -> String {
        let docking = self.designs.iter().filter(|one| one.obstacle().is_none());
        let of = counted(self.designs.len(), "design");
        let of = match self.model() {
            Some(model) => format!("{of}, magnets as {model}"),
            None => of,
        };
        match self.designs.first() {
            Some(best) if docking.count() > 0 => {
                let among = self.designs.iter().filter(|one| one.obstacle().is_none());
                let told = match &self.not_below(best, among, self.by)[..] {
                    [] => format!(
                        "{} is first with {}",
                        self.name(best),
                        cell(&[self.by], best)
                    ),
                    others => format!("undecided between {}", self.describe(best, others, self.by)),
                };
                format!("{of}, ranked by {}: {told}", self.by.label)
            }
            _ => format!("{of}, ranked by {}: none reaches its bond", self.by.label),
        }
    }

    /// Notes: why designs are last, and what the figures mean.
    fn notes(&self) -> Vec<String> {
        let behind = |one: &Assessment| {
            let (_, why) = one.obstacle()?;
            Some(format!(
                "{} is ranked below all designs that dock: {why}",
                self.name(one)
            ))
        };
        let mut notes: Vec<String> = self.designs.iter().filter_map(behind).collect();
        notes.push(format!(
            "brackets: certified bounds; percentages: of {} far starts, with 95 % intervals; \
             offset, gap and tilt: how misaligned a tile touching head-on may be and still slide \
             downhill into the bond, to within {} of its depth",
            self.settings.survey.far_starts.unwrap_or(0),
            share_to(capture_range::ENERGY_SHARE, 1),
        ));
        if self.designs.iter().any(has_estimates) {
            notes.push(ESTIMATES.to_owned());
        }
        notes.extend(self.unlisted());
        if self.designs.iter().any(misses_head_on) {
            notes.push(format!("{NOT_HEAD_ON}: {WHY_NOT_HEAD_ON}"));
        }
        notes.extend(checked(self.designs.iter()));
        notes
    }

    /// The note on the column of unlisted states, where it has any number.
    fn unlisted(&self) -> Option<String> {
        let column = QUANTITIES.iter().find(|it| it.key == "unlisted_depth")?;
        let heading = column.column?.heading;
        let is_known = self.designs.iter().any(|one| column.of(one).is_some());
        is_known.then(|| format!("column \"{heading}\": {UNLISTED}"))
    }

    /// A design's name, with the model if models differ.
    pub fn name(&self, design: &Assessment) -> String {
        match self.model() {
            Some(_) => design.name.clone(),
            None => format!("{} ({})", design.name, design.model),
        }
    }

    /// The kind of all magnets, such as `dipoles` or `blocks`; `None` if models differ.
    fn model(&self) -> Option<&str> {
        let first = &self.designs.first()?.model;
        let same = self.designs.iter().all(|design| design.model == *first);
        let mut others = self.designs.iter().map(|design| &design.magnets);
        let magnets = others.next()?;
        same.then(|| match others.all(|other| other == magnets) {
            true => magnets,
            false => "blocks and discs",
        })
    }

    /// The main figures, and for each the design with the largest value.
    fn firsts(&self) -> Vec<(String, String, String)> {
        let best = QUANTITIES.iter().filter(|quantity| quantity.most.is_some());
        let best = best.filter(|it| !it.is_left_out(self.designs.iter()));
        let mut firsts: Vec<(String, String, String)> = Vec::new();
        for quantity in std::iter::once(self.by).chain(best) {
            let highest = || format!("highest {}", quantity.label);
            let name = quantity.most.map_or_else(highest, str::to_owned);
            let order = ranking::ranked(&self.designs, quantity);
            let first = order.first().map(|first| &self.designs[*first]);
            let known = first.filter(|first| quantity.of(first).is_some());
            if let Some(first) = known
                && firsts.iter().all(|(other, ..)| *other != name)
            {
                let others = self.not_below(first, self.designs.iter(), quantity);
                firsts.push(match &others[..] {
                    [] => (name, self.name(first), cell(&[quantity], first)),
                    others => {
                        let told = self.describe(first, others, quantity);
                        (name, "undecided".to_owned(), format!("between {told}"))
                    }
                });
            }
        }
        firsts
    }

    /// Those of some designs of which it is not known that they have less of a figure than the first
    /// one: bounds overlap or are not known, or numbers are the same.
    fn not_below<'a>(
        &self,
        first: &Assessment,
        among: impl Iterator<Item = &'a Assessment>,
        quantity: &Quantity,
    ) -> Vec<&'a Assessment> {
        let of_first = quantity.of(first);
        let is_not_below = |one: &&Assessment| {
            let (Some(most), Some(other)) = (of_first, quantity.of(one)) else {
                return false;
            };
            match quantity.bounds {
                CERTIFIED => ranking::order(first, one, quantity) != Ordering::Higher,
                Some(_) => most.low <= other.high,
                None => other.value >= (1.0 - 1e-6) * most.value,
            }
        };
        let others = among.filter(|one| !std::ptr::eq(*one, first));
        others.filter(is_not_below).collect()
    }

    /// Two designs of which it is not known which has more of a figure, and how many others.
    fn describe(&self, first: &Assessment, others: &[&Assessment], quantity: &Quantity) -> String {
        let describe = |one| format!("{} with {}", self.name(one), cell(&[quantity], one));
        let more = match others.len() {
            ..2 => String::new(),
            count => format!(" and {} more", count - 1),
        };
        format!("{} and {}{more}", describe(first), describe(others[0]))
    }

    /// Figures with bounds, and the designs from the highest to the lowest: `a > b ~ c`.
    fn orders(&self) -> Table {
        let mut orders = Vec::new();
        for (heading, quantity) in ordered() {
            let order = ranking::ranked(&self.designs, quantity).into_iter();
            let order = order.map(|i| &self.designs[i]);
            let bounded = |one: &&Assessment| quantity.of(one).is_some_and(|e| e.low.is_some());
            let known: Vec<&Assessment> = order.filter(bounded).collect();
            if known.len() < 2 {
                continue;
            }
            let mut line = self.name(known[0]);
            for pair in known.windows(2) {
                let sign = match ranking::order(pair[0], pair[1], quantity) {
                    Ordering::Higher => ">",
                    Ordering::Lower | Ordering::Undecided => "~",
                };
                let _ = write!(line, " {sign} {}", self.name(pair[1]));
            }
            orders.push((heading, line));
        }
        rows(orders)
            .shown("figure", "", |(figure, _)| *figure)
            .shown("highest first", "", |(_, line)| line.clone())
            .table("")
            .titled(
                "Certified order",
                "> proved for the stated model, ~ undecided: bounds overlap",
            )
            .in_view()
    }

    /// One row per design, best first.
    pub fn table(&self) -> Table {
        let ranked = rows(self.designs.iter().zip(1_usize..))
            .data("rank", |(_, rank)| *rank)
            .data("name", |(one, _)| one.name.clone())
            .data("model", |(one, _)| one.model.clone());
        numbers(ranked, |(one, _)| Some(*one))
            .table("compare")
            .in_csv("compare")
    }

    fn designs(&self) -> Value {
        let designs = self.designs.iter().enumerate();
        let entry = |(k, design): (usize, &Assessment)| {
            let mut entry = json!({"rank": k + 1});
            merge(&mut entry, json!(design));
            merge(&mut entry, json!({"quantities": quantities(design)}));
            entry
        };
        designs.map(entry).collect()
    }

    /// For each figure the pairs of designs whose order is proved, by their indices in the ranking.
    fn proved(&self) -> Value {
        let mut all = Map::new();
        for (_, quantity) in ordered() {
            let mut pairs = Vec::new();
            for (i, a) in self.designs.iter().enumerate() {
                for (j, b) in self.designs.iter().enumerate() {
                    if ranking::order(a, b, quantity) == Ordering::Higher {
                        pairs.push(json!({
                            "higher": a.name, "higher_rank": i + 1,
                            "lower": b.name, "lower_rank": j + 1,
                        }));
                    }
                }
            }
            all.insert(quantity.key.to_owned(), Value::Array(pairs));
        }
        Value::Object(all)
    }
}

/// The note on traps that were not found.
const UNLISTED: &str = "proved that no missed state is deeper than this and needs more than 0.5 % \
    of the bond to escape";
/// The note on barriers without proved bounds.
const ESTIMATES: &str = "barriers without brackets are roadmap estimates: too high if the roadmap \
    missed a passage";

/// Whether a shown barrier has no proved bounds.
fn has_estimates(design: &Assessment) -> bool {
    let is_estimate = |quantity: &&Quantity| {
        let estimate = quantity.of(design);
        quantity.bounds == CERTIFIED
            && estimate.is_some_and(|e| e.low.is_none() && e.value.is_finite())
    };
    QUANTITIES.iter().any(|quantity| is_estimate(&quantity))
}

/// The quantities whose order can be proved, with their headings in the tables.
fn ordered() -> impl Iterator<Item = (&'static str, &'static Quantity)> {
    let certified = |quantity: &Quantity| quantity.column.filter(|_| quantity.bounds == CERTIFIED);
    let places = placed(certified).into_iter();
    places.flat_map(|(place, shared)| shared.into_iter().map(move |one| (place.heading, one)))
}
