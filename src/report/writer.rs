//! The files of an analysis: whole or not there at all.

use std::collections::BTreeSet;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Instant;

use super::earlier::{Earlier, Listed, content};
pub use super::files::{Files, PAGE, PICTURES, REPORT};
use super::json::Report;
use super::names::{alternative_file, pathway_file};
use super::page::Page;
use super::plots::{self, PictureError, Scene, Sheet};
use super::{arrays, csv, dynamics, topsearch};
use crate::design::Design;
use crate::landscape::Barrier;
use crate::pipeline::Analysis;

/// The folders of an analysis within that of its results.
pub const FOLDERS: [&str; 4] = ["pathways", PICTURES, arrays::FOLDER, topsearch::FOLDER];

/// Why results could not be written.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// The file system refused.
    #[error("cannot write {}: {source}", path.display())]
    File {
        /// The file, or the folder that it was to be in.
        path: PathBuf,
        /// What the file system says.
        source: io::Error,
    },
    /// A picture could not be drawn.
    #[error(transparent)]
    Picture(#[from] PictureError),
}

/// How much is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// Everything.
    Full,
    /// Without the pathways of copies, the page and the files for TopSearch, pictures as SVG (and
    /// PDF) only and without their numbers: for results that are kept.
    Compact,
}

/// What is written, and how.
#[derive(Clone, Debug)]
pub struct Contents {
    /// How much.
    pub extent: Extent,
    /// Whether arrays for NumPy too.
    pub arrays: bool,
    /// How pictures are laid out.
    pub sheet: Sheet,
    /// The command line that gives the same results, for the page.
    pub command: String,
}

/// All files of an analysis begun at `start`: report, tables, pathways, pictures with their numbers,
/// page, and arrays if they are asked for.
///
/// # Errors
/// Where a picture cannot be drawn.
pub fn files(
    design: &Design,
    analysis: &Analysis,
    contents: &Contents,
    start: Instant,
) -> Result<Files, PictureError> {
    let extent = contents.extent;
    let mut files = tables(design, analysis, extent);
    files.extend(pictures(design, analysis, contents)?);
    if contents.arrays {
        files.extend(arrays::files(design, analysis));
    }
    if contents.extent == Extent::Full {
        let listed = [REPORT.to_owned()];
        let linked = |name: &&String| !name.contains('/') || name.starts_with(PICTURES);
        let scene = Scene::new(design, &analysis.problem, &analysis.inventory);
        let page = Page::of_analysis(design, analysis, &scene)
            .made_by(&contents.command)
            .beside(files.keys().filter(linked).chain(&listed));
        files.insert(PAGE.to_owned(), page.to_html().into_bytes());
    }
    let mut report = Report::new(design, analysis, start.elapsed().as_secs_f64());
    if extent == Extent::Compact {
        report = report.without_copies();
    }
    report = report.listing(&files);
    files.insert(REPORT.to_owned(), report.to_text().into_bytes());
    Ok(files)
}

fn tables(design: &Design, analysis: &Analysis, extent: Extent) -> Files {
    let mut files = Files::new();
    let mut add = |name: String, content: String| {
        files.insert(name, content.into_bytes());
    };
    add("states.csv".into(), csv::states(design, analysis));
    add(
        "barriers.csv".into(),
        csv::barriers(&analysis.inventory.barriers),
    );
    if let Some(checks) = &analysis.dynamics {
        add(dynamics::TABLE.into(), dynamics::csv(checks));
    }
    let escapes = analysis
        .inventory
        .states
        .iter()
        .filter(|state| extent == Extent::Full || state.id == state.class)
        .filter_map(|state| analysis.escape(state.id));
    let barriers = escapes.chain(analysis.inventory.barriers.iter().cloned());
    for barrier in barriers.filter(Barrier::has_way) {
        add(pathway_file(&barrier), csv::pathway(&barrier.pathway));
    }
    for alternative in &analysis.inventory.alternatives {
        add(
            alternative_file(alternative),
            csv::pathway(&alternative.pathway),
        );
    }
    files
}

/// The pictures, and the graph for TopSearch.
fn pictures(
    design: &Design,
    analysis: &Analysis,
    contents: &Contents,
) -> Result<Files, PictureError> {
    let mut files = Files::new();
    let scene = Scene::new(design, &analysis.problem, &analysis.inventory);
    let is_full = contents.extent == Extent::Full;
    let sheet = match contents.extent {
        Extent::Full => contents.sheet,
        Extent::Compact => contents.sheet.without_bitmaps(),
    };
    for figure in plots::draw_all(&scene, &sheet)? {
        let kept = figure
            .files()
            .filter(|(name, _)| is_full || is_vector(name));
        files.extend(kept.map(|(name, bytes)| (format!("{PICTURES}/{name}"), bytes)));
    }
    if is_full {
        files.extend(topsearch::files(&scene, analysis.ring[1]));
    }
    Ok(files)
}

/// Whether a picture can be enlarged.
fn is_vector(name: &str) -> bool {
    name.ends_with(".svg") || name.ends_with(".pdf")
}

