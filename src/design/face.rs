//! The entries of `[fixed.faces]` and `[moving.faces]`: a face's line and its magnets.

use super::error::Span;
use super::magnet::{ListedMagnet, MAGNET_KEYS, MagnetKeys};
use super::quantity;
use super::reader::{Entry, Result, Section, nearest_help};
use crate::tile::barcode::{Barcode, BarcodeError};
use crate::tile::profile::{Polyline, Profile, ProfileError, Waveform, complement};

/// The magnets of a face, before their sizes and spacing are known.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Pattern {
    /// A code, with the place of each of its characters in the file.
    Code(Barcode, Vec<Span>),
    /// Magnets one by one.
    List(Vec<ListedMagnet>),
}

impl Pattern {
    fn mate(&self) -> Self {
        match self {
            Self::Code(code, spans) => {
                Self::Code(code.mate(), spans.iter().rev().copied().collect())
            }
            Self::List(magnets) => {
                Self::List(magnets.iter().rev().map(|magnet| magnet.mate()).collect())
            }
        }
    }
}

/// Everything that makes a face, before it is put on its tile.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FaceContent {
    pub polyline: Polyline,
    /// How far the line is drawn back (m).
    pub fit: f64,
    pub pattern: Pattern,
    pub keys: MagnetKeys,
    /// Where the file draws the line, and where it places the magnets.
    pub line_span: Span,
    pub pattern_span: Span,
}

impl FaceContent {
    /// The complement: the line mirrored, every magnet exchanged for the one that binds it.
    fn mate(&self, at: Span) -> Self {
        Self {
            polyline: complement(&self.polyline),
            fit: 0.0,
            pattern: self.pattern.mate(),
            keys: self.keys.mate(),
            line_span: at,
            pattern_span: at,
        }
    }
}

/// What the file says of one face: its own entry over `all`.
#[derive(Clone, Copy)]
pub(super) struct FaceEntry<'a> {
    own: Option<Section<'a>>,
    all: Option<Section<'a>>,
}

const FACE_KEYS: [&str; 6] = ["code", "magnets", "profile", "magnet", "mates", "fit"];

impl<'a> FaceEntry<'a> {
    pub fn new(own: Option<Section<'a>>, all: Option<Section<'a>>) -> Result<Self> {
        for section in [&own, &all].into_iter().flatten() {
            if let Some(shield) = section.get("shield") {
                return Err(super::shield::refused(&shield));
            }
            section.allow(&FACE_KEYS)?;
            if let (Some(mates), Some(other)) = (section.get("mates"), first_of(section)) {
                return Err(other.key_error(
                    format!(
                        "`mates` and `{}` both say what this face is like",
                        other.key
                    ),
                    format!(
                        "a mate takes shape and magnets from `{}`: keep one of the two",
                        mates.string()?
                    ),
                ));
            }
            if let (Some(_), Some(magnets)) = (section.get("code"), section.get("magnets")) {
                return Err(magnets.key_error(
                    "`code` and `magnets` both place the magnets of this face",
                    "keep one of the two",
                ));
            }
        }
        Ok(Self { own, all })
    }

