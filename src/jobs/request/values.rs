//! Parses user input: poses, numbers with limits.

use std::f64::consts::TAU;

use crate::design;
use crate::text::decimal_comma;
use physics::configuration::Configuration;

/// Largest coordinate (m, rad): powers of larger ones would be infinite.
pub const FARTHEST: f64 = 1e30;

/// Largest angle of a pose (rad), two full turns: larger ones are degrees without a unit.
pub const MOST_TURNED: f64 = 2.0 * TAU;

/// A coordinate (m), or with a unit.
pub fn coordinate(text: &str) -> Option<f64> {
    design::length(text).filter(|x| x.abs() <= FARTHEST)
}

/// A pose as `X,Y,THETA` (m, m, rad), or each with a unit: `43 cm,0,90 deg`.
pub fn pose(text: &str) -> Result<Configuration, String> {
    const FORM: &str = "a pose is X,Y,THETA in m, m and rad, such as 0.43,0,0, or with units, \
                        such as \"43 cm,0,90 deg\"";
    let parts: Vec<&str> = text.split(',').collect();
    let [x, y, theta] = parts[..] else {
        return Err(match decimal_comma(text).filter(|_| parts.len() > 3) {
            Some(comma) => format!("{comma}; {FORM}"),
            None => FORM.to_owned(),
        });
    };
    let numbers = [coordinate(x), coordinate(y), design::angle(theta)];
    let [Some(x), Some(y), Some(theta)] = numbers else {
        return Err(FORM.to_owned());
    };
    if theta.abs() > MOST_TURNED {
        return Err(format!(
            "theta = {theta:?} rad is more than two full turns: for degrees write \
             \"{x},{y},{theta} deg\""
        ));
    }
    Ok(Configuration::from([x, y, theta]))
}

/// Finite numbers separated by commas.
pub fn numbers(text: &str) -> Option<Vec<f64>> {
    text.split(',')
        .map(|part| part.trim().parse().ok().filter(|x: &f64| x.is_finite()))
        .collect()
}

/// A whole number, at least 1; `1e4` is also accepted.
pub fn count(text: &str) -> Result<usize, String> {
    let found = count_or_none(text).ok().filter(|&count| count > 0);
    found.ok_or_else(|| "a whole number of 1 or more is needed, such as 8000 or 8e3".to_owned())
}

/// A whole number, including 0.
pub fn count_or_none(text: &str) -> Result<usize, String> {
    let scientific = || {
        let number = text.parse().ok();
        let whole = |x: &f64| x.fract() == 0.0 && (0.0..1e15).contains(x);
        number.filter(whole).map(|x| x as usize)
    };
    let found = text.parse().ok().or_else(scientific);
    found.ok_or_else(|| "a whole number is needed, such as 8000 or 8e3".to_owned())
}

/// A whole number from `least` to `most`.
pub fn whole(least: u16, most: u16) -> impl Fn(&str) -> Result<u16, String> + Clone {
    move |text| {
        let found = count_or_none(text).ok().and_then(|it| it.try_into().ok());
        let found = found.filter(|number| (least..=most).contains(number));
        found.ok_or_else(|| format!("a whole number from {least} to {most} is needed"))
    }
}

/// A seed of random numbers.
pub fn seed(text: &str) -> Result<u64, String> {
    let found = text.parse().ok();
    found.ok_or_else(|| format!("a seed is a whole number from 0 to {}", u64::MAX))
}

/// Largest number of runs if all results are kept in memory.
const MOST_RUNS: usize = 10_000_000;

/// A number of runs, at least 1.
pub fn runs(text: &str) -> Result<usize, String> {
    count(text).and_then(not_too_many)
}

/// A number of runs for a mean with its error.
pub fn runs_of_a_mean(text: &str) -> Result<usize, String> {
    match runs(text)? {
        1 => Err("one run gives no error of the mean: use 2 or more".to_owned()),
        count => Ok(count),
    }
}

/// A number of runs, including 0.
pub fn runs_or_none(text: &str) -> Result<usize, String> {
    count_or_none(text).and_then(not_too_many)
}

fn not_too_many(count: usize) -> Result<usize, String> {
    match count {
        0..=MOST_RUNS => Ok(count),
        _ => Err(format!("at most {MOST_RUNS} fit in memory")),
    }
}

/// Largest coefficient of friction: tiles that touch stick from far below it on.
pub const MOST_FRICTION: f64 = 1e3;

