//! Tables as comma-separated values, units in the headers.

use ordered_float::OrderedFloat;

use physics::landscape::{Pathway, PathwayPoint};

/// Lengths are in m, theta is in rad.
const PATHWAY: [&str; 6] = ["s", "x", "y", "theta", "energy_J", "clearance_m"];

/// Largest distance (m, and rad) of a point omitted from a pathway's file from the straight motion
/// between its neighbours, and largest energy error there, as a fraction of the range of energies
/// on the pathway. The points of the file, joined by straight motions, are the pathway.
const SAME_MOTION: [f64; 2] = [1e-8, 1e-4];
/// The same for pictures.
pub(super) const SEEN: [f64; 2] = [1e-5, 1e-3];
/// Largest error of the clearance there, as a share of the extent of the pathway.
const CLEARANCE_TOLERANCE: f64 = 1e-5;
/// Additional allowed error of the clearance, relative to the clearance.
const RELATIVE_CLEARANCE: f64 = 1e-3;
/// A pathway as a list of points; between two points it is straight in x, y and theta (the shorter
/// way round). Points are omitted where the motion between their neighbours is straight and the
/// energy along it linear; the highest point is always kept.
pub fn pathway(pathway: &Pathway) -> String {
    let rows = thinned(pathway, SAME_MOTION).into_iter().map(|point| {
        let [x, y, theta] = point.configuration.to_array();
        [point.s, x, y, theta, point.energy, point.clearance].map(number)
    });
    table(PATHWAY, rows)
}

/// A table: the names of its columns, and its rows with as many cells each. Cells are quoted if
/// they contain a comma, a quote or a line end (RFC 4180).
///
/// # Panics
/// If a row has more or fewer cells than there are columns.
pub(crate) fn table<Row: IntoIterator<Item: AsRef<[u8]>>>(
    columns: impl IntoIterator<Item: AsRef<[u8]>>,
    rows: impl IntoIterator<Item = Row>,
) -> String {
    let mut writer = ::csv::Writer::from_writer(Vec::new());
    let mut add = |cell: Option<&[u8]>| added(&mut writer, cell);
    columns
        .into_iter()
        .for_each(|cell| add(Some(cell.as_ref())));
    add(None);
    for row in rows {
        row.into_iter().for_each(|cell| add(Some(cell.as_ref())));
        add(None);
    }
    let bytes = writer.into_inner().expect("a vector takes all");
    String::from_utf8(bytes).expect("cells are text")
}

/// Adds a cell, or the end of a row.
#[inline(never)]
fn added(writer: &mut ::csv::Writer<Vec<u8>>, cell: Option<&[u8]>) {
    match cell {
        Some(cell) => writer.write_field(cell),
        None => writer.write_record(None::<&[u8]>),
    }
    .expect("a vector takes rows of equal length");
}

