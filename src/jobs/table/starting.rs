//! What a request means for the tiles of a table: its goal, its start, and its contradictions.

use super::crowds::MOST_TILES;
use super::{About, Request, start_file, workload};
use physics::observer::Observer;
use physics::table::Crowd;
use physics::table::run::Start;
use physics::table::structures::Goal;

impl Request {
    /// What is to be built, of the tiles of a start.
    ///
    /// # Errors
    /// If the start file that describes it is invalid, or such tiles cannot build it.
    pub fn goal(
        &self,
        (about, crowd): (&About, &Crowd),
        start: &Start,
        observer: &dyn Observer,
    ) -> Result<Option<Goal>, String> {
        let wanted = self.target.as_ref();
        let goal = wanted.map(|it| it.goal((crowd, &about.named), start.tiles(), observer));
        goal.transpose()
    }

    /// The starting positions: from a file, given by its name and text, or at random.
    ///
    /// # Errors
    /// If the file is invalid, the number of counts differs from the number of kinds, or there is no
    /// single design to compare with.
    pub fn start(
        &self,
        (about, crowd): (&About, &Crowd),
        file: Option<(&str, &str)>,
        observer: &dyn Observer,
    ) -> Result<Start, String> {
        if self.compare && about.designs.len() > 1 {
            return Err(
                "--compare needs exactly one design, as `tilebind yield` counts pairs of one design, or one \
                 tile set: remove it, or give one design"
                    .into(),
            );
        }
        if let Some((name, text)) = file {
            let movers = start_file::read(text, (crowd, &about.named), observer);
            let movers = movers.map_err(|error| format!("{name}: {error}"))?;
            return Ok(Start::Given(movers));
        }
        let counts = counts(&self.count, about, crowd).ok_or_else(|| {
            let kinds: Vec<&str> = crowd.kinds.iter().map(|kind| kind.name.as_str()).collect();
            format!(
                "--count has {} numbers, but needs {}, one for each kind of tile: {}",
                self.count.len(),
                kinds.len(),
                kinds.join(", ")
            )
        })?;
        let all = counts.iter().copied().fold(0, usize::saturating_add);
        if !(1..=MOST_TILES).contains(&all) {
            return Err(format!("a table can have 1 to {MOST_TILES} tiles"));
        }
        Ok(Start::Random(counts))
    }

    /// Checks for contradictory options.
    ///
    /// # Errors
    /// A contradiction, and how to fix it.
    pub fn check(&self) -> Result<(), String> {
        if self.shaking.is_some() && self.motion.drag == 0.0 {
            return Err(
                "--shaking without drag heats the tiles without limit: set --drag above 0".into(),
            );
        }
        if self.correlation.is_some() && self.shaking.is_none() {
            return Err("--correlation needs --shaking: add it".into());
        }
        if self.made().is_empty() {
            return Err(format!(
                "--shard: this part has none of the {} runs",
                self.runs
            ));
        }
        if self.compare && self.shaking.is_none() {
            return Err("--compare needs a kT: add --shaking".into());
        }
        workload::check_steps(self)
    }
}

/// The number of tiles of each kind; `None` if there are too many numbers, or too few.
fn counts(given: &[usize], about: &About, crowd: &Crowd) -> Option<Vec<usize>> {
    let count = crowd.kinds.len();
    let kinds = &about.named.kinds;
    if given.len() == count {
        return Some(given.to_vec());
    }
    let of_each = |[fixed, moving]: &[usize; 2]| if fixed == moving { 1 } else { 2 };
    let equal = kinds.iter().all(|it| of_each(it) == given.len());
    let whole: Vec<usize> = match given.len() {
        // The numbers of one design apply to all, or two numbers although both tiles are equal.
        many if equal && many > 0 => given.repeat(kinds.len()),
        2 => given.repeat(kinds.len()),
        many if many == 2 * kinds.len() => given.to_vec(),
        // Equal tiles in different frames: all of them are drawn as the fixed one.
        1 if about.named.only().is_some() => return Some(vec![given[0], 0]),
        _ => return None,
    };
    if kinds.is_empty() {
        return None;
    }
    if whole.len() == count {
        return Some(whole);
    }
    let mut counts = vec![0; count];
    for (numbers, own) in whole.chunks(2).zip(kinds) {
        for (number, kind) in numbers.iter().zip(own) {
            counts[*kind] += number;
        }
    }
    Some(counts)
}
