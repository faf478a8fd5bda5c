//! Many tiles on a table, by the laws of mechanics and of thermodynamics.

mod contact;
mod discs;
mod drives;
mod together;

use std::f64::consts::TAU;
use std::sync::Arc;

use nalgebra::{Vector2, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::contact::Contact;
use tilebind::dynamics::docking::{DockingSettings, End, MatchRule, Starts, dock};
use tilebind::dynamics::{Body, Motion, MotionSettings, Simulation, thermal_velocity};
use tilebind::interruption::Interruption;
use tilebind::kinetics::Well;
use tilebind::landscape::Proportion;
use tilebind::many_bodies::contacts::Tie;
use tilebind::many_bodies::run::{Run, RunError, Start, run};
use tilebind::many_bodies::start::check;
use tilebind::many_bodies::{
    Crowd, Kind, Linear, Mover, Orbital, Rim, Sample, StartError, StepError, Stepper, TableSettings,
};
use tilebind::potential::{Interaction, MagnetModel};
use tilebind::roadmap::Point;
use tilebind::tile::strength::Strength;
use tilebind::tile::{Face, Magnet, Outline, Pair, Tile, face_to_face};
use tilebind::{Configuration, ConfigurationSpace, Problem};

const BAR: [f64; 3] = [0.010, 0.010, 0.003];

/// A square of 100 g with a code on some of its faces, the magnets 4 cm apart.
fn square(side: f64, code: &str, coded: &[usize]) -> Tile {
    let corner = |k: usize| {
        let angle = TAU / 4.0 * (k as f64 - 0.5);
        Vector2::new(libm::cos(angle), libm::sin(angle)) * (side / libm::sqrt(2.0))
    };
    let faces: Vec<Face> = (0..4)
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
                form: Default::default(),
                position: at.point((k as f64 - middle) * 0.04, -BAR[0] / 2.0),
                angle: libm::atan2(out.y, out.x),
                moment: Strength::Remanence(1.2).moment(Default::default(), BAR),
                size: BAR,
                face,
            }
        })
    });
    Tile {
        outline: Outline::new((0..4).map(corner).collect()).unwrap(),
        magnets: magnets.collect(),
        faces: faces.clone(),
        mass: 0.1,
        thickness: 0.013,
    }
}

/// Tiles of which face 0 of the first binds face 2 of the second.
fn problem(tiles: [Tile; 2], model: MagnetModel, table: [f64; 2]) -> Problem {
    let [fixed, moving] = tiles;
    let bound = face_to_face(&fixed.faces[0], &moving.faces[2], 0.0, 0.0);
    let pair = Arc::new(Pair {
        fixed,
        moving,
        target: (0, 2),
        bound,
        only: false,
    });
    let space = ConfigurationSpace {
        half_size: table.map(|size| size / 2.0),
        rho: pair.moving.radius_of_gyration(),
        free_distance: pair.free_distance(),
    };
    Problem::new(space, pair, &of(model))
}

fn of(model: MagnetModel) -> Interaction {
    Interaction {
        model,
        ..Interaction::default()
    }
}

fn crowd(problem: &Problem, model: MagnetModel) -> Crowd {
    let pair = problem.pair.as_ref().unwrap();
    let kinds = vec![
        Kind::new("fixed", pair.fixed.clone()),
        Kind::new("moving", pair.moving.clone()),
    ];
    let bonds = |i: usize, j: usize| match (i, j) {
        (0, 1) => MatchRule::new(problem, None).into_iter().collect(),
        _ => Vec::new(),
    };
    let size = Rim::Rectangle(problem.space.half_size);
    let tolerance = 1e-4 * problem.depth();
    Crowd::new(kinds, size, tolerance, &|_, _| of(model), bonds).unwrap()
}

/// One coded face each.
fn one_face(model: MagnetModel) -> (Problem, Crowd) {
    let tiles = [square(0.43, "NNNS", &[0]), square(0.43, "NSSS", &[2])];
    let problem = problem(tiles, model, [2.0; 2]);
    let crowd = crowd(&problem, model);
    (problem, crowd)
}

