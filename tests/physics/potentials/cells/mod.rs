//! Bounds of energies over cells contain the energies, and are as narrow as intended.

mod blocks;
mod dipoles;
mod widths;

use std::f64::consts::FRAC_PI_2;

use nalgebra::{Matrix3, Vector2, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::Configuration;
use tilebind::cell::Cell;
use tilebind::contact::Contact;
use tilebind::potential::bounds::Enclosure;
use tilebind::potential::shielding::{Shield, Shields};
use tilebind::potential::simd::Level;
use tilebind::potential::{CellBounds, MagnetModel, Potential};
use tilebind::tile::Tile;
use tilebind::tile::magnet::{Form, Shape, Standing};

use super::any_shields;
use super::kinds::{
    Make, block_bounds, blocks, bodies_of, dipole_bounds, dipoles, mixed_bounds, paper_tile,
    shielded_bounds, shielded_of, shielded_pair_bounds,
};
use crate::designs;

/// Two tiles whose energy is enclosed.
struct Enclosed {
    name: &'static str,
    tiles: [Tile; 2],
    energy: Make<dyn Potential>,
    bounds: Make<dyn CellBounds>,
    /// Whether there are shields, different ones for each cell.
    shielded: bool,
    levels: Vec<Level>,
    /// A random cell, the number of cells, and the smallest number of free configurations in them,
    /// in all cells and in those larger than 1 cm.
    cell: fn(&mut ChaCha8Rng) -> Cell,
    cells: usize,
    met: [usize; 2],
    /// The errors of the potential itself: of energies (J), and of slopes (relative).
    off: [f64; 2],
    /// Cells of no size: where, what may be off of the value, of the gradient (absolute, and as a
    /// share of the largest) and of the Hessian (as a share of the largest entry, or of one and the own; infinite if
    /// there is none), and the width (J) that is left.
    centres: Vec<[f64; 3]>,
    value: [f64; 2],
    gradient: [f64; 2],
    hessian: f64,
    width: f64,
    /// Cells that shrink: the middle, the shape, two sizes, and the least and the greatest ratio of
    /// their widths.
    shrinking: Vec<Shrinking>,
}

type Shrinking = ([f64; 3], [f64; 3], [f64; 2], [f64; 2]);

fn all() -> Vec<Enclosed> {
    let paper = || ["NNNS", "NSSS"].map(paper_tile);
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let of_dipoles = Enclosed {
        name: "dipoles",
        tiles: paper(),
        energy: dipoles,
        bounds: dipole_bounds,
        shielded: false,
        levels: Level::available(),
        cell: |rng| {
            let size = 10f64.powf(rng.random_range(-4.0..-0.5));
            Cell {
                centre: Configuration::new(
                    rng.random_range(0.35..0.6),
                    rng.random_range(-0.3..0.3),
                    rng.random_range(-0.4..0.4),
                ),
                half: std::array::from_fn(|_| size * rng.random_range(0.05..1.0)),
            }
        },
        cells: 3000,
        met: [10_000, 3_000],
        off: [0.0, 1e-9],
        centres: vec![[0.44, -0.07, 0.08]],
        value: [1e-14, 0.0],
        gradient: [1e-12, 0.0],
        hessian: 1e-5,
        width: 2e-11,
        shrinking: vec![(
            [0.46, 0.03, 0.1],
            [1.0, 1.0, 4.0],
            [1e-3, 1e-4],
            [600.0, 1400.0],
        )],
    };
    let of_blocks = |tiles, levels, cells, met| Enclosed {
        name: "blocks",
        tiles,
        energy: blocks,
        bounds: block_bounds,
        shielded: false,
        levels,
        cell: about_contact,
        cells,
        met: [met, 0],
        // The potential's quadrature at contact is accurate to 3e-5 of a pair's energy.
        off: [3e-6 * 0.03, 3e-6],
        centres: vec![[0.44, -0.07, 0.02], [0.47, 0.01, -0.1], [0.6, 0.2, 2.0]],
        value: [0.0, 2e-7],
        gradient: [0.0, 1e-6],
        // That of blocks far from each other is their dipoles'.
        hessian: f64::INFINITY,
        width: 1e-7,
        shrinking: vec![
            // Clear of each other, and face to face: second order but for logarithms.
            (
                [0.46, 0.013, 0.0],
                [1.0, 1.0, 2.0],
                [4e-4, 8e-5],
                [24.0, 1000.0],
            ),
            (
                [0.43, 0.013, 0.0],
                [1.0, 1.0, 2.0],
                [1e-4, 1e-5],
                [30.0, 1000.0],
            ),
        ],
    };
    let small = designs::load("shapes/shielded-backs.toml").pair;
    let behind_shields = || Enclosed {
        name: "dipoles behind shields",
        tiles: [small.fixed.clone(), small.moving.clone()],
        energy: shielded_of(MagnetModel::Dipole),
        bounds: shielded_bounds,
        shielded: true,
        levels: Level::available(),
        cell: |rng| {
            let size = 10f64.powf(rng.random_range(-5.0..-1.0));
            Cell {
                centre: Configuration::new(
                    rng.random_range(0.06..0.12),
                    rng.random_range(-0.08..0.08),
                    rng.random_range(-0.8..0.8),
                ),
                half: [1.0, 1.0, 10.0].map(|scale| scale * size * rng.random_range(0.0..1.0)),
            }
        },
        cells: 2000,
        met: [10_000, 2_000],
        off: [0.0, 1e-9],
        centres: vec![[0.085, -0.02, 0.03]; 20],
        value: [1e-14, 0.0],
        gradient: [1e-12, 1e-12],
        hessian: 1e-6,
        width: 2e-11,
        shrinking: vec![(
            [0.09, 0.01, 0.1],
            [1.0, 1.0, 10.0],
            [1e-4, 1e-5],
            [800.0, 1200.0],
        )],
    };
    let blocks_behind_shields = Enclosed {
        name: "blocks behind shields",
        energy: shielded_of(MagnetModel::Cuboid),
        bounds: shielded_pair_bounds(MagnetModel::Cuboid),
        levels: vec![Level::best()],
        cells: 300,
        met: [1_500, 300],
        // The potential's quadrature at contact, as of bare blocks.
        off: [3e-6 * 0.03, 3e-6],
        centres: vec![[0.085, -0.02, 0.03], [0.2, 0.1, 2.0]],
        value: [0.0, 2e-7],
        gradient: [0.0, 1e-6],
        hessian: f64::INFINITY,
        width: 1e-7,
        shrinking: vec![(
            [0.11, 0.01, 0.1],
            [1.0, 1.0, 10.0],
            [4e-4, 8e-5],
            // Of second order, as of bare blocks.
            [20.0, 1000.0],
        )],
        ..behind_shields()
    };
    let standing = |name, model, inset: f64, lying: bool| Enclosed {
        name,
        tiles: ["NNNS", "NSSS"].map(|code| standing_tile(code, inset, lying)),
        energy: bodies_of(model),
        bounds: mixed_bounds(model),
        cell: about_contact,
        // Energies of pairs are exact to 1e-9 of touching magnets.
        off: [1e-9, 1e-7],
        centres: vec![[0.44, -0.07, 0.02], [0.47, 0.01, -0.1], [0.6, 0.2, 2.0]],
        value: [0.0, 1e-8],
        gradient: [0.0, 1e-6],
        // A cell of no size needs none.
        hessian: f64::INFINITY,
        width: 1e-7,
        shrinking: vec![(
            [0.46, 0.013, 0.1],
            [1.0, 1.0, 2.0],
            [4e-4, 4e-5],
            [100.0, 1400.0],
        )],
        ..of_blocks(paper(), vec![Level::best()], 1200, 6_000)
    };
    let lying_too = |inset| Enclosed {
        hessian: f64::INFINITY,
        shrinking: Vec::new(),
        ..standing(
            "upright discs among blocks",
            MagnetModel::Cuboid,
            inset,
            true,
        )
    };
    // From a little inside to flush with the surface.
    let bodies = |name, forms: &'static [MadeOf], inset| Enclosed {
        name,
        tiles: ["NNNS", "NSSS"].map(|code| tile_of(code, inset, forms)),
        // A cell of no size needs none.
        hessian: f64::INFINITY,
        gradient: [0.0, 1e-5],
        cells: 400,
        met: [2_000, 0],
        shrinking: vec![(
            [0.46, 0.013, 0.1],
            [1.0, 1.0, 2.0],
            // Of third order where it counts once for all pairs, of fourth order in each.
            [2e-3, 4e-4],
            [100.0, 700.0],
        )],
        ..standing("", MagnetModel::Cuboid, 0.001, false)
    };
    let bodies_behind_shields = |name, model| Enclosed {
        name,
        energy: shielded_of(model),
        bounds: shielded_pair_bounds(model),
        shielded: true,
        cells: 300,
        met: [1_500, 0],
        // As of blocks at contact.
        off: [3e-6 * 0.03, 3e-6],
        value: [0.0, 2e-7],
        shrinking: Vec::new(),
        ..bodies("", &EVERY_FORM, 0.001)
    };
    let mut all = vec![
        standing("upright discs", MagnetModel::Cuboid, 0.001, false),
        Enclosed {
            shrinking: Vec::new(),
            ..standing("touching upright discs", MagnetModel::Cuboid, 0.0, false)
        },
        standing("upright dipoles", MagnetModel::Dipole, 0.001, false),
        lying_too(0.0005),
        bodies("discs that lie", &[LYING_DISC], 0.0005),
        bodies("touching discs that lie", &[LYING_DISC], 0.0),
        bodies("upright blocks", &[UPRIGHT_BLOCK], 0.0005),
        bodies("touching upright blocks", &[UPRIGHT_BLOCK], 0.0),
        bodies("magnets of every form", &EVERY_FORM, 0.001),
        Enclosed {
            // As of blocks at contact.
            off: [3e-6 * 0.03, 3e-6],
            ..bodies("touching magnets of every form", &EVERY_FORM, 0.0)
        },
        of_dipoles,
        of_blocks(paper(), Level::available(), 1200, 6_000),
        behind_shields(),
        blocks_behind_shields,
        bodies_behind_shields("magnets of every form behind shields", MagnetModel::Cuboid),
        bodies_behind_shields("the same as dipoles", MagnetModel::Dipole),
    ];
    all.extend((0..4).map(|_| {
        let tiles = [mixed_tile(&mut rng), mixed_tile(&mut rng)];
        Enclosed {
            name: "blocks of all shapes",
            shrinking: Vec::new(),
            ..of_blocks(tiles, vec![Level::best()], 400, 2_000)
        }
    }));
    all
}

