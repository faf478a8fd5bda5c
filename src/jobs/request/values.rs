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

/// A positive length (m), or with a unit.
pub fn length(text: &str) -> Result<f64, String> {
    design::length(text).filter(|x| *x > 0.0).ok_or_else(|| {
        "a length greater than 0 is needed, such as 0.12 (m) or \"12 cm\"".to_owned()
    })
}

/// A length (m) of 0 or more, or with a unit.
pub fn length_or_none(text: &str) -> Result<f64, String> {
    design::length(text)
        .filter(|x| *x >= 0.0)
        .ok_or_else(|| "a length of 0 or more is needed, such as 1e-4 (m) or \"0.1 mm\"".to_owned())
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
    let found = design::energy(text).filter(|x| *x > 0.0);
    found.ok_or_else(|| format!("a number greater than 0 is needed, {JOULES}"))
}

/// An energy (J) below 0, or with a unit.
pub fn binding(text: &str) -> Result<f64, String> {
    let found = design::energy(text).filter(|x| *x < 0.0);
    found.ok_or_else(|| format!("a number less than 0 is needed, {JOULES}"))
}

/// The notation of energies.
const JOULES: &str = "in J or with a unit: 3e-3 or \"3 mJ\"";

/// A positive time (s), or with a unit.
pub fn time(text: &str) -> Result<f64, String> {
    let found = design::time(text).filter(|x| *x > 0.0);
    found.ok_or_else(|| format!("a number greater than 0 is needed, {SECONDS}"))
}

/// A time (s) of 0 or more, or with a unit.
pub fn time_or_none(text: &str) -> Result<f64, String> {
    let found = design::time(text).filter(|x| *x >= 0.0);
    found.ok_or_else(|| format!("a number of 0 or more is needed, {SECONDS}"))
}

/// The notation of times.
const SECONDS: &str = "in s or with a unit: 120 or \"2 min\"";

/// A positive area (m^2), or with a unit.
pub fn area(text: &str) -> Result<f64, String> {
    let found = design::area(text).filter(|x| *x > 0.0);
    found.ok_or_else(|| {
        "a number greater than 0 is needed, in m^2 or with a unit: \"50 cm2\"".to_owned()
    })
}

/// A positive rate (1/s), or with a unit.
pub fn rate(text: &str) -> Result<f64, String> {
    let found = design::rate(text).filter(|x| *x > 0.0);
    found.ok_or_else(|| {
        "a number greater than 0 is needed, in 1/s or with a unit: \"0.5 /s\"".to_owned()
    })
}

/// A positive number.
pub fn positive(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|x: &f64| x.is_finite() && *x > 0.0)
        .ok_or_else(|| "a number greater than 0 is needed".to_owned())
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
    text.parse()
        .ok()
        .filter(|x: &f64| x.is_finite() && *x >= 0.0)
        .ok_or_else(|| "a number of 0 or more is needed".to_owned())
}

/// A number from 0 to `most`.
pub fn up_to(most: f64) -> impl Fn(&str) -> Result<f64, String> {
    move |text| {
        let found = not_negative(text).ok().filter(|x| *x <= most);
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