/// Tiles without magnets.
fn inert(side: f64, table: [f64; 2]) -> Crowd {
    let tiles = [square(side, "", &[]), square(side, "", &[])];
    crowd(
        &problem(tiles, MagnetModel::Dipole, table),
        MagnetModel::Dipole,
    )
}

/// Elastic and without friction, shaken with kT (J) at a drag rate (1/s), within the rim.
fn shaken(duration: f64, kt: f64, drag: f64) -> TableSettings {
    TableSettings {
        shaking: Some(kt),
        drag,
        walls: true,
        ..ideal(duration)
    }
}

/// No shaking, drag or friction.
fn ideal(duration: f64) -> TableSettings {
    TableSettings {
        duration,
        drag: 0.0,
        friction: 0.0,
        table_friction: 0.0,
        restitution: 1.0,
        shaking: None,
        kicks: 5e-3,
        orbital: None,
        linear: None,
        fans: Vec::new(),
        step: TableSettings::USUAL_STEP,
        sampling: duration / 100.0,
        walls: false,
    }
}

fn mover(kind: usize, place: [f64; 3], velocity: [f64; 3]) -> Mover {
    Mover {
        kind,
        place: place.into(),
        velocity: velocity.into(),
    }
}

fn stream(k: usize) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(k as u64)
}

/// Momentum along x and y and about the origin.
fn momentum(crowd: &Crowd, movers: &[Mover]) -> Vector3<f64> {
    let of = |it: &Mover| {
        let body = &crowd.kinds[it.kind].body;
        let p = it.velocity * body.mass;
        let turn = it.place.x * p.y - it.place.y * p.x + body.inertia * it.velocity.z;
        Vector3::new(p.x, p.y, turn)
    };
    movers.iter().map(of).sum()
}

fn totals(run: &Run) -> Vec<f64> {
    let total = |it: &tilebind::many_bodies::Sample| it.kinetic + it.potential;
    run.samples.iter().map(total).collect()
}

/// Two tiles that fly at each other, off centre.
fn thrown() -> Vec<Mover> {
    vec![
        mover(0, [-0.4, 0.0, 0.0], [0.3, 0.02, 0.0]),
        mover(1, [0.3, 0.05, 0.4], [-0.3, 0.0, 0.5]),
    ]
}

#[test]
fn momentum_is_kept_and_energy_never_rises() {
    for model in [MagnetModel::Dipole, MagnetModel::Cuboid] {
        let (problem, crowd) = one_face(model);
        for (friction, restitution) in [(0.0, 1.0), (0.3, 0.5), (0.3, 0.01)] {
            let settings = TableSettings {
                friction,
                restitution,
                ..ideal(3.0)
            };
            let mut stepper = Stepper::new(&crowd, &settings, thrown(), &stream);
            let start = momentum(&crowd, &stepper.movers());
            let mut energy = stepper.kinetic() + stepper.potential();
            for _ in 0..3000 {
                stepper.step().unwrap();
                let off = momentum(&crowd, &stepper.movers()) - start;
                assert!(off.xy().norm() < 1e-9 * 0.03, "{off:?}");
                // Where tiles are held within a step they have moved less than their velocities say.
                assert!(off.z.abs() < 1e-6 * 0.03, "{off:?}");
                let now = stepper.kinetic() + stepper.potential();
                assert!(now < energy + 1e-6 * problem.depth(), "{now} {energy}");
                energy = now;
            }
        }
    }
}

