//! Parses user input: designs, poses, numbers with limits.

use std::fmt::Display;
use std::path::{Path, PathBuf};

use tilebind::Configuration;
use tilebind::design::{Design, MagnetModel, WordSet};
use tilebind::text::{self, with_commas};

use super::{Failure, tell};
use tilebind::request::Unanswered;

/// Reads a design; its warnings go to standard error.
pub fn load(path: &Path) -> Result<Design, Failure> {
    load_as(path, None)
}

/// Prints the warnings of a design on standard error.
pub fn tell_doubts(design: &Design) {
    for warning in &design.warnings {
        tell(format!("warning: {warning}"));
    }
}

/// A design with the magnet model overridden by `model`.
pub fn load_as(path: &Path, model: Option<MagnetModel>) -> Result<Design, Failure> {
    let design = load_silently_as(path, model)?;
    tell_doubts(&design);
    Ok(design)
}

/// The same without printing warnings.
pub fn load_silently_as(path: &Path, model: Option<MagnetModel>) -> Result<Design, Failure> {
    let mut design = Design::load(path)?;
    design.interaction.model = model.unwrap_or(design.interaction.model);
    Ok(design)
}

/// An optional design, with its files.
pub fn if_given(path: Option<&Path>) -> Result<Option<(Design, Vec<PathBuf>)>, Failure> {
    let read = |path| load(path).map(|design| (files_of(path, &design), design));
    let read = path.map(read).transpose()?;
    Ok(read.map(|(files, design)| (design, files)))
}

/// The words of a file, with its text.
pub fn words(
    path: Option<&Path>,
    model: Option<MagnetModel>,
) -> Result<Option<(WordSet, String)>, Failure> {
    let Some(path) = path else {
        return Ok(None);
    };
    let set = WordSet::load(path, model)?;
    let text = text::read(path).map_err(|error| Failure::Run(error.to_string()))?;
    Ok(Some((set, text)))
}

/// The files of a design: its own and its drawings.
pub fn files_of(path: &Path, design: &Design) -> Vec<PathBuf> {
    let drawings = design.drawings.iter();
    let drawings = drawings.map(|drawing| path.with_file_name(&drawing.file));
    [path.to_owned()].into_iter().chain(drawings).collect()
}

/// Warns of a pose far off the table, which is probably in millimetres.
pub fn doubt_pose(design: &Design, q: &Configuration) {
    let [x, y, theta] = q.to_array();
    let [half_x, half_y] = design.space().half_size;
    if x.abs() > 2.0 * half_x || y.abs() > 2.0 * half_y {
        let [x_mm, y_mm] = [x, y].map(|length| length / 1e3);
        tell(format!(
            "warning: pose {x},{y},{theta} is off the table of {} m by {} m: lengths are in m; \
             did you mean {x_mm},{y_mm} (in mm: \"{x} mm,{y} mm,{theta}\")?",
            2.0 * half_x,
            2.0 * half_y
        ));
    }
}

/// Reads a table named on the command line; errors contain its name.
pub fn table<T, E: Unanswered>(
    file: &Path,
    read: impl FnOnce(&str) -> Result<T, E>,
) -> Result<T, Failure> {
    let wrong = |error: &dyn Display| Failure::usage(format!("{}: {error}", file.display()));
    let text = text::read(file).map_err(|error| wrong(&error))?;
    read(&with_commas(&text)).map_err(|error| match error.is_of_the_question() {
        true => wrong(&error),
        false => Failure::run(error),
    })
}