/// The tile of the paper with upright discs of three sizes, of which blocks may take every third
/// place.
fn standing_tile(code: &str, inset: f64, lying: bool) -> Tile {
    let mut tile = paper_tile(code);
    for (k, magnet) in tile.magnets.iter_mut().enumerate() {
        let outwards = magnet.face as f64 * FRAC_PI_2;
        let normal = Vector2::new(outwards.cos(), outwards.sin());
        if !(lying && k % 3 == 0) {
            let north = (magnet.angle - outwards).cos() > 0.0;
            magnet.size = [
                [0.02, 0.02, 0.01],
                [0.012, 0.012, 0.003],
                [0.006, 0.006, 0.012],
            ][k % 3];
            magnet.form = Form {
                shape: Shape::Disc,
                stands: Some(if north { Standing::Up } else { Standing::Down }),
            };
        }
        let depth = inset + magnet.size[0] / 2.0;
        magnet.position += normal * (0.215 - depth - magnet.position.dot(&normal));
    }
    tile
}

/// A shape, whether it stands, and two sizes (m).
type MadeOf = (Shape, bool, [[f64; 3]; 2]);

const LYING_DISC: MadeOf = (
    Shape::Disc,
    false,
    [[0.005, 0.016, 0.016], [0.012, 0.006, 0.006]],
);
const UPRIGHT_BLOCK: MadeOf = (
    Shape::Block,
    true,
    [[0.01, 0.014, 0.004], [0.006, 0.008, 0.01]],
);
const EVERY_FORM: [MadeOf; 4] = [
    LYING_DISC,
    UPRIGHT_BLOCK,
    (
        Shape::Block,
        false,
        [[0.006, 0.016, 0.003], [0.01, 0.01, 0.01]],
    ),
    (
        Shape::Disc,
        true,
        [[0.012, 0.012, 0.003], [0.006, 0.006, 0.012]],
    ),
];

