//! Tables as comma-separated values, units in the headers.

use std::fmt::Write;

use super::json::{copies, face_names, kind, place_name, positive_zero};
use crate::configuration::Configuration;
use crate::design::Design;
use crate::landscape::{Barrier, Pathway, PathwayPoint};
use crate::pipeline::Analysis;

const STATES: &str = "id,kind,class,copies,x_m,y_m,theta_rad,energy_J,escape_J,escape_to,\
                      capture_share,capture_low,capture_high,attracting,repelling,faces,\
                      block_energy_J,dipole_error_J";
const BARRIERS: &str = "from,to,saddle_energy_J,lower_J,upper_J,forward_J,reverse_J,\
                        spread_low_J,spread_high_J,x_m,y_m,theta_rad,pathway";
/// Lengths are in m, theta is in rad.
const PATHWAY: &str = "s,x,y,theta,energy_J,clearance_m";

/// How far (m, and rad) a dropped point of a pathway may lie from the straight motion between its
/// neighbours in the file.
const POSE_TOLERANCE: f64 = 1e-5;
/// How far the clearance may be off there beyond that, as a fraction of itself.
const CLEARANCE_TOLERANCE: f64 = 1e-3;
/// How far the energy may be off there, as a fraction of the range of energies on the pathway.
const ENERGY_TOLERANCE: f64 = 1e-3;

/// The table of states. Where magnets are point dipoles its last two columns hold the energy of the
/// blocks they stand for, and how much higher the dipoles' is.
pub fn states(design: &Design, analysis: &Analysis) -> String {
    let mut table = String::from(STATES);
    for state in &analysis.inventory.states {
        let escape = analysis.escape(state.id);
        let (escape_height, escape_to) = match escape {
            Some(escape) => (number(escape.forward()), place_name(escape.to)),
            None => Default::default(),
        };
        let [share, low, high] = match &state.capture {
            Some(capture) => [capture.share(), capture.low, capture.high].map(number),
            None => Default::default(),
        };
        let faces: Vec<String> = face_names(design, state)
            .iter()
            .map(|pair| pair.join("-"))
            .collect();
        let _ = write!(
            table,
            "\n{},{},{},{},{},{},{escape_height},{escape_to},{share},{low},{high},{},{},{},{},{}",
            state.id,
            kind(state.kind),
            state.class,
            copies(state, &analysis.inventory.states),
            pose(&state.configuration),
            number(state.energy),
            state.attracting,
            state.repelling,
            faces.join(" "),
            state.block_energy.map(number).unwrap_or_default(),
            state.dipole_error().map(number).unwrap_or_default(),
        );
    }
    table.push('\n');
    table
}

/// The table of barriers; `pathway_file` names the file of a barrier's pathway.
pub fn barriers(barriers: &[Barrier], pathway_file: impl Fn(&Barrier) -> String) -> String {
    let mut table = String::from(BARRIERS);
    for barrier in barriers {
        let optional = |value: Option<f64>| value.map(number).unwrap_or_default();
        // Without a way the barrier is infinite: an empty cell.
        let finite = |value: f64| optional(Some(value).filter(|value| value.is_finite()));
        let _ = write!(
            table,
            "\n{},{},{},{},{},{},{},{},{},{},{}",
            place_name(barrier.from),
            place_name(barrier.to),
            finite(barrier.saddle_energy),
            optional(barrier.bounds.lower),
            optional(barrier.bounds.upper),
            finite(barrier.forward()),
            finite(barrier.reverse()),
            optional(barrier.spread.map(|spread| spread.0)),
            optional(barrier.spread.map(|spread| spread.1)),
            pose(&barrier.saddle),
            if barrier.pathway.is_empty() {
                String::new()
            } else {
                pathway_file(barrier)
            },
        );
    }
    table.push('\n');
    table
}

/// A pathway, point by point. Points are left out where the motion between their neighbours is
/// straight and the energy along it linear; the highest point always stays.
pub fn pathway(pathway: &Pathway) -> String {
    let mut table = String::from(PATHWAY);
    for point in thinned(pathway) {
        let _ = write!(
            table,
            "\n{},{},{},{}",
            number(point.s),
            pose(&point.configuration),
            number(point.energy),
            number(point.clearance),
        );
    }
    table.push('\n');
    table
}

