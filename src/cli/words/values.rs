//! What the options of `tilebind words` mean.

use tilebind::words::{Faces, Fault, Shape};

use tilebind::request::Word;

/// A gap.
pub fn gap(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|gap: &f64| (0.0..=1.0).contains(gap))
        .ok_or_else(|| "a gap lies between 0 (wrong as strong as right) and 1".to_owned())
}

pub fn faces() -> Word<Faces> {
    let names = [("all", Faces::All), ("mates", Faces::Mates)];
    Word::new(&names, "faces are all or mates".to_owned())
}

pub fn shape() -> Word<Shape> {
    let names = [
        ("none", Shape::None),
        ("shared", Shape::Shared),
        ("polar", Shape::Polar),
    ];
    Word::new(&names, "a shape is none, shared or polar".to_owned())
}

pub fn mismatches(text: &str) -> Result<[usize; 3], String> {
    let parts: Option<Vec<usize>> = text
        .split(',')
        .map(|part| part.trim().parse().ok())
        .collect();
    parts
        .and_then(|parts| parts.try_into().ok())
        .ok_or_else(|| "three whole numbers are needed, such as 2,2,0".to_owned())
}

pub fn whole_range(text: &str) -> Result<[usize; 2], String> {
    let wrong = || "a range is A:B in whole numbers, such as 0:3".to_owned();
    let (low, high) = text.split_once(':').ok_or_else(wrong)?;
    let [low, high] = [low, high].map(|part| part.trim().parse().ok());
    let range = low.zip(high).filter(|(low, high)| low <= high);
    range.map(|(low, high)| [low, high]).ok_or_else(wrong)
}

pub fn range(text: &str) -> Result<[f64; 2], String> {
    let wrong = || "a range is E:E in J, from the lower to the higher, such as -0.02:0".to_owned();
    let (low, high) = text.split_once(':').ok_or_else(wrong)?;
    let number = |part: &str| part.trim().parse().ok().filter(|x: &f64| !x.is_nan());
    let range = number(low)
        .zip(number(high))
        .filter(|(low, high)| low <= high);
    range.map(|(low, high)| [low, high]).ok_or_else(wrong)
}

pub fn fault() -> Word<Fault> {
    let names = [("missing=1", Fault::Missing), ("flipped=1", Fault::Flipped)];
    Word::new(&names, "tolerate missing=1 or flipped=1".to_owned())
}
