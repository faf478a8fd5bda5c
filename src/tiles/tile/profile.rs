//! Face profiles: the line that a face's outline follows instead of its straight base line.
//!
//! A profile is drawn in the face's frame: s (m) along the face, counter-clockwise, 0 in the
//! middle; h (m) outwards. It begins and ends on the base line, h = 0; depth > 0 sticks out,
//! depth < 0 cuts in.
//!
//! An outline is a polygon, so a curve (arc, sine) is drawn as chords between points *on* the
//! curve, close enough that no chord is farther from it than [`CHORD_SHARE`] of the profile's
//! depth, nor of an arc's radius than [`CHORD_SHARE_OF_RADIUS`]: a shape has the same chords at
//! every size. This polygon *is* the outline: contact, areas and clearances are exact for it. The
//! [`complement`] is taken point by point, so a mate's polygon coincides with its partner's in the
//! bound configuration, however well the chords follow the curve.

use std::f64::consts::PI;

/// Largest distance of a chord from its curve, as a fraction of the profile's depth: 0.2 mm for a
/// bulge of 20 mm, about the accuracy of cutting or printing, with few enough points for contact to
/// stay cheap (ten times as many take twelve times as long).
pub const CHORD_SHARE: f64 = 0.01;

/// The same as a fraction of an arc's radius, which decides for half circles and more: chords turn
/// by at most 10 degrees.
pub const CHORD_SHARE_OF_RADIUS: f64 = 0.0038;

/// Chords of a quarter of a sine wave: they deviate from it by at most `1 - cos(pi / 16)` = 0.0193
/// of the amplitude, which is [`CHORD_SHARE`] of the depth (twice the amplitude).
const CHORDS_PER_QUARTER_WAVE: i64 = 4;

/// A profile no deeper than this fraction of its width is flat. Shallower ones result from
/// rounding, as in -0.01 + 0.01, and the circle through an arc of 1e-15 m would be wider than the
/// solar system.
pub const SHALLOWEST: f64 = 2e-6;

/// A polyline in a face's frame: points (s, h), m.
pub type Polyline = Vec<[f64; 2]>;

/// Which points of a polyline lie on arcs of circles: the first and the last of each arc, in order.
/// The polygon is the outline; the arcs are for cutting it.
pub type Arcs = Vec<[usize; 2]>;

/// The waveform of [`Profile::Teeth`], odd in its phase.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Waveform {
    /// `sin(phase)`.
    Sine,
    /// Straight flanks through the zeros of the sine, crests at plus and minus 1.
    Triangle,
    /// The sign of the sine, with upright flanks.
    Square,
}

/// A face's profile. Lengths are in m, angles in rad.
#[derive(Clone, Debug, PartialEq)]
pub enum Profile {
    /// The base line itself.
    Flat,
    /// A trapezoid, `width` wide at its base, with sides that lean inwards by `draft` (a dovetail
    /// if negative), centred at s = `offset`.
    Tab {
        /// Width at the base line (m).
        width: f64,
        /// Height (m).
        depth: f64,
        /// Angle (rad) between a side and the normal, inwards.
        draft: f64,
        /// s of the middle (m).
        offset: f64,
    },
    /// `h = depth / 2 * wave(2 pi count s / span)` over `|s| <= span / 2`.
    Teeth {
        /// The waveform.
        form: Waveform,
        /// Number of periods.
        count: u32,
        /// Height (m) from valley to crest.
        depth: f64,
        /// Length (m) of the teeth, centred on the face.
        span: f64,
    },
    /// A segment of a circle over a chord of `width`, `depth` high at its middle, s = `offset`;
    /// more than half a circle if `depth` exceeds `width / 2`.
    Arc {
        /// Length of the chord on the base line (m).
        width: f64,
        /// Height (m).
        depth: f64,
        /// s of the middle (m).
        offset: f64,
    },
    /// A polyline.
    Points(Polyline),
    /// A drawn line, and which of its points lie on arcs.
    Drawn(Polyline, Arcs),
}

