//! Reads poses from a CSV file, and computes energy, force and torque at a pose.

use csv::{ReaderBuilder, StringRecord, Trim};

use crate::design::angle;
use crate::measured::{ANGLE, Column, LENGTH, Measured};
use crate::request::{FARTHEST, MOST_TURNED, coordinate};
use crate::text::{decimal_comma, not_too_long};
use physics::configuration::Configuration;
use physics::problem::Problem;

/// Energy, force and torque at a pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Felt {
    /// The pose of the moving tile.
    pub pose: Configuration,
    /// U (J).
    pub energy: f64,
    /// The force on the moving tile (N).
    pub force: [f64; 2],
    /// The torque on the moving tile about its reference point (N m).
    pub torque: f64,
    /// The distance between the outlines (m), see [`clearance`].
    pub clearance: f64,
    /// Whether the tiles do not overlap.
    pub is_free: bool,
}

impl Felt {
    /// Evaluates a pose.
    pub fn new(problem: &Problem, pose: &Configuration) -> Self {
        let (energy, gradient) = problem.energy_and_gradient(pose);
        Self {
            pose: *pose,
            energy,
            force: [-gradient.x, -gradient.y],
            torque: -gradient.z,
            clearance: clearance(problem, pose),
            is_free: problem.is_clear(pose),
        }
    }
}

/// The distance between the outlines (m), negative if they overlap.
pub fn clearance(problem: &Problem, pose: &Configuration) -> f64 {
    let clearance = problem.clearance(pose);
    // Tiles that touch may overlap by a rounding error.
    match problem.is_clear(pose) {
        true => clearance.max(0.0),
        false => clearance,
    }
}

/// The columns, alone or with a unit: `x_mm`, `theta_deg`.
const COLUMNS: [(&str, Measured); 3] = [("x", LENGTH), ("y", LENGTH), ("theta", ANGLE)];

/// Reads poses (m, m, rad; or with units, such as `12 mm`), one per line: the columns x, y and
/// theta if the first line names columns (others are ignored, so that pathways can be read), or
/// else three numbers. Empty lines and lines that begin with `#` are skipped.
///
/// # Errors
/// If the text is invalid; the message has the line, counted from 1.
///
/// ```
/// use tilebind_jobs::query::poses;
/// let all = poses::read("s,x,y,theta\n0,0.43,0,0\n1,44 cm,0,0\n").unwrap();
/// assert_eq!(all[1].to_array(), [0.44, 0.0, 0.0]);
/// assert_eq!(poses::read("0.43,0,0\n").unwrap().len(), 1);
/// ```
pub fn read(text: &str) -> Result<Vec<Configuration>, String> {
    let mut reader = ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .trim(Trim::All)
        .comment(Some(b'#'))
        .from_reader(text.as_bytes());
    let header = StringRecord::from(COLUMNS.map(|(name, _)| name).to_vec());
    let first = named_by(&header)?;
    let mut columns: Option<[Column; 3]> = None;
    let mut entries = 0;
    let mut poses = Vec::new();
    let mut record = StringRecord::new();
    // Reading from memory cannot fail.
    while reader.read_record(&mut record).unwrap_or(false) {
        let line = record.position().map_or(0, csv::Position::line);
        if columns.is_none() {
            let names = named(&record).map_err(|wrong| format!("line {line}: {wrong}"))?;
            columns = Some(names.unwrap_or(first));
            entries = if names.is_some() { record.len() } else { 3 };
            if names.is_some() {
                continue;
            }
        }
        let pose = not_too_long(&record, entries)
            .and_then(|()| pose(&record, columns.as_ref().unwrap_or(&first)));
        poses.push(pose.map_err(|wrong| format!("line {line}: {wrong}"))?);
    }
    if poses.is_empty() {
        return Err("it has no poses; write a line x,y,theta, then one line per pose".to_owned());
    }
    Ok(poses)
}

/// The columns of x, y and theta, if the line names columns.
fn named(record: &StringRecord) -> Result<Option<[Column; 3]>, String> {
    if record
        .iter()
        .all(|entry| coordinate(entry).is_some() || angle(entry).is_some())
    {
        return Ok(None);
    }
    named_by(record).map(Some)
}

fn named_by(record: &StringRecord) -> Result<[Column; 3], String> {
    let find = |(name, measured): (&str, Measured)| {
        let none = || format!("there is no column `{name}`; name the columns x,y,theta");
        measured.column(record, name)?.ok_or_else(none)
    };
    let [x, y, theta] = COLUMNS.map(find);
    Ok([x?, y?, theta?])
}

fn pose(record: &StringRecord, columns: &[Column; 3]) -> Result<Configuration, String> {
    let entry = |k: usize| {
        let (name, _) = COLUMNS[k];
        record
            .get(columns[k].place)
            .ok_or_else(|| format!("there is no {name}; a pose is x,y,theta"))
    };
    let wrong = |k: usize, text: &str| {
        let ((name, _), unit) = (COLUMNS[k], columns[k].unit());
        match decimal_comma(text) {
            Some(comma) => format!("{name} is `{text}`: {comma}"),
            None => format!(
                "{name} is `{text}`, which is not a number in {unit} up to \
                {FARTHEST:e}"
            ),
        }
    };
    let metres = |k: usize| {
        let text = entry(k)?;
        let found = columns[k].number(text).filter(|x| x.abs() <= FARTHEST);
        found.ok_or_else(|| wrong(k, text))
    };
    let [x, y] = [metres(0)?, metres(1)?];
    let text = entry(2)?;
    let theta = columns[2].number(text).filter(|x| x.abs() <= FARTHEST);
    let theta = theta.ok_or_else(|| wrong(2, text))?;
    if theta.abs() > MOST_TURNED {
        return Err(format!(
            "theta is `{text}`, more than two full turns (in rad): for degrees write `{theta} deg`"
        ));
    }
    Ok(Configuration::from([x, y, theta]))
}

#[cfg(test)]
mod tests {
    use super::read;

    #[test]
    fn what_is_no_pose_is_refused() {
        for (text, told) in [
            (
                "x,x,y,theta\n0,0,0,0\n",
                "line 1: the column `x` is there twice",
            ),
            (
                "x,y,x_m,theta\n0,0,0,0\n",
                "line 1: the column `x_m` is there twice",
            ),
            ("x,y\n0,0\n", "no column `theta`"),
            ("x,y,theta\n1e308,0,0\n", "line 2: x is `1e308`"),
            ("x,y,theta\n0,0,1e308\n", "line 2: theta is `1e308`"),
            (
                "0.2,0,90\n",
                "line 1: theta is `90`, more than two full turns (in rad): for degrees write `90 deg`",
            ),
        ] {
            let found = read(text).unwrap_err();
            assert!(found.contains(told), "{found}");
        }
    }
}