/// The points of a pathway that are not on the straight line between their neighbours, within
/// tolerances of the pose (rad, and as a share of the pathway's largest distance from the fixed
/// tile's centre) and of the energy (a fraction of its range).
pub(super) fn thinned(pathway: &Pathway, [pose, energy]: [f64; 2]) -> Vec<PathwayPoint> {
    let Some(highest) = (0..pathway.len()).max_by_key(|&k| OrderedFloat(pathway[k].energy)) else {
        return Vec::new();
    };
    let lowest = pathway
        .iter()
        .map(|p| p.energy)
        .fold(f64::INFINITY, f64::min);
    let distances = pathway.iter().map(|p| p.configuration.position().norm());
    let size = distances.fold(0.0, f64::max);
    let allowed = [pose, energy * (pathway[highest].energy - lowest), size];
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
fn is_between(
    pathway: &Pathway,
    start: usize,
    between: usize,
    end: usize,
    [pose, energy, size]: [f64; 3],
) -> bool {
    let (a, p, b) = (&pathway[start], &pathway[between], &pathway[end]);
    let t = (p.s - a.s) / (b.s - a.s);
    let linear = |of: fn(&PathwayPoint) -> f64| of(p) - (of(a) + t * (of(b) - of(a)));
    let straight = a.configuration.interpolate(&b.configuration, t);
    let off = straight.step_to(&p.configuration);
    t.is_finite()
        && off.xy().amax() <= pose * size
        && off.z.abs() <= pose
        && linear(|p| p.clearance).abs()
            <= CLEARANCE_TOLERANCE * size + RELATIVE_CLEARANCE * p.clearance
        && linear(|p| p.energy).abs() <= energy
}

/// Largest number of significant digits.
const DIGITS: u8 = 10;

/// A number with ten digits.
pub(crate) fn number(value: f64) -> String {
    rounded(value, DIGITS)
}

/// A number with a given number of digits, at most 15, plain or scientific, whichever is shorter. A
/// number half way between two decimals, within rounding, becomes either.
pub(super) fn rounded(value: f64, count: u8) -> String {
    let size = value.abs();
    if !value.is_finite() || size < f64::MIN_POSITIVE {
        return if size == 0.0 {
            "0".to_owned()
        } else {
            format!("{value:e}")
        };
    }
    // The digits as an integer, and the power of ten of the first of them.
    let mut power = libm::log10(size).floor() as i32;
    let (count, least) = (i32::from(count), 10u64.pow(u32::from(count) - 1));
    let mut digits = scaled(size, count - 1 - power);
    // Both the logarithm and the digits have been rounded.
    if digits < least {
        power -= 1;
        digits = scaled(size, count - 1 - power);
    } else if digits >= 10 * least {
        power += 1;
        digits = scaled(size, count - 1 - power);
    }
    while digits.is_multiple_of(10) {
        digits /= 10;
    }
    written(value < 0.0, &digits.to_string(), power)
}

/// `size` times a power of ten, rounded.
fn scaled(size: f64, power: i32) -> u64 {
    // Neither factor overflows, and powers up to 22 are exact.
    let (first, rest) = (power.clamp(-300, 300), power - power.clamp(-300, 300));
    (size * 10f64.powi(first) * 10f64.powi(rest)).round() as u64
}

/// A number from its digits and the power of ten of the first digit.
fn written(is_negative: bool, digits: &str, power: i32) -> String {
    let (count, size) = (digits.len() as i32, power.unsigned_abs());
    let plain = match power {
        ..0 => 1 - power + count,
        _ if count <= power + 1 => power + 1,
        _ => count + 1,
    };
    let exponent = i32::from(power < 0) + 1 + size.checked_ilog10().unwrap_or(0) as i32;
    let scientific = count + i32::from(count > 1) + 1 + exponent;
    let mut text = String::with_capacity(1 + plain.min(scientific) as usize);
    if is_negative {
        text.push('-');
    }
    if scientific < plain {
        let (first, rest) = digits.split_at(1);
        text.push_str(first);
        if !rest.is_empty() {
            text.push('.');
            text.push_str(rest);
        }
        text.push('e');
        text.push_str(&power.to_string());
    } else if power < 0 {
        text.push_str("0.");
        text.extend((1..size).map(|_| '0'));
        text.push_str(digits);
    } else if count <= power + 1 {
        text.push_str(digits);
        text.extend((count..=power).map(|_| '0'));
    } else {
        let (whole, rest) = digits.split_at(power as usize + 1);
        text.push_str(whole);
        text.push('.');
        text.push_str(rest);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use physics::configuration::Configuration;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

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
        let rows = [["a tab", "b"], ["a \"tab\", wide", ""]];
        let expected = "x,y\na tab,b\n\"a \"\"tab\"\", wide\",\n";
        assert_eq!(table(["x", "y"], rows), expected);
    }

    #[test]
    fn numbers_keep_ten_digits() {
        assert_eq!(number(-0.0), "0");
        assert_eq!(number(0.43), "0.43");
        assert_eq!(number(0.1 + 0.2), "0.3");
        assert_eq!(number(-1.234_567_890_123_4e-9), "-1.23456789e-9");
        assert_eq!(number(1200.0), "1200");
        assert_eq!(number(3e12), "3e12");
        assert_eq!(number(12.5), "12.5");
        assert_eq!(number(-0.001_25), "-0.00125");
        assert_eq!(number(9.999_999_999_99), "10");
        assert_eq!(number(0.099_999_999_999_9), "0.1");
        assert_eq!(number(-1e300), "-1e300");
        assert_eq!(number(f64::MAX), "1.797693135e308");
        assert_eq!(number(f64::MIN_POSITIVE), "2.225073859e-308");
        assert_eq!(number(f64::INFINITY), "inf");
    }

    #[test]
    fn numbers_are_the_nearest_of_ten_digits() {
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        for _ in 0..20_000 {
            let value = rng.random_range(-1.0..1.0) * 10f64.powi(rng.random_range(-20..20));
            let error = (number(value).parse::<f64>().unwrap() - value).abs();
            assert!(
                error <= 0.500_001e-9 * value.abs(),
                "{value}: {}",
                number(value)
            );
            let exact: f64 = format!("{value:.9e}").parse().unwrap();
            assert_eq!(number(exact).parse::<f64>(), Ok(exact), "{exact}");
        }
    }

    #[test]
    fn straight_stretches_lose_their_inner_points_but_never_the_peak() {
        let line: Pathway = (0..=10).map(|k| point(k as f64, k as f64)).collect();
        assert_eq!(thinned(&line, SAME_MOTION).len(), 2);
        let bent: Pathway = (0..=10)
            .map(|k| point(k as f64, -(k as f64 - 4.0).abs()))
            .collect();
        let kept: Vec<f64> = thinned(&bent, SAME_MOTION).iter().map(|p| p.s).collect();
        assert_eq!(kept, [0.0, 4.0, 10.0]);
        let flat: Pathway = (0..=10).map(|k| point(k as f64, 1.0)).collect();
        assert!(thinned(&flat, SAME_MOTION).len() <= 3);
        assert!(thinned(&Vec::new(), SAME_MOTION).is_empty());
    }
}
