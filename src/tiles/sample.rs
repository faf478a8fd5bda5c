//! Pairs of regular tiles for unit tests.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use nalgebra::Vector2;

use crate::configuration::ConfigurationSpace;
use crate::potential::{Interaction, MagnetModel};
use crate::problem::Problem;
use crate::tile::strength::Strength;
use crate::tile::{Face, Magnet, Outline, Pair, Tile, face_to_face};

/// The paper's magnets: size (m) and pitch (m).
const BAR: [f64; 3] = [0.010, 0.010, 0.003];
const PITCH: f64 = 0.040;

/// A regular tile, face 0 towards +x, with this code on some of its faces.
pub fn tile(sides: usize, side: f64, code: &str, coded: &[usize]) -> Tile {
    let circumradius = side / 2.0 / libm::sin(PI / sides as f64);
    let corner = |k: usize| {
        let angle = TAU / sides as f64 * (k as f64 - 0.5);
        Vector2::new(libm::cos(angle), libm::sin(angle)) * circumradius
    };
    let faces: Vec<Face> = (0..sides)
        .map(|k| Face {
            name: k.to_string(),
            start: corner(k),
            end: corner(k + 1),
        })
        .collect();
    let magnets = coded.iter().flat_map(|&face| {
        let middle = (code.len() - 1) as f64 / 2.0;
        let at = &faces[face];
        code.chars().enumerate().map(move |(k, pole)| {
            let out = at.normal() * if pole == 'N' { 1.0 } else { -1.0 };
            Magnet {
                position: at.point((k as f64 - middle) * PITCH, -BAR[0] / 2.0),
                angle: libm::atan2(out.y, out.x),
                moment: Strength::Remanence(1.2).moment(crate::tile::magnet::Shape::Block, BAR),
                size: BAR,
                form: Default::default(),
                face,
            }
        })
    });
    Tile {
        outline: Outline::new((0..sides).map(corner).collect()).expect("a regular polygon"),
        magnets: magnets.collect(),
        faces,
        mass: 0.1,
        thickness: 0.013,
    }
}

/// Two of them on a table of 2 m, NNNS on some faces of one, its mate on some of the other.
pub fn pair(sides: usize, side: f64, [fixed, moving]: [&[usize]; 2]) -> Problem {
    let fixed = tile(sides, side, "NNNS", fixed);
    let moving = tile(sides, side, "NSSS", moving);
    let target = (0, sides / 2);
    let bound = face_to_face(&fixed.faces[target.0], &moving.faces[target.1], 0.0, 0.0);
    let pair = Arc::new(Pair {
        fixed,
        moving,
        target,
        bound,
        only: false,
    });
    let space = ConfigurationSpace {
        half_size: [1.0, 1.0],
        rho: pair.moving.radius_of_gyration(),
        free_distance: pair.free_distance(),
    };
    let interaction = Interaction {
        model: MagnetModel::Dipole,
        ..Interaction::default()
    };
    Problem::new(space, pair, &interaction)
}

/// The paper's tile.
pub fn paper_tile() -> Problem {
    pair(4, 0.43, [&[0, 1, 2, 3]; 2])
}
