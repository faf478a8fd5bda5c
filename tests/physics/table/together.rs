//! Tiles that rest relative to each other are moved as one; what they do is the same.

use super::*;
use tilebind::dynamics::Fan;

/// Friction and restitution as usual.
fn settings(duration: f64) -> TableSettings {
    TableSettings {
        friction: 0.3,
        restitution: 0.01,
        ..ideal(duration)
    }
}

/// The same, solved in full: where there are fans tiles are not moved as one, and this one does not blow.
fn in_full(settings: &TableSettings) -> TableSettings {
    TableSettings {
        fans: vec![Fan::steady([0.0; 2], 0.0, 1.0)],
        ..settings.clone()
    }
}

/// A bound pair that flies and spins about its centre of mass at a rate (rad/s).
fn spinning(rate: f64) -> Start {
    let pair = [(0, -0.2150005), (1, 0.2150005)];
    let movers = pair.map(|(kind, x)| mover(kind, [x, 0.0, 0.0], [0.01, rate * x, rate]));
    Start::Given(movers.to_vec())
}

/// Magnets hold a pair together up to some spin, and beyond it do not.
#[test]
fn a_spinning_pair_moves_and_parts_as_in_the_full_solution() {
    let (_, crowd) = one_face(MagnetModel::Dipole);
    let settings = settings(1.0);
    let mut held = Vec::new();
    for rate in [0.5, 2.0, 8.0, 16.0, 32.0, 64.0, 128.0] {
        let found = [settings.clone(), in_full(&settings)]
            .map(|settings| run(&crowd, &settings, (1, 0), &spinning(rate), false).unwrap());
        let last = found.each_ref().map(|it| it.samples.last().unwrap());
        let bonds = last.map(|it| it.count(Tie::Bond));
        assert_eq!(bonds[0], bonds[1], "{rate}");
        held.push(bonds[0]);
        if bonds[0] == 0 {
            continue;
        }
        assert!(found[0].steps <= found[1].steps, "{rate}");
        for (one, full) in found[0].movers.iter().zip(&found[1].movers) {
            let off = one.place - full.place;
            // The full solution goes along chords: it lags by (rate h)^2 / 24.
            let lag = (rate * settings.step).powi(2) / 24.0 * rate;
            let most = 1e-6 + 1.5 * lag;
            assert!(
                off.xy().norm() + 0.3 * off.z.abs() < most,
                "{rate} {off:?} {most}"
            );
        }
        let kinetic = found[0].samples[0].kinetic;
        let change = last[0].kinetic / kinetic - 1.0;
        assert!(change.abs() < 1e-4, "{rate} {change}");
    }
    assert!(
        held.first() == Some(&1) && held.last() == Some(&0),
        "{held:?}"
    );
}

/// Mean and standard error over seeds of bonds, of all contacts, and of the energy (J).
#[test]
fn tiles_moved_as_one_assemble_as_in_the_full_solution() {
    let (problem, crowd) = one_face(MagnetModel::Dipole);
    let shaken = TableSettings {
        walls: true,
        drag: 0.5,
        shaking: Some(0.03 * problem.depth()),
        ..settings(6.0)
    };
    let of = |settings: &TableSettings| {
        let runs = (0..24).map(|seed| {
            let start = Start::Random(vec![5, 5]);
            let found = run(&crowd, settings, (seed, 0), &start, false).unwrap();
            let last = found.samples.last().unwrap();
            let energy = last.potential / problem.depth();
            [last.count(Tie::Bond) as f64, last.held.len() as f64, energy]
        });
        let runs: Vec<[f64; 3]> = runs.collect();
        [0, 1, 2].map(|k| mean(&runs.iter().map(|it| it[k]).collect::<Vec<_>>()))
    };
    let (one, full) = (of(&shaken), of(&in_full(&shaken)));
    println!("{one:?} {full:?}");
    for (one, full) in one.into_iter().zip(full) {
        let error = one[1].hypot(full[1]);
        assert!((one[0] - full[0]).abs() < 3.0 * error, "{one:?} {full:?}");
        assert!(error < 0.25 * full[0].abs().max(1.0), "{error}");
    }
}

