//! The key `profile` of a face: the shape of its outline.

use ordered_float::OrderedFloat;

use super::DesignError;
use super::error::Result;
use super::quantity;
use super::reader::{Entry, Section, all};
use super::svg;
use physics::tile::profile::{Polyline, Profile, ProfileError, Waveform};

/// A shape: its name, its keys, and the function that reads it for a face of a given length (m).
type ShapeReader = (
    &'static str,
    &'static [&'static str],
    fn(&Section, f64) -> Result<Profile>,
);

/// The known shapes.
pub(super) const SHAPES: [ShapeReader; 6] = [
    ("flat", &["shape"], |_, _| Ok(Profile::Flat)),
    ("tab", &["shape", "width", "depth", "draft", "offset"], tab),
    (
        "teeth",
        &["shape", "form", "count", "depth", "span", "width"],
        teeth,
    ),
    ("arc", &["shape", "width", "depth", "offset"], arc),
    ("points", &["shape", "points"], points),
    (
        "svg",
        &["shape", "file", "unit", "dpi", "id", "offset"],
        drawn,
    ),
];

/// Largest number of points of a face's line, with curves as chords: contact with more takes too
/// long.
const MOST_POINTS: usize = 4000;

/// Largest number of teeth on a face.
const MOST_TEETH: u32 = 200;

/// The line of a face of the given length (m), from its `profile`.
pub(super) fn read_profile(entry: &Entry, length: f64) -> Result<(Profile, Polyline)> {
    let section = entry.section("`profile`")?;
    let example = "write shape = \"flat\", \"tab\", \"teeth\", \"arc\", \"points\" or \"svg\"";
    let shapes = SHAPES.map(|shape| (shape.0, shape));
    let (_, keys, read) = section.require("shape", example)?.word(&shapes)?;
    section.allow(keys);
    let profile = read(&section, length)?;
    section.source.faults.check_guesses()?;
    let line = profile.polyline();
    let line = line.map_err(|error| fix(&section, &profile, error))?;
    within_face(&section, &profile, &line, length)?;
    if line.len() > MOST_POINTS {
        return Err(section.error(
            format!(
                "the profile's line has {} points, more than {MOST_POINTS}",
                line.len()
            ),
            "use fewer or shallower teeth, or fewer points",
        ));
    }
    Ok((profile, line))
}

fn tab(section: &Section, _: f64) -> Result<Profile> {
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
    let form = section.require("form", "write form = \"sine\", \"triangle\" or \"square\"")?;
    let count = section.require("count", "give the number of teeth: count = 4")?;
    let form = form.word(&forms);
    let count = count.count(MOST_TEETH);
    let depth = depth(section);
    // `width` as for the other shapes, so that all can be varied together.
    let [span, width] = ["span", "width"].map(|key| section.number(key, quantity::PROFILE_WIDTH));
    let (span, width) = (span?, width?);
    if span.is_some() && width.is_some() {
        return Err(section.error(
            "`span` and `width` are the same for teeth",
            "remove one of them",
        ));
    }
    Ok(Profile::Teeth {
        form: form?,
        count: count?,
        depth: depth?,
        span: span.or(width).unwrap_or(length),
    })
}

fn arc(section: &Section, _: f64) -> Result<Profile> {
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

fn points(section: &Section, _: f64) -> Result<Profile> {
    let points = section.require("points", "give the line: points = [[s, h], ...] (m)")?;
    let points = points.array()?;
    let what = "s along the face and h outwards";
    let points = points
        .iter()
        .map(|point| point.numbers::<2>(quantity::ALONG_FACE, what));
    Ok(Profile::Points(all(points)?))
}

fn drawn(section: &Section, _: f64) -> Result<Profile> {
    let (line, arcs) = svg::read_line(section)?;
    Ok(Profile::Drawn(line, arcs))
}

fn width(section: &Section) -> Result<f64> {
    section
        .require("width", "give its width at the base: width = 0.20 (m)")?
        .number(quantity::PROFILE_WIDTH)
}

fn depth(section: &Section) -> Result<f64> {
    section
        .require(
            "depth",
            "give its depth: depth = 0.02 (m; negative cuts in)",
        )?
        .number(quantity::PROFILE_DEPTH)
}

/// The fault of an impossible profile, at the key to change.
fn fix(section: &Section, profile: &Profile, error: ProfileError) -> DesignError {
    match error {
        ProfileError::SidesMeet { largest_draft } => {
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
            let entry = section.get("draft").or_else(|| section.get("depth"));
            fault(section, entry, error.to_string(), help)
        }
        ProfileError::OffTheBaseLine { first, .. } => {
            let points = section.get("points");
            let items = points
                .and_then(|entry| entry.array().ok())
                .unwrap_or_default();
            let item = if first { items.first() } else { items.last() };
            let help = "begin and end the profile at h = 0";
            fault(section, item.copied(), error.to_string(), help)
        }
        ProfileError::TooFewPoints => {
            section.error(error.to_string(), "give more points, or shape = \"flat\"")
        }
    }
}

/// Rejects a profile that is wider than its face.
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
        "the profile extends beyond its face: it reaches s = {}, the face ends at {}",
        quantity::four_digits(s),
        quantity::four_digits(half.copysign(s))
    );
    let point = section
        .get("points")
        .and_then(|entry| entry.array().ok()?.get(index).copied());
    let (key, fix) = narrower(profile, half);
    let help = format!(
        "the face is {} m long; {fix}",
        quantity::four_digits(length)
    );
    let entry = point.or_else(|| section.get(key));
    Err(fault(section, entry, message, help))
}

/// A fault of a key of a profile, or of the profile as a whole.
fn fault(
    section: &Section,
    entry: Option<Entry>,
    message: String,
    help: impl Into<String>,
) -> DesignError {
    let span = entry.map_or(section.span, |entry| entry.span());
    section.source.error(span, message, help)
}

/// The key that makes a profile too wide for a face of half this length (m), and how to change it.
fn narrower(profile: &Profile, half: f64) -> (&'static str, String) {
    let at_most = |key: &'static str, largest: f64| {
        let largest = quantity::rounded_down(largest);
        let fix = format!("`{key}` can be at most {largest} m here (absolute value)");
        (key, fix)
    };
    match *profile {
        // It is wider than its base, because of its depth.
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
        Profile::Flat | Profile::Points(_) | Profile::Drawn(..) => (
            "file",
            "make the profile narrower or move it towards the middle".to_owned(),
        ),
    }
}

/// The depth of a profile (m), if it has this key.
pub(super) fn depth_of(profile: &mut Profile) -> Option<&mut f64> {
    match profile {
        Profile::Tab { depth, .. } | Profile::Arc { depth, .. } | Profile::Teeth { depth, .. } => {
            Some(depth)
        }
        Profile::Flat | Profile::Points(_) | Profile::Drawn(..) => None,
    }
}
