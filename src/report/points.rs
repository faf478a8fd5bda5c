//! The points of a sweep, and their names.

use crate::csv::number;
use jobs::comparison::Assessment;
use jobs::sweep::{Outcome, Plan, Progress, Store, SweepPoint, Value};
use physics::order::Order;

/// The folder of the designs of points.
pub const DESIGNS: &str = "designs";
/// With more points than this the designs are not written.
const MOST_DESIGNS: usize = 400;
/// Keys of the design that are lengths, shown in mm.
const LENGTHS: [&str; 12] = [
    "depth",
    "width",
    "offset",
    "span",
    "side",
    "thickness",
    "pitch",
    "inset",
    "fit",
    "size",
    "x",
    "y",
];

/// A finished sweep.
#[derive(Clone, Debug)]
pub struct FinishedSweep<'a> {
    /// The plan.
    pub plan: &'a Plan,
    /// The points of the plan, in order.
    pub points: Vec<SweepPoint>,
    /// The outcome of each point.
    pub outcomes: Vec<Outcome>,
}

impl<'a> FinishedSweep<'a> {
    /// Reads the outcome of each point.
    ///
    /// # Errors
    /// The progress of the sweep, if points are missing.
    pub fn read(plan: &'a Plan, store: &Store) -> Result<Self, Progress> {
        let points = plan.points();
        let found: Vec<Option<Outcome>> = points.iter().map(|point| store.load(point)).collect();
        let progress = Progress::new(found.iter().map(Option::as_ref));
        if progress.missing > 0 {
            return Err(progress);
        }
        Ok(Self {
            plan,
            points,
            outcomes: found.into_iter().flatten().collect(),
        })
    }

    /// The numbers of done, impossible, failed and missing points.
    pub fn progress(&self) -> Progress {
        Progress::new(self.outcomes.iter().map(Some))
    }

    /// The assessment of a point, if its design is possible.
    pub fn assessment(&self, index: usize) -> Option<&Assessment> {
        match &self.outcomes[index] {
            Outcome::Done { result } => Some(result),
            Outcome::Impossible { .. } | Outcome::Failed { .. } => None,
        }
    }

    /// Why a point has no assessment.
    pub fn reason(&self, index: usize) -> Option<&str> {
        reason(&self.outcomes[index])
    }

    /// The file of a point's design beside the results; `None` if it is impossible, or needs
    /// drawings, which are elsewhere.
    pub fn design_file(&self, point: &SweepPoint) -> Option<String> {
        let needs_drawings = !self.plan.designs[point.design].drawings.is_empty();
        let possible = self.assessment(point.index).is_some() && point.text().is_some();
        let few = self.points.len() <= MOST_DESIGNS;
        (possible && few && !needs_drawings).then(|| format!("{DESIGNS}/{}.toml", point.name))
    }

    /// The name of a point by its values: `depth = 5 mm, model = dipole`; preceded by its design if
    /// there are several, or if nothing is varied.
    pub fn called(&self, point: &SweepPoint) -> String {
        let design = &self.plan.designs[point.design].name;
        let named = self.plan.designs.len() > 1 || self.plan.axes.is_empty();
        let values = self.plan.axes.iter().zip(&point.values);
        let values = values.map(|(axis, value)| {
            let name = axis.name();
            format!("{name} = {}", said(name, value))
        });
        let parts = named.then(|| design.clone()).into_iter().chain(values);
        parts.collect::<Vec<_>>().join(", ")
    }

    /// The baseline point, if one is named and was assessed.
    pub fn baseline(&self) -> Option<usize> {
        let index = self.plan.baseline_of(&self.points)?;
        self.assessment(index).map(|_| index)
    }

    /// The axes along which more than one number is varied.
    pub fn variables(&self) -> Vec<Variable> {
        let axes = self.plan.axes.iter().enumerate();
        axes.filter_map(|(axis, varied)| {
            let values: Option<Vec<f64>> = varied.values.iter().map(Value::number).collect();
            let mut values = values?;
            values.order_by(f64::total_cmp);
            values.dedup();
            (values.len() > 1).then(|| Variable {
                axis,
                key: varied.key.clone(),
                values,
            })
        })
        .collect()
    }

    /// The values that a point shares with others of its series, word by word: the design, if there
    /// are several, and the values along all axes except the given numbers.
    pub fn common(&self, point: &SweepPoint, numbers: &[Variable]) -> Common {
        let design = &self.plan.designs[point.design].name;
        let several = self.plan.designs.len() > 1;
        let design = several.then(|| ("design".to_owned(), design.clone()));
        let others = (0..self.plan.axes.len())
            .filter(|axis| numbers.iter().all(|number| number.axis != *axis));
        let others = others.map(|axis| {
            let key = self.plan.axes[axis].name().to_owned();
            let value = said(&key, &point.values[axis]);
            (key, value)
        });
        design.into_iter().chain(others).collect()
    }
}

fn reason(outcome: &Outcome) -> Option<&str> {
    match outcome {
        Outcome::Done { .. } => None,
        Outcome::Impossible { reason } | Outcome::Failed { reason } => Some(reason),
    }
}

/// Words that distinguish points, with their keys.
pub type Common = Vec<(String, String)>;

/// A varied number.
#[derive(Clone, Debug)]
pub struct Variable {
    /// The index of its axis in the plan.
    pub axis: usize,
    /// Its key in the design.
    key: String,
    /// At least two values, in ascending order.
    pub values: Vec<f64>,
}

impl Variable {
    /// The factor on the file's numbers for an axis, and the axis's name.
    pub fn shown(&self) -> (f64, String) {
        let mut parts = self.key.rsplit('.');
        let mut last = parts.next().unwrap_or_default().to_owned();
        if last.parse::<usize>().is_ok() {
            // An item of an array.
            last = format!("{} {last}", parts.next().unwrap_or_default());
        }
        let word = last.split(' ').next().unwrap_or_default();
        if LENGTHS.contains(&word) {
            (1e3, format!("{last} (mm)"))
        } else {
            (1.0, last)
        }
    }

    /// The value of a point.
    pub fn value(&self, point: &SweepPoint) -> Option<f64> {
        point.values[self.axis].number()
    }
}

/// A value with its unit, if it has one: `3 mm`.
pub(crate) fn said(key: &str, value: &Value) -> String {
    match value.number().filter(|_| LENGTHS.contains(&key)) {
        Some(metres) => format!("{} mm", number(1e3 * metres)),
        None => value.to_string(),
    }
}