    /// The face that this one mates with, unless the face's own entry describes a face of its own.
    pub fn mates(&self) -> Option<Entry<'a>> {
        let own = self.own.and_then(|own| own.get("mates"));
        let of_its_own = self.own.as_ref().and_then(first_of).is_some();
        own.or_else(|| self.all.filter(|_| !of_its_own)?.get("mates"))
    }

    fn get(&self, key: &str) -> Option<Entry<'a>> {
        [self.own, self.all]
            .into_iter()
            .flatten()
            .find_map(|section| section.get(key))
    }

    /// The entry of the first of `keys` that the face's own entry has, then of `all`.
    fn get_either(&self, keys: [&str; 2]) -> Option<Entry<'a>> {
        [self.own, self.all]
            .into_iter()
            .flatten()
            .find_map(|section| keys.iter().find_map(|key| section.get(key)))
    }

    /// The content of a face that mates with none; `length` is the face's (m).
    pub fn content(&self, length: f64, keys: MagnetKeys, span: Span) -> Result<FaceContent> {
        if let Some(fit) = self.own.and_then(|own| own.get("fit")) {
            return Err(fit.key_error(
                "`fit` draws a mate back, and this face has no `mates`",
                "add `mates = \"FACE\"`, or take `fit` away",
            ));
        }
        let profile = self.get("profile");
        let pattern = self.get_either(["code", "magnets"]);
        Ok(FaceContent {
            polyline: match &profile {
                Some(entry) => read_profile(entry, length)?,
                None => Polyline::new(),
            },
            fit: 0.0,
            pattern: match &pattern {
                Some(entry) => read_pattern(entry)?,
                None => Pattern::List(Vec::new()),
            },
            keys: self.magnet_keys()?.over(keys),
            line_span: profile.map_or(span, |entry| entry.span()),
            pattern_span: pattern.map_or(span, |entry| entry.span()),
        })
    }

    /// The content of a face that mates with `partner`.
    pub fn mate_of(&self, partner: &FaceContent, mates: &Entry) -> Result<FaceContent> {
        let fit = match self.get("fit") {
            Some(entry) => entry.number(quantity::FIT)?,
            None => 0.0,
        };
        let complement = partner.mate(mates.span());
        Ok(FaceContent {
            fit,
            keys: self.magnet_keys()?.over(complement.keys),
            ..complement
        })
    }

    fn magnet_keys(&self) -> Result<MagnetKeys> {
        let mut keys = MagnetKeys::default();
        for section in [self.own, self.all].into_iter().flatten() {
            if let Some(magnet) = section.section("magnet", "`magnet`")? {
                magnet.allow(&MAGNET_KEYS)?;
                keys = keys.over(MagnetKeys::read(&magnet)?);
            }
        }
        Ok(keys)
    }
}

/// The first key of a face's entry that `mates` would replace.
fn first_of<'a>(section: &Section<'a>) -> Option<Entry<'a>> {
    ["code", "magnets", "profile"]
        .iter()
        .find_map(|key| section.get(key))
}

fn read_pattern(entry: &Entry) -> Result<Pattern> {
    if entry.key == "magnets" {
        let magnets = entry
            .array()?
            .iter()
            .map(ListedMagnet::read)
            .collect::<Result<_>>()?;
        return Ok(Pattern::List(magnets));
    }
    let text = entry.string()?;
    let code = Barcode::parse(text).map_err(|error: BarcodeError| {
        let help = match error.character {
            'n' | 's' => format!("write {}", error.character.to_ascii_uppercase()),
            _ => "N is north pole out, S south pole out, . no magnet".to_owned(),
        };
        let span = entry.character_span(error.index);
        entry.error_at(span, error.to_string(), help)
    })?;
    let spans = (0..code.len()).map(|k| entry.character_span(k)).collect();
    Ok(Pattern::Code(code, spans))
}

#[derive(Clone, Copy)]
enum Shape {
    Flat,
    Tab,
    Teeth,
    Arc,
    Points,
    Svg,
}

const SHAPES: [(&str, Shape); 6] = [
    ("flat", Shape::Flat),
    ("tab", Shape::Tab),
    ("teeth", Shape::Teeth),
    ("arc", Shape::Arc),
    ("points", Shape::Points),
    ("svg", Shape::Svg),
];

/// Most teeth on a face.
const MOST_TEETH: u32 = 200;

fn read_profile(entry: &Entry, length: f64) -> Result<Polyline> {
    let section = entry.section("`profile`")?;
    let example = "say shape = \"flat\", \"tab\", \"teeth\", \"arc\", \"points\" or \"svg\"";
    let shape = section.require("shape", example)?.word(&SHAPES)?;
    let profile = match shape {
        Shape::Flat => flat(&section),
        Shape::Tab => tab(&section),
        Shape::Teeth => teeth(&section, length),
        Shape::Arc => arc(&section),
        Shape::Points => points(&section),
        Shape::Svg => return Err(super::svg::refused(&section)),
    }?;
    let line = profile.polyline().map_err(|error| mend(&section, error))?;
    within_face(&section, &line, length)?;
    Ok(line)
}

fn flat(section: &Section) -> Result<Profile> {
    section.allow(&["shape"])?;
    Ok(Profile::Flat)
}

fn tab(section: &Section) -> Result<Profile> {
    section.allow(&["shape", "width", "depth", "draft", "offset"])?;
    Ok(Profile::Tab {
        width: width(section)?,
        depth: depth(section)?,
        draft: section.number("draft", quantity::DRAFT)?.unwrap_or(0.0),
        offset: section
            .number("offset", quantity::ALONG_FACE)?
            .unwrap_or(0.0),
    })
}

