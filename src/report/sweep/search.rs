//! Searches: the best point with its bounds, all points that were tried, and which key matters.

use serde_json::{Value as Json, json};

use super::search_pictures::drawings;
use super::searched::Searched;
use crate::assessments::{capture_settings, checked, merge, view};
use crate::document::{Document, Entries, PagePart, Table, rows};
use crate::page::Charts;
use crate::points::{FinishedSweep, said};
use jobs::comparison::Quantity;
use jobs::comparison::quantity::Measure;
use jobs::search::{Direction, Effect, FigureBounds, Objective, Standing, Verdict};
use jobs::sweep::{Outcome, Value};
use ordered_float::OrderedFloat;
use physics::units::{change_with, share_with, si, si_range};

/// The file of the best design.
pub const BEST: &str = "best.toml";
/// Largest number of points in the table on a terminal.
const LISTED: usize = 12;
/// Significant digits of energies.
const DIGITS: usize = 4;

impl Searched<'_> {
    /// The document of the search.
    pub fn document(&self) -> Document<'_> {
        let sweep = self.sweep();
        let names: Vec<&str> = self.plan.designs.iter().map(|d| d.name.as_str()).collect();
        let aims: Vec<String> = self
            .search
            .aim
            .objectives
            .iter()
            .map(Objective::to_string)
            .collect();
        let beside = sweep.designs();
        let mut beside: crate::files::Files = beside
            .map(|(name, text)| (name, text.as_bytes().to_vec()))
            .collect();
        if let Some(text) = self
            .best()
            .and_then(|best| self.found.tried[best].point.text())
        {
            beside.insert(BEST.to_owned(), text.as_bytes().to_vec());
        }
        let designs = (0..sweep.outcomes.len()).filter_map(|index| sweep.assessment(index));
        let notes = [self.ends(), self.method()].into_iter().flatten();
        Document {
            title: format!(
                "{}: search for the {}",
                names.join(", "),
                aims.join(" and ")
            ),
            answer: self.answer(&sweep),
            entries: self.entries(&sweep),
            part: Some(PagePart::Charts(Charts::new(&self.ranked()))),
            pictures: drawings(self),
            notes: notes.chain(checked(designs)).collect(),
            beside,
            origin: format!("seed {}; plan.json has all settings", self.plan.seed),
            ..Document::default()
        }
    }

    /// The headline.
    fn answer(&self, sweep: &FinishedSweep) -> String {
        let analysed = self.analysed();
        let describe = |index: usize| {
            let point = sweep.called(&self.found.tried[index].point);
            let figures = self.search.aim.objectives.iter().map(|one| {
                let interval = self.figure(one.quantity(), index);
                let text = interval.map_or_else(str::to_owned, |it| figure(one.quantity(), &it));
                format!("{} {text}", one.quantity().label)
            });
            format!("{point}: {}", figures.collect::<Vec<_>>().join(", "))
        };
        let Some(&first) = self.front.first() else {
            return self.nothing_fits(sweep);
        };
        if self.best().is_none() {
            let last = self.front[self.front.len() - 1];
            let count = self.front.len();
            return match count {
                1 => format!(
                    "one of {analysed} points surpasses all others: {}",
                    describe(first)
                ),
                _ => format!(
                    "{count} of {analysed} points are on the front, from {} to {}",
                    describe(first),
                    describe(last)
                ),
            };
        }
        let open = self.count(Verdict::Undecided);
        let others = self.found.tried.len() - self.count(Verdict::Impossible) - 1;
        let proof = match open {
            _ if others == 0 => String::new(),
            0 => format!(", proved better than all {others} others"),
            _ if open == others => String::from("; no bounds prove it better than others"),
            _ => format!(", proved better than all but {open} of {others} others"),
        };
        format!("best of {analysed}: {}{proof}", describe(first))
    }

    fn nothing_fits(&self, sweep: &FinishedSweep) -> String {
        let nearest = (0..self.standings.len()).filter_map(|k| match &self.standings[k] {
            Standing::Unfit {
                shortfall, reason, ..
            } => Some((*shortfall, k, reason)),
            _ => None,
        });
        match nearest.min_by_key(|(shortfall, k, _)| (OrderedFloat(*shortfall), *k)) {
            Some((_, k, reason)) => format!(
                "no point is fit; the nearest, {}: {reason}",
                sweep.called(&self.found.tried[k].point)
            ),
            None => "no point was analysed".to_owned(),
        }
    }

    /// The ends of ranges at which the best point is.
    fn ends(&self) -> Option<String> {
        let effects = self.effects();
        let at = effects.iter().filter(|one| one.ends != [false; 2]);
        let at = at.filter_map(|one| {
            let end = if one.ends[0] { "lower" } else { "upper" };
            Some(format!("{} ({end})", self.plan.axes[one.axis?].name()))
        });
        let at: Vec<String> = at.collect();
        (!at.is_empty()).then(|| {
            format!(
                "the best is at the end of the range of {}: better ones may lie beyond it",
                at.join(", ")
            )
        })
    }

    /// What was done.
    fn method(&self) -> Option<String> {
        let tried = &self.found.tried;
        let proved = tried.iter().filter(|one| one.proved.is_some()).count();
        let analysed = self.analysed();
        let impossible = match self.count(Verdict::Impossible) {
            0 => String::new(),
            1 => "; 1 design is impossible".to_owned(),
            count => format!("; {count} designs are impossible"),
        };
        let refused = match tried.iter().filter(|one| one.refused.is_some()).count() {
            0 => String::new(),
            count => format!("; {count} were refused by the energy of their bond"),
        };
        Some(format!(
            "{analysed} points were analysed without proofs, {proved} of them again with \
             proofs{refused}{impossible}"
        ))
    }

    /// The figure of a point with its bounds.
    fn figure(&self, quantity: &Quantity, index: usize) -> Result<FigureBounds, &'static str> {
        match self.found.tried[index].known() {
            Outcome::Done { result } => FigureBounds::of(quantity, result),
            Outcome::Impossible { .. } | Outcome::Failed { .. } => Err("not known"),
        }
    }

    fn effects(&self) -> Vec<Effect> {
        self.found.effects(self.search)
    }

    /// The figures of the objectives, then those of the conditions.
    fn quantities(&self) -> Vec<&'static Quantity> {
        let aim = &self.search.aim;
        let objectives = aim.objectives.iter().map(Objective::quantity);
        let conditions = aim.subject.iter().map(|one| one.quantity());
        let mut found: Vec<&Quantity> = Vec::new();
        for one in objectives.chain(conditions) {
            if found.iter().all(|known| known.key != one.key) {
                found.push(one);
            }
        }
        found
    }

    // One line an entry.
    #[rustfmt::skip]
    fn entries(&self, sweep: &FinishedSweep) -> Entries {
        let plan = &self.search.plan;
        let designs = plan.designs.iter().map(|source| json!({"name": source.name, "sha256": source.sha256}));
        let points = 0..self.found.tried.len();
        Entries::default()
            .data("tilebind", &plan.tilebind[..])
            .data("designs", designs.collect::<Json>())
            .data("axes", &plan.axes)
            .data("search", &self.search.aim)
            .data("settings", &plan.settings)
            .data("capture_range", capture_settings())
            .data("seed", plan.seed)
            .data("counts", sweep.progress())
            .data("best", self.best().map_or(Json::Null, |best| self.winner(sweep, best)))
            .data("front", self.front.iter().map(|&k| self.named(sweep, k)).collect::<Json>())
            .data("points", points.map(|k| self.entry(sweep, k)).collect::<Json>())
            .table(sweep.numbers())
            .table(self.listed(sweep))
            .table(self.what_matters())
            .table(self.together())
    }

    fn entry(&self, sweep: &FinishedSweep, index: usize) -> Json {
        let tried = &self.found.tried[index];
        let mut entry = sweep.entry(&tried.point);
        let reason = match &self.standings[index] {
            Standing::Unfit { reason, .. } => Some(reason),
            _ => None,
        };
        let more = json!({
            "verdict": self.verdicts[index].name(),
            "unfit": reason,
            "with_proofs": tried.proved.is_some(),
        });
        merge(&mut entry, more);
        entry
    }

    /// A point by its values, with the figures of the aim.
    fn named(&self, sweep: &FinishedSweep, index: usize) -> Json {
        let point = &self.found.tried[index].point;
        let axes = self.plan.axes.iter().zip(&point.values);
        let values: serde_json::Map<String, Json> = axes
            .map(|(axis, value)| (axis.key.clone(), json!(value)))
            .collect();
        let figures: serde_json::Map<String, Json> = self
            .quantities()
            .into_iter()
            .map(|quantity| {
                let bounds = match self.figure(quantity, index) {
                    Ok(it) => json!({
                        "value": it.value, "lower": it.low, "upper": it.high,
                    }),
                    Err(_) => Json::Null,
                };
                (quantity.name(""), bounds)
            })
            .collect();
        json!({
            "index": index,
            "design": self.plan.designs[point.design].name,
            "values": values,
            "figures": figures,
            "with_proofs": self.found.tried[index].proved.is_some(),
            "file": sweep.design_file(point),
        })
    }

    fn winner(&self, sweep: &FinishedSweep, best: usize) -> Json {
        let aim = &self.search.aim;
        let result = match self.found.tried[best].known() {
            Outcome::Done { result } => Some(result),
            _ => None,
        };
        let conditions = aim.subject.iter().map(|one| {
            let is_proved = result.and_then(|result| one.is_proved(result));
            json!({"condition": one.to_string(), "is_proved": is_proved == Some(true)})
        });
        let undecided =
            (0..self.verdicts.len()).filter(|&k| self.verdicts[k] == Verdict::Undecided);
        let step = |step: Option<(f64, f64)>| {
            step.map(|(value, change)| json!({"value": value, "relative_gain": change}))
        };
        let effects = self.effects();
        let sensitivity = effects.iter().filter_map(|one| {
            Some(json!({
                "key": self.plan.axes[one.axis?].key,
                "down": step(one.steps[0]),
                "up": step(one.steps[1]),
                "is_flat": one.is_flat(),
                "at_lower_end": one.ends[0],
                "at_upper_end": one.ends[1],
            }))
        });
        let directions = self.found.directions(self.search);
        let directions = directions.iter().map(|one| {
            let step = |step: Option<([f64; 2], f64)>| {
                step.map(|(values, change)| json!({"values": values, "relative_gain": change}))
            };
            json!({
                "keys": one.axes.map(|axis| &self.plan.axes[axis].key),
                "is_opposed": one.is_opposed,
                "down": step(one.steps[0]),
                "up": step(one.steps[1]),
                "is_flat": one.is_flat(),
            })
        });
        let mut entry = self.named(sweep, best);
        let more = json!({
            "file": BEST,
            "tried": self.found.tried.len(),
            "analysed": self.analysed(),
            "proved_better_than": self.count(Verdict::Worse),
            "undecided": undecided.collect::<Vec<_>>(),
            "conditions": conditions.collect::<Json>(),
            "sensitivity": sensitivity.collect::<Json>(),
            "directions": directions.collect::<Json>(),
        });
        merge(&mut entry, more);
        entry
    }

    /// The points with the figures of the aim, the best first.
    fn listed(&self, sweep: &FinishedSweep) -> Table {
        let result = |index: usize| match self.found.tried[index].known() {
            Outcome::Done { result } => Some(&**result),
            _ => None,
        };
        let mut table = rows(self.order().into_iter().map(|index| (index, result(index)))).shown(
            "point",
            "",
            |(index, _)| sweep.called(&self.found.tried[*index].point),
        );
        for quantity in self.quantities() {
            table = view(table, quantity.label, vec![quantity], |(_, one)| *one);
        }
        table
            .shown("verdict", "", |(index, _)| self.verdicts[*index].name())
            .shown("why", "", |(index, _)| self.why(sweep, *index))
            .table("")
            .in_view()
            .listing(LISTED)
    }

    fn why(&self, sweep: &FinishedSweep, index: usize) -> Option<String> {
        match &self.standings[index] {
            Standing::Unfit { reason, .. } => Some(reason.clone()),
            _ => sweep.reason(index).map(str::to_owned),
        }
    }

    /// Which key matters about the best.
    fn what_matters(&self) -> Table {
        let best = self.best();
        let effects: Vec<Effect> = self.effects();
        let name = |one: &Effect| one.axis.map(|axis| self.plan.axes[axis].key.clone());
        let own = |one: &Effect| {
            let value = &self.found.tried[best?].point.values[one.axis?];
            Some(said(self.plan.axes[one.axis?].name(), value))
        };
        let step = |side: usize| {
            move |one: &Effect| {
                let (value, change) = one.steps[side]?;
                let key = self.plan.axes[one.axis?].name();
                let value = said(key, &Value::Number(value));
                Some(format!("{value}: {}", change_with(change, 1)))
            }
        };
        let remark = |one: &Effect| match (one.ends, one.is_flat()) {
            ([true, _], _) => "at the lower end of its range",
            ([_, true], _) => "at the upper end of its range",
            (_, true) => "hardly matters here",
            _ => "",
        };
        rows(effects)
            .shown("key", "", name)
            .shown("best", "", own)
            .shown("a step down", "", step(0))
            .shown("a step up", "", step(1))
            .shown("remark", "", remark)
            .table("")
            .in_view()
            .titled(
                "What matters",
                "change of the objective by a step of one key, positive if it gets better",
            )
    }

    /// What two keys do together about the best.
    fn together(&self) -> Table {
        let directions = self.found.directions(self.search);
        let names = |one: &Direction| {
            let [first, second] = one.axes.map(|axis| self.plan.axes[axis].name());
            let sense = if one.is_opposed { "against" } else { "with" };
            format!("{first} {sense} {second}")
        };
        let step = |side: usize| {
            move |one: &Direction| {
                let (values, change) = one.steps[side]?;
                let said = |k: usize| {
                    let key = self.plan.axes[one.axes[k]].name();
                    said(key, &Value::Number(values[k]))
                };
                Some(format!(
                    "{}, {}: {}",
                    said(0),
                    said(1),
                    change_with(change, 1)
                ))
            }
        };
        let remark = |one: &Direction| {
            if one.is_flat() {
                "flat: they cancel"
            } else {
                ""
            }
        };
        rows(directions)
            .shown("keys", "", names)
            .shown("first down", "", step(0))
            .shown("first up", "", step(1))
            .shown("remark", "", remark)
            .table("")
            .in_view()
            .titled(
                "Two keys at once",
                "change of the objective by a step of both, with each other or against",
            )
    }
}

/// A figure with its bounds, for people.
pub fn figure(quantity: &Quantity, interval: &FigureBounds) -> String {
    let FigureBounds { value, low, high } = *interval;
    let one = |value: f64| match quantity.measure {
        _ if value.is_infinite() => "infinite".to_owned(),
        Measure::Energy => si(value, "J", DIGITS),
        Measure::Length => si(value, "m", DIGITS),
        Measure::Angle => format!("{:.1}\u{b0}", value.to_degrees()),
        Measure::Share => share_with(value, 1),
        Measure::Ratio => format!("{value:.3}"),
        Measure::Count => format!("{value}"),
    };
    let is_exact = low == value && high == value;
    match (low.is_finite(), high.is_finite()) {
        _ if is_exact => one(value),
        (true, true) if quantity.measure == Measure::Energy => {
            format!("{} [{}]", one(value), si_range(low, high, "J", DIGITS))
        }
        (true, true) => format!("{} [{} to {}]", one(value), one(low), one(high)),
        (true, false) => format!("{} [at least {}]", one(value), one(low)),
        (false, true) => format!("{} [at most {}]", one(value), one(high)),
        (false, false) => one(value),
    }
}
