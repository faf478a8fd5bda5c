//! Sets of barcodes that bind their mates and nothing else.

use pyo3::prelude::*;
use tilebind::budget::Budget;
use tilebind::design::WordSet;
use tilebind::report::crosstalk as crosstalk_report;
use tilebind::report::words as report;
use tilebind::word_sets::{self, Request, Spaced};
use tilebind::words::continuous::Wanted;
use tilebind::words::crosstalk::{Stage, TOLERANCE};
use tilebind::words::search::Effort;
use tilebind::words::word::MOST_PLACES;
use tilebind::words::{
    Bar, Constraints, Faces, Fault, Lags, PAPER_FACE, Question, Rules, Shape, Task, answer,
};

use crate::design::Design;
use crate::{convert, fault, job};

/// Find sets of barcodes that bind their mates and nothing else.
///
/// Parameters
/// ----------
/// length : int
///     Magnets of a word.
/// gap : float, optional
///     Least gap, from 0 to 1: the answer is the largest set.
/// count : int, optional
///     Words wanted: the answer is the set with the widest gap. With neither, the number of words
///     for every number of contacts.
/// slots : int, optional
///     Places of a face, of which `length` hold magnets: spacing is part of the code.
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
/// tolerate : {"missing", "flipped"}, optional
///     The words hold though one magnet of every face is missing, or lies the wrong way round.
/// pitch : float, optional
///     From place to place (m).
/// balanced : bool, optional
///     As many north as south poles, or one more.
/// max_run : int, optional
///     Longest run of equal poles.
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
#[pyo3(signature = (length, *, gap = None, count = None, slots = None, continuous = false,
                    face = None, design = None, faces = "all", shape = "none", flip = false,
                    tolerate = None, pitch = None, balanced = false, max_run = None,
                    seconds = 20.0, seed = 1, progress = None))]
#[allow(clippy::too_many_arguments)]
pub fn words<'py>(
    py: Python<'py>,
    length: usize,
    gap: Option<f64>,
    count: Option<usize>,
    slots: Option<usize>,
    continuous: bool,
    face: Option<f64>,
    design: Option<Py<Design>>,
    faces: &str,
    shape: &str,
    flip: bool,
    tolerate: Option<&str>,
    pitch: Option<f64>,
    balanced: bool,
    max_run: Option<usize>,
    seconds: f64,
    seed: u64,
    progress: Option<bool>,
) -> PyResult<Bound<'py, PyAny>> {
    let places = slots.unwrap_or(length);
    if length == 0 || places < length || places > MOST_PLACES {
        return Err(fault::value(format!(
            "length must be at least 1, slots at least as many and at most {MOST_PLACES}"
        )));
    }
    fault::positive("seconds", Some(seconds))?;
    let question = match (gap, count) {
        (Some(_), Some(_)) => return Err(fault::value("give gap or count, not both")),
        (Some(gap), None) if (0.0..=1.0).contains(&gap) => Question::Gap(gap),
        (Some(_), None) => return Err(fault::value("a gap lies between 0 and 1")),
        (None, Some(0)) => return Err(fault::value("count must be at least 1")),
        (None, Some(count)) => Question::Count(count),
        (None, None) => Question::Frontier,
    };
    let rules = Rules {
        faces: match faces {
            "all" => Faces::All,
            "mates" => Faces::Mates,
            _ => return Err(fault::value("faces are \"all\" or \"mates\"")),
        },
        shape: word_shape(shape)?,
        flip,
        fault: match tolerate {
            None => None,
            Some("missing") => Some(Fault::Missing),
            Some("flipped") => Some(Fault::Flipped),
            Some(_) => return Err(fault::value("tolerated are \"missing\" or \"flipped\"")),
        },
    };
    let (bar, whole) = bar(design.as_ref(), pitch)?;
    if continuous {
        if slots.is_some() || rules.shape != Shape::None || rules.fault.is_some() {
            return Err(fault::value(
                "slots, shape and tolerate do not go with continuous=True",
            ));
        }
        fault::positive("face", face)?;
        let wanted = Wanted {
            magnets: length,
            bar,
            face: face.unwrap_or(whole),
            words_meet: rules.faces == Faces::All,
            flip,
            balanced,
            longest_run: max_run,
        };
        let found = job::run(py, progress, |told| {
            told.tell(0.0, "words".to_owned());
            Spaced::search(&wanted, question, seed, seconds)
        })?;
        let found = found.map_err(fault::value)?;
        return convert::json(py, &report::document_of_spaced(&found).report());
    }
    if face.is_some() {
        return Err(fault::value("face goes with continuous=True"));
    }
    let least_spacing = (bar.size[1] / bar.pitch * (1.0 - 1e-9)).ceil() as usize;
    if (length - 1) * least_spacing >= places {
        return Err(fault::value(format!(
            "magnets {} m wide do not fit side by side {} m apart: give a wider pitch",
            bar.size[1], bar.pitch
        )));
    }
    let energies = Lags::new(&bar, places);
    let constraints = Constraints {
        balanced,
        longest_run: max_run,
        least_spacing,
        ..Constraints::default()
    };
    let task = Task {
        places,
        magnets: length,
        lags: energies.clone(),
        rules,
        constraints,
    };
    let mut effort = Effort {
        seed,
        budget: Budget::seconds(seconds),
    };
    let answer = job::run(py, progress, |told| {
        told.tell(0.0, "words".to_owned());
        answer(&task, question, &energies, &mut effort)
    })?;
    let request = Request {
        design: design.map(|design| design.get().content.design.name.clone()),
        bar,
        task,
        question,
        contacts: None,
        seed,
        seconds,
        energies,
    };
    convert::json(py, &report::document(&request, &answer).report())
}

