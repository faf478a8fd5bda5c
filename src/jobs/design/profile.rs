//! The key `profile` of a face: which line its outline follows.

use ordered_float::OrderedFloat;

use super::DesignError;
use super::error::Result;
use super::quantity;
use super::reader::{Entry, Section, all};
use super::svg;
use physics::tile::profile::{Polyline, Profile, ProfileError, Waveform};

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

impl Shape {
    /// The keys of a profile of this shape.
    const fn keys(self) -> &'static [&'static str] {
        match self {
            Self::Flat => &["shape"],
            Self::Tab => &["shape", "width", "depth", "draft", "offset"],
            Self::Teeth => &["shape", "form", "count", "depth", "span"],
            Self::Arc => &["shape", "width", "depth", "offset"],
            Self::Points => &["shape", "points"],
            Self::Svg => &["shape", "file", "unit", "id", "offset"],
        }
    }
}

/// The shapes that can be read, and the keys of each.
#[cfg(test)]
pub(super) fn shapes() -> impl Iterator<Item = (&'static str, &'static [&'static str])> {
    SHAPES.into_iter().map(|(name, shape)| (name, shape.keys()))
}

/// Most points of a face's line, curves drawn as chords: contact with more takes too long.
const MOST_POINTS: usize = 4000;

/// Most teeth on a face.
const MOST_TEETH: u32 = 200;

/// The line of a face of the given length (m), as its `profile` draws it.
pub(super) fn read_profile(entry: &Entry, length: f64) -> Result<(Profile, Polyline)> {
    let section = entry.section("`profile`")?;
    let example = "say shape = \"flat\", \"tab\", \"teeth\", \"arc\", \"points\" or \"svg\"";
    let shape = section.require("shape", example)?.word(&SHAPES)?;
    section.allow(shape.keys());
    let profile = match shape {
        Shape::Flat => Ok(Profile::Flat),
        Shape::Tab => tab(&section),
        Shape::Teeth => teeth(&section, length),
        Shape::Arc => arc(&section),
        Shape::Points => points(&section),
        Shape::Svg => svg::read_line(&section).map(Profile::Points),
    }?;
    section.source.faults.check_guesses()?;
    let line = profile.polyline();
    let line = line.map_err(|error| mend(&section, &profile, error))?;
    within_face(&section, &profile, &line, length)?;
    if line.len() > MOST_POINTS {
        return Err(section.error(
            format!(
                "the profile's line has {} points, more than {MOST_POINTS}",
                line.len()
            ),
            "give it fewer or shallower teeth, or fewer points",
        ));
    }
    Ok((profile, line))
}

fn tab(section: &Section) -> Result<Profile> {
    let (width, depth) = (width(section), depth(section));
    let draft = section.number("draft", quantity::DRAFT);
    Ok(Profile::Tab {
        width: width?,
        depth: depth?,
        draft: draft?.unwrap_or(0.0),
        offset: offset(section)?,
    })
}

fn teeth(section: &Section, length: f64) -> Result<Profile> {
    let forms = [
        ("sine", Waveform::Sine),
        ("triangle", Waveform::Triangle),
        ("square", Waveform::Square),
    ];
    let form = section.require("form", "say form = \"sine\", \"triangle\" or \"square\"")?;
    let count = section.require("count", "say how many teeth: count = 4")?;
    let form = form.word(&forms);
    let count = count.count(MOST_TEETH);
    let depth = depth(section);
    Ok(Profile::Teeth {
        form: form?,
        count: count?,
        depth: depth?,
        span: section
            .number("span", quantity::PROFILE_WIDTH)?
            .unwrap_or(length),
    })
}

fn arc(section: &Section) -> Result<Profile> {
    let (width, depth) = (width(section), depth(section));
    Ok(Profile::Arc {
        width: width?,
        depth: depth?,
        offset: offset(section)?,
    })
}

fn offset(section: &Section) -> Result<f64> {
    let offset = section.number("offset", quantity::ALONG_FACE)?;
    Ok(offset.unwrap_or(0.0))
}

fn points(section: &Section) -> Result<Profile> {
    let points = section.require("points", "give the line: points = [[s, h], ...] (m)")?;
    let points = points.array()?;
    let what = "s along the face and h outwards";
    let points = points
        .iter()
        .map(|point| point.numbers::<2>(quantity::ALONG_FACE, what));
    Ok(Profile::Points(all(points)?))
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
fn mend(section: &Section, profile: &Profile, error: ProfileError) -> DesignError {
    match error {
        ProfileError::SidesMeet { largest_draft } => {
            let key = if section.get("draft").is_some() {
                "draft"
            } else {
                "depth"
            };
            let less_deep = match profile {
                Profile::Tab { width, draft, .. } if *draft > 0.0 => {
                    let largest = quantity::rounded_down(width / 2.0 / libm::tan(*draft));
                    format!("less deep than {largest} m")
                }
                _ => "less deep".to_owned(),
            };
            let help = format!(
                "keep draft below {} rad, or make the tab wider or {less_deep}",
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
fn within_face(section: &Section, profile: &Profile, line: &[[f64; 2]], length: f64) -> Result<()> {
    let half = length / 2.0;
    let farthest = line
        .iter()
        .enumerate()
        .max_by_key(|(_, p)| OrderedFloat(p[0].abs()));
    let Some((index, &[s, _])) = farthest.filter(|(_, p)| p[0].abs() > half * (1.0 + 1e-12)) else {
        return Ok(());
    };
    let message = format!(
        "the profile leaves its face: it reaches s = {}, the face ends at {}",
        quantity::four_digits(s),
        quantity::four_digits(half.copysign(s))
    );
    let point = section
        .get("points")
        .and_then(|entry| entry.array().ok()?.get(index).copied());
    let (key, mend) = narrower(profile, half);
    let help = format!(
        "the face is {} m long; {mend}",
        quantity::four_digits(length)
    );
    Err(match point.or_else(|| section.get(key)) {
        Some(entry) => entry.error(message, help),
        None => section.error(message, help),
    })
}

/// The key that makes a profile too wide for a face of half this length (m), and how to change it.
fn narrower(profile: &Profile, half: f64) -> (&'static str, String) {
    let at_most = |key: &'static str, largest: f64| {
        let largest = quantity::rounded_down(largest);
        (
            key,
            format!("`{key}` may be up to {largest} m in size here"),
        )
    };
    match *profile {
        // Wider than its base: by its depth.
        Profile::Tab {
            width,
            draft,
            offset,
            ..
        } if draft < 0.0 && width / 2.0 + offset.abs() < half => {
            let room = half - offset.abs() - width / 2.0;
            at_most("depth", room / libm::tan(draft.abs()))
        }
        Profile::Arc { width, offset, .. } if width / 2.0 + offset.abs() < half => {
            // The circle's radius (w^2/4 + d^2) / 2d must not exceed the room beside its middle.
            let room = half - offset.abs();
            at_most("depth", room + (room * room - width * width / 4.0).sqrt())
        }
        Profile::Tab { offset, .. } | Profile::Arc { offset, .. } if offset.abs() < half => {
            at_most("width", 2.0 * (half - offset.abs()))
        }
        Profile::Tab { .. } | Profile::Arc { .. } => at_most("offset", half),
        Profile::Teeth { .. } => at_most("span", 2.0 * half),
        Profile::Flat | Profile::Points(_) => (
            "file",
            "make the profile narrower or move it inwards".to_owned(),
        ),
    }
}

/// The profile with another depth (m), if it has one.
pub(super) fn with_depth(profile: &Profile, to: f64) -> Option<Profile> {
    let mut changed = profile.clone();
    match &mut changed {
        Profile::Tab { depth, .. } | Profile::Arc { depth, .. } | Profile::Teeth { depth, .. } => {
            *depth = to;
        }
        Profile::Flat | Profile::Points(_) => return None,
    }
    Some(changed)
}

/// How deep a profile is (m), if that is one of its keys.
pub(super) fn depth_of(profile: &Profile) -> Option<f64> {
    match *profile {
        Profile::Tab { depth, .. } | Profile::Arc { depth, .. } | Profile::Teeth { depth, .. } => {
            Some(depth)
        }
        Profile::Flat | Profile::Points(_) => None,
    }
}
