//! The files of a set of words: tables, and `words.toml`.

use std::fmt::Write;

use super::{Request, headline, name, value};
use crate::csv::table;
use crate::files::{Files, with_report};
use crate::page::Page;
use crate::values::positive_zero;
use physics::potential::MagnetModel;
use physics::units::MU0;
use physics::words::{Answer, Bar};

/// All files of an answer, made by `command`.
pub fn files(request: &Request, answer: &Answer, command: &str) -> Files {
    let mut files = Files::new();
    let mut add = |name: &str, text: String| {
        files.insert(name.to_owned(), text.into_bytes());
    };
    add("words.csv", words_csv(request, answer));
    add("crosstalk.csv", crosstalk_csv(request, answer));
    add("words.toml", words_toml(request, answer));
    let page = Page::of_words(request, answer);
    with_report(files, Some(page), &value(request, answer), command)
}

/// The words, each with its bond and its own worst meeting.
fn words_csv(request: &Request, answer: &Answer) -> String {
    let rows = answer.words.iter().enumerate().map(|(k, word)| {
        let worst = answer
            .words
            .iter()
            .filter_map(|other| request.strongest(*word, *other));
        let worst = worst.min_by(|a, b| a.energy.total_cmp(&b.energy));
        let or_empty = |text: Option<String>| text.unwrap_or_default();
        vec![
            name(k),
            word.to_string(),
            word.mate().to_string(),
            request
                .task
                .rules
                .bond(&request.energies, *word)
                .to_string(),
            or_empty(worst.map(|it| it.energy.to_string())),
            or_empty(worst.map(|it| it.second.to_string())),
            or_empty(worst.map(|it| it.slide.to_string())),
            or_empty(worst.map(|it| it.flipped.to_string())),
        ]
    });
    let header = [
        "name",
        "word",
        "mate",
        "bond_J",
        "worst_J",
        "worst_with",
        "worst_slide",
        "worst_flipped",
    ];
    table(header.map(str::to_owned), rows)
}

/// Every two words, with their mates: the strongest wrong meeting, and the pose of the second tile
/// in the frame of the first where both are squares as wide as the words need.
fn crosstalk_csv(request: &Request, answer: &Answer) -> String {
    let words = &answer.words;
    let pairs = (0..words.len()).flat_map(|i| (i..words.len()).map(move |j| (i, j)));
    let rows = pairs.filter_map(|(i, j)| {
        let worst = request.strongest(words[i], words[j])?;
        let slide = positive_zero(f64::from(worst.slide) * request.bar.pitch);
        let second = match worst.second == words[j] {
            true => name(j),
            false => name(j) + "*",
        };
        Some(vec![
            name(i),
            second,
            worst.first.to_string(),
            worst.second.to_string(),
            worst.energy.to_string(),
            worst.slide.to_string(),
            slide.to_string(),
            worst.flipped.to_string(),
            request.side().to_string(),
            slide.to_string(),
            "0".to_owned(),
        ])
    });
    let header = [
        "first",
        "second",
        "first_code",
        "second_code",
        "energy_J",
        "slide",
        "slide_m",
        "flipped",
        "x_m",
        "y_m",
        "theta_rad",
    ];
    table(header.map(str::to_owned), rows)
}

/// The set as a file: `tilebind crosstalk` reads it, and its faces can be pasted into a design.
fn words_toml(request: &Request, answer: &Answer) -> String {
    let (words, bar) = (&answer.words, &request.bar);
    let quoted: Vec<String> = words.iter().map(|word| format!("\"{word}\"")).collect();
    let list = format!("words = [{}]\n\n", quoted.join(", "));
    let faces = words.iter().map(|word| {
        [word.to_string(), word.mate().to_string()].map(|code| format!("code = \"{code}\""))
    });
    set_toml(
        &headline(request, answer),
        &list,
        bar,
        request.side(),
        faces,
    )
}

/// The text of a set: its magnets, the tiles' side (m), and what each face and its mate hold.
pub fn set_toml(
    headline: &str,
    list: &str,
    bar: &Bar,
    side: f64,
    faces: impl Iterator<Item = [String; 2]>,
) -> String {
    let [length, width, thickness] = bar.size;
    // A rounding error would make figures that nobody typed.
    let rounded = |x: f64| (x * 1e9).round() / 1e9;
    let remanence = rounded(MU0 * bar.moment / (length * width * thickness));
    let mut text = format!(
        "# {headline}\n\n{list}[magnet]\nsize = [{length}, {width}, {thickness}]\n\
         remanence = {remanence:?}\npitch = {:?}\n",
        bar.pitch
    );
    if bar.inset > 0.0 {
        let _ = writeln!(text, "inset = {:?}", bar.inset);
    }
    let _ = writeln!(text, "\n[tile]\nside = {:?}", rounded(side));
    if bar.model == MagnetModel::Cuboid {
        text += "\n[potential]\nmodel = \"cuboid\"\n";
    }
    text += "\n# Ready to paste into [fixed.faces] or [moving.faces] of a design, by the name of a \
             face\n# (east = { ... }); X* is the mate of X.\n[faces]\n";
    for (k, [word, mate]) in faces.enumerate() {
        let name = name(k);
        let _ = writeln!(text, "{name} = {{ {word} }}\n\"{name}*\" = {{ {mate} }}");
    }
    text
}
