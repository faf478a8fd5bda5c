//! The files of an analysis.

use std::time::Instant;

use super::files::{Files, PAGE, PICTURES, REPORT};
use super::json::Report;
use super::names::{alternative_file, pathway_file};
use super::page::Page;
use super::plots::{self, PictureError, Scene, Sheet};
use super::{csv, dynamics, topsearch};
use jobs::design::Design;
use jobs::pipeline::Analysis;
use physics::landscape::Barrier;

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
    /// How pictures are laid out.
    pub sheet: Sheet,
    /// The command line that gives the same results, for the page.
    pub command: String,
}

impl Contents {
    /// Whether a file of this name may be among them.
    pub fn may_hold(&self, name: &str) -> bool {
        let is_in = |folder: &str| {
            name.split_once('/')
                .is_some_and(|(first, _)| first == folder)
        };
        match self.extent {
            Extent::Full => true,
            Extent::Compact => {
                let is_picture = !is_in(PICTURES) || is_vector(name);
                is_picture && name != PAGE && !is_in(topsearch::FOLDER)
            }
        }
    }
}

/// All files of an analysis begun at `start`: report, tables, pathways, pictures with their numbers
/// and page.
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
    let mut report = Report::new(design, analysis, start.elapsed().as_secs_f64());
    if extent == Extent::Compact {
        report = report.without_copies();
    }
    files.insert(REPORT.to_owned(), report.to_text().into_bytes());
    if extent == Extent::Full {
        let linked = |name: &&String| !name.contains('/') || name.starts_with(PICTURES);
        let scene = Scene::new(design, &analysis.problem, &analysis.inventory);
        let page = Page::of_analysis(design, analysis, &scene)
            .made_by(&contents.command)
            .beside(files.keys().filter(linked));
        files.insert(PAGE.to_owned(), page.to_html().into_bytes());
    }
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