/// The tile of the paper with magnets of some forms, each form in two sizes, a little turned where there is
/// room.
fn tile_of(code: &str, inset: f64, forms: &[MadeOf]) -> Tile {
    let mut tile = paper_tile(code);
    for (k, magnet) in tile.magnets.iter_mut().enumerate() {
        let outwards = magnet.face as f64 * FRAC_PI_2;
        let normal = Vector2::new(outwards.cos(), outwards.sin());
        let north = (magnet.angle - outwards).cos() > 0.0;
        let (shape, stands, sizes) = forms[(k + k / 4) % forms.len()];
        magnet.size = sizes[(k / forms.len()) % 2];
        let up = if north { Standing::Up } else { Standing::Down };
        let stands = stands.then_some(up);
        magnet.form = Form { shape, stands };
        // All magnets of the third face are turned.
        let turn: f64 = if magnet.face == 2 { 0.3 } else { 0.0 };
        magnet.angle += turn;
        let [a, b, _] = magnet.size;
        let reach = match magnet.is_round() {
            true => a,
            false => a * turn.cos() + b * turn.sin(),
        };
        let depth = inset + reach / 2.0;
        magnet.position += normal * (0.215 - depth - magnet.position.dot(&normal));
    }
    tile
}

/// The tile of the paper with blocks of other shapes at other angles, as deep in the tile as they
/// just fit.
fn mixed_tile(rng: &mut ChaCha8Rng) -> Tile {
    let mut tile = paper_tile("NNNS");
    for (k, magnet) in tile.magnets.iter_mut().enumerate() {
        let size = [
            [0.006, 0.016, 0.003],
            [0.012, 0.005, 0.006],
            [0.01, 0.01, 0.01],
        ][k % 3];
        let turn: f64 = rng.random_range(-3.1..3.1);
        let depth = (size[0] * turn.cos().abs() + size[1] * turn.sin().abs()) / 2.0;
        let outwards = magnet.face as f64 * FRAC_PI_2;
        let normal = Vector2::new(outwards.cos(), outwards.sin());
        magnet.position += normal * (0.215 - depth - magnet.position.dot(&normal));
        magnet.angle = outwards + turn;
        magnet.size = size;
    }
    tile
}

