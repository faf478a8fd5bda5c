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
///     Magnets per word; with `slots`, the same as `magnets`.
/// gap : float, optional
///     Smallest gap, 0 to 1: find the largest set.
/// count : int, optional
///     Number of words: find the set with the widest gap. With neither, find the number of
///     words for every number of matching contacts.
/// contacts : int, optional
///     Count contacts: at most this many more matches than mismatches in wrong meetings.
/// slots : int, optional
///     Positions per face, of which `length` have magnets: spacing is part of the code.
/// magnets : int, optional
///     Magnets per word with `slots` or `continuous`; `length` by default.
/// continuous : bool, optional
///     Place magnets anywhere along the face, at least a pitch apart. Positions and poles
///     are optimised together, and wrong meetings are searched over all poses. Needs `gap`
///     or `count`.
/// face : float, optional
///     Face length (m) with `continuous`; the design's by default, or the paper's.
/// design : Design, optional
///     Its target face gives magnets and pitch; the paper's tile by default.
/// self : bool, optional
///     Words that bind their own kind and nothing else: there are no mates.
/// faces : {"all", "mates"}, optional
///     Which faces can meet.
/// shape : {"none", "shared", "polar"}, optional
///     Complementary shapes.
/// flip : bool, optional
///     Tiles can lie upside down.
/// tolerate : {"missing=1", "flipped=1"}, optional
///     Keep the gap even if one magnet per face is missing or flipped.
/// pitch : float, optional
///     Distance between magnet positions (m).
/// balanced : bool, optional
///     As many north poles as south poles, or one more.
/// max_run : int, optional
///     Longest run of equal poles.
/// min_mismatch : sequence of int, optional
///     Smallest numbers of mismatches: between two aligned words, between an aligned word
///     and complement, and of either at any slide (overhanging magnets count as
///     mismatches).
/// consecutive : sequence of int, optional
///     Range of the longest run of consecutive matches of two words over all slides.
/// min_bond : float, optional
///     Smallest depth of a bond (J).
/// word_word, word_mate, mate_mate : sequence of float, optional
///     Range of the lowest energy (J) over all slides of two words, of a word and another
///     word's mate, and of two mates.
/// model : {"dipole", "cuboid"}, optional
///     Magnet model; the design's by default.
/// seconds : float, optional
///     Search effort in core-seconds, counted in steps.
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

/// Find the strongest attraction between every two words of a set, mates included, over
/// all poses.
///
/// Parameters
/// ----------
/// words : sequence of str or Mapping
///     The words, without their mates, or a whole set with the keys of its file.
/// certify : float or bool, optional
///     Prove that no attraction is stronger, to within this energy (J); True for 1/4 of a
///     contact.
/// certify_cells : int, optional
///     Most cells for the proof.
/// model : {"dipole", "cuboid"}, optional
///     Magnet model; the set's by default.
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
    let found = job::run(py, progress, |told| asked.crosstalk(&set, told))?;
    let found = found.map_err(|why| fault::refused(py, &why))?;
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
