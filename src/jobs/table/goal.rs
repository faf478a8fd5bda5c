//! What the tiles of a table are to build.

use std::path::{Path, PathBuf};

use super::crowds::Named;
use super::start_file;
use crate::text;
use physics::observer::Observer;
use physics::table::Crowd;
use physics::table::structures::{Goal, are_joined};

/// Largest number of tiles of a goal.
const MOST: usize = 100_000;

/// A goal as the command line has it: `ring:8`, `chain:5`, `sheet:3x3` or a start file.
#[derive(Clone, Debug, PartialEq)]
pub enum Wanted {
    /// Given by numbers.
    Known(Goal),
    /// The tiles of a start file.
    File(PathBuf),
}

impl Wanted {
    /// Reads a goal.
    ///
    /// # Errors
    /// What to write instead.
    pub fn parse(given: &str) -> Result<Self, String> {
        const FORM: &str = "write ring:8, chain:5, sheet:3x3, or the name of a start file (.csv)";
        let size = |text: &str, least: usize| {
            let count: Option<usize> = text.trim().parse().ok();
            count
                .filter(|count| (least..=MOST).contains(count))
                .ok_or_else(|| {
                    format!("`{text}` is not a whole number from {least} to {MOST}: {FORM}")
                })
        };
        let Some((shape, sizes)) = given.split_once(':').filter(|(shape, _)| {
            ["ring", "chain", "sheet"].contains(&shape.to_lowercase().as_str())
        }) else {
            let is_table = Path::new(given)
                .extension()
                .is_some_and(|it| it.eq_ignore_ascii_case("csv"));
            return match is_table {
                true => Ok(Self::File(given.into())),
                false => Err(format!("`{given}` is no target: {FORM}")),
            };
        };
        Ok(Self::Known(match shape.to_lowercase().as_str() {
            "ring" => Goal::Ring(size(sizes, 3)?),
            "chain" => Goal::Chain(size(sizes, 2)?),
            _ => {
                let (rows, columns) = sizes
                    .split_once(['x', 'X'])
                    .ok_or_else(|| format!("`{given}` lacks rows or columns: {FORM}"))?;
                let (rows, columns) = (size(rows, 1)?, size(columns, 1)?);
                if !(2..=MOST).contains(&rows.saturating_mul(columns)) {
                    return Err(format!("`{given}` has not from 2 to {MOST} tiles: {FORM}"));
                }
                Goal::Sheet(rows, columns)
            }
        }))
    }

    /// The goal, for this many tiles of these kinds.
    ///
    /// # Errors
    /// If the file cannot be read, or such tiles can never build it.
    pub(super) fn goal(
        &self,
        (crowd, named): (&Crowd, &Named),
        tiles: usize,
        observer: &dyn Observer,
    ) -> Result<Goal, String> {
        let goal = match self {
            Self::Known(goal) => goal.clone(),
            Self::File(file) => Self::pattern(file, (crowd, named), observer)?,
        };
        let four = |kind: &physics::table::Kind| kind.tile.faces.len() == 4;
        if matches!(goal, Goal::Sheet(..)) && !crowd.kinds.iter().any(four) {
            return Err(
                "--target: sheets have rows and columns of tiles with four faces, which these have not: give a \
                 start file as the pattern"
                    .to_owned(),
            );
        }
        if goal.tiles() > tiles {
            return Err(format!(
                "--target: it has {} tiles, but there are only {tiles} on the table: raise --count",
                goal.tiles()
            ));
        }
        Ok(goal)
    }

    /// The tiles of a start file.
    fn pattern(
        file: &Path,
        (crowd, named): (&Crowd, &Named),
        observer: &dyn Observer,
    ) -> Result<Goal, String> {
        let name = file.display();
        let wrong = |error: &dyn std::fmt::Display| format!("--target {name}: {error}");
        let text = text::read(file).map_err(|error| wrong(&error))?;
        let movers = start_file::read(&text::with_commas(&text), (crowd, named), observer);
        let movers = movers.map_err(|error| wrong(&error))?;
        let place = |it: &physics::table::Mover| (it.kind, it.motion(crowd).configuration);
        let tiles: Vec<_> = movers.iter().map(place).collect();
        if tiles.len() < 2 || !are_joined(crowd, &tiles) {
            return Err(wrong(
                &"its tiles are not all joined by bonds, so no structure can be like it: place them where \
                  their faces bind",
            ));
        }
        Ok(Goal::Pattern(tiles))
    }
}