/// The points of a pathway that are not on the straight line between their neighbours.
pub(super) fn thinned(pathway: &Pathway) -> Vec<PathwayPoint> {
    let Some(highest) =
        (0..pathway.len()).max_by(|&a, &b| pathway[a].energy.total_cmp(&pathway[b].energy))
    else {
        return Vec::new();
    };
    let lowest = pathway
        .iter()
        .map(|p| p.energy)
        .fold(f64::INFINITY, f64::min);
    let allowed = ENERGY_TOLERANCE * (pathway[highest].energy - lowest);
    let mut kept = vec![pathway[0]];
    let mut here = 0;
    while here + 1 < pathway.len() {
        let next = (here + 2..pathway.len())
            .take_while(|&end| {
                (here + 1..end).all(|between| {
                    between != highest && is_between(pathway, here, between, end, allowed)
                })
            })
            .last()
            .unwrap_or(here + 1);
        kept.push(pathway[next]);
        here = next;
    }
    kept
}

/// Whether interpolation between two points of a pathway gives the one between them.
fn is_between(pathway: &Pathway, start: usize, between: usize, end: usize, allowed: f64) -> bool {
    let (a, p, b) = (&pathway[start], &pathway[between], &pathway[end]);
    let t = (p.s - a.s) / (b.s - a.s);
    let linear = |of: fn(&PathwayPoint) -> f64| of(p) - (of(a) + t * (of(b) - of(a)));
    let straight = a.configuration.interpolate(&b.configuration, t);
    t.is_finite()
        && straight.step_to(&p.configuration).amax() <= POSE_TOLERANCE
        && linear(|p| p.clearance).abs() <= POSE_TOLERANCE + CLEARANCE_TOLERANCE * p.clearance
        && linear(|p| p.energy).abs() <= allowed
}

fn pose(q: &Configuration) -> String {
    q.to_array().map(number).join(",")
}

/// A number with ten significant digits at most.
pub(crate) fn number(value: f64) -> String {
    if !value.is_finite() {
        return value.to_string();
    }
    let rounded: f64 = format!("{value:.9e}").parse().unwrap_or(value);
    let rounded = positive_zero(rounded);
    let plain = rounded.to_string();
    let scientific = format!("{rounded:e}");
    if scientific.len() < plain.len() {
        scientific
    } else {
        plain
    }
}

/// A text as one cell: in quotes where it holds a comma, a quote or a line's end (RFC 4180).
pub(crate) fn text(cell: &str) -> String {
    if cell.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", cell.replace('"', "\"\""))
    } else {
        cell.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(s: f64, energy: f64) -> PathwayPoint {
        PathwayPoint {
            s,
            configuration: Configuration::new(s, 0.0, 0.0),
            energy,
            clearance: s,
        }
    }

    #[test]
    fn a_cell_with_commas_or_quotes_is_quoted() {
        assert_eq!(text("a tab"), "a tab");
        assert_eq!(text("a \"tab\", wide"), "\"a \"\"tab\"\", wide\"");
    }

    #[test]
    fn numbers_keep_ten_digits() {
        assert_eq!(number(-0.0), "0");
        assert_eq!(number(0.43), "0.43");
        assert_eq!(number(0.1 + 0.2), "0.3");
        assert_eq!(number(-1.234_567_890_123_4e-9), "-1.23456789e-9");
    }

    #[test]
    fn straight_stretches_lose_their_inner_points_but_never_the_peak() {
        let line: Pathway = (0..=10).map(|k| point(k as f64, k as f64)).collect();
        assert_eq!(thinned(&line).len(), 2);
        let bent: Pathway = (0..=10)
            .map(|k| point(k as f64, -(k as f64 - 4.0).abs()))
            .collect();
        let kept: Vec<f64> = thinned(&bent).iter().map(|p| p.s).collect();
        assert_eq!(kept, [0.0, 4.0, 10.0]);
        let flat: Pathway = (0..=10).map(|k| point(k as f64, 1.0)).collect();
        assert!(thinned(&flat).len() <= 3);
        assert!(thinned(&Vec::new()).is_empty());
    }
}