/// A bound pair of small squares in the field of a very strong and heavy third tile one metre away, which
/// turns it round like a compass needle; and the force (N) of its bond.
fn needle() -> (Crowd, Vec<Mover>, f64) {
    let tiles = [square(0.04, "N", &[0]), square(0.04, "S", &[2])];
    let mut strong = tiles[0].clone();
    strong.mass = 1e9;
    // Its field at the pair is so many times that of one magnet at the other, so that the pair is fast enough to
    // open when it has nearly turned round, where it needs no friction.
    strong.magnets[0].moment *= 3.0 * libm::pow(1.0 / BAR[0], 3.0);
    let model = MagnetModel::Dipole;
    let problem = problem(tiles.clone(), model, [4.0; 2]);
    let [first, second] = tiles;
    let kinds = [("first", first), ("second", second), ("strong", strong)];
    let kinds: Vec<_> = kinds.map(|(name, tile)| Kind::new(name, tile)).into();
    let rim = Rim::Rectangle([2.0; 2]);
    let crowd = Crowd::new(
        kinds,
        rim,
        1e-4 * problem.depth(),
        &|_, _| of(model),
        |_, _| vec![],
    );
    let crowd = crowd.unwrap();
    let bound = Configuration::new(0.04, 0.0, 0.0);
    let force = crowd
        .couple(0, 1)
        .0
        .potential
        .energy_and_gradient(&bound)
        .1
        .x;
    let tilt = 0.1;
    let at = |x: f64| [x * libm::cos(tilt), x * libm::sin(tilt), tilt];
    let pair = [(0, -0.02000005), (1, 0.02000005)];
    let mut movers = pair.map(|(kind, x)| mover(kind, at(x), [0.0; 3])).to_vec();
    movers.push(mover(2, [-1.0, 0.0, TAU / 2.0], [0.0; 3]));
    (crowd, movers, force)
}

/// The number of steps until the pair slides or opens, and its spin (rad/s) then.
fn turns_until(crowd: &Crowd, movers: &[Mover], settings: &TableSettings) -> (usize, f64) {
    let mut stepper = Stepper::new(crowd, settings, movers.to_vec(), &stream);
    for step in 0.. {
        stepper.step().unwrap();
        let now = stepper.movers();
        let between = (now[1].place - now[0].place).xy();
        let (sin, cos) = libm::sincos(now[0].place.z);
        let slid = between.dot(&Vector2::new(-sin, cos));
        let apart = between.dot(&Vector2::new(cos, sin)) - 0.04;
        if slid.abs() > 1e-6 || apart > 1e-6 {
            return (step, now[0].velocity.z);
        }
        assert!(step < 2000, "{now:?}");
    }
    unreachable!()
}

/// With little friction a pair slides as the torque on it grows; with more it opens where its spin is too fast for
/// its bond, `m w^2 r = F`. Until then it moves as one.
#[test]
fn a_pair_that_is_turned_faster_and_faster_slides_or_opens_as_in_the_full_solution() {
    let (crowd, movers, force) = needle();
    let fastest = libm::sqrt(force / (0.1 * 0.02));
    let mut spins = Vec::new();
    for friction in [0.2, 1.0] {
        let settings = TableSettings {
            step: 2.5e-4,
            friction,
            ..settings(1.0)
        };
        let [one, full] = [settings.clone(), in_full(&settings)]
            .map(|settings| turns_until(&crowd, &movers, &settings));
        assert!(one.0.abs_diff(full.0) <= 2, "{friction} {one:?} {full:?}");
        assert!((one.1 / full.1 - 1.0).abs() < 5e-3, "{one:?} {full:?}");
        spins.push(one.1 / fastest);
    }
    assert!(
        spins[0] < 0.5 && (0.85..1.0).contains(&spins[1]),
        "{spins:?}"
    );
}
