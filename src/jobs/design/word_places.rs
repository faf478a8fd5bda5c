//! Words whose magnets lie anywhere along the face, expressed as words over one common list of
//! places.
//!
//! The places are all positions at which a word or a mate has a magnet. They are mirror-symmetric,
//! so that mates are defined as for evenly spaced words.

use super::error::Result;
use super::quantity;
use super::reader::{Entry, all};
use physics::order::Order;
use physics::words::word::MOST_PLACES;
use physics::words::{Bar, Word};

/// Positions closer than this (m) are equal: a thousandth of the micrometre to which files state
/// them.
const SAME: f64 = 1e-9;

/// Places (m along the face, ascending) and words of faces, each with its name and its list of
/// `magnets`, on faces `side` (m) long.
pub(super) fn common(
    faces: &[(&str, Entry)],
    bar: &Bar,
    side: f64,
) -> Result<(Vec<f64>, Vec<Word>)> {
    let read = faces.iter().map(|face| magnets(face, bar, side));
    let faces_magnets = all(read)?;
    let at = faces_magnets.iter().flatten().map(|(at, _)| *at);
    let mut places: Vec<f64> = at.flat_map(|at| [at, -at]).collect();
    places.order_by(f64::total_cmp);
    places.dedup_by(|a, b| (*a - *b).abs() < SAME);
    if places.len() > MOST_PLACES {
        let message = format!(
            "its words and their mates have magnets at {} positions, more than {MOST_PLACES}",
            places.len()
        );
        return Err(faces[0].1.error(message, "use fewer words at a time"));
    }
    let word = |magnets: &Vec<(f64, &str)>| {
        let letter = |place: &f64| {
            let magnet = magnets.iter().find(|(at, _)| (at - place).abs() < SAME);
            magnet.map_or(".", |(_, pole)| pole)
        };
        let text: String = places.iter().map(letter).collect();
        Word::parse(&text).expect("use N, S and . at no more positions than words have")
    };
    let words = faces_magnets.iter().map(word).collect();
    Ok((places, words))
}

/// The magnets of a face in ascending order: positions along the face (m), and poles.
fn magnets<'a>(
    (name, entry): &(&str, Entry<'a>),
    bar: &Bar,
    side: f64,
) -> Result<Vec<(f64, &'a str)>> {
    let (width, letters) = (bar.size[1], letters(bar));
    let wrong = |message: String, help: &str| Err(entry.error(format!("`{name}` {message}"), help));
    let one = |magnet: &Entry<'a>| {
        let section = magnet.section("a magnet of `magnets`")?;
        section.allow(&["at", "pole"]);
        let at = section.require("at", "give its position along the face: at = 0.02 (m)")?;
        let pole = section.require("pole", "give the outward pole: pole = \"N\"")?;
        Ok((at.number(quantity::ALONG_FACE)?, pole.string()?))
    };
    let mut magnets = all(entry.array()?.iter().map(one))?;
    magnets.order_by(|a, b| a.0.total_cmp(&b.0));
    let half = (side - width) / 2.0 + SAME;
    if magnets.is_empty() {
        let help = "list them: magnets = [{ at = 0.02, pole = \"N\" }]";
        return wrong("has no magnets".to_owned(), help);
    }
    if let Some((at, _)) = magnets.iter().find(|(at, _)| at.abs() > half) {
        return wrong(
            format!("has a magnet at {at} m, which extends beyond its face of {side} m"),
            "positions are from the face's centre, in m",
        );
    }
    let mut pairs = magnets.windows(2);
    if let Some([(one, _), (two, _)]) = pairs.find(|two| two[1].0 - two[0].0 < width - SAME) {
        return wrong(
            format!("has magnets at {one} and {two} m, which overlap: they are {width} m wide"),
            "move them apart",
        );
    }
    let is_known = |pole: &str| letters.iter().any(|letter| pole == letter.to_string());
    if let Some((_, pole)) = magnets.iter().find(|(_, pole)| !is_known(pole)) {
        let help = format!("a pole is \"{}\" or \"{}\"", letters[0], letters[1]);
        return wrong(format!("has the pole `{pole}`"), &help);
    }
    Ok(magnets)
}

/// The letters of the two poles, for magnets that lie flat or point up.
pub(super) fn letters(bar: &Bar) -> [char; 2] {
    match bar.form.stands {
        Some(_) => ['U', 'D'],
        None => ['N', 'S'],
    }
}
