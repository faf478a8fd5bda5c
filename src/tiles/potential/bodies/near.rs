//! The energy of two magnets close to each other, by their charged faces.

use nalgebra::Vector2;

use super::Body;
use super::edges;
use super::face::{ChargedFace, Integral, Shape as Charged};
use super::line::{self, Placed};
use crate::potential::cuboid::block::Block;
use crate::potential::cuboid::exact as blocks;
use crate::potential::far::PairEnergy;
use crate::tile::magnet::Shape;
use crate::units::MU0_OVER_4PI;

/// Faces in one plane are treated as this fraction of their size apart, on the side of the free
/// configurations, because the force jumps there.
const APART: f64 = 1e-9;

/// The energy (J) of two magnets that both lie or both stand, and its derivatives.
pub fn exact(first: &Body, second: &Body) -> PairEnergy {
    if first.stands {
        return standing(first, second);
    }
    match (first.shape, second.shape) {
        (Shape::Block, Shape::Block) => blocks(&block(first), &block(second)),
        _ => lying(first, second),
    }
}

fn block(body: &Body) -> Block {
    Block {
        position: body.position,
        axis: body.direction,
        moment: body.moment,
        size: body.size,
    }
}

/// The charge densities' product, times `mu0 / (4 pi)` (J/m^3).
pub fn strength(first: &Body, second: &Body) -> f64 {
    MU0_OVER_4PI * first.moment / first.volume() * second.moment / second.volume()
}

fn standing(first: &Body, second: &Body) -> PairEnergy {
    // The two of like signs are each other's mirror images, and so are the others.
    let strength = 2.0 * strength(first, second);
    if [first.shape, second.shape] == [Shape::Block; 2] {
        return scaled(&edges::integral(first, second), strength);
    }
    let face = |body: &Body, side: f64| {
        let [a, b, height] = body.size;
        let shape = match body.shape {
            Shape::Disc => Charged::Disc(a / 2.0),
            Shape::Block => Charged::Rectangle([a / 2.0, b / 2.0]),
        };
        ChargedFace::flat(body.position, body.direction, side * height / 2.0, shape)
    };
    let own = face(first, 1.0);
    let others = [1.0, -1.0].map(|side| face(second, side));
    let places = [0, 1].map(|k| Placed {
        centres: [own.centre, others[k].centre],
        share: [1.0, -1.0][k],
        offset: Vector2::zeros(),
    });
    scaled(&integral(&own, &others[0], &places), strength)
}

fn lying(first: &Body, second: &Body) -> PairEnergy {
    let [from, to] = [first, second].map(upright);
    let places = pole_places(first, second);
    scaled(&integral(&from, &to, &places), strength(first, second))
}

/// A face of a magnet that lies, at its middle.
pub fn upright(body: &Body) -> ChargedFace {
    let [_, width, height] = body.size;
    let shape = match body.shape {
        Shape::Disc => Charged::Disc(width / 2.0),
        Shape::Block => Charged::Rectangle([width / 2.0, height / 2.0]),
    };
    ChargedFace::upright(body.position, body.direction, shape)
}

/// The places of both faces of one magnet that lies and those of another one.
pub fn pole_places(first: &Body, second: &Body) -> [Placed; 4] {
    [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]].map(|[own, side]| {
        let [from, offset] = [(first, own), (second, side)]
            .map(|(body, side)| body.direction * (side * body.size[0] / 2.0));
        let [from, mut to] = [first.position + from, second.position + offset];
        let outwards = first.direction * own;
        let height = (to - from).dot(&outwards);
        let apart = APART * first.size[1];
        if height.abs() < apart && first.direction.perp(&second.direction).abs() < APART {
            to += outwards * (apart - height);
        }
        Placed {
            centres: [from, to].map(|centre| centre.push(0.0)),
            share: own * side,
            offset,
        }
    })
}

/// The energy of faces of a strength (J/m^3).
fn scaled(integral: &Integral, strength: f64) -> PairEnergy {
    PairEnergy {
        energy: strength * integral.value,
        gradient: integral.gradient * strength,
        slope: strength * integral.slope,
    }
}

/// The integral over two faces that do not meet, both upright or both flat, one of them a disc.
pub fn alone(first: &ChargedFace, second: &ChargedFace) -> Integral {
    let place = Placed {
        centres: [first.centre, second.centre],
        share: 1.0,
        offset: Vector2::zeros(),
    };
    integral(first, second, &[place])
}

/// The sum of the integrals over two faces that do not meet, at several places: both upright or both flat,
/// one of them a disc.
fn integral(first: &ChargedFace, second: &ChargedFace, places: &[Placed]) -> Integral {
    match [first.shape, second.shape] {
        [Charged::Disc(radius), _] => line::integral(first, radius, second, false, places),
        [_, Charged::Disc(radius)] => line::integral(second, radius, first, true, places),
        [Charged::Rectangle(_), Charged::Rectangle(_)] => unreachable!("blocks have closed forms"),
    }
}
