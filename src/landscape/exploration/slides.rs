//! Guesses for minima along sliding faces: where magnets of both faces lie opposite or beside each
//! other, often tilted so that one corner touches.

use nalgebra::Vector2;
use ordered_float::OrderedFloat;

use super::siblings::{FacePose, SAME};
use tiles::configuration::Configuration;
use tiles::order::Order;
use tiles::problem::Problem;
use tiles::tile::{Face, Tile, face_to_face};

/// Slides are tried up to this many steps from the position in which two magnets are opposite ...
const STEPS: i32 = 6;
/// ... each this share of the closest magnets' distance (the pitch), ...
const STEP: f64 = 0.25;
/// ... flush and with the ends of the moving face nearer and farther by these amounts, in pitches.
const TILTS: [f64; 5] = [0.0, 0.25, -0.25, 0.5, -0.5];

/// Slid contacts of all pairs of faces, one of each set of symmetric ones, drawn apart until the
/// tiles do not overlap.
pub(super) fn slid_meetings(problem: &Problem) -> Vec<Configuration> {
    let Some(pair) = &problem.pair else {
        return Vec::new();
    };
    let mut known: Vec<Configuration> = Vec::new();
    let mut found = Vec::new();
    for (i, fixed) in pair.fixed.faces.iter().enumerate() {
        for (j, moving) in pair.moving.faces.iter().enumerate() {
            let flush = face_to_face(fixed, moving, 0.0, 0.0);
            let images = problem.symmetries.iter().map(|s| s.apply(&flush));
            let distance = |q: &Configuration| {
                let to_known = known.iter().map(|other| problem.space.distance(q, other));
                to_known.fold(f64::INFINITY, f64::min)
            };
            if images
                .map(|q| distance(&q))
                .any(|d| d < problem.scaled(SAME))
            {
                continue;
            }
            known.push(flush);
            let places = [places(&pair.fixed, i), places(&pair.moving, j)];
            let meetings = meetings(places, fixed.length().min(moving.length()));
            found.extend(meetings.map(|meeting| meeting.place(problem, fixed, moving)));
        }
    }
    found
}

/// The least distance (m) between two magnets of a face of either tile.
pub(super) fn pitch(problem: &Problem) -> f64 {
    let pair = problem.pair.iter();
    let tiles = pair.flat_map(|pair| [&pair.fixed, &pair.moving]);
    let faces = tiles.flat_map(|tile| (0..tile.faces.len()).map(move |face| places(tile, face)));
    faces
        .map(|places| closest(&places))
        .fold(f64::INFINITY, f64::min)
}

/// The meetings of two faces with magnets at these places (m), the shorter face of this length (m).
fn meetings([fixed, moving]: [Vec<f64>; 2], length: f64) -> impl Iterator<Item = FacePose> {
    let pitch = closest(&fixed).min(closest(&moving)).min(length);
    let mut slides: Vec<f64> = Vec::new();
    for (s, t) in fixed
        .iter()
        .flat_map(|s| moving.iter().map(move |t| (s, t)))
    {
        slides.extend((-STEPS..=STEPS).map(|k| s + t + f64::from(k) * STEP * pitch));
    }
    slides.order_by_key(|&slide| OrderedFloat(slide));
    slides.dedup_by(|a, b| *a - *b < STEP * pitch / 2.0);
    slides.into_iter().flat_map(move |slide| {
        TILTS.map(|tilt| FacePose {
            slide,
            gap: 0.0,
            tilt: 2.0 * tilt * pitch / length,
            energy: 0.0,
        })
    })
}

/// The places of a face's magnets along it, from its middle (m).
fn places(tile: &Tile, number: usize) -> Vec<f64> {
    let face: &Face = &tile.faces[number];
    let along = |p: Vector2<f64>| (p - face.middle()).dot(&face.tangent());
    let magnets = tile.magnets.iter().filter(|magnet| magnet.face == number);
    magnets.map(|magnet| along(magnet.position)).collect()
}

/// The least distance (m) between two of these places; infinite for fewer.
fn closest(places: &[f64]) -> f64 {
    let mut places = places.to_vec();
    places.order_by_key(|&s| OrderedFloat(s));
    let apart = places.windows(2).map(|two| two[1] - two[0]);
    apart.fold(f64::INFINITY, f64::min)
}