#[test]
fn elastic_knocks_keep_energy_in_a_bond() {
    let (problem, crowd) = one_face(MagnetModel::Cuboid);
    let bound = problem.pair.as_ref().unwrap().bound;
    let mut rng = stream(5);
    let mut movers = vec![
        mover(0, [0.0; 3], [0.0; 3]),
        mover(1, [bound.x + 1e-5, bound.y, bound.theta], [0.0; 3]),
    ];
    for it in &mut movers {
        it.velocity = thermal_velocity(&crowd.kinds[it.kind].body, 3e-3, &mut rng);
    }
    let settings = ideal(2.0);
    let found = run(&crowd, &settings, (1, 0), &Start::Given(movers), false).unwrap();
    let totals = totals(&found);
    assert_eq!(found.step, settings.step);
    for total in &totals {
        assert!(
            (total - totals[0]).abs() < 0.02 * 3e-3,
            "{total} {}",
            totals[0]
        );
    }
    let last = found.samples.last().unwrap();
    assert_eq!((last.count(Tie::Bond), last.count(Tie::Trap)), (1, 0));
    assert_eq!(last.clusters, [2]);
}

/// Mean kinetic energy per degree of freedom over kT, and its standard error by halves of the runs.
fn kinetic(crowd: &Crowd, settings: &TableSettings, start: &Start, runs: usize) -> [f64; 2] {
    let kt = settings.shaking.unwrap();
    let of = |index| {
        run(crowd, settings, (3, index), start, false)
            .unwrap()
            .kinetic
            / kt
    };
    mean(&(0..runs).map(of).collect::<Vec<_>>())
}

#[test]
fn a_gas_has_the_temperature_of_its_shaking() {
    let crowd = inert(0.12, [2.0; 2]);
    let settings = shaken(15.0, 3e-3, 20.0);
    let [mean, error] = kinetic(&crowd, &settings, &Start::Random(vec![20, 20]), 4);
    assert!(
        error < 0.004 && (mean - 0.5).abs() < 0.01,
        "{mean} +- {error}"
    );
}

#[test]
fn bound_tiles_have_the_temperature_of_their_shaking() {
    for model in [MagnetModel::Dipole, MagnetModel::Cuboid] {
        let (problem, crowd) = one_face(model);
        let bound = problem.pair.as_ref().unwrap().bound;
        let movers = vec![
            mover(0, [0.0; 3], [0.0; 3]),
            mover(1, [bound.x + 1e-5, bound.y, bound.theta], [0.0; 3]),
        ];
        let settings = TableSettings {
            walls: false,
            ..shaken(30.0, 2e-3, 100.0)
        };
        let [mean, error] = kinetic(&crowd, &settings, &Start::Given(movers), 8);
        assert!(
            error < 0.005 && (mean - 0.5).abs() < 0.01,
            "{mean} +- {error} {model:?}"
        );
    }
}

/// Whether a tile there lies within the rim.
fn is_on_table(problem: &Problem, tile: &Tile, q: &Configuration) -> bool {
    let half = problem.space.half_size;
    tile.outline.vertices().iter().all(|corner| {
        let p = q.transform(*corner);
        p.x.abs() <= half[0] && p.y.abs() <= half[1]
    })
}

/// Integrals over the places of two tiles.
struct Integrals {
    /// The share of time in which the tiles are bound on the table, with its standard error.
    bound: [f64; 2],
    /// The integral (m^2 rad) of exp(-U / kT) over the poses of one tile relative to the other that have
    /// less than an energy, without a rim, with its standard error.
    volume: [f64; 2],
}