/// A cell about contact, from tiny to large.
fn about_contact(rng: &mut ChaCha8Rng) -> Cell {
    let size = 10f64.powf(rng.random_range(-6.0..-1.0));
    let tilt = [1e-4, 2e-3, 0.02, 0.4][rng.random_range(0..4)];
    let theta: f64 = tilt * rng.random_range(-1.0..1.0);
    let apart = [0.1, 2e-3, 2e-4, 1e-5][rng.random_range(0..4)];
    let contact = 0.215 * (1.0 + theta.cos() + theta.sin().abs());
    Cell {
        centre: Configuration::new(
            contact + apart * rng.random_range(-0.3..1.0),
            rng.random_range(-0.1..0.1),
            theta,
        ),
        half: [1.0, 1.0, 5.0].map(|shape| size * shape * rng.random_range(0.05..1.0)),
    }
}

impl Enclosed {
    fn made(
        &self,
        rng: &mut ChaCha8Rng,
        narrowest: f64,
        level: Level,
    ) -> (Box<dyn CellBounds>, Box<dyn Potential>) {
        let shields = if self.shielded {
            any_shields(rng, narrowest)
        } else {
            Shields::default()
        };
        let tiles = self.tiles.each_ref();
        let energy = (self.energy)(tiles, &shields, Level::best());
        ((self.bounds)(tiles, &shields, level), energy)
    }
}