/// Ranges of what options state in m, s, J, m^2 and 1/s: far beyond any tiles, so that nothing that is
/// computed with them overflows.
const LENGTHS: [f64; 2] = [1e-12, 1e6];
/// The least and the largest time (s).
pub const TIMES: [f64; 2] = [1e-12, 1e12];
const ENERGIES: [f64; 2] = [1e-30, 1e6];
const AREAS: [f64; 2] = [1e-18, 1e12];
const RATES: [f64; 2] = [1e-12, 1e12];

/// A quantity in a range: what it is, its unit, and how it is written.
type Kind = ([f64; 2], [&'static str; 3]);

const LENGTH: Kind = (LENGTHS, ["length", "m", "0.12 (m) or \"12 cm\""]);
const TIME: Kind = (TIMES, ["time", "s", "120 (s) or \"2 min\""]);
const AREA: Kind = (AREAS, ["area", "m^2", "0.005 (m^2) or \"50 cm2\""]);
const RATE: Kind = (RATES, ["rate", "/s", "0.5 (1/s) or \"0.5 /s\""]);

/// A quantity, if one was read that is in its range.
fn within(([least, most], [what, unit, form]): Kind, found: Option<f64>) -> Result<f64, String> {
    found.filter(|x| (least..=most).contains(x)).ok_or_else(|| {
        format!("a {what} from {least:e} to {most:e} {unit} is needed, such as {form}")
    })
}

/// The same, or 0.
fn within_or_none(kind: Kind, found: Option<f64>) -> Result<f64, String> {
    match found {
        Some(0.0) => Ok(0.0),
        found => within(kind, found).map_err(|told| format!("0 or {told}")),
    }
}

/// A positive length (m), or with a unit.
pub fn length(text: &str) -> Result<f64, String> {
    within(LENGTH, design::length(text))
}

/// A length (m) of 0 or more, or with a unit.
pub fn length_or_none(text: &str) -> Result<f64, String> {
    within_or_none(LENGTH, design::length(text))
}

/// An angle (rad) from 0 to a full turn, or with a unit.
pub fn turn(text: &str) -> Result<f64, String> {
    let found = design::angle(text).filter(|x| (0.0..=TAU).contains(x));
    found.ok_or_else(|| {
        format!("a number from 0 to {TAU:.4} is needed, in rad or with a unit: \"30 deg\"")
    })
}

/// A positive energy (J), or with a unit.
pub fn energy(text: &str) -> Result<f64, String> {
    let [least, most] = ENERGIES;
    let found = design::energy(text).filter(|x| (least..=most).contains(x));
    found.ok_or_else(|| format!("an energy from {least:e} to {most:e} J is needed, {JOULES}"))
}

/// An energy (J) below 0, or with a unit.
pub fn binding(text: &str) -> Result<f64, String> {
    let [least, most] = ENERGIES;
    let found = design::energy(text).filter(|x| (least..=most).contains(&-x));
    found.ok_or_else(|| {
        format!(
            "an energy from {:e} to {:e} J is needed, {JOULES}",
            -most, -least
        )
    })
}

/// Any energy (J) of magnets, or with a unit.
pub fn any_energy(text: &str) -> Option<f64> {
    design::energy(text).filter(|x| x.abs() <= ENERGIES[1])
}

/// The notation of energies.
const JOULES: &str = "in J or with a unit: 3e-3 or \"3 mJ\"";

/// A positive time (s), or with a unit.
pub fn time(text: &str) -> Result<f64, String> {
    within(TIME, design::time(text))
}

/// A time (s) of 0 or more, or with a unit.
pub fn time_or_none(text: &str) -> Result<f64, String> {
    within_or_none(TIME, design::time(text))
}

/// A positive area (m^2), or with a unit.
pub fn area(text: &str) -> Result<f64, String> {
    within(AREA, design::area(text))
}

/// A positive rate (1/s), or with a unit.
pub fn rate(text: &str) -> Result<f64, String> {
    within(RATE, design::rate(text))
}

/// Range of numbers without a unit.
const NUMBERS: [f64; 2] = [1e-9, 1e9];

/// A positive number.
pub fn positive(text: &str) -> Result<f64, String> {
    let [least, most] = NUMBERS;
    let found = text.parse().ok().filter(|x| (least..=most).contains(x));
    found.ok_or_else(|| format!("a number from {least:e} to {most:e} is needed"))
}

/// Range of energies (J) of shaking.
const SHAKING: [f64; 2] = [1e-12, 1e3];

/// An effective energy of shaking (J).
pub fn shaking(text: &str) -> Result<f64, String> {
    let [least, most] = SHAKING;
    design::energy(text)
        .filter(|kt| (least..=most).contains(kt))
        .ok_or_else(|| format!("a kT between {least:e} and {most:e} J is needed, {JOULES}"))
}

/// A number that is not negative.
pub fn not_negative(text: &str) -> Result<f64, String> {
    up_to(NUMBERS[1])(text)
}

/// A number from 0 to `most`.
pub fn up_to(most: f64) -> impl Fn(&str) -> Result<f64, String> + Clone {
    move |text| {
        let found = text.parse().ok().filter(|x| (0.0..=most).contains(x));
        found.ok_or_else(|| format!("a number from 0 to {most} is needed"))
    }
}

/// A share from 0 to 1.
pub fn share(text: &str) -> Result<f64, String> {
    of_one(text)
        .filter(|x| (0.0..=1.0).contains(x))
        .ok_or_else(|| "a number from 0 to 1, or a percentage, is needed".to_owned())
}

/// A fraction greater than 0 and less than 1.
pub fn fraction(text: &str) -> Result<f64, String> {
    of_one(text)
        .filter(|x| 0.0 < *x && *x < 1.0)
        .ok_or_else(|| "a number between 0 and 1, or a percentage, is needed".to_owned())
}

/// A number, or a percentage of 1.
fn of_one(text: &str) -> Option<f64> {
    let number = |text: &str| text.trim().parse().ok();
    match text.trim().strip_suffix('%') {
        Some(percent) => number(percent).map(|percent: f64| percent / 100.0),
        None => number(text),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poses() {
        assert_eq!(pose("0.43,-1e-2,0").unwrap().to_array(), [0.43, -0.01, 0.0]);
        assert_eq!(pose("-1, 2 ,-3").unwrap().to_array(), [-1.0, 2.0, -3.0]);
        let turn = std::f64::consts::FRAC_PI_2;
        assert_eq!(
            pose("43cm,5 mm,90 deg").unwrap().to_array(),
            [0.43, 0.005, turn]
        );
        for wrong in [
            "",
            "1,2",
            "1,2,3,4",
            "a,b,c",
            "1,2,NaN",
            "1,inf,0",
            "1e308,0,0",
        ] {
            assert!(pose(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn limits() {
        assert!(positive("0").is_err() && positive("-1").is_err() && positive("inf").is_err());
        assert_eq!((shaking("3 mJ"), time("2 min")), (Ok(3e-3), Ok(120.0)));
        assert_eq!(binding("-3 mJ"), Ok(-3e-3));
        assert!(energy("3 mm").is_err() && energy("0 mJ").is_err() && time("-1 s").is_err());
        for far in ["1e300", "1e-300", "inf", "nan"] {
            assert!(
                length(far).is_err() && length_or_none(far).is_err(),
                "{far}"
            );
            assert!(time(far).is_err() && time_or_none(far).is_err(), "{far}");
            assert!(
                energy(far).is_err() && binding(&format!("-{far}")).is_err(),
                "{far}"
            );
            assert!(
                area(far).is_err() && rate(far).is_err() && positive(far).is_err(),
                "{far}"
            );
        }
        assert!(not_negative("1e300").is_err() && any_energy("1e300").is_none());
        assert_eq!(
            (length_or_none("0"), time_or_none("0 s")),
            (Ok(0.0), Ok(0.0))
        );
        assert!(up_to(5.0)("5").is_ok() && up_to(5.0)("6").is_err() && up_to(5.0)("-1").is_err());
        assert!(turn("360 deg").is_ok() && turn("1e308").is_err() && turn("-1").is_err());
        assert!(fraction("1").is_err() && fraction("0.5").is_ok());
        assert_eq!((fraction("30 %"), share("100%")), (Ok(0.3), Ok(1.0)));
        assert!(fraction("100%").is_err() && share("101%").is_err() && share("nan").is_err());
        assert!(runs("0").is_err() && runs_or_none("0") == Ok(0));
        assert!(runs("1e7").is_ok() && runs("4294967295").is_err());
        assert!(runs_or_none("4294967295").is_err());
    }
}