/// By Monte Carlo, half of it with the second tile anywhere on the table, half of it near one of the bonds
/// (the places there are some hundred thousandths of all but have a third of the weight); each place
/// counts by the inverse of the sum of both densities.
fn integrals(problem: &Problem, kt: f64, below: f64) -> Integrals {
    let pair = problem.pair.as_ref().unwrap();
    let rule = MatchRule::new(problem, None).unwrap();
    let bonds: Vec<Configuration> = rule.poses().collect();
    let tiles = [&pair.fixed, &pair.moving];
    let contact = Contact::new(&pair.fixed.outline, &pair.moving.outline);
    let half = problem.space.half_size;
    let lever = pair.moving.faces[0].length() / 2.0;
    // About the bonds: gap (m), slide (m), turn (rad).
    let [gap, slide, turn] = [0.5e-3, 2.5e-3, 0.08];
    // Turned tiles touch with a corner, of the one or, where it is past the other's face, of that one.
    let least = |turned: f64, aside: f64| {
        let (sin, cos) = libm::sincos(turned.abs());
        lever * (sin - (1.0 - cos)) - 1.1 * aside.abs() * sin - 0.02 * gap
    };
    let bell = |x: f64, width: f64| {
        libm::exp(-0.5 * (x / width) * (x / width)) / (width * libm::sqrt(TAU))
    };
    let near = |q: &Configuration| {
        let each = bonds.iter().map(|bond| {
            let turned = (q.theta - bond.theta + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0;
            let out = bond.position().normalize();
            let aside = out.x * q.y - out.y * q.x;
            let beyond = out.dot(&q.position()) - bond.position().norm() - least(turned, aside);
            match beyond >= 0.0 {
                true => libm::exp(-beyond / gap) / gap * bell(aside, slide) * bell(turned, turn),
                false => 0.0,
            }
        });
        each.sum::<f64>() / bonds.len() as f64
    };
    let anywhere = 1.0 / (4.0 * half[0] * half[1] * TAU);
    let mut rng = stream(11);
    let samples = 2_000_000;
    // Bound, not bound, and of relative poses: the sums of the weights and of their squares.
    let mut sums = [[0.0; 2]; 3];
    for sample in 0..samples {
        let mut even = |half: f64| half * (2.0 * rng.random::<f64>() - 1.0);
        let a = Configuration::from([even(half[0]), even(half[1]), even(TAU / 2.0)]);
        let q = if sample % 2 == 0 {
            let p = a.inverse_transform(Vector2::new(even(half[0]), even(half[1])));
            Configuration::new(p.x, p.y, even(TAU / 2.0))
        } else {
            let bond = bonds[rng.random_range(0..bonds.len())];
            let body = Body {
                mass: 1.0 / (slide * slide),
                inertia: 1.0 / (turn * turn),
                centre: Vector2::zeros(),
            };
            let by = thermal_velocity(&body, 1.0, &mut rng);
            let beyond = least(by.z, by.x) - gap * libm::log(1.0 - rng.random::<f64>());
            let out = bond.position().normalize();
            let p = bond.position() + out * beyond + Vector2::new(-out.y, out.x) * by.x;
            Configuration::new(p.x, p.y, bond.theta + by.z)
        };
        if !contact.is_free(&q) {
            continue;
        }
        let energy = problem.potential().energy(&q);
        let p = a.transform(q.position());
        let is_there = p.x.abs() <= half[0] && p.y.abs() <= half[1];
        let density = near(&q) + if is_there { anywhere } else { 0.0 };
        let weight = libm::exp(-energy / kt) / (0.5 * density);
        let b = Configuration::new(p.x, p.y, a.theta + q.theta);
        let is_bound = rule.holds(&q);
        if is_on_table(problem, tiles[0], &a) && is_on_table(problem, tiles[1], &b) {
            let sum = &mut sums[usize::from(!is_bound)];
            *sum = [sum[0] + weight, sum[1] + weight * weight];
        }
        if energy < below {
            sums[2] = [sums[2][0] + weight, sums[2][1] + weight * weight];
        }
    }
    let [bound, apart, relative] = sums.map(|[sum, squares]| [sum, libm::sqrt(squares)]);
    let share = bound[0] / (bound[0] + apart[0]);
    let error = libm::hypot(bound[1] / bound[0], apart[1] / apart[0]);
    Integrals {
        bound: [share, share * (1.0 - share) * error],
        volume: relative.map(|it| it / f64::from(samples)),
    }
}

/// The share of time in which two tiles of a table are bound, with its standard error. They start apart: the
/// first tenth, many times the life of a bond, does not count.
fn share_bound(crowd: &Crowd, kt: f64) -> [f64; 2] {
    let settings = TableSettings {
        sampling: 0.05,
        ..shaken(300.0, kt, 20.0)
    };
    let share = |index| {
        let start = Start::Random(vec![1, 1]);
        let found = run(crowd, &settings, (2, index), &start, false).unwrap();
        let samples = &found.samples[found.samples.len() / 10..];
        let bound = samples.iter().filter(|it| it.count(Tie::Bond) == 1).count();
        bound as f64 / samples.len() as f64
    };
    mean(&(0..24).map(share).collect::<Vec<_>>())
}

/// On a small table, elastic and without friction, two tiles that bind by any two faces are bound as often
/// as integrals over their places say; and these agree with the volume of a bond in ln K.
#[test]
fn two_tiles_are_bound_as_often_as_boltzmann_and_ln_k_say() {
    let faces = [0, 1, 2, 3];
    let tiles = [square(0.04, "N", &faces), square(0.04, "S", &faces)];
    let model = MagnetModel::Dipole;
    let problem = problem(tiles, model, [0.16; 2]);
    let crowd = crowd(&problem, model);
    let minimum = Point::new(&problem, problem.pair.as_ref().unwrap().bound);
    let kt = -minimum.energy / 11.0;
    // Below this energy the bonds are apart from each other.
    let well = Well::new(&problem, &minimum, -2.0 * kt, &[]);
    let Integrals { bound, volume } = integrals(&problem, kt, well.level);
    let bonds = MatchRule::new(&problem, None).unwrap().poses().count();
    assert_eq!(bonds, 16);
    let by_well = bonds as f64 * libm::exp(11.0) * well.volume(kt, 1e-3).value;
    println!("{volume:?}, by the well {by_well}");
    assert!(volume[1] < 0.005 * volume[0], "{volume:?}");
    assert!((by_well - volume[0]).abs() < 3.0 * volume[1] + 1e-3 * by_well);
    let [mean, error] = share_bound(&crowd, kt);
    println!("{mean} +- {error}, {bound:?}");
    assert!(error < 0.015 && bound[1] < 0.002, "{error} {bound:?}");
    assert!(
        (mean - bound[0]).abs() < 3.0 * libm::hypot(error, bound[1]),
        "{mean} +- {error}, {bound:?}"
    );
}

#[test]
fn two_tiles_dock_as_often_as_one_at_a_fixed_one() {
    let (runs, duration) = (120, 6.0);
    for (model, friction, restitution) in [
        (MagnetModel::Dipole, 0.3, 0.01),
        (MagnetModel::Cuboid, 0.0, 0.6),
    ] {
        // The fixed tile is so heavy that it stays where it is.
        let mut tiles = [
            square(0.43, "NNNS", &[0, 1, 2, 3]),
            square(0.43, "NSSS", &[0, 1, 2, 3]),
        ];
        tiles[0].mass = 1e7;
        let problem = problem(tiles, model, [2.0; 2]);
        let crowd = crowd(&problem, model);
        let docking = DockingSettings {
            runs,
            duration,
            motion: MotionSettings {
                drag: 0.5,
                friction,
                restitution,
                walls: false,
                ..MotionSettings::default()
            },
            starts: Starts {
                orientation: 0.6,
                ..Starts::default()
            },
            ..DockingSettings::default()
        };
        let docked = dock(&problem, &docking, &|| ()).unwrap();
        let settings = TableSettings {
            drag: 0.5,
            friction,
            restitution,
            ..ideal(duration)
        };
        // Bound, trapped, free: how many in docking runs, how many on the table, how many that differ.
        let mut counts = [[0usize; 2]; 3];
        let mut others = 0;
        for docked in &docked.runs {
            let still = Motion {
                configuration: Configuration::new(0.0, 0.0, 0.0),
                velocity: Vector3::zeros(),
            };
            let movers = [(0, still), (1, docked.start.motion)];
            let movers = movers.map(|(kind, motion)| Mover::new(&crowd, kind, &motion));
            let start = Start::Given(movers.to_vec());
            let found = run(&crowd, &settings, (1, docked.index), &start, false).unwrap();
            let last = found.samples.last().unwrap();
            let held = last.count(Tie::Trap) + last.count(Tie::Contact);
            let there = match (last.count(Tie::Bond), held) {
                (1, _) => 0,
                (_, 1) => 1,
                _ => 2,
            };
            let by_dock = match docked.end {
                End::Bound { .. } => 0,
                End::Trapped { .. } => 1,
                End::Free | End::Unsolved => 2,
            };
            counts[by_dock][0] += 1;
            counts[there][1] += 1;
            others += usize::from(by_dock != there);
        }
        println!("{counts:?}, {others} end otherwise");
        for [by_dock, there] in counts {
            let [by_dock, there] = [by_dock, there].map(|count| Proportion::new(count, runs));
            let overlap = by_dock.low <= there.high && there.low <= by_dock.high;
            assert!(overlap, "{by_dock:?} {there:?}");
        }
        // Enough of them end in contact for this to be meaningful.
        assert!(counts[0][0] + counts[1][0] > runs / 16, "{counts:?}");
        assert!(others < runs / 20, "{others} of {runs}");
    }
}

#[test]
fn the_cut_off_leaves_out_no_more_than_it_says() {
    for model in [MagnetModel::Dipole, MagnetModel::Cuboid] {
        let tiles = [square(0.2, "NNN", &[0]), square(0.2, "SNS", &[1, 2])];
        let problem = problem(tiles, model, [2.0; 2]);
        let crowd = crowd(&problem, model);
        let mut rng = stream(1);
        for couple in crowd.couples() {
            let cutoff = &couple.cutoff;
            assert!(cutoff.left_out <= 1e-4 * problem.depth());
            let mut largest: f64 = 0.0;
            for _ in 0..4000 {
                let mut turn = || TAU * rng.random::<f64>();
                let (bearing, theta) = (turn(), turn());
                let r = cutoff.from * (1.0 + rng.random::<f64>());
                let q = Configuration::new(r * libm::cos(bearing), r * libm::sin(bearing), theta);
                largest = largest.max(couple.potential.energy(&q).abs());
            }
            // The poses that it looked at are 20 degrees apart.
            assert!(largest < 1.1 * cutoff.left_out, "{largest} {cutoff:?}");
        }
    }
}

#[test]
fn a_run_depends_on_nothing_but_its_seed() {
    let (_, crowd) = one_face(MagnetModel::Dipole);
    let settings = TableSettings {
        friction: 0.3,
        restitution: 0.1,
        ..shaken(1.0, 3e-3, 1.0)
    };
    let start = Start::Random(vec![2, 2]);
    let last = |seed| {
        let found = run(&crowd, &settings, (seed, 0), &start, true).unwrap();
        found.samples.last().unwrap().movers.clone().unwrap()
    };
    assert_eq!(last(1), last(1));
    assert_ne!(last(1), last(2));
    let on = |threads| Interruption::default().run(threads, || last(1)).unwrap();
    assert_eq!(on(1), on(3));
}

#[test]
fn tiles_stay_on_the_table_and_apart() {
    let (_, crowd) = one_face(MagnetModel::Cuboid);
    let settings = TableSettings {
        friction: 0.3,
        restitution: 0.6,
        ..shaken(4.0, 2e-2, 2.0)
    };
    let found = run(&crowd, &settings, (7, 0), &Start::Random(vec![3, 3]), true).unwrap();
    assert!(found.energy_error < 1e-3, "{}", found.energy_error);
    let outlines: Vec<&Outline> = crowd.kinds.iter().map(|kind| &kind.tile.outline).collect();
    for sample in &found.samples {
        let movers = sample.movers.as_ref().unwrap();
        let places: Vec<_> = movers
            .iter()
            .map(|it| it.motion(&crowd).configuration)
            .collect();
        for (k, a) in places.iter().enumerate() {
            for vertex in outlines[movers[k].kind].vertices() {
                let p = a.transform(*vertex);
                assert!(p.x.abs() < 1.0 + 1e-6 && p.y.abs() < 1.0 + 1e-6, "{p:?}");
            }
            for (l, b) in places.iter().enumerate().skip(k + 1) {
                let contact = Contact::new(outlines[movers[k].kind], outlines[movers[l].kind]);
                let p = a.inverse_transform(b.position());
                let q = Configuration::new(p.x, p.y, b.theta - a.theta);
                assert!(contact.clearance(&q) > -1e-6, "{}", contact.clearance(&q));
            }
        }
    }
}

#[test]
fn a_knock_rubs_by_the_coefficient_of_friction() {
    // Flat against the rim the tile loses its 0.02 m/s towards it, and mu times that along it.
    let crowd = inert(0.2, [4.0, 1.0]);
    let settings = TableSettings {
        friction: 0.2,
        restitution: 0.0,
        walls: true,
        ..ideal(1.0)
    };
    let sliding = mover(0, [0.0, -0.395, 0.0], [0.3, -0.02, 0.0]);
    let found = run(
        &crowd,
        &settings,
        (1, 0),
        &Start::Given(vec![sliding]),
        true,
    )
    .unwrap();
    let last = found.samples.last().unwrap().movers.clone().unwrap()[0];
    assert!(
        (last.velocity.x - (0.3 - 0.2 * 0.02)).abs() < 1e-6,
        "{last:?}"
    );
    assert!(last.velocity.y.abs() < 1e-3, "{last:?}");
}

#[test]
fn on_a_table_that_goes_round_a_free_tile_stands_still() {
    // Seen from the table it goes round the other way: -A (cos, sin) about where it was.
    let crowd = inert(0.1, [2.0; 2]);
    let orbital = Orbital {
        amplitude: 0.01,
        frequency: 2.0,
    };
    let rate = TAU * orbital.frequency;
    let settings = TableSettings {
        orbital: Some(orbital),
        ..ideal(1.0)
    };
    let still = mover(0, [0.3 - 0.01, 0.0, 0.0], [0.0, -0.01 * rate, 0.0]);
    let found = run(&crowd, &settings, (1, 0), &Start::Given(vec![still]), true).unwrap();
    for sample in &found.samples {
        let place = sample.movers.as_ref().unwrap()[0].place;
        let phase = rate * sample.time;
        let expected = Vector2::new(0.3 - 0.01 * libm::cos(phase), -0.01 * libm::sin(phase));
        assert!(
            (place.xy() - expected).norm() < 1e-5,
            "{place:?} {expected:?}"
        );
    }
    assert!(found.energy_error < 1e-4, "{}", found.energy_error);
}

#[test]
fn drag_takes_what_it_should() {
    let crowd = inert(0.1, [2.0; 2]);
    let settings = TableSettings {
        drag: 0.7,
        ..ideal(1.0)
    };
    let flying = mover(0, [0.0; 3], [0.2, 0.1, 1.0]);
    let found = run(&crowd, &settings, (1, 0), &Start::Given(vec![flying]), true).unwrap();
    let last = found.samples.last().unwrap();
    let expected = flying.velocity * libm::exp(-0.7);
    let velocity = last.movers.as_ref().unwrap()[0].velocity;
    assert!((velocity - expected).norm() < 1e-9, "{velocity:?}");
    assert!(found.energy_error < 1e-9);
}

/// Twenty squares that cover seven tenths of the table have no room one by one at random places.
#[test]
fn tiles_on_a_dense_table_start_from_rows_and_are_moved() {
    let crowd = inert(0.12, [0.64; 2]);
    let settings = TableSettings {
        walls: true,
        ..ideal(0.01)
    };
    let start = |seed| {
        let start = Start::Random(vec![10, 10]);
        let found = run(&crowd, &settings, (seed, 0), &start, true).unwrap();
        found.samples[0].movers.clone().unwrap()
    };
    let one = start(1);
    assert_eq!(check(&crowd, &one, true), Ok(()));
    assert_ne!(one, start(2));
    // Neither in rows nor upright any more, and each kind everywhere.
    let angle = |mover: &Mover| mover.place.z.rem_euclid(TAU / 4.0);
    assert!(one.iter().all(|it| angle(it) > 1e-6));
    for kind in [0, 1] {
        let on_the_left = |it: &&Mover| it.kind == kind && it.place.x < 0.0;
        let left = one.iter().filter(on_the_left).count();
        assert!((1..10).contains(&left), "{left}");
    }
}

#[test]
fn what_cannot_start_is_told() {
    let crowd = inert(0.4, [1.0; 2]);
    let settings = ideal(1.0);
    let tried = |start| run(&crowd, &settings, (1, 0), &start, false).map(|_| ());
    let fails = |start, is: &dyn Fn(&StartError) -> bool| match tried(start) {
        Err(RunError::Start(error)) => assert!(is(&error), "{error}"),
        other => panic!("{other:?}"),
    };
    fails(Start::Random(vec![4, 4]), &|it| {
        matches!(it, StartError::TooMany { .. })
    });
    fails(Start::Random(vec![3, 3]), &|it| {
        matches!(it, StartError::NoRoom { .. })
    });
    let at = |x: f64| mover(0, [x, 0.0, 0.0], [0.0; 3]);
    fails(Start::Given(vec![at(0.0), at(0.399)]), &|it| {
        matches!(
            it,
            StartError::Overlap {
                first: 0,
                second: 1,
                ..
            }
        )
    });
    assert_eq!(tried(Start::Given(vec![at(0.0), at(0.4)])), Ok(()));
    let walled = TableSettings {
        walls: true,
        ..ideal(1.0)
    };
    let beyond = run(
        &crowd,
        &walled,
        (1, 0),
        &Start::Given(vec![at(0.31)]),
        false,
    );
    assert!(matches!(
        beyond,
        Err(RunError::Start(StartError::BeyondRim { tile: 0, .. }))
    ));
    let fast = mover(0, [0.0; 3], [1e4, 0.0, 0.0]);
    let fast = run(&crowd, &settings, (1, 0), &Start::Given(vec![fast]), false);
    assert!(matches!(fast, Err(RunError::Step(StepError::BlowUp(_)))));
}

/// Mean and standard error.
fn mean(values: &[f64]) -> [f64; 2] {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let square: f64 = values.iter().map(|it| (it - mean) * (it - mean)).sum();
    [mean, libm::sqrt(square / (n - 1.0) / n)]
}

#[test]
fn halving_the_step_changes_nothing_that_seeds_do_not() {
    // Sticky tiles: all faces bind, so that clusters grow with friction in them.
    let tiles = [
        square(0.1, "NN", &[0, 1, 2, 3]),
        square(0.1, "SS", &[0, 1, 2, 3]),
    ];
    let model = MagnetModel::Dipole;
    let problem = problem(tiles, model, [0.7, 0.7]);
    let crowd = crowd(&problem, model);
    let held = |step: f64| {
        let settings = TableSettings {
            friction: 0.3,
            restitution: 0.01,
            step,
            ..shaken(4.0, 3e-3, 0.5)
        };
        let run = |index| {
            let start = Start::Random(vec![6, 6]);
            let found = run(&crowd, &settings, (9, index), &start, false).unwrap();
            let last = found.samples.last().unwrap();
            [last.held.len() as f64, last.clusters.len() as f64]
        };
        let all: Vec<[f64; 2]> = (0..16).map(run).collect();
        [0, 1].map(|k| mean(&all.iter().map(|it| it[k]).collect::<Vec<_>>()))
    };
    let [usual, half] = [1.0, 0.5].map(|share| held(share * TableSettings::USUAL_STEP));
    println!("{usual:?} {half:?}");
    for ([a, e], [b, f]) in usual.into_iter().zip(half) {
        assert!(
            (a - b).abs() < 3.0 * libm::hypot(e, f),
            "{a} +- {e}, {b} +- {f}"
        );
    }
    assert!(usual[0][0] > 4.0, "{usual:?}");
}