#[test]
fn no_free_configuration_of_a_cell_lies_outside_its_enclosure() {
    for case in all() {
        let [a, b] = &case.tiles;
        let contact = Contact::new(&a.outline, &b.outline);
        for level in &case.levels {
            let mut rng = ChaCha8Rng::seed_from_u64(11);
            let (mut bounds, mut potential) = case.made(&mut rng, -3.0, *level);
            println!("{}, {level}", case.name);
            let mut met = [0; 2];
            // Bits are the same on all levels (`levels.rs`): the others need fewer cells.
            let part = if *level == Level::best() { 1 } else { 20 };
            for _ in 0..case.cells / part {
                if case.shielded {
                    (bounds, potential) = case.made(&mut rng, -3.0, *level);
                }
                let cell = (case.cell)(&mut rng);
                let enclosure = bounds.enclose(&cell);
                assert!(enclosure.low <= 0.0 && enclosure.high >= 0.0);
                let free =
                    assert_encloses(&enclosure, &*potential, &contact, &cell, case.off, &mut rng);
                met[0] += free;
                met[1] += if cell.half[0] > 0.01 { free } else { 0 };
            }
            let least = case.met.map(|least| least / (2 * part - 1));
            let enough = met[0] > least[0] && met[1] >= least[1];
            assert!(enough, "{}, {level}: {met:?}", case.name);
        }
    }
}

#[test]
fn cells_of_no_size_give_the_energy_and_its_derivatives() {
    for case in all() {
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        for (centre, level) in case
            .centres
            .iter()
            .flat_map(|c| case.levels.iter().map(move |l| (c, *l)))
        {
            let name = format!("{}, {level}: {centre:?}", case.name);
            let (bounds, potential) = case.made(&mut rng, -0.7, level);
            let q = Configuration::from(*centre);
            let half = [0.0; 3];
            let Enclosure {
                form, low, high, ..
            } = bounds.enclose(&Cell { centre: q, half });
            assert!(high - low < case.width, "{name}: {}", high - low);
            let (energy, gradient) = potential.energy_and_gradient(&q);
            let off = (form.value - energy).abs();
            let [absolute, share] = case.value;
            assert!(off <= absolute + share * energy.abs(), "{name}: {off}");
            let off = (Vector3::from(form.gradient) - gradient).amax();
            let [absolute, share] = case.gradient;
            assert!(off <= absolute + share * gradient.norm(), "{name}: {off}");
            if case.hessian.is_infinite() {
                continue;
            }
            let hessian = matrix(form.hessian);
            let slopes = Matrix3::from_columns(&[0, 1, 2].map(|axis| {
                let mut step = Vector3::zeros();
                step[axis] = [1e-5, 1e-5, 1e-4][axis];
                let at = |step: Vector3<f64>| potential.energy_and_gradient(&q.moved(step)).1;
                let (near, far) = (at(step) - at(-step), at(step * 2.0) - at(step * -2.0));
                (near * 8.0 - far) / (12.0 * step[axis])
            }));
            let size = hessian.abs().map(|entry| hessian.amax().min(1.0 + entry));
            let off = (slopes - hessian).abs().component_div(&size).max();
            assert!(off < case.hessian, "{name}: {off}");
        }
    }
}

#[test]
fn enclosures_tighten_as_cells_shrink() {
    let shield = Shield {
        attenuation: 0.8,
        length: 0.03,
        width: 0.3,
        front_gain: 1.1,
    };
    let shields = Shields {
        fixed: vec![Some(shield); 4],
        ..Shields::default()
    };
    for case in all() {
        let bounds = (case.bounds)(case.tiles.each_ref(), &shields, Level::best());
        for (centre, shape, sizes, [least, greatest]) in &case.shrinking {
            let [coarse, fine] = sizes.map(|size| {
                let enclosure = bounds.enclose(&Cell {
                    centre: (*centre).into(),
                    half: shape.map(|s| s * size),
                });
                enclosure.high - enclosure.low
            });
            let ratio = coarse / fine;
            let right = (*least..*greatest).contains(&ratio);
            assert!(right, "{} {centre:?}: {coarse} {fine}", case.name);
        }
    }
}

/// On corners, where no depth keeps magnets apart.
#[test]
fn magnets_that_may_coincide_are_unknown() {
    for case in all().iter().filter(|case| case.name.starts_with("dipoles")) {
        let mut tiles = case.tiles.clone();
        for tile in &mut tiles {
            tile.magnets[0].position = tile.outline.vertices()[0];
        }
        let bounds = (case.bounds)(tiles.each_ref(), &Shields::default(), Level::best());
        let enclosure = bounds.enclose(&Cell {
            centre: Configuration::new(0.0, 0.0, 0.0),
            half: [0.1, 0.1, 0.1],
        });
        assert_eq!(enclosure.low, f64::NEG_INFINITY);
    }
}

