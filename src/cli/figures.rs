//! The options for pictures.

use std::path::Path;

use clap::Args;
use tilebind::report::plots::Sheet;
use tilebind::request;

use super::Failure;

/// Text size (points) that most journals require.
const FONT: f64 = 7.0;

/// Pictures for print.
#[derive(Args)]
pub struct FigureOptions {
    /// Draw pictures for print, at this width (85mm, 18cm, 3.3in)
    ///
    /// Pictures are then without titles, and PDF files are added.
    #[arg(long, value_name = "LENGTH", value_parser = millimetres)]
    figure_width: Option<f64>,

    /// Font size of printed pictures in points [default: 7]
    #[arg(long, value_name = "POINTS", requires = "figure_width", value_parser = request::positive)]
    figure_font: Option<f64>,

    /// Write each panel as a separate picture
    #[arg(long, requires = "figure_width")]
    figure_panels: bool,
}

impl FigureOptions {
    /// The layout of pictures.
    pub fn sheet(&self) -> Result<Sheet, Failure> {
        let Some(width) = self.figure_width else {
            return Ok(Sheet::SCREEN);
        };
        let font = self.figure_font.unwrap_or(FONT);
        let sheet = Sheet::for_print(width, font).map_err(|[least, most]| {
            // Rounded inwards, so that both widths are accepted.
            let (least, most) = (least.ceil(), most.floor());
            Failure::Usage(format!(
                "--figure-width {width}mm: with text of {font} points pictures can be \
                 {least}mm to {most}mm wide\n  help: change the width or --figure-font"
            ))
        })?;
        Ok(match self.figure_panels {
            true => sheet.with_panels_apart(),
            false => sheet,
        })
    }
}

/// A length on paper, in mm.
fn millimetres(text: &str) -> Result<f64, String> {
    let units = [("mm", 1.0), ("cm", 10.0), ("in", 25.4), ("pt", 25.4 / 72.0)];
    let parsed = units.iter().find_map(|(unit, factor)| {
        let number = text.strip_suffix(unit)?.trim_end();
        request::positive(number).ok().map(|number| number * factor)
    });
    parsed.ok_or_else(|| "a width with its unit is needed, such as 85mm, 18cm or 3.3in".to_owned())
}

/// Options that do not change the results, and the number of their values.
const ELSEWHERE: [(&str, usize); 5] = [
    ("--threads", 1),
    ("--quiet", 0),
    ("--force", 0),
    ("--json", 0),
    ("--dry-run", 0),
];

/// The command line that gives the same results, independent of their destination: files are given
/// by their names only.
pub fn command_line() -> String {
    let words = std::env::args_os().skip(1);
    describe(words.map(|word| word.to_string_lossy().into_owned()))
}

fn describe(words: impl Iterator<Item = String>) -> String {
    let mut told = vec!["tilebind".to_owned()];
    let mut left_out = 0;
    let mut words = words;
    while let Some(word) = words.next() {
        if left_out > 0 {
            left_out -= 1;
            continue;
        }
        let name = word.split('=').next().unwrap_or_default();
        if let Some((_, more)) = ELSEWHERE.iter().find(|(option, _)| *option == name) {
            left_out = if word.contains('=') { 0 } else { *more };
            continue;
        }
        if ["--out", "-o"].contains(&name) {
            let place = word.split_once('=').map(|(_, place)| place.to_owned());
            let place = place.or_else(|| words.next()).unwrap_or_default();
            told.extend(["--out".to_owned(), elsewhere(&place).to_owned()]);
            continue;
        }
        let file = word
            .ends_with(".toml")
            .then(|| word.rsplit(['/', '\\']).next());
        let word = file.flatten().unwrap_or(&word);
        let plain = |c: char| c.is_alphanumeric() || "-_.,:=/+".contains(c);
        told.push(match !word.is_empty() && word.chars().all(plain) {
            true => word.to_owned(),
            false => format!("'{}'", word.replace('\'', r"'\''")),
        });
    }
    told.join(" ")
}

/// The destination in the shown command: a neutral folder, or a picture of the same format.
fn elsewhere(place: &str) -> &'static str {
    match Path::new(place)
        .extension()
        .and_then(|ending| ending.to_str())
    {
        Some("svg") => "results.svg",
        Some("png") => "results.png",
        Some("pdf") => "results.pdf",
        _ => "results",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_width_has_a_unit() {
        assert_eq!(millimetres("85mm"), Ok(85.0));
        assert_eq!(millimetres("8.5 cm"), Ok(85.0));
        assert!((millimetres("1in").unwrap() - 25.4).abs() < 1e-12);
        for wrong in ["85", "mm", "-85mm", "85 m", ""] {
            assert!(millimetres(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn the_widths_that_a_refusal_names_are_accepted() {
        let sheet = |width: f64| {
            let options = FigureOptions {
                figure_width: Some(width),
                figure_font: None,
                figure_panels: false,
            };
            options.sheet()
        };
        let Err(Failure::Usage(refused)) = sheet(10.0) else {
            panic!("too narrow");
        };
        let range = refused.split("can be ").nth(1).expect("a range");
        let named = range
            .split("mm")
            .take(2)
            .map(|word| word.trim_start_matches(" to "));
        let named: Vec<f64> = named.map(|word| word.parse().expect("a number")).collect();
        assert!(named.iter().all(|width| sheet(*width).is_ok()), "{named:?}");
    }

    #[test]
    fn the_command_line_is_told_without_what_does_not_matter() {
        let words = "analyse a/b c.toml --out x --seed 3 --threads=2 --quiet --dynamics=100";
        let words = words.replace("b c", "b\u{a0}c");
        let words = words.split(' ').map(|word| word.replace('\u{a0}', " "));
        let expected = "tilebind analyse 'b c.toml' --out results --seed 3 --dynamics=100";
        assert_eq!(describe(words), expected);
        let words = ["show", "a.toml", "--out=b/c.png"].map(str::to_owned);
        assert_eq!(
            describe(words.into_iter()),
            "tilebind show a.toml --out results.png"
        );
    }
}