/// Why a profile cannot be drawn.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ProfileError {
    /// The sides of a tab meet before they reach `depth`; the steepest possible `draft` is given
    /// (rad).
    #[error("the tab's sides meet before they reach its depth")]
    SidesMeet {
        /// The draft (rad) at which the sides meet exactly at the depth.
        largest_draft: f64,
    },
    /// A profile begins or ends off the base line, at height h (m).
    #[error("the profile's {} point lies at h = {h}, off the base line", if *.first { "first" } else { "last" })]
    OffTheBaseLine {
        /// Whether it is the first point, not the last.
        first: bool,
        /// Its height (m).
        h: f64,
    },
    /// A profile has fewer than two points.
    #[error("a profile needs at least two points")]
    TooFewPoints,
}

impl Profile {
    /// The profile's points (s, h), from its beginning to its end, both at h = 0; empty for a
    /// profile equal to the base line, or no deeper than [`SHALLOWEST`] of its width.
    ///
    /// # Errors
    /// If no profile has these parameters.
    pub fn polyline(&self) -> Result<Polyline, ProfileError> {
        match self {
            Self::Flat => Ok(Vec::new()),
            Self::Tab { width, depth, .. }
            | Self::Teeth {
                span: width, depth, ..
            }
            | Self::Arc { width, depth, .. }
                if depth.abs() < SHALLOWEST * width =>
            {
                Ok(Vec::new())
            }
            Self::Tab {
                width,
                depth,
                draft,
                offset,
            } => tab(*width, *depth, *draft, *offset),
            Self::Teeth {
                form,
                count,
                depth,
                span,
            } => Ok(teeth(*form, *count, *depth, *span)),
            Self::Arc {
                width,
                depth,
                offset,
            } => Ok(arc(*width, *depth, *offset)),
            Self::Points(points) | Self::Drawn(points, _) => checked_points(points),
        }
    }

    /// The arcs among the points of its [`polyline`](Self::polyline), which is given.
    pub fn arcs(&self, polyline: &[[f64; 2]]) -> Arcs {
        match (self, polyline.len()) {
            (Self::Arc { .. }, points @ 3..) => vec![[0, points - 1]],
            (Self::Drawn(_, arcs), _) => arcs.clone(),
            _ => Arcs::new(),
        }
    }
}

/// The complement `-h(-s)` of a polyline, point by point: the profile of the mating face.
pub fn complement(line: &[[f64; 2]]) -> Polyline {
    line.iter().rev().map(|[s, h]| [-s, -h]).collect()
}

/// The arcs of the [`complement`] of a polyline with this many points.
pub fn complement_arcs(arcs: &[[usize; 2]], points: usize) -> Arcs {
    let mirrored = |&[first, last]: &[usize; 2]| [points - 1 - last, points - 1 - first];
    arcs.iter().rev().map(mirrored).collect()
}

fn tab(width: f64, depth: f64, draft: f64, offset: f64) -> Result<Polyline, ProfileError> {
    let base = width / 2.0;
    let top = base - depth.abs() * libm::tan(draft);
    if top <= 0.0 {
        let largest_draft = libm::atan(base / depth.abs());
        return Err(ProfileError::SidesMeet { largest_draft });
    }
    Ok(vec![
        [offset - base, 0.0],
        [offset - top, depth],
        [offset + top, depth],
        [offset + base, 0.0],
    ])
}

