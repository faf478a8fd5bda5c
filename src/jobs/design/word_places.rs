//! Words whose magnets lie anywhere along the face, as words over places common to all of them.
//!
//! The places are where any word or mate has a magnet: they lie mirror-symmetrically, so that the
//! mate of a word is what it is for evenly spaced ones.

use serde::Deserialize;

use physics::order::Order;
use physics::words::Word;
use physics::words::word::MOST_PLACES;

/// A magnet of a list `magnets = [{ at, pole }]`.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MagnetAt {
    at: f64,
    pole: String,
}

/// Positions closer than this (m) are one.
const SAME: f64 = 1e-9;

/// Places (m along the face, ascending) and words; a message and its mend where there are none such.
/// Magnets are `width` (m) wide, faces `side` (m) long.
pub(super) fn common(
    faces: &[(String, Vec<MagnetAt>)],
    width: f64,
    side: f64,
) -> Result<(Vec<f64>, Vec<Word>), (String, String)> {
    let mut places: Vec<f64> = Vec::new();
    for (name, magnets) in faces {
        let wrong =
            |message: String, help: &str| Err((format!("`{name}` {message}"), help.to_owned()));
        let mut sorted: Vec<f64> = magnets.iter().map(|magnet| magnet.at).collect();
        sorted.order_by(f64::total_cmp);
        if sorted.is_empty() {
            return wrong(
                "has no magnets".to_owned(),
                "list them: magnets = [{ at = 0.02, pole = \"N\" }]",
            );
        }
        if let Some(at) = sorted
            .iter()
            .find(|at| at.is_nan() || at.abs() + width / 2.0 > side / 2.0 + SAME)
        {
            return wrong(
                format!("has a magnet at {at} m, which reaches beyond its face of {side} m"),
                "positions are from the face's middle, in m",
            );
        }
        if let Some(two) = sorted.windows(2).find(|two| two[1] - two[0] < width - SAME) {
            return wrong(
                format!(
                    "has magnets at {} and {} m, which overlap: they are {width} m wide",
                    two[0], two[1]
                ),
                "move them apart",
            );
        }
        if let Some(magnet) = magnets
            .iter()
            .find(|magnet| !["N", "S"].contains(&magnet.pole.as_str()))
        {
            return wrong(
                format!("has the pole `{}`", magnet.pole),
                "a pole is \"N\" or \"S\"",
            );
        }
        places.extend(sorted.iter().flat_map(|at| [*at, -at]));
    }
    places.order_by(f64::total_cmp);
    places.dedup_by(|a, b| (*a - *b).abs() < SAME);
    if places.len() > MOST_PLACES {
        let message = format!(
            "its words and their mates have magnets at {} places, more than {MOST_PLACES}",
            places.len()
        );
        return Err((message, "judge fewer words at a time".to_owned()));
    }
    let words = faces.iter().map(|(_, magnets)| word(magnets, &places));
    Ok((places.clone(), words.collect()))
}

fn word(magnets: &[MagnetAt], places: &[f64]) -> Word {
    let letter = |place: &f64| {
        let magnet = magnets
            .iter()
            .find(|magnet| (magnet.at - place).abs() < SAME);
        magnet.map_or(".", |magnet| magnet.pole.as_str())
    };
    let text: String = places.iter().map(letter).collect();
    Word::parse(&text).expect("N, S and . at no more places than words have")
}
