//! What users type: designs, poses, numbers with limits.

use std::path::Path;

use tilebind::Configuration;
use tilebind::design::{Design, MagnetModel};

use super::Failure;
use super::word::Word;

/// Reads a design; its warnings go to standard error.
pub fn load(path: &Path) -> Result<Design, Failure> {
    let design = Design::load(path)?;
    for warning in &design.warnings {
        eprintln!("warning: {warning}");
    }
    Ok(design)
}

/// A design with its magnets modelled as `model` says, if it says so.
pub fn load_as(path: &Path, model: Option<MagnetModel>) -> Result<Design, Failure> {
    let mut design = load(path)?;
    design.interaction.model = model.unwrap_or(design.interaction.model);
    Ok(design)
}

/// A magnet model by the name that design files use.
pub fn model() -> Word<MagnetModel> {
    let wrong = "a model is dipole or cuboid".to_owned();
    Word::new(&MagnetModel::NAMES, wrong)
}

/// A pose as `X,Y,THETA` (m, m, rad).
pub fn pose(text: &str) -> Result<Configuration, String> {
    const FORM: &str = "a pose is X,Y,THETA in m, m and rad, such as 0.43,0,0";
    let numbers = numbers(text).ok_or(FORM)?;
    let numbers: [f64; 3] = numbers.try_into().map_err(|_| FORM)?;
    Ok(numbers.into())
}

/// Finite numbers with commas between them.
pub fn numbers(text: &str) -> Option<Vec<f64>> {
    text.split(',')
        .map(|part| part.trim().parse().ok().filter(|x: &f64| x.is_finite()))
        .collect()
}

/// A whole number, at least 1; `1e4` is one too.
pub fn count(text: &str) -> Result<usize, String> {
    let found = count_or_none(text).ok().filter(|&count| count > 0);
    found.ok_or_else(|| "a whole number of 1 or more is needed, such as 8000 or 8e3".to_owned())
}

/// A whole number, 0 among them.
pub fn count_or_none(text: &str) -> Result<usize, String> {
    let scientific = || {
        let number = text.parse().ok();
        let whole = |x: &f64| x.fract() == 0.0 && (0.0..1e15).contains(x);
        number.filter(whole).map(|x| x as usize)
    };
    let found = text.parse().ok().or_else(scientific);
    found.ok_or_else(|| "a whole number is needed, such as 8000 or 8e3".to_owned())
}

/// A positive number.
pub fn positive(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|x: &f64| x.is_finite() && *x > 0.0)
        .ok_or_else(|| "a number greater than 0 is needed".to_owned())
}

/// A number that is not negative.
pub fn not_negative(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|x: &f64| x.is_finite() && *x >= 0.0)
        .ok_or_else(|| "a number of 0 or more is needed".to_owned())
}

/// A fraction greater than 0 and less than 1.
pub fn fraction(text: &str) -> Result<f64, String> {
    positive(text)
        .ok()
        .filter(|x| *x < 1.0)
        .ok_or_else(|| "a number between 0 and 1 is needed".to_owned())
}

/// Refuses a folder that cannot be one, before any work is done.
pub fn check_folder(folder: &Path) -> Result<(), Failure> {
    let existing = folder.ancestors().find(|path| path.exists());
    match existing {
        Some(path) if !path.is_dir() => Err(Failure::Usage(format!(
            "--out {}: {} is a file; name a folder",
            folder.display(),
            path.display(),
        ))),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poses() {
        assert_eq!(pose("0.43,-1e-2,0").unwrap().to_array(), [0.43, -0.01, 0.0]);
        assert_eq!(pose("-1, 2 ,-3").unwrap().to_array(), [-1.0, 2.0, -3.0]);
        for wrong in ["", "1,2", "1,2,3,4", "a,b,c", "1,2,NaN", "1,inf,0"] {
            assert!(pose(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn limits() {
        assert!(positive("0").is_err() && positive("-1").is_err() && positive("inf").is_err());
        assert!(fraction("1").is_err() && fraction("0.5").is_ok());
    }
}