/// Writes files into a folder, which is made if need be. Each is written under a temporary name;
/// only when all are there do they take their places, the report last. What an earlier analysis
/// wrote, and nobody changed since, is replaced or taken away. All else stays: what is in the way
/// of a new file goes under another name, and these names are returned.
///
/// # Errors
/// Where the file system refuses; then no file has been changed unless it refused a renaming.
pub fn write(folder: &Path, files: &Files) -> Result<Vec<PathBuf>, WriteError> {
    let mut staged = Staged::default();
    for (name, content) in files {
        staged.add(&folder.join(name), content)?;
    }
    let earlier = Earlier::read(folder);
    let mut own: BTreeSet<&str> = earlier
        .iter()
        .flat_map(|earlier| earlier.unchanged(folder))
        .collect();
    own.extend(earlier.is_some().then_some(REPORT));
    let listed = Listed::read(folder);
    let kept = make_way(folder, files, |name| own.contains(name) || listed.has(name))?;
    let _ = std::fs::remove_file(folder.join(REPORT));
    let stale = own.iter().filter(|name| !files.contains_key(**name));
    let stale: Vec<PathBuf> = stale.map(|name| folder.join(name)).collect();
    for path in &stale {
        let _ = std::fs::remove_file(path);
    }
    staged.settle()?;
    // Of a folder that is not empty this takes nothing away.
    for emptied in stale.iter().filter_map(|path| path.parent()) {
        let _ = std::fs::remove_dir(emptied);
    }
    Ok(kept)
}

/// Writes a file, whole or not at all.
///
/// # Errors
/// Where the file system refuses.
pub fn write_file(path: &Path, content: &[u8]) -> Result<(), WriteError> {
    let mut staged = Staged::default();
    staged.add(path, content)?;
    staged.settle()
}

/// Writes files into a folder, each whole or not at all, in their order, for commands without a
/// report that lists them: `.tilebind.sha256` does. What they wrote, and nobody changed since, is replaced.
/// What else is in the way goes under another name, and these names are returned.
///
/// # Errors
/// Where the file system refuses; the files before are then in their places.
pub fn write_each<N: AsRef<str>>(
    folder: &Path,
    files: &[(N, Vec<u8>)],
) -> Result<Vec<PathBuf>, WriteError> {
    let named = || files.iter().map(|(name, content)| (name.as_ref(), content));
    let earlier = Earlier::read(folder);
    let own: BTreeSet<&str> = earlier
        .iter()
        .flat_map(|earlier| earlier.unchanged(folder))
        .collect();
    let listed = Listed::read(folder);
    let kept = make_way(folder, named(), |name| {
        own.contains(name) || listed.has(name)
    })?;
    // First, so that a run that ends in between leaves no file that is not listed.
    let list = folder.join(Listed::NAME);
    write_file(&list, listed.with(named()).text().as_bytes())?;
    named().try_for_each(|(name, content)| write_file(&folder.join(name), content))?;
    Ok(kept)
}

/// Gives other names to what is in the way of new files, unless it is tilebind's own or the same.
fn make_way<N: AsRef<str>>(
    folder: &Path,
    files: impl IntoIterator<Item = (N, impl AsRef<[u8]>)>,
    is_own: impl Fn(&str) -> bool,
) -> Result<Vec<PathBuf>, WriteError> {
    files
        .into_iter()
        .filter(|(name, _)| !is_own(name.as_ref()))
        .map(|(name, new)| (folder.join(name.as_ref()), new))
        .filter(|(path, new)| in_the_way(path) && content(path).as_deref() != Some(new.as_ref()))
        .map(|(path, _)| set_aside(path))
        .collect()
}

/// Whether a folder holds a report that is not of tilebind.
pub fn has_foreign_report(folder: &Path) -> bool {
    in_the_way(&folder.join(REPORT)) && Earlier::read(folder).is_none()
}

/// Whether there is something by this name, be it a link that leads nowhere.
fn in_the_way(path: &Path) -> bool {
    path.symlink_metadata().is_ok()
}

/// Renames a file so that its name is free, and tells the new one.
fn set_aside(path: PathBuf) -> Result<PathBuf, WriteError> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let kept = (1..)
        .map(|k| path.with_file_name(format!("{name}.kept-{k}")))
        .find(|kept| !in_the_way(kept))
        .unwrap_or_default();
    match std::fs::rename(&path, &kept) {
        Ok(()) => Ok(kept),
        Err(source) => Err(WriteError::File { path, source }),
    }
}

/// Files under temporary names; those not settled are removed when this goes, with the folders that
/// were made for them.
#[derive(Default)]
struct Staged {
    /// Temporary and final path.
    waiting: Vec<(PathBuf, PathBuf)>,
    /// Folders that were not there, outer ones first.
    made: Vec<PathBuf>,
}

impl Staged {
    fn add(&mut self, path: &Path, content: &[u8]) -> Result<(), WriteError> {
        let folder = path.parent().unwrap_or(Path::new(""));
        let missing = folder.ancestors().take_while(|folder| !folder.exists());
        let missing: Vec<PathBuf> = missing.map(Path::to_owned).collect();
        self.made.extend(missing.into_iter().rev());
        std::fs::create_dir_all(folder).map_err(|source| WriteError::File {
            path: folder.to_owned(),
            source,
        })?;
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let temporary = folder.join(format!(".{name}.{}.partial", std::process::id()));
        self.waiting.push((temporary.clone(), path.to_owned()));
        std::fs::write(&temporary, content).map_err(|source| WriteError::File {
            path: path.to_owned(),
            source,
        })
    }

    /// Renames the files in the order of their names, the report last.
    fn settle(mut self) -> Result<(), WriteError> {
        self.waiting
            .sort_by_key(|(_, path)| (path.ends_with(REPORT), path.clone()));
        while let Some((temporary, path)) = self.waiting.first().cloned() {
            std::fs::rename(&temporary, &path)
                .map_err(|source| WriteError::File { path, source })?;
            self.waiting.remove(0);
        }
        Ok(())
    }
}

impl Drop for Staged {
    fn drop(&mut self) {
        for (temporary, _) in &self.waiting {
            let _ = std::fs::remove_file(temporary);
        }
        // Of a folder that is not empty this takes nothing away.
        for folder in self.made.iter().rev() {
            let _ = std::fs::remove_dir(folder);
        }
    }
}
