//! Face profiles for new designs.

use crate::design::quantity::rounded_down;

/// Largest share of a face that a profile takes.
const WIDEST: f64 = 0.9;

/// The profile of the target faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProfileShape {
    /// Straight.
    Flat,
    /// A trapezoid with leaning sides.
    Tab,
    /// A segment of a circle.
    Arc,
    /// A sine wave.
    Sine,
    /// A triangle wave.
    Triangle,
}

impl ProfileShape {
    /// The shapes by name.
    pub const NAMES: [(&str, Self); 5] = [
        ("flat", Self::Flat),
        ("tab", Self::Tab),
        ("arc", Self::Arc),
        ("sine", Self::Sine),
        ("triangle", Self::Triangle),
    ];

    /// The profile for a face of the given length (m), in the notation of design files, with its
    /// description; `wider` times as wide as usual, if it has a width.
    pub(super) fn profile(self, side: f64, wider: f64) -> Option<(String, &'static str)> {
        let part = |share: f64| rounded_down(side * share);
        let width = |share: f64| part((share * wider).min(WIDEST));
        let teeth = |form: &str| {
            let depth = part(0.03);
            format!("{{ shape = \"teeth\", form = \"{form}\", count = 2, depth = {depth} }}")
        };
        match self {
            Self::Flat => None,
            Self::Tab => Some((
                format!(
                    "{{ shape = \"tab\", width = {}, depth = {}, draft = 0.3 }}",
                    width(0.47),
                    part(0.047)
                ),
                "a tab in its slot",
            )),
            Self::Arc => Some((
                format!(
                    "{{ shape = \"arc\", width = {}, depth = {} }}",
                    width(0.6),
                    part(0.047)
                ),
                "an arc in its hollow",
            )),
            Self::Sine => Some((teeth("sine"), "two waves in theirs")),
            Self::Triangle => Some((teeth("triangle"), "two teeth in theirs")),
        }
    }
}