/// A complementary shape by its name.
pub fn word_shape(name: &str) -> PyResult<Shape> {
    match name {
        "none" => Ok(Shape::None),
        "shared" => Ok(Shape::Shared),
        "polar" => Ok(Shape::Polar),
        _ => Err(fault::value("a shape is \"none\", \"shared\" or \"polar\"")),
    }
}

/// The magnets of words, and the length of the face (m).
fn bar(design: Option<&Py<Design>>, pitch: Option<f64>) -> PyResult<(Bar, f64)> {
    fault::positive("pitch", pitch)?;
    let design = design.map(|design| &design.get().content.design);
    let (bar, face) = word_sets::bar(design, pitch, None).map_err(fault::value)?;
    Ok((bar, face.unwrap_or(PAPER_FACE)))
}

/// The strongest attraction of every two words of a set over all poses, with their mates.
///
/// Parameters
/// ----------
/// words : sequence of str or Mapping
///     The words, without their mates, or a whole set with the keys of its file.
/// certify : float or bool, optional
///     Prove that no attraction is stronger, to within so many J; True for a quarter of a contact.
/// cells : int, optional
///     Spent on the proof at most.
/// progress : bool, optional
///
/// Returns
/// -------
/// dict
///     As ``tilebind crosstalk --json``: `words`, `strongest_J`, `lower_J`, `poses`.
#[pyfunction]
#[pyo3(signature = (words, *, certify = None, cells = 8_000_000, progress = None))]
pub fn crosstalk<'py>(
    py: Python<'py>,
    words: &Bound<'py, PyAny>,
    certify: Option<&Bound<'py, PyAny>>,
    cells: usize,
    progress: Option<bool>,
) -> PyResult<Bound<'py, PyAny>> {
    let (set, _) = word_set(py, words)?;
    let stage = Stage::new(
        set.stage.pair.as_ref().clone(),
        set.stage.interaction.clone(),
    );
    let usual = || TOLERANCE * stage.contact_energy();
    let tolerance = match certify.filter(|certify| !certify.is_none()) {
        None => None,
        Some(certify) => match certify.extract::<bool>() {
            Ok(wanted) => wanted.then(usual),
            Err(_) => Some(certify.extract()?),
        },
    };
    fault::positive("certify", tolerance)?;
    let found = job::run(py, progress, |told| {
        told.tell(0.0, "crosstalk".to_owned());
        stage.crosstalk(&set.words, tolerance.map(|tolerance| (tolerance, cells)))
    })?;
    convert::json(py, &crosstalk_report::document(&set, &found).report())
}

/// A set of words and its file, from a list of them or the keys of the file.
pub fn word_set(py: Python<'_>, words: &Bound<'_, PyAny>) -> PyResult<(WordSet, String)> {
    let table = match convert::toml(words)? {
        toml::Value::Table(table) => table,
        list => toml::Table::from_iter([("words".to_owned(), list)]),
    };
    let text = table.to_string();
    let set = WordSet::parse(&text, "words.toml", None);
    Ok((set.map_err(|error| fault::design(py, &error))?, text))
}
