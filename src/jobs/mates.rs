//! Whether the codes of the target faces are mates.

use crate::design::Design;
use nalgebra::Vector2;
use physics::configuration::Configuration;
use physics::problem::Problem;
use physics::tile::{Face, Magnet, Pair, Tile};

/// A bond weaker than this share of the mates' is not one of mates.
const WEAK: f64 = 0.7;
/// A slid contact this much stronger than the bond is worth a warning.
const STRONGER: f64 = 1.1;
/// Steps of a slide in half widths of the smallest magnet, and the largest number of them either way.
const MOST_STEPS: usize = 400;

/// A sentence that the target faces bind far less than each would bind its own mate, or than they do
/// slid along each other; `None` if the codes are fine.
pub(crate) fn fault(design: &Design, problem: &Problem) -> Option<String> {
    let pair = &design.pair;
    let (fixed, moving) = (&pair.fixed, &pair.moving);
    let bond = problem.potential().energy(&pair.bound);
    if bond >= 0.0 || problem.is_inert() {
        return None;
    }
    let (f, m) = pair.target;
    let strength = |fixed: &Tile, moving: &Tile| {
        let potential = design.interaction.between(fixed, moving).potential;
        potential.energy(&pair.bound)
    };
    // Each face alone against its own mate: for mates of unlike magnets the mean is geometric.
    let [a, b] = [only(fixed, f), only(moving, m)];
    let own = strength(&a, &b);
    let of_fixed = strength(&a, &mated((&b, m), (&a, f)));
    let of_moving = strength(&mated((&a, f), (&b, m)), &b);
    let mates = -(of_fixed * of_moving).max(0.0).sqrt();
    let help = remedy(design);
    let slid = slid(design, problem);
    if let Some((way, energy)) = slid.filter(|(_, energy)| *energy < STRONGER * bond) {
        return Some(format!(
            "the codes are not mates: slid by {:.0} mm along the face they bind {} times as strongly; {help}",
            1e3 * way,
            physics::units::plain(energy / bond, 2)
        ));
    }
    (mates < 0.0 && own > WEAK * mates).then(|| {
        format!(
            "the codes are not mates: they bind with {} of the energy of mates; {help}",
            physics::units::share_to((own / mates).max(0.0), 2)
        )
    })
}

/// How the target faces become mates.
pub(crate) fn remedy(design: &Design) -> String {
    let Pair {
        fixed,
        moving,
        target: (f, m),
        ..
    } = &*design.pair;
    let [one, other] = [&fixed.faces[*f].name, &moving.faces[*m].name];
    match f == m && design.is_of_one_kind() {
        true => format!(
            "face {one} binds its own kind if its code, read backwards with N and S (or U and D) exchanged, is \
             the code itself, such as NS, NNSS or UD"
        ),
        false => {
            format!("make the second face the mate of the first: {other} = {{ mates = \"{one}\" }}")
        }
    }
}

/// A tile with the magnets of one face only.
fn only(tile: &Tile, face: usize) -> Tile {
    let mut bare = tile.clone();
    bare.magnets.retain(|magnet| magnet.face == face);
    bare
}

/// A tile whose face number `face` carries the mates of another tile's magnets, which are all on one
/// face: as deep behind its surface as these are behind theirs.
fn mated((tile, face): (&Tile, usize), (other_tile, other_face): (&Tile, usize)) -> Tile {
    let (own, other) = (&tile.faces[face], &other_tile.faces[other_face]);
    let mate = |magnet: &Magnet| {
        let from = magnet.position - other.middle();
        let (s, h) = (from.dot(&other.tangent()), from.dot(&other.normal()));
        let outwards = |it: &Face| {
            let normal = it.normal();
            libm::atan2(normal.y, normal.x)
        };
        let turned = Magnet {
            position: own.point(
                -s,
                surface(tile, own, -s) + h - surface(other_tile, other, s),
            ),
            // Mirrored in the line between the faces; the poles are exchanged below.
            angle: outwards(own) - (magnet.angle - outwards(other)),
            face,
            ..magnet.clone()
        };
        turned.reversed()
    };
    let mut tile = tile.clone();
    tile.magnets = other_tile.magnets.iter().map(mate).collect();
    tile
}

/// The height (m) of a tile's outline above a face's base line, at `s` along the face.
fn surface(tile: &Tile, face: &Face, s: f64) -> f64 {
    let local = |p: &Vector2<f64>| {
        let from = p - face.middle();
        [from.dot(&face.tangent()), from.dot(&face.normal())]
    };
    let corners = tile.outline.vertices();
    let edges = corners.iter().zip(corners.iter().cycle().skip(1));
    let heights = edges.filter_map(|(start, end)| {
        let ([a, low], [b, high]) = (local(start), local(end));
        let is_there = a != b && (a.min(b)..=a.max(b)).contains(&s);
        is_there.then(|| low + (high - low) * (s - a) / (b - a))
    });
    heights.reduce(f64::max).unwrap_or(0.0)
}

/// The strongest free contact of the target faces slid along each other: how far (m), and its energy (J).
fn slid(design: &Design, problem: &Problem) -> Option<(f64, f64)> {
    let pair = &design.pair;
    let face = pair.target_face();
    let widths = pair.fixed.magnets.iter().chain(&pair.moving.magnets);
    let width = widths
        .map(|it| it.size[1].min(it.size[0]))
        .fold(f64::INFINITY, f64::min);
    let step = (0.5 * width).max(face.length() / MOST_STEPS as f64);
    let steps = (face.length() / step).floor() as i64;
    let poses = (-steps..=steps).filter(|k| *k != 0).map(|k| {
        let way = step * k as f64;
        let place = pair.bound.position() + face.tangent() * way;
        (
            way.abs(),
            Configuration::new(place.x, place.y, pair.bound.theta),
        )
    });
    let free = poses.filter(|(_, q)| problem.is_free(q));
    let all = free.map(|(way, q)| (way, problem.potential().energy(&q)));
    all.min_by(|a, b| a.1.total_cmp(&b.1))
}