fn teeth(form: Waveform, count: u32, depth: f64, span: f64) -> Polyline {
    let amplitude = depth / 2.0;
    let halves = 2 * i64::from(count);
    // Point k of `pieces`; symmetric about s = 0 to the last bit, because k and pieces - k differ
    // only in sign.
    let s = |k: i64, pieces: i64| span / 2.0 * (2 * k - pieces) as f64 / pieces as f64;
    match form {
        Waveform::Sine => {
            let quarter = CHORDS_PER_QUARTER_WAVE;
            let pieces = 2 * halves * quarter;
            let half = pieces / 2;
            (0..=pieces)
                .map(|k| {
                    let phase = ((k - half) % (4 * quarter)) as f64 / quarter as f64;
                    let on_base_line = (k - half) % (2 * quarter) == 0;
                    let wave = libm::sin(PI / 2.0 * phase);
                    let h = if on_base_line { 0.0 } else { amplitude * wave };
                    [s(k, pieces), h]
                })
                .collect()
        }
        Waveform::Triangle => {
            let mut line = vec![[-span / 2.0, 0.0]];
            line.extend(
                (0..halves).map(|k| [s(2 * k + 1, 2 * halves), amplitude * sign(k, count)]),
            );
            line.push([span / 2.0, 0.0]);
            line
        }
        Waveform::Square => {
            let mut line = vec![[-span / 2.0, 0.0]];
            for k in 0..halves {
                let h = amplitude * sign(k, count);
                line.push([s(k, halves), h]);
                line.push([s(k + 1, halves), h]);
            }
            line.push([span / 2.0, 0.0]);
            line
        }
    }
}

/// Sign of the wave over half wave k of `2 count`, counted from s = -span / 2: an odd wave starts
/// its half wave at s = 0 upwards.
fn sign(k: i64, count: u32) -> f64 {
    if (k - i64::from(count)) % 2 == 0 {
        1.0
    } else {
        -1.0
    }
}

fn arc(width: f64, depth: f64, offset: f64) -> Polyline {
    let sagitta = depth.abs();
    // Half the angle that the segment spans, and the circle's radius.
    let half_angle = 2.0 * libm::atan(2.0 * sagitta / width);
    let radius = (width * width / 4.0 + sagitta * sagitta) / (2.0 * sagitta);
    // A chord over the angle 2 a deviates from its circle by radius (1 - cos a).
    let error = (CHORD_SHARE * sagitta / radius).min(CHORD_SHARE_OF_RADIUS);
    let largest = libm::acos(1.0 - error);
    // Rounding of the angles of a shape at other sizes must not add a chord.
    let half = (half_angle / (2.0 * largest) - 1e-9).ceil().max(1.0) as i64;
    (-half..=half)
        .map(|k| {
            if k.abs() == half {
                return [offset + width / 2.0 * k.signum() as f64, 0.0];
            }
            let angle = half_angle * k as f64 / half as f64;
            let h = radius * (libm::cos(angle) - libm::cos(half_angle));
            [offset + radius * libm::sin(angle), h.copysign(depth)]
        })
        .collect()
}

fn checked_points(points: &[[f64; 2]]) -> Result<Polyline, ProfileError> {
    let (Some(first), Some(last), true) = (points.first(), points.last(), points.len() >= 2) else {
        return Err(ProfileError::TooFewPoints);
    };
    for (first, h) in [(true, first[1]), (false, last[1])] {
        if h != 0.0 {
            return Err(ProfileError::OffTheBaseLine { first, h });
        }
    }
    Ok(points.to_vec())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_depth_of_rounding_is_flat() {
        for depth in [0.0, 1e-15, -1e-18, 5e-324, 0.18 * SHALLOWEST] {
            let (width, offset, span) = (0.2, 0.0, 0.4);
            let tab = Profile::Tab {
                width,
                depth,
                draft: 0.0,
                offset,
            };
            let arc = Profile::Arc {
                width,
                depth,
                offset,
            };
            let form = Waveform::Sine;
            let teeth = Profile::Teeth {
                form,
                count: 3,
                depth,
                span,
            };
            for profile in [tab, arc, teeth] {
                assert_eq!(profile.polyline(), Ok(Vec::new()), "{profile:?}");
            }
        }
        assert!(arc(10.0, 10.0 * SHALLOWEST, 0.0).len() >= 3);
    }
}