fn matrix([xx, yy, tt, xy, xt, yt]: [f64; 6]) -> Matrix3<f64> {
    Matrix3::new(xx, xy, xt, xy, yy, yt, xt, yt, tt)
}

/// Asserts that the energies of free ones among twenty random configurations of a cell, half of them
/// at its corners, where remainders are largest, lie in its enclosure; returns how many these were.
pub fn assert_encloses(
    enclosure: &Enclosure,
    potential: &dyn Potential,
    contact: &Contact,
    cell: &Cell,
    [slack, error]: [f64; 2],
    rng: &mut ChaCha8Rng,
) -> usize {
    let mut tested = 0;
    for k in 0..20 {
        let d = cell.half.map(|half| match k % 2 {
            0 => half * rng.random_range(-1.0f64..1.0).signum(),
            _ => half * rng.random_range(-1.0..=1.0),
        });
        let q = cell.centre.moved(d.into());
        if !contact.is_free(&q) {
            continue;
        }
        let rest = potential.energy(&q) - enclosure.form.at(d);
        tested += 1;
        assert!(
            rest >= enclosure.low - slack && rest <= enclosure.high + slack,
            "{cell:?} {d:?}: {rest} not in [{}, {}]",
            enclosure.low,
            enclosure.high
        );
        assert_follows(enclosure, potential, cell, d, error);
    }
    tested
}

/// A fraction of a cell's sizes so small that bounds of values are useless.
const SHORT: f64 = 1e-6;

/// Asserts that the form's slope at the offset d from a cell's centre, along some directions, is no
/// farther from the energy's than the enclosure says, and than the gradient's relative error.
fn assert_follows(
    enclosure: &Enclosure,
    potential: &dyn Potential,
    cell: &Cell,
    d: [f64; 3],
    error: f64,
) {
    let (energy, gradient) = potential.energy_and_gradient(&cell.centre.moved(d.into()));
    let bent = matrix(enclosure.form.hessian) * Vector3::from(d);
    let rest = gradient - Vector3::from(enclosure.form.gradient) - bent;
    let size: f64 = (0..3).map(|i| gradient[i].abs() * cell.half[i]).sum();
    for shares in [
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.1, 1.0, -0.1],
        [1.0, 1.0, 1.0],
        [1.0, 1.0, -1.0],
        [1.0, -1.0, 1.0],
        [-1.0, 1.0, 1.0],
    ] {
        let step = Vector3::from_fn(|i, _| SHORT * shares[i] * cell.half[i]);
        let along = rest.dot(&step) / SHORT;
        let allowed = (enclosure.change(&step, &cell.half) - enclosure.jump) / SHORT;
        assert!(
            along.abs() <= allowed + error * (size + energy.abs()),
            "{cell:?} {d:?} {shares:?}: {along} > {allowed}"
        );
    }
}

/// What was enclosed before, by these bounds or others, at this turn or another one, does not matter.
#[test]
fn enclosures_are_those_of_a_new_thread() {
    for case in all() {
        let mut rng = ChaCha8Rng::seed_from_u64(7);
        let made = [(); 2].map(|()| case.made(&mut rng, -0.7, Level::best()).0);
        let cells: Vec<Cell> = (0..12)
            .map(|k| Cell {
                centre: Configuration::new(
                    0.45 + 0.01 * f64::from(k),
                    0.02,
                    [0.1, 0.1, 0.3][k as usize % 3],
                ),
                half: [0.002, 0.002, 0.01 / f64::from(1 + k % 4)],
            })
            .collect();
        for (k, cell) in cells.iter().enumerate() {
            let bounds = &made[k / 2 % 2];
            let alone = std::thread::scope(|scope| {
                let enclosed = scope.spawn(|| bounds.enclose(cell));
                enclosed.join().unwrap()
            });
            assert_eq!(bounds.enclose(cell), alone, "{} {k}", case.name);
        }
    }
}
