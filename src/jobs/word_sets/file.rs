//! Sets of words as files: `tilebind crosstalk` reads them, and their faces can be pasted into a
//! design.

use std::fmt::Write;

use crate::design::written;
use physics::units::MU0;
use physics::words::continuous::SpacedWord;
use physics::words::set::name;
use physics::words::{Bar, Word};

/// The file of words with a pitch, on faces of length `side` (m); words that bind their `own` kind
/// have no mates.
pub fn of_words(headline: &str, words: &[Word], bar: &Bar, side: f64, own: bool) -> String {
    let quoted: Vec<String> = words.iter().map(|word| format!("\"{word}\"")).collect();
    let list = format!("words = [{}]\n\n", quoted.join(", "));
    let code = |word: Word| format!("code = \"{word}\"");
    let faces = words
        .iter()
        .map(|word| (code(*word), (!own).then(|| code(word.mate()))));
    text(headline, &list, bar, side, faces)
}

/// The file of words with magnets anywhere along the face.
pub fn of_spaced(headline: &str, words: &[SpacedWord], bar: &Bar, side: f64) -> String {
    let magnets = |word: &SpacedWord| {
        let letters = word.code(bar.form.stands.is_some());
        let magnets = word.magnets.iter().zip(letters.chars());
        // Avoids -0.
        let magnets =
            magnets.map(|((at, _), pole)| format!("{{ at = {:?}, pole = \"{pole}\" }}", at + 0.0));
        format!("magnets = [{}]", magnets.collect::<Vec<_>>().join(", "))
    };
    let faces = words
        .iter()
        .map(|word| (magnets(word), Some(magnets(&word.mate()))));
    text(headline, "", bar, side, faces)
}

/// The text of a set: its magnets, the tiles' side (m), and the entries of each face and its mate.
fn text(
    headline: &str,
    list: &str,
    bar: &Bar,
    side: f64,
    faces: impl Iterator<Item = (String, Option<String>)>,
) -> String {
    // Rounds, since rounding errors would show as spurious digits.
    let rounded = |x: f64| (x * 1e9).round() / 1e9;
    let remanence = rounded(MU0 * bar.moment / bar.form.shape.volume(bar.size));
    let mut text = format!(
        "# {headline}\n\n{list}[magnet]\n{}\
         remanence = {remanence:?}\npitch = {:?}\n",
        written::magnet(bar.form, bar.size),
        bar.pitch
    );
    if bar.inset > 0.0 {
        let _ = writeln!(text, "inset = {:?}", rounded(bar.inset));
    }
    let _ = writeln!(text, "\n[tile]\nside = {:?}", rounded(side));
    let _ = writeln!(text, "\n[potential]\nmodel = \"{}\"", bar.model.name());
    text += "\n# Ready to paste into [fixed.faces] or [moving.faces] of a design, under the name \
        of a face\n# (east = { ... }); X* is the mate of X.\n[faces]\n";
    for (k, (word, mate)) in faces.enumerate() {
        let name = name(k);
        let _ = writeln!(text, "{name} = {{ {word} }}");
        if let Some(mate) = mate {
            let _ = writeln!(text, "\"{name}*\" = {{ {mate} }}");
        }
    }
    text
}
