//! Simplifies lines of very many points, such as tracing programs write.

use super::super::error::Result;
use super::super::quantity::four_digits;
use super::super::source::Source;
use super::document::DrawnShape;

/// Lines and outlines with more points than this are simplified: the time to split an outline into
/// convex parts grows with the cube of its points.
pub(super) const MANY: usize = 256;

/// Largest number of points of a simplified line or outline.
const MOST_LEFT: usize = 500;

/// Largest number of points of a line or an outline before it is simplified.
const MOST_DRAWN: usize = 100_000;

/// Largest distance of removed points from the simplified line, as a share of the shape's chord
/// error. The rest is for the curves: the chords of such shapes are within that distance of the
/// curves.
pub(super) const SHARE: f64 = 0.5;

/// Removes the points of lines that are within [`SHARE`] of the chord error of the remaining line;
/// each line keeps its ends. Lines with few points stay as they are. If many points are removed,
/// there is a warning.
///
/// # Errors
/// If there are too many points before or after.
pub(super) fn simplified<P: Copy + Into<[f64; 2]>>(
    source: &Source,
    shape: &DrawnShape,
    lines: Vec<Vec<P>>,
) -> Result<Vec<Vec<P>>> {
    // Several lines surround a tile, each ending where the next begins.
    let shared = usize::from(lines.len() > 1);
    let count = |lines: &[Vec<P>]| lines.iter().map(|l| l.len() - shared).sum::<usize>();
    let drawn = count(&lines);
    if drawn <= MANY {
        return Ok(lines);
    }
    let help = "draw it with fewer points: use the drawing program's simplify command";
    if drawn > MOST_DRAWN {
        let message = format!("the line has {drawn} points, more than {MOST_DRAWN}");
        return Err(source.error(shape.span, message, help));
    }
    let tolerance = SHARE * shape.chord_error;
    let lines: Vec<Vec<P>> = lines.iter().map(|line| within(line, tolerance)).collect();
    let left = count(&lines);
    let tolerance = four_digits(1e3 * tolerance);
    if left > MOST_LEFT {
        let message = format!(
            "the line has {drawn} points; simplified to {tolerance} mm it still has {left}, more \
             than {MOST_LEFT}"
        );
        return Err(source.error(shape.span, message, help));
    }
    if left < drawn {
        let message = format!(
            "simplified the line to {tolerance} mm: {} of its {drawn} points are left out, {left} \
             remain",
            drawn - left
        );
        source
            .drawings
            .note(source.doubt(shape.span, message, help));
    }
    Ok(lines)
}

/// The points of a line, including its ends, that are needed to approximate all of them within
/// `tolerance`. Between two kept points, no point is farther from the segment that joins them (D.
/// H. Douglas and T. K. Peucker, *Algorithms for the reduction of the number of points required to
/// represent a digitized line*, 1973); so every visible corner is kept.
fn within<P: Copy + Into<[f64; 2]>>(line: &[P], tolerance: f64) -> Vec<P> {
    let mut kept = vec![false; line.len()];
    let mut pieces = Vec::new();
    if let Some(last) = line.len().checked_sub(1) {
        (kept[0], kept[last]) = (true, true);
        pieces.push((0, last));
    }
    while let Some((first, last)) = pieces.pop() {
        let ends = [line[first].into(), line[last].into()];
        let inner = first + 1..last;
        let distances = inner.map(|k| (distance(line[k].into(), ends), k));
        let farthest = distances.reduce(|a, b| if b.0 > a.0 { b } else { a });
        if let Some((far, k)) = farthest
            && far > tolerance
        {
            kept[k] = true;
            pieces.extend([(first, k), (k, last)]);
        }
    }
    let points = line.iter().zip(kept);
    points.filter(|(_, kept)| *kept).map(|(p, _)| *p).collect()
}

/// Distance of a point to a segment, which may be a point itself.
fn distance(p: [f64; 2], [a, b]: [[f64; 2]; 2]) -> f64 {
    let (u, v) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let length_squared = u[0] * u[0] + u[1] * u[1];
    let share = if length_squared > 0.0 {
        ((u[0] * v[0] + u[1] * v[1]) / length_squared).clamp(0.0, 1.0)
    } else {
        0.0
    };
    libm::hypot(v[0] - share * u[0], v[1] - share * u[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_point_is_farther_than_the_tolerance_and_corners_stay() {
        // Half a circle of 0.1 m, a spike and a step, traced in steps of a tenth of a millimetre.
        let mut line: Vec<[f64; 2]> = (0..3000)
            .map(|k| std::f64::consts::PI * f64::from(k) / 3000.0)
            .map(|angle| [0.1 * libm::cos(angle), 0.1 * libm::sin(angle)])
            .collect();
        line.extend((0..100).map(|k| [-0.1, -1e-4 * f64::from(k)]));
        line.push([-0.05, -0.01]);
        line.extend((100..200).map(|k| [-0.1, -1e-4 * f64::from(k)]));
        let tolerance = 1e-4;
        let left = within(&line, tolerance);
        assert!((20..120).contains(&left.len()), "{}", left.len());
        assert_eq!((left[0], left.last()), (line[0], line.last()));
        assert!(left.contains(&[-0.05, -0.01]));
        for p in &line {
            let near = left.windows(2).map(|w| distance(*p, [w[0], w[1]]));
            assert!(near.fold(f64::INFINITY, f64::min) <= tolerance, "{p:?}");
        }
        assert_eq!(within(&[[0.0; 2]; 1], tolerance).len(), 1);
        // A closed line without any extent, and one that returns along itself.
        assert_eq!(within(&[[0.0; 2]; 9], tolerance).len(), 2);
        let back = [[0.0, 0.0], [1.0, 0.0], [0.0, 0.0]];
        assert_eq!(within(&back, tolerance), back);
    }
}
