//! Sets of barcodes that bind their mates and nothing else.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use tilebind::design::{MagnetModel, WordSet};
use tilebind::report::{crosstalk as crosstalk_report, words as report};
use tilebind::word_sets::{CrosstalkRequest, Request};

use crate::design::Design;
use crate::request::request;
use crate::{convert, fault, job};

/// Find sets of barcodes that bind their mates and nothing else.
///
/// Parameters
/// ----------
/// length : int, optional
///     Magnets of a word; with `slots`, `magnets` says the same.
/// gap : float, optional
///     Least gap, from 0 to 1: the answer is the largest set.
/// count : int, optional
///     Words wanted: the answer is the set with the widest gap. With neither, the number of words
///     for every number of contacts.
/// contacts : int, optional
///     Judge by counted contacts: wrong meetings have at most so many matches more than mismatches.
/// slots : int, optional
///     Places of a face, of which `length` hold magnets: spacing is part of the code.
/// magnets : int, optional
///     Magnets of a word with `slots` or `continuous`; `length` by default.
/// continuous : bool, optional
///     Magnets may lie anywhere along the face, at least a pitch apart: positions and poles are
///     found together, wrong meetings judged over all poses. Takes `gap` or `count`.
/// face : float, optional
///     Length of the face (m) with `continuous`; the design's by default, or the paper's.
/// design : Design, optional
///     From whose target face magnets and pitch are taken; the paper's tile by default.
/// faces : {"all", "mates"}, optional
///     Which faces can meet.
/// shape : {"none", "shared", "polar"}, optional
///     Complementary shapes.
/// flip : bool, optional
///     Tiles may lie upside down.
/// tolerate : {"missing=1", "flipped=1"}, optional
///     The words hold though one magnet of every face is missing, or lies the wrong way round.
/// pitch : float, optional
///     From place to place (m).
/// balanced : bool, optional
///     As many north as south poles, or one more.
/// max_run : int, optional
///     Longest run of equal poles.
/// min_mismatch : sequence of int, optional
///     Least mismatches of two words aligned, of a word and a complement aligned, and of either over
///     every slide (what hangs over counts).
/// consecutive : sequence of int, optional
///     Least and greatest length of the longest run of consecutive matches of two words over all slides.
/// min_bond : float, optional
///     Least depth of a bond (J).
/// word_word, word_mate, mate_mate : sequence of float, optional
///     Between which two energies (J) the lowest one of two words, of a word and another's mate, of two
///     mates lies, over all slides.
/// model : {"dipole", "cuboid"}, optional
///     Of the magnets; the design's by default.
/// seconds : float, optional
///     Work to spend, as what takes about so many seconds of a core; it is counted.
/// seed : int, optional
/// progress : bool, optional
///
/// Returns
/// -------
/// dict
///     As ``tilebind words --json``: `words`, `count`, `upper_bound`, `proved`, `gap`, `bond_J`,
///     `worst`; with `continuous` also `positions_m`.
#[pyfunction]
#[pyo3(signature = (length = None, *, design = None, progress = None, **asked))]
pub fn words<'py>(
    py: Python<'py>,
    length: Option<&Bound<'py, PyAny>>,
    design: Option<Py<Design>>,
    progress: Option<bool>,
    asked: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let asked = asked.map_or_else(|| Ok(PyDict::new(py)), |asked| asked.copy())?;
    asked.set_item("length", length)?;
    let asked: Request = request(Some(&asked))?;
    let design = design.map(|design| design.get().content.clone());
    let found = job::run(py, progress, |told| {
        told.tell(0.0, "words".to_owned());
        asked.search(design.as_ref().map(|content| &content.design))
    })?;
    let found = found.map_err(|why| fault::refused(py, &why))?;
    convert::json(py, &report::document(&found).report())
}

/// The strongest attraction of every two words of a set over all poses, with their mates.
///
/// Parameters
/// ----------
/// words : sequence of str or Mapping
///     The words, without their mates, or a whole set with the keys of its file.
/// certify : float or bool, optional
///     Prove that no attraction is stronger, to within so many J; True for a quarter of a contact.
/// certify_cells : int, optional
///     Cells spent on the proof at most.
/// model : {"dipole", "cuboid"}, optional
///     Of the magnets; the set's by default.
/// progress : bool, optional
///
/// Returns
/// -------
/// dict
///     As ``tilebind crosstalk --json``: `words`, `strongest_J`, `lower_J`, `poses`.
#[pyfunction]
#[pyo3(signature = (words, *, progress = None, **asked))]
pub fn crosstalk<'py>(
    py: Python<'py>,
    words: &Bound<'py, PyAny>,
    progress: Option<bool>,
    asked: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let asked: CrosstalkRequest = request(asked)?;
    let (set, _) = word_set(py, words, asked.model)?;
    let found = job::run(py, progress, |told| {
        told.tell(0.0, "crosstalk".to_owned());
        asked.crosstalk(&set)
    })?;
    convert::json(py, &crosstalk_report::document(&set, &found).report())
}

/// A set of words and its file, from a list of them or the keys of the file.
pub fn word_set(
    py: Python<'_>,
    words: &Bound<'_, PyAny>,
    model: Option<MagnetModel>,
) -> PyResult<(WordSet, String)> {
    let table = match convert::toml(words)? {
        toml::Value::Table(table) => table,
        list => toml::Table::from_iter([("words".to_owned(), list)]),
    };
    let text = table.to_string();
    let set = WordSet::parse(&text, "words.toml", model);
    Ok((set.map_err(|error| fault::design(py, &error))?, text))
}