fn teeth(section: &Section, length: f64) -> Result<Profile> {
    section.allow(&["shape", "form", "count", "depth", "span"])?;
    let forms = [
        ("sine", Waveform::Sine),
        ("triangle", Waveform::Triangle),
        ("square", Waveform::Square),
    ];
    let form = section.require("form", "say form = \"sine\", \"triangle\" or \"square\"")?;
    let count = section.require("count", "say how many teeth: count = 4")?;
    Ok(Profile::Teeth {
        form: form.word(&forms)?,
        count: count.count(MOST_TEETH)?,
        depth: depth(section)?,
        span: section
            .number("span", quantity::PROFILE_WIDTH)?
            .unwrap_or(length),
    })
}

fn arc(section: &Section) -> Result<Profile> {
    section.allow(&["shape", "width", "depth", "offset"])?;
    Ok(Profile::Arc {
        width: width(section)?,
        depth: depth(section)?,
        offset: section
            .number("offset", quantity::ALONG_FACE)?
            .unwrap_or(0.0),
    })
}

fn points(section: &Section) -> Result<Profile> {
    section.allow(&["shape", "points"])?;
    let points = section.require("points", "give the line: points = [[s, h], ...] (m)")?;
    let points = points
        .array()?
        .iter()
        .map(|point| point.numbers::<2>(quantity::ALONG_FACE, "s along the face and h outwards"))
        .collect::<Result<_>>()?;
    Ok(Profile::Points(points))
}

fn width(section: &Section) -> Result<f64> {
    section
        .require("width", "say how wide it is at its base: width = 0.20 (m)")?
        .number(quantity::PROFILE_WIDTH)
}

fn depth(section: &Section) -> Result<f64> {
    section
        .require(
            "depth",
            "say how far it sticks out: depth = 0.02 (m; negative cuts in)",
        )?
        .number(quantity::PROFILE_DEPTH)
}

/// A profile that cannot be drawn, as a fault of the key that is to be changed.
fn mend(section: &Section, error: ProfileError) -> super::DesignError {
    match error {
        ProfileError::SidesMeet { largest_draft } => {
            let key = if section.get("draft").is_some() {
                "draft"
            } else {
                "depth"
            };
            let help = format!(
                "keep draft below {} rad, or make the tab wider or less deep",
                quantity::four_digits(largest_draft)
            );
            match section.get(key) {
                Some(entry) => entry.error(error.to_string(), help),
                None => section.error(error.to_string(), help),
            }
        }
        ProfileError::OffTheBaseLine { first, .. } => {
            let points = section.get("points");
            let items = points
                .and_then(|entry| entry.array().ok())
                .unwrap_or_default();
            let item = if first { items.first() } else { items.last() };
            let help = "begin and end the profile at h = 0";
            match item {
                Some(item) => item.error(error.to_string(), help),
                None => section.error(error.to_string(), help),
            }
        }
        ProfileError::TooFewPoints => {
            section.error(error.to_string(), "give more points, or shape = \"flat\"")
        }
    }
}

/// Refuses a profile that leaves its face to the left or to the right.
fn within_face(section: &Section, line: &[[f64; 2]], length: f64) -> Result<()> {
    let half = length / 2.0;
    let farthest = line
        .iter()
        .enumerate()
        .max_by(|(_, a), (_, b)| a[0].abs().total_cmp(&b[0].abs()));
    let Some((index, &[s, _])) = farthest.filter(|(_, p)| p[0].abs() > half * (1.0 + 1e-12)) else {
        return Ok(());
    };
    let message = format!(
        "the profile leaves its face: it reaches s = {}, the face ends at {}",
        quantity::four_digits(s),
        quantity::four_digits(half.copysign(s))
    );
    let help = format!(
        "the face is {} m long; make the profile narrower or move it inwards",
        quantity::four_digits(length)
    );
    let point = section
        .get("points")
        .and_then(|entry| entry.array().ok()?.get(index).copied());
    let culprit = point.or_else(|| ["width", "span"].iter().find_map(|key| section.get(key)));
    Err(match culprit {
        Some(entry) => entry.error(message, help),
        None => section.error(message, help),
    })
}

/// Which face a word or number means, among the names of a tile's faces.
pub(super) fn find_face(names: &[Vec<String>], entry: &Entry, tile: &str) -> Result<usize> {
    let name = entry.name_or_number()?;
    names
        .iter()
        .position(|names| names.contains(&name))
        .ok_or_else(|| {
            let known: Vec<_> = names.iter().map(|names| names[0].as_str()).collect();
            entry.error(
                format!("the {tile} tile has no face `{name}`"),
                nearest_help(&name, &known),
            )
        })
}
