//! The kinds of energy: an energy that is added to [`all`] is tested by every law in
//! [`super::laws`].

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use nalgebra::{Vector2, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::Configuration;
use tilebind::potential::bounds::{
    CuboidBounds, DipoleBounds, MixedBounds, ShieldedBounds, ShieldedPairBounds,
};
use tilebind::potential::shielding::{Shield, ShieldRule, Shields};
use tilebind::potential::simd::Level;
use tilebind::potential::{
    BodyPotential, CellBounds, CuboidPotential, DipolePotential, MagnetModel, Potential,
    ShieldedPotential, dipole,
};
use tilebind::tile::magnet::{Form, Shape, Standing};
use tilebind::tile::{Face, Magnet, Outline, Tile};
use tilebind::units::{MU0, MU0_OVER_4PI};

pub type Make<T> = fn([&Tile; 2], &Shields, Level) -> Box<T>;

/// A kind of energy, two tiles for its tests, and its accuracy.
#[derive(Clone)]
pub struct Kind {
    pub name: String,
    pub tiles: [Tile; 2],
    pub shields: Shields,
    pub energy: Make<dyn Potential>,
    /// Its bounds over cells, if it has any.
    pub bounds: Option<Make<dyn CellBounds>>,
    /// Free configurations, from contact to far away.
    pub poses: Vec<Configuration>,
    /// Other configurations: overlapping, with magnets 1 cm from each other, a kilometre away.
    pub anywhere: Vec<Configuration>,
    pub exact: Exact,
}

/// The allowed errors.
#[derive(Clone, Copy)]
pub struct Exact {
    /// Steps (m, rad) of differences, and their error as a share of force, and of torque as of a
    /// force at `lever` (m).
    pub steps: [f64; 2],
    pub slope: f64,
    pub lever: f64,
    /// Energy, as a share of itself or of the force times 1 cm, whichever is less, and force and
    /// torque as shares of the force, and of the force at 5 cm, seen from the other tile or from
    /// elsewhere.
    pub seen: [f64; 3],
    /// Energy of a scaled pair, as a share of itself.
    pub scaled: f64,
    /// Energy and gradient by the plain formulas, as shares of the pairs' magnitudes, if they have
    /// any; and the largest ratio to the plain bounds of derivatives, if that is known.
    pub plain: Option<[f64; 2]>,
    pub wider: Option<f64>,
    /// The least shares of the bounds of the second, third and fourth derivatives that differences
    /// reach, and what of the pairs' magnitudes is lost in these.
    pub reached: [f64; 3],
    pub lost: f64,
}

impl Kind {
    pub fn energy(&self, level: Level) -> Box<dyn Potential> {
        self.energy_of(&self.tiles, &self.shields, level)
    }

    pub fn energy_of(
        &self,
        [a, b]: &[Tile; 2],
        shields: &Shields,
        level: Level,
    ) -> Box<dyn Potential> {
        (self.energy)([a, b], shields, level)
    }
}

/// Every kind.
pub fn all() -> Vec<Kind> {
    let mut all = Vec::new();
    let dipoles = [
        (1, 1),
        (1, 3),
        (5, 2),
        (4, 9),
        (16, 16),
        (12, 17),
        (7, 19),
        (100, 90),
    ];
    all.extend(dipoles.map(few_dipoles));
    let many = [
        (4, 64, 0.0, false),
        (4, 64, 0.0, true),
        (4, 40, 0.001, false),
        (4, 200, 0.004, false),
        (64, 4, 0.0, false),
        (1, 300, 0.0, true),
    ];
    all.extend(many.map(many_dipoles));
    all.push(odd_blocks());
    all.extend([MagnetModel::Dipole, MagnetModel::Cuboid].map(bodies));
    for model in [MagnetModel::Dipole, MagnetModel::Cuboid] {
        all.push(shielded(model, ShieldRule::Smooth));
        all.push(shielded(model, ShieldRule::NearestFace));
        all.push(shielded_bodies(model, ShieldRule::Smooth));
        all.push(shielded_bodies(model, ShieldRule::NearestFace));
    }
    all.extend((0..6).map(odd_shields));
    all.push(attraction());
    if std::env::var_os("TILEBIND_KERNEL").is_some() {
        // One level is tested here; all levels are tested for bare dipoles.
        all.retain(|kind| kind.exact.wider.is_none());
    }
    all
}

pub fn dipoles([a, b]: [&Tile; 2], _: &Shields, level: Level) -> Box<dyn Potential> {
    let [a, b] = [a, b].map(|tile| dipole::dipoles(&tile.magnets));
    Box::new(DipolePotential::with_level(&a, &b, level))
}

pub fn blocks([a, b]: [&Tile; 2], _: &Shields, level: Level) -> Box<dyn Potential> {
    Box::new(CuboidPotential::with_level(&a.magnets, &b.magnets, level))
}

pub fn shielded_of(model: MagnetModel) -> Make<dyn Potential> {
    match model {
        MagnetModel::Dipole => |[a, b], s, level| {
            let model = MagnetModel::Dipole;
            Box::new(ShieldedPotential::with_level(model, a, b, s, level))
        },
        MagnetModel::Cuboid => |[a, b], s, level| {
            let model = MagnetModel::Cuboid;
            Box::new(ShieldedPotential::with_level(model, a, b, s, level))
        },
    }
}

pub fn dipole_bounds([a, b]: [&Tile; 2], _: &Shields, level: Level) -> Box<dyn CellBounds> {
    Box::new(DipoleBounds::with_level(a, b, level))
}

pub fn block_bounds([a, b]: [&Tile; 2], _: &Shields, level: Level) -> Box<dyn CellBounds> {
    Box::new(CuboidBounds::with_level(a, b, level))
}

pub fn shielded_bounds([a, b]: [&Tile; 2], s: &Shields, level: Level) -> Box<dyn CellBounds> {
    Box::new(ShieldedBounds::with_level(a, b, s, level))
}

/// Of any magnets, pair by pair.
pub fn shielded_pair_bounds(model: MagnetModel) -> Make<dyn CellBounds> {
    match model {
        MagnetModel::Dipole => |[a, b], s, level| {
            let model = MagnetModel::Dipole;
            Box::new(ShieldedPairBounds::with_level(model, a, b, s, level))
        },
        MagnetModel::Cuboid => |[a, b], s, level| {
            let model = MagnetModel::Cuboid;
            Box::new(ShieldedPairBounds::with_level(model, a, b, s, level))
        },
    }
}

pub fn bodies_of(model: MagnetModel) -> Make<dyn Potential> {
    match model {
        MagnetModel::Dipole => |[a, b], _, _| {
            let model = MagnetModel::Dipole;
            Box::new(BodyPotential::new(model, &a.magnets, &b.magnets))
        },
        MagnetModel::Cuboid => |[a, b], _, _| {
            let model = MagnetModel::Cuboid;
            Box::new(BodyPotential::new(model, &a.magnets, &b.magnets))
        },
    }
}

pub fn mixed_bounds(model: MagnetModel) -> Make<dyn CellBounds> {
    match model {
        MagnetModel::Dipole => |[a, b], _, _| Box::new(MixedBounds::new(MagnetModel::Dipole, a, b)),
        MagnetModel::Cuboid => |[a, b], _, _| Box::new(MixedBounds::new(MagnetModel::Cuboid, a, b)),
    }
}

/// Of point dipoles, by whatever is computed in the same way.
const OF_DIPOLES: Exact = Exact {
    steps: [2e-5, 2e-4],
    slope: 1e-9,
    lever: 0.05,
    seen: [1e-12; 3],
    scaled: 1e-12,
    plain: Some([1e-12; 2]),
    wider: Some(1.0 + 1e-11),
    reached: [0.01, 0.0, 0.01],
    lost: 1e-14,
};

/// Dipoles in a disc of radius 0.3 m, at any angle, of moments from 0.1 to 1 A m^2.
fn few_dipoles((n, m): (usize, usize)) -> Kind {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let tiles = [n, m].map(|count| {
        let mut magnet = |k: usize| Magnet {
            position: turned(rng.random_range(-PI..PI)) * (0.3 * rng.random::<f64>().sqrt()),
            angle: rng.random_range(-PI..PI),
            moment: rng.random_range(0.1..1.0),
            size: [1e-3; 3],
            form: Default::default(),
            face: k % 4,
        };
        square(0.31, (0..count).map(&mut magnet).collect())
    });
    let far = |_| {
        let away = turned(rng.random_range(-PI..PI)) * rng.random_range(0.65..1.0);
        Configuration::new(away.x, away.y, rng.random_range(-PI..PI))
    };
    let poses = (0..60).map(far).collect();
    // Angles of several full turns.
    let turns = [10.0, -100.0, 9.9e4, -1.1e5, 1e9].map(|turns| Configuration::new(0.8, 0.3, turns));
    let anywhere = (0..300).map(|i| {
        let theta = rng.random_range(-PI..PI);
        let away = turned(rng.random_range(-PI..PI));
        let position = match i % 3 {
            0 => away * 10f64.powf(rng.random_range(0.0..3.0)),
            1 => away * rng.random_range(0.0..1.0),
            _ => {
                let at = Configuration::new(0.0, 0.0, theta);
                let second = &tiles[1].magnets[rng.random_range(0..m)];
                let first = &tiles[0].magnets[rng.random_range(0..n)];
                first.position + away * 0.01 - at.transform(second.position)
            }
        };
        Configuration::new(position.x, position.y, theta)
    });
    Kind {
        name: format!("{n} x {m} dipoles"),
        anywhere: anywhere.chain(turns).collect(),
        tiles,
        shields: Shields::default(),
        energy: dipoles,
        bounds: Some(dipole_bounds),
        poses,
        exact: OF_DIPOLES,
    }
}

/// Tiles of 0.4 m with so many dipoles that they are grouped: along the faces of a regular polygon
/// (one face: a row), `wave` (m) up and down from them, north and south at random or all alike.
fn many_dipoles((faces, each, wave, alike): (usize, usize, f64, bool)) -> Kind {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let (apothem, sides) = (0.2, faces.max(4));
    let turn = TAU / sides as f64;
    let side = 2.0 * apothem * (turn / 2.0).tan();
    let tiles = [(); 2].map(|()| {
        let places = (0..faces).flat_map(|face| (0..each).map(move |k| (face, k)));
        let magnet = |(face, k): (usize, usize)| {
            let angle = turn * face as f64;
            let along = turned(angle + FRAC_PI_2);
            let s = side * ((k as f64 + 0.5) / each as f64 - 0.5);
            let h = wave * (40.0 * s / side).sin() - 0.002;
            let out = alike || rng.random();
            Magnet {
                position: turned(angle) * (apothem + h) + along * s,
                angle: if out { angle } else { angle + PI },
                moment: 0.01,
                size: [1e-3; 3],
                form: Default::default(),
                face: face % 4,
            }
        };
        square(apothem, places.map(magnet).collect())
    });
    // Face to face, slid along, at corners, tilted, near and far.
    let pose = |i| {
        let quarter = turn * rng.random_range(0..sides) as f64;
        let (away, theta) = match i % 4 {
            0 => (0.4, PI + quarter),
            1 => (0.4 + 0.1 * rng.random::<f64>(), rng.random_range(-PI..PI)),
            2 => (rng.random_range(0.45..1.0), PI + quarter),
            _ => (rng.random_range(0.6..3.0), rng.random_range(-PI..PI)),
        };
        Configuration::new(away, rng.random_range(-0.5..0.5), theta)
    };
    // The plain formulas take all pairs one by one.
    let poses = (60 * 65_536 / (faces * each).pow(2)).clamp(16, 60);
    let anywhere: Vec<_> = (0..poses).map(pose).collect();
    let apart = |q: &&Configuration| q.position().norm() > 0.65;
    Kind {
        name: format!("{faces} x {each} dipoles on either tile"),
        tiles,
        shields: Shields::default(),
        energy: dipoles,
        bounds: None,
        poses: anywhere.iter().filter(apart).copied().collect(),
        anywhere,
        exact: Exact {
            slope: 1e-8,
            seen: [1e-9; 3],
            scaled: 1e-10,
            plain: Some([1.1e-11, 1e-10]),
            wider: (faces > 1).then_some(2.0),
            reached: [0.0; 3],
            lost: 1e-12,
            ..OF_DIPOLES
        },
    }
}

pub const SIZE: [f64; 3] = [0.010, 0.012, 0.003];
pub const OTHER: [f64; 3] = [0.006, 0.008, 0.005];

/// A magnet of 1.2 T.
pub fn magnet(x: f64, y: f64, angle: f64, size: [f64; 3]) -> Magnet {
    Magnet {
        position: Vector2::new(x, y),
        angle,
        moment: 1.2 * size.iter().product::<f64>() / MU0,
        size,
        form: Default::default(),
        face: 0,
    }
}

/// A few blocks of two sizes at odd angles, in either tile, from touching to far away.
pub fn odd_blocks() -> Kind {
    let pose = |i| {
        let t = f64::from(i);
        let distance = 0.0565 * 1.06f64.powi(i);
        Configuration::new(distance, 0.01 * (1.3 * t).sin(), 0.3 * (0.7 * t).cos())
    };
    let overlapping = |i| {
        let t = f64::from(i);
        let (x, y) = (0.05 * (0.9 * t).sin(), 0.05 * (1.7 * t).cos());
        Configuration::new(x, y, 3.0 * t.sin())
    };
    let fixed = vec![
        magnet(0.020, 0.010, 0.1, SIZE),
        magnet(0.020, -0.010, 3.2, OTHER),
        magnet(-0.015, 0.012, 1.7, SIZE),
    ];
    let moving = vec![
        magnet(-0.020, 0.011, 0.2, OTHER),
        magnet(-0.019, -0.012, 2.9, SIZE),
    ];
    Kind {
        name: "blocks".into(),
        tiles: [fixed, moving].map(|magnets| square(0.03, magnets)),
        shields: Shields::default(),
        energy: blocks,
        bounds: Some(block_bounds),
        poses: (0..40).map(pose).collect(),
        anywhere: (0..2000).map(overlapping).collect(),
        exact: Exact {
            steps: [2e-5, 1e-3],
            slope: 1e-7,
            lever: 0.03,
            seen: [1e-7; 3],
            scaled: 1e-9,
            plain: None,
            wider: None,
            reached: [0.0; 3],
            lost: 0.0,
        },
    }
}

/// A magnet of 1.2 T of one of four forms: lying and standing, discs and blocks.
fn of_form(number: usize, like: Magnet) -> Magnet {
    let standing = |stands, shape| Form { shape, stands };
    let [up, down] = [Some(Standing::Up), Some(Standing::Down)];
    let (form, size) = [
        (standing(None, Shape::Disc), [0.006, 0.010, 0.010]),
        (standing(up, Shape::Disc), [0.008, 0.008, 0.004]),
        (standing(down, Shape::Block), [0.006, 0.009, 0.005]),
        (standing(None, Shape::Block), [0.010, 0.012, 0.003]),
    ][number % 4];
    Magnet {
        form,
        size,
        moment: 1.2 * form.shape.volume(size) / MU0,
        ..like
    }
}

/// Lying and standing discs and blocks in either tile, from touching to far away.
fn bodies(model: MagnetModel) -> Kind {
    let tile = |places: [[f64; 3]; 4], shift: usize| {
        let magnets = places.iter().enumerate();
        let magnets =
            magnets.map(|(k, [x, y, angle])| of_form(k + shift, magnet(*x, *y, *angle, SIZE)));
        square(0.03, magnets.collect())
    };
    let fixed = [
        [0.020, 0.010, 0.1],
        [0.020, -0.010, 3.2],
        [-0.015, 0.012, 1.7],
        [-0.015, -0.012, 0.4],
    ];
    let moving = [
        [-0.020, 0.011, 0.2],
        [-0.019, -0.012, 2.9],
        [0.014, 0.011, 0.0],
        [0.012, -0.013, 1.0],
    ];
    let pose = |i: i32| {
        let t = f64::from(i);
        let distance = 0.0585 * 1.06f64.powi(i);
        Configuration::new(distance, 0.01 * (1.3 * t).sin(), 0.3 * (0.7 * t).cos())
    };
    Kind {
        name: format!("lying and standing magnets as {}", model.name()),
        tiles: [tile(fixed, 0), tile(moving, 1)],
        energy: bodies_of(model),
        bounds: Some(mixed_bounds(model)),
        poses: (0..30).map(pose).collect(),
        anywhere: Vec::new(),
        ..odd_blocks()
    }
}

/// A square of 0.2 m with two magnets on each face.
pub fn shielded_tile(code: [f64; 2]) -> Tile {
    let mut tile = square(0.1, Vec::new());
    for (face, frame) in tile.faces.iter().enumerate() {
        let outwards = face as f64 * FRAC_PI_2;
        tile.magnets.extend([0, 1].map(|k| Magnet {
            position: frame.point([-0.02, 0.02][k], -0.005),
            angle: if code[k] > 0.0 {
                outwards
            } else {
                outwards + PI
            },
            moment: 0.3,
            size: [0.010, 0.010, 0.003],
            form: Default::default(),
            face,
        }));
    }
    tile
}

/// Shields on all faces, but for one of the moving tile's, where there are any.
pub fn shields(rule: ShieldRule) -> Shields {
    let shield = (rule == ShieldRule::Smooth).then_some(Shield {
        attenuation: 0.9,
        length: 0.05,
        width: 0.2,
        front_gain: 1.0,
    });
    Shields {
        rule,
        fixed: vec![shield; 4],
        moving: vec![shield, shield, None, shield],
    }
}

pub fn shielded(model: MagnetModel, rule: ShieldRule) -> Kind {
    let pose = |i| {
        let t = f64::from(i);
        let (y, theta) = (0.1 * (0.9 * t).sin(), 0.08 * (1.7 * t).cos());
        Configuration::new(0.215 + 0.01 * t, y, theta)
    };
    let poses: Vec<_> = (0..40).map(pose).collect();
    let of_dipoles = model == MagnetModel::Dipole;
    let smooth = rule == ShieldRule::Smooth;
    Kind {
        name: format!("{model:?}s by the rule {rule:?}"),
        tiles: [shielded_tile([1.0, -1.0]), shielded_tile([1.0, 1.0])],
        shields: shields(rule),
        energy: shielded_of(model),
        bounds: smooth.then_some(if of_dipoles {
            shielded_bounds as Make<dyn CellBounds>
        } else {
            shielded_pair_bounds(model)
        }),
        anywhere: poses.clone(),
        poses,
        exact: Exact {
            steps: [2e-5, 2e-4],
            slope: 1e-8,
            lever: 0.05,
            seen: [if of_dipoles { 1e-11 } else { 1e-7 }; 3],
            scaled: if of_dipoles { 1e-12 } else { 1e-10 },
            plain: of_dipoles.then_some([1e-13; 2]),
            wider: None,
            reached: [0.0, if of_dipoles && smooth { 0.02 } else { 0.0 }, 0.0],
            lost: 0.0,
        },
    }
}

/// The same tiles with lying and standing discs and blocks.
pub fn shielded_bodies(model: MagnetModel, rule: ShieldRule) -> Kind {
    let usual = shielded(model, rule);
    let mut tiles = usual.tiles;
    for (shift, tile) in tiles.iter_mut().enumerate() {
        let magnets = tile.magnets.iter().enumerate();
        let of_forms = magnets.map(|(k, magnet)| of_form(k / 2 + k + shift, magnet.clone()));
        tile.magnets = of_forms.collect();
    }
    Kind {
        name: format!("magnets of all forms as {} by {rule:?}", model.name()),
        tiles,
        bounds: (rule == ShieldRule::Smooth).then(|| shielded_pair_bounds(model)),
        exact: shielded(MagnetModel::Cuboid, rule).exact,
        ..usual
    }
}

/// Dipoles anywhere behind various shields, some with a transition from front to back within a
/// thousandth of a turn, so that differences are not tested.
fn odd_shields(seed: u64) -> Kind {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let tiles = [5, 3].map(|count| {
        let mut magnet = |k: usize| Magnet {
            position: turned(rng.random_range(-PI..PI)) * rng.random_range(0.01..0.06),
            angle: rng.random_range(-PI..PI),
            moment: 0.3,
            size: [1e-3; 3],
            form: Default::default(),
            face: k % 4,
        };
        square(0.06, (0..count).map(&mut magnet).collect())
    });
    let shields = super::any_shields(&mut rng, -3.0);
    let pose = |_| {
        let place = turned(rng.random_range(-PI..PI)) * rng.random_range(0.15..0.3);
        Configuration::new(place.x, place.y, rng.random_range(-PI..PI))
    };
    Kind {
        name: format!("dipoles behind shields of all sorts, {seed}"),
        anywhere: (0..60).map(pose).collect(),
        poses: Vec::new(),
        tiles,
        shields,
        exact: Exact {
            plain: Some([1e-12; 2]),
            reached: [0.0; 3],
            ..shielded(MagnetModel::Dipole, ShieldRule::Smooth).exact
        },
        ..shielded(MagnetModel::Dipole, ShieldRule::Smooth)
    }
}

/// An example of an added force: magnets as points that attract each other.
fn attraction() -> Kind {
    let plain = few_dipoles((4, 9));
    Kind {
        name: "attraction of points".into(),
        energy: |[a, b], _, _| {
            let points = |tile: &Tile| {
                let point = |magnet: &Magnet| (magnet.position, magnet.moment);
                tile.magnets.iter().map(point).collect()
            };
            Box::new(Attraction([a, b].map(points)))
        },
        bounds: None,
        exact: Exact {
            plain: None,
            wider: None,
            reached: [0.0; 3],
            ..OF_DIPOLES
        },
        ..plain
    }
}

struct Attraction([Vec<(Vector2<f64>, f64)>; 2]);

impl Potential for Attraction {
    fn energy(&self, q: &Configuration) -> f64 {
        self.energy_and_gradient(q).0
    }

    fn energy_and_gradient(&self, q: &Configuration) -> (f64, Vector3<f64>) {
        let (mut energy, mut gradient) = (0.0, Vector3::zeros());
        for (place, strength) in &self.0[1] {
            let arm = q.rotation() * place;
            for (other, other_strength) in &self.0[0] {
                let way = q.position() + arm - other;
                if way.norm() == 0.0 {
                    return (f64::INFINITY, Vector3::zeros());
                }
                let u = -MU0_OVER_4PI * strength * other_strength / way.norm().powi(3);
                let slope = way * (-3.0 * u / way.norm_squared());
                energy += u;
                gradient += Vector3::new(slope.x, slope.y, arm.perp(&slope));
            }
        }
        (energy, gradient)
    }

    fn curvature_bound(&self, _: &Configuration, _: f64) -> f64 {
        f64::INFINITY
    }

    fn displacement(&self, step: Vector3<f64>) -> f64 {
        let levers = self.0[1].iter().map(|(place, _)| place.norm());
        step.xy().norm() + levers.fold(0.0, f64::max) * step.z.abs()
    }
}

fn turned(angle: f64) -> Vector2<f64> {
    Vector2::new(angle.cos(), angle.sin())
}

/// A square with half its side (m), its face 0 towards +x.
pub fn square(half: f64, magnets: Vec<Magnet>) -> Tile {
    let corners = [[half, -half], [half, half], [-half, half], [-half, -half]].map(Vector2::from);
    let face = |i: usize| Face {
        name: i.to_string(),
        start: corners[i],
        end: corners[(i + 1) % 4],
    };
    Tile {
        outline: Outline::new(corners.to_vec()).unwrap(),
        faces: (0..4).map(face).collect(),
        magnets,
        mass: 0.1,
        thickness: 0.013,
    }
}

/// The tile of the paper: a square of 43 cm with four magnets on each face, by the poles that point
/// out.
pub fn paper_tile(code: &str) -> Tile {
    let mut tile = square(0.215, Vec::new());
    for (face, frame) in tile.faces.iter().enumerate() {
        let outwards = face as f64 * FRAC_PI_2;
        tile.magnets
            .extend(code.chars().enumerate().map(|(k, pole)| {
                let place = frame.point((k as f64 - 1.5) * 0.04, -0.005);
                let angle = if pole == 'N' { outwards } else { outwards + PI };
                Magnet {
                    face,
                    ..magnet(place.x, place.y, angle, [0.01, 0.01, 0.003])
                }
            }));
    }
    tile
}

/// The same square with many small magnets on each face, north and south as the bits of a number
/// that `seed` multiplies.
pub fn pixel_tile(each: usize, seed: u64) -> Tile {
    let pitch = 0.4 / each as f64;
    let mut tile = paper_tile("N");
    let faces = std::mem::take(&mut tile.magnets);
    for (face, frame) in faces.iter().zip(&tile.faces) {
        tile.magnets.extend((0..each).map(|k| {
            let s = (k as f64 - (each as f64 - 1.0) / 2.0) * pitch;
            let bits = seed
                .wrapping_mul(0x9E37_79B9_7F4A_7C15)
                .rotate_left(k as u32);
            Magnet {
                position: frame.point(s, -pitch / 2.0),
                angle: face.angle + if bits & 1 == 0 { 0.0 } else { PI },
                moment: face.moment * (pitch / 0.04).powi(3),
                ..face.clone()
            }
        }));
    }
    tile
}

/// The same tile in another frame, in which it stands at `at`, and `size` times as large.
pub fn placed(tile: &Tile, at: &Configuration, size: f64) -> Tile {
    let place = |p: Vector2<f64>| at.transform(p) * size;
    let vertices = tile.outline.vertices().iter().map(|p| place(*p));
    Tile {
        outline: Outline::new(vertices.collect()).unwrap(),
        faces: tile
            .faces
            .iter()
            .map(|face| Face {
                start: place(face.start),
                end: place(face.end),
                ..face.clone()
            })
            .collect(),
        magnets: tile
            .magnets
            .iter()
            .map(|magnet| Magnet {
                position: place(magnet.position),
                angle: magnet.angle + at.theta,
                moment: magnet.moment * size.powi(3),
                size: magnet.size.map(|length| length * size),
                ..magnet.clone()
            })
            .collect(),
        ..*tile
    }
}
