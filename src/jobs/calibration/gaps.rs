//! Reads the forces between two tiles over the gap of their target faces, as measured on a scale.

use csv::StringRecord;

use super::lines::records;
use crate::design::units::{self, Units};
use crate::text::{decimal_comma, not_too_long};

/// Largest gap (m) and force (N) of a reading.
const MOST: [f64; 2] = [10.0, 1e6];

/// What is read: the column, its units, and how to write it.
const COLUMNS: [(&str, Units, &str); 2] = [
    (
        "gap",
        units::LENGTH,
        "gap_mm, gap_cm, gap_m or gap_in; or `gap` with values such as 1.5 mm",
    ),
    (
        "force",
        units::FORCE,
        "force_g, force_kg, force_N or force_lb; or `force` with values such as 120 g",
    ),
];

/// A reading: the force that pulls the tiles straight apart, or pushes them together, at a gap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Its line in the file.
    pub line: usize,
    /// The gap between the target faces (m).
    pub gap: f64,
    /// The force (N), positive whichever way it acts.
    pub force: f64,
    /// The place value of its last digit (N), below which nothing is known of it.
    pub resolution: f64,
}

/// A column of the file: where it is, and how many of its unit make one of the SI's, if its name has
/// a unit.
#[derive(Clone, Copy)]
struct Column {
    place: usize,
    factor: Option<f64>,
}

/// Reads a table of gaps and forces. Lines without entries and lines that begin with `#` are
/// skipped.
///
/// # Errors
/// If a line cannot be read, a gap is there twice with forces of both signs, or there is no reading:
/// what is wrong, where, and how to write it.
pub fn read(text: &str) -> Result<Vec<Reading>, String> {
    let mut records = records(text);
    let names = "the first line must name two columns, such as gap_mm,force_g";
    let (line, header) = records
        .next()
        .ok_or_else(|| format!("the file is empty; {names}"))?;
    let columns = columns(&header).map_err(|wrong| format!("line {line}: {wrong}"))?;
    let mut readings: Vec<Reading> = Vec::new();
    let mut sign = 0.0;
    for (line, record) in records {
        let at = |wrong: String| format!("line {line}: {wrong}");
        not_too_long(&record, header.len()).map_err(at)?;
        let [(gap, _), (force, resolution)] = [0, 1].map(|k| value(&record, columns[k], k));
        let (gap, force, resolution) = (gap.map_err(at)?, force.map_err(at)?, resolution);
        if gap < 0.0 {
            return Err(at(format!(
                "the gap {:?} is negative; gaps are distances between the faces, 0 where they touch",
                &record[columns[0].place]
            )));
        }
        if force * sign < 0.0 {
            return Err(at(
                "the forces change sign; write attraction or repulsion, whichever you measured, with \
                 positive numbers throughout"
                    .to_owned(),
            ));
        }
        if force != 0.0 {
            sign = force.signum();
        }
        readings.push(Reading {
            line,
            gap,
            force: force.abs(),
            resolution,
        });
    }
    match readings.iter().any(|reading| reading.force > 0.0) {
        true => Ok(readings),
        false => Err("there is no force above 0 below the line that names the columns".to_owned()),
    }
}

/// The columns of gap and force.
fn columns(header: &StringRecord) -> Result<[Column; 2], String> {
    let mut found = [None; 2];
    for (place, name) in header.iter().enumerate() {
        let (k, factor) = column(name)?;
        if found[k].replace(Column { place, factor }).is_some() {
            return Err(format!("there are two columns of the {}", COLUMNS[k].0));
        }
    }
    let missing = |k: usize| {
        let (what, _, how) = COLUMNS[k];
        format!("there is no column of the {what}: name it {how}")
    };
    Ok([
        found[0].ok_or_else(|| missing(0))?,
        found[1].ok_or_else(|| missing(1))?,
    ])
}

/// Which quantity a column has, and in which unit: `gap_mm`, `Gap (mm)`, `force [g]`, `force`.
fn column(name: &str) -> Result<(usize, Option<f64>), String> {
    let both = || {
        format!(
            "unknown column `{name}`; there are two, the gap ({}) and the force ({})",
            COLUMNS[0].2, COLUMNS[1].2
        )
    };
    let end = name.find(|c: char| !c.is_ascii_alphabetic());
    let (what, rest) = name.split_at(end.unwrap_or(name.len()));
    let k = COLUMNS
        .iter()
        .position(|it| it.0.eq_ignore_ascii_case(what));
    let k = k.ok_or_else(both)?;
    let unit = rest.trim_matches(|c: char| c.is_whitespace() || "_()[]/,".contains(c));
    if unit.is_empty() {
        return Ok((k, None));
    }
    let known = COLUMNS[k].1;
    let exact = known.iter().find(|(name, _)| *name == unit);
    let alike = || {
        known
            .iter()
            .find(|(name, _)| name.eq_ignore_ascii_case(unit))
    };
    let (_, factor) = exact.or_else(alike).ok_or_else(|| {
        format!(
            "unknown unit `{unit}` in the column `{name}`: name it {}",
            COLUMNS[k].2
        )
    })?;
    Ok((k, Some(*factor)))
}

