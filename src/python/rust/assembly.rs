//! Tile sets whose glues are words.

use std::path::PathBuf;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use tilebind::assembly::{Assembly, Built, TileSet, Wiring, WordSearch, proofread};
use tilebind::design::WordSet;
use tilebind::kinetics::bond::Shaking;
use tilebind::report::assembly::document;
use tilebind::report::plots::Sheet;
use tilebind::words::Rules;

use crate::design::Design;
use crate::words::{word_set, word_shape};
use crate::{convert, fault, job};

/// Most tiles along a block's edge.
const LARGEST_BLOCK: usize = 6;

/// Build a tile set of words: what engines of tile assembly read, with energies in units of kT.
///
/// Parameters
/// ----------
/// tiles : str or os.PathLike
///     A tile set as xgrow (``.tiles``) or rgrow (YAML, JSON) read it.
/// words : sequence of str or Mapping, optional
///     Words enough for its glues, one for each axis on which a glue is used: those of
///     :func:`words`, or a whole set with the keys of its file. Searched by default.
/// design : Design, optional
///     From whose target face magnets, pitch and side are taken; the paper's tile by default.
/// kt : float
///     Effective energy of the shaking (J).
/// coverage : float, optional
///     Share of the table that tiles cover.
/// proofread : int, optional
///     Blocks of so many tiles a side in place of tiles.
/// length : int, optional
///     Places of a face where words are searched; the fewest that carry them by default.
/// magnets : int, optional
///     Magnets of the strongest bonds' words, where spacing is code too.
/// gap : float, optional
///     Least gap of the words: 0.5 by default, with `length` the widest there is.
/// shape : {"none", "shared", "polar"}, optional
///     Complementary shapes of the faces.
/// pitch : float, optional
///     From place to place (m).
/// seconds : float, optional
///     Work to spend on words, as what takes about so many seconds of a core; it is counted.
/// seed : int, optional
/// progress : bool, optional
///
/// Returns
/// -------
/// dict of str to bytes
///     By their names, as ``tilebind assemble`` writes them: `assembly.yaml` (rgrow),
///     `assembly.tiles` (xgrow), a design for each pair that meets, sheet, matrix, page, report.
///
/// Raises
/// ------
/// DesignError
///     With the line of what is wrong with the tile set or the words.
/// ValueError
///     Where the words do not suffice.
#[pyfunction]
#[pyo3(signature = (tiles, words = None, *, design = None, kt, coverage = 0.3, proofread = 1,
                    length = None, magnets = None, gap = None, shape = "none", pitch = None,
                    seconds = 20.0, seed = 1, progress = None))]
#[allow(clippy::too_many_arguments)]
pub fn assemble<'py>(
    py: Python<'py>,
    tiles: PathBuf,
    words: Option<&Bound<'py, PyAny>>,
    design: Option<Py<Design>>,
    kt: f64,
    coverage: f64,
    proofread: usize,
    length: Option<usize>,
    magnets: Option<usize>,
    gap: Option<f64>,
    shape: &str,
    pitch: Option<f64>,
    seconds: f64,
    seed: u64,
    progress: Option<bool>,
) -> PyResult<Bound<'py, PyDict>> {
    fault::positive("kt", Some(kt))?;
    fault::fraction("coverage", coverage)?;
    if !(1..=LARGEST_BLOCK).contains(&proofread) {
        return Err(fault::value(format!(
            "proofread = {proofread}: from 1 to {LARGEST_BLOCK} tiles a side"
        )));
    }
    let tiles = TileSet::load(&tiles).map_err(|error| fault::design(py, &error))?;
    fault::positive("pitch", pitch)?;
    fault::positive("seconds", Some(seconds))?;
    let rules = Rules {
        shape: word_shape(shape)?,
        ..Rules::default()
    };
    let searched = WordSearch {
        pitch,
        model: None,
        length,
        magnets,
        gap,
        rules,
        seed,
        seconds,
    };
    let design = design.map(|design| design.get().content.clone());
    let design = design.as_ref().map(|content| &content.design);
    let set = proofread::blocks(&tiles, proofread);
    let wiring = Wiring::new(&set).map_err(fault::value)?;
    let (words, words_toml, tried) = match words {
        Some(words) => {
            let (words, text) = word_set(py, words)?;
            (words, text, Vec::new())
        }
        None => {
            let found = job::run(py, progress, |told| {
                told.tell(0.0, "words".to_owned());
                searched.run(&wiring, design)
            })?;
            let (text, tried) = found.map_err(fault::value)?;
            let words = WordSet::parse(&text, "the words found", None);
            (
                words.map_err(|error| fault::design(py, &error))?,
                text,
                tried,
            )
        }
    };
    let shaking = Shaking { kt, coverage };
    let files = job::run(py, progress, |told| {
        told.tell(0.0, "assembly".to_owned());
        Built::new(&set, &words, shaking).map(|built| {
            let assembly = Assembly {
                built: &built,
                words: &words,
                words_toml,
                design,
                tried,
                lattice: None,
                rules,
                proofread,
                seed,
            };
            document(&assembly).files(&Sheet::SCREEN, "tilebind assemble")
        })
    })?;
    let files = files.map_err(fault::value)?.map_err(fault::value)?;
    convert::files(py, files)
}