/// The value of a quantity in SI units, and the place value of its last digit.
fn value(record: &StringRecord, column: Column, k: usize) -> (Result<f64, String>, f64) {
    let (what, units, how) = COLUMNS[k];
    let text = record.get(column.place).unwrap_or_default();
    let plain = text.parse::<f64>().ok().filter(|x| x.is_finite());
    let found = match (plain, column.factor) {
        (Some(number), Some(factor)) => Some((number / factor, 1.0 / factor)),
        (Some(_), None) => {
            let wrong = format!("`{text}` has no unit: name the column {how}");
            return (Err(wrong), 0.0);
        }
        (None, _) => units::read_with_unit(text, units),
    };
    let Some((value, unit)) = found else {
        let comma = decimal_comma(text).map_or(String::new(), |comma| format!("; {comma}"));
        let wrong = format!("`{text}` is not a {what}: write a number{comma}");
        return (Err(wrong), 0.0);
    };
    if value.abs() > MOST[k] {
        let wrong = format!("the {what} `{text}` is too large; check its unit");
        return (Err(wrong), 0.0);
    }
    (Ok(value), last_digit(text) * unit)
}

/// The place value of a decimal number's last digit: 0.01 of `1.20`, 1 of `35`.
fn last_digit(text: &str) -> f64 {
    let number = text.trim_start_matches(|c: char| "+-".contains(c));
    let end = number.find(|c: char| !c.is_ascii_digit() && c != '.');
    let (digits, rest) = number.split_at(end.unwrap_or(number.len()));
    let places = digits.split_once('.').map_or(0, |(_, places)| places.len());
    let power = rest
        .strip_prefix(['e', 'E'])
        .and_then(|rest| rest.parse::<i32>().ok())
        .unwrap_or(0);
    let places = i32::try_from(places).unwrap_or(i32::MAX);
    libm::pow(10.0, f64::from(power.saturating_sub(places)))
}

#[cfg(test)]
mod tests {
    use super::*;

    const G: f64 = 9.806_65e-3;

    #[test]
    fn tables_are_read_as_people_write_them() {
        for text in [
            "gap_mm,force_g\n1,620\n",
            "force_g,gap_mm\n620,1\n",
            "Gap (mm), Force [g]\n1, 620\n",
            "gap,force\n1 mm,620 g\n",
            "gap,force_g\n0.1 cm,620\n",
            "gap_m,force_g\n0.001,-620\n",
        ] {
            let read = read(text).unwrap();
            assert_eq!(read.len(), 1, "{text}");
            assert!((read[0].gap - 1e-3).abs() < 1e-15, "{text}");
            assert!((read[0].force - 620.0 * G).abs() < 1e-9, "{text}");
            assert!((read[0].resolution - G).abs() < 1e-9, "{text}");
        }
        let pounds = read("gap_in,force_lb\n0,1.50\n").unwrap()[0];
        assert!((pounds.force - 1.5 * 4.448_221_615).abs() < 1e-6);
        assert!((pounds.resolution - 0.01 * 4.448_221_615).abs() < 1e-8);
    }

    #[test]
    fn what_cannot_be_read_is_said_with_its_line() {
        for (text, wanted) in [
            ("", "the file is empty"),
            ("0,1050\n1,620\n", "line 1: unknown column `0`"),
            ("gap,force_g\n1,620\n", "line 2: `1` has no unit"),
            (
                "gap_mm,force_stone\n1,620\n",
                "line 1: unknown unit `stone`",
            ),
            ("gap_mm\n1\n", "line 1: there is no column of the force"),
            (
                "gap_mm,gap_m,force_g\n1,1,1\n",
                "line 1: there are two columns of the gap",
            ),
            ("gap_mm,force_g\n\n1,x\n", "line 3: `x` is not a force"),
            ("gap_mm,force_g\n1,\n", "line 2: `` is not a force"),
            ("gap_mm,force_g\n-1,5\n", "line 2: the gap"),
            (
                "gap_mm,force_g\n1,5\n2,-4\n",
                "line 3: the forces change sign",
            ),
            ("gap_mm,force_g\n1,0\n", "there is no force above 0"),
            ("gap_m,force_g\n20,5\n", "line 2: the gap `20` is too large"),
            (
                "gap_mm,force_g\n1,5,3\n",
                "line 2: it has 3 entries instead of 2",
            ),
        ] {
            let wrong = read(text).unwrap_err();
            assert!(wrong.starts_with(wanted), "{text:?}: {wrong}");
        }
    }
}
