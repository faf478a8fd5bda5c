//! Contact takes energy or none, and the energy balance can tell.

use super::*;

/// The paper's tile and its mate, with friction and restitution, without drives or drag.
fn settings(duration: f64, [friction, restitution]: [f64; 2]) -> TableSettings {
    TableSettings {
        friction,
        restitution,
        sampling: 0.01,
        ..ideal(duration)
    }
}

/// A tab in its slot: two tiles whose outlines fit into each other, with sides leaning inwards by
/// 0.3 rad, which friction may wedge.
fn tab_and_slot() -> Crowd {
    let mut tiles = [square(0.43, "NNNS", &[0]), square(0.43, "NSSS", &[2])];
    let [half, wide, deep] = [0.215, 0.1, 0.02];
    let narrow = wide - deep * libm::tan(0.3);
    let outline = |side: f64, out: f64| {
        let mut corners = vec![
            [half * side, -half],
            [half * side, -wide],
            [half * side + out, -narrow],
            [half * side + out, narrow],
            [half * side, wide],
            [half * side, half],
            [-half * side, half],
            [-half * side, -half],
        ];
        if side < 0.0 {
            corners.reverse();
        }
        Outline::new(corners.into_iter().map(Vector2::from).collect()).unwrap()
    };
    tiles[0].outline = outline(1.0, deep);
    tiles[1].outline = outline(-1.0, deep);
    let model = MagnetModel::Cuboid;
    crowd(&problem(tiles, model, [2.0; 2]), model)
}

/// A bound pair that turns freely about its common centre of mass keeps its kinetic energy, whatever
/// the friction and the restitution.
#[test]
fn a_wedged_pair_that_spins_keeps_its_kinetic_energy() {
    let crowd = tab_and_slot();
    for law in [[0.3, 0.0], [0.0, 0.0], [2.0, 1.0]] {
        let settings = settings(1.0, law);
        let centres = [0, 1].map(|kind| {
            let x = [-0.215, 0.215][kind];
            let motion = Motion {
                configuration: Configuration::new(x, 0.0, 0.0),
                velocity: Vector3::zeros(),
            };
            Mover::new(&crowd, kind, &motion)
        });
        let masses = centres.map(|it| crowd.kinds[it.kind].body.mass);
        let centre = (centres[0].place.x * masses[0] + centres[1].place.x * masses[1])
            / (masses[0] + masses[1]);
        let spinning = centres.map(|mut it| {
            it.velocity = Vector3::new(0.0, 0.84 * (it.place.x - centre), 0.84);
            it
        });
        let start = Start::Given(spinning.to_vec());
        let found = run(&crowd, &settings, (1, 0), &start, false).unwrap();
        let first = found.samples[0].kinetic;
        for sample in &found.samples {
            let change = sample.kinetic / first - 1.0;
            assert!(change.abs() < 1e-3, "{law:?} {} {change}", sample.time);
        }
    }
}

/// Tiles that slide on each other without friction keep their energy, which does not drift.
#[test]
fn sliding_without_friction_keeps_energy() {
    let (_, crowd) = one_face(MagnetModel::Dipole);
    let slid = || {
        Start::Given(vec![
            mover(0, [-0.215, 0.0, 0.0], [0.0; 3]),
            mover(1, [0.215001, 0.004, 0.0], [0.0; 3]),
        ])
    };
    let off = |duration: f64| {
        let settings = settings(duration, [0.0, 0.0]);
        let found = run(&crowd, &settings, (1, 0), &slid(), false).unwrap();
        let totals = totals(&found);
        let there = found
            .samples
            .iter()
            .map(|it| it.kinetic)
            .fold(0.0, f64::max);
        let late = &totals[totals.len() / 2..];
        let late = late.iter().sum::<f64>() / late.len() as f64;
        // By the second sample they have met.
        let off = totals[1..].iter().map(|it| (it - totals[1]).abs());
        let worst = off.fold(0.0, f64::max);
        [worst / there, (late - totals[1]).abs() / there]
    };
    let [worst, drift] = off(20.0);
    assert!(worst < 2e-3 && drift < 1e-3, "{worst} {drift}");
}

/// However small the slide: in each step, also where it turns and there is no kinetic energy to put right,
/// a small share of what is there is missing, and with half the step much less.
#[test]
fn slides_of_any_size_keep_energy_in_each_step() {
    let (_, crowd) = one_face(MagnetModel::Dipole);
    let missing = |slid: f64, share: f64| {
        let mut settings = settings(5.0, [0.0, 0.0]);
        settings.step *= share;
        let movers = vec![
            mover(0, [-0.215, 0.0, 0.0], [0.0; 3]),
            mover(1, [0.215001, slid, 0.0], [0.0; 3]),
        ];
        let mut stepper = Stepper::new(&crowd, &settings, movers, &stream);
        let total = |stepper: &mut Stepper| {
            stepper.kinetic() + stepper.potential() + stepper.account.contact_loss
        };
        let mut last = total(&mut stepper);
        let [mut there, mut worst] = [0.0; 2];
        for _ in 0..(settings.duration / settings.step) as usize {
            stepper.step().unwrap();
            let now = total(&mut stepper);
            worst = f64::max(worst, (now - last).abs());
            there = f64::max(there, stepper.kinetic());
            last = now;
        }
        worst / there
    };
    for slid in [3e-4, 8e-4, 3e-3, 1e-2] {
        let [whole, half] = [1.0, 0.5].map(|share| missing(slid, share));
        assert!(whole < 0.01, "{slid} {whole}");
        assert!(half < 0.3 * whole, "{slid} {whole} {half}");
    }
}

/// Nine tiles that fly and spin at random within a rim, without drives, looked at after each step: contact
/// never gives energy, where it is elastic it takes none, and what it says it took is what is gone.
#[test]
fn energy_of_many_tiles_never_rises() {
    let (problem, crowd) = one_face(MagnetModel::Dipole);
    let depth = problem.depth();
    let laws = [[0.3, 0.01], [2.0, 0.5], [0.0, 0.0], [0.0, 1.0], [0.3, 1.0]];
    let mut missing = Vec::new();
    // In the last one points come back while tiles slide fast past each other.
    let runs = (0..6).flat_map(|seed| laws.map(|law| (seed, law)));
    for (seed, law) in runs.chain([(54, [0.0, 0.0])]) {
        let settings = TableSettings {
            walls: true,
            ..settings(6.0, law)
        };
        let mut rng = stream(seed);
        let movers = (0..9).map(|k| {
            let [x, y] = [k % 3, k / 3].map(|it| 0.64 * (it as f64 - 1.0));
            let angle = TAU * rng.random::<f64>();
            let v = thermal_velocity(&crowd.kinds[k % 2].body, 3e-3, &mut rng);
            mover(k % 2, [x, y, angle], v.into())
        });
        let mut stepper = Stepper::new(&crowd, &settings, movers.collect(), &stream);
        let start = stepper.kinetic() + stepper.potential();
        let (mut energy, mut lost, mut off) = (start, 0.0, 0.0);
        for _ in 0..2400 {
            stepper.step().unwrap();
            let now = stepper.kinetic() + stepper.potential();
            // In rare steps that the force of a pair is too strong for; what is missing then is made up for later.
            assert!(now - energy < 1e-2 * depth, "{now} {energy} {law:?} {seed}");
            let taken = stepper.account.contact_loss;
            // Of second order in the step, where tiles slide without friction.
            assert!(
                taken - lost > -3e-5 * depth,
                "{taken} {lost} {law:?} {seed}"
            );
            (energy, lost) = (now, taken);
            off = f64::max(off, (energy + lost - start).abs());
        }
        let is_elastic = law == [0.0, 1.0];
        assert_eq!(lost < 1e-9 * depth, is_elastic, "{lost} {law:?} {seed}");
        missing.push(off / depth);
    }
    missing.sort_by(f64::total_cmp);
    println!("{missing:?}");
    let [median, worst] = [missing[missing.len() / 2], missing[missing.len() - 1]];
    assert!(median < 1e-6 && worst < 1e-2, "{missing:?}");
}

/// Tabs and slots that are shaken, with so much friction that they wedge: the impulses of contact are found in
/// every step, also where tiles rub on the table and where bounces contradict each other.
#[test]
fn wedged_tiles_never_fail() {
    let crowd = tab_and_slot();
    let laws = [[0.0, 1.0], [0.05, 0.01], [0.05, 0.5], [0.05, 1.0]];
    let runs = (0..12).flat_map(|seed| laws.map(|law| (seed, law)));
    for (seed, [table_friction, restitution]) in runs {
        let settings = TableSettings {
            friction: 2.0,
            table_friction,
            restitution,
            ..shaken(20.0, 3e-3, 0.5)
        };
        let mut rng = stream(seed);
        let movers = (0..8).map(|k| {
            let [x, y] = [k % 3, k / 3].map(|it| 0.64 * (it as f64 - 1.0));
            mover(k % 2, [x, y, TAU * rng.random::<f64>()], [0.0; 3])
        });
        let own = |tile: usize| stream(100 * seed + tile);
        let mut stepper = Stepper::new(&crowd, &settings, movers.collect(), &own);
        for _ in 0..8000 {
            if let Err(error) = stepper.step() {
                panic!("{error} {table_friction} {restitution} {seed}");
            }
        }
    }
}

/// A design scaled by s, with masses and energies scaled by s^3 and times by s, moves in the same way.
#[test]
fn a_scaled_table_moves_alike() {
    let ends = |s: f64| {
        let code = |code: &str, face: usize| {
            let mut tile = square(0.43, code, &[face]);
            let corners = tile.outline.vertices().iter().map(|it| it * s).collect();
            tile.outline = Outline::new(corners).unwrap();
            for magnet in &mut tile.magnets {
                magnet.position *= s;
                magnet.size = magnet.size.map(|it| it * s);
                magnet.moment *= s * s * s;
            }
            for face in &mut tile.faces {
                face.start *= s;
                face.end *= s;
            }
            tile.mass *= s * s * s;
            tile.thickness *= s;
            tile
        };
        let tiles = [code("NNNS", 0), code("NSSS", 2)];
        let model = MagnetModel::Dipole;
        let problem = problem(tiles, model, [2.0 * s; 2]);
        let crowd = crowd(&problem, model);
        let settings = TableSettings {
            step: s * TableSettings::USUAL_STEP,
            sampling: 0.01 * s,
            ..settings(0.8 * s, [0.3, 0.5])
        };
        let thrown: Vec<Mover> = thrown()
            .into_iter()
            .map(|mut it| {
                it.place.x *= s;
                it.place.y *= s;
                it.velocity.z /= s;
                it
            })
            .collect();
        let found = run(&crowd, &settings, (1, 0), &Start::Given(thrown), false).unwrap();
        let last = found.samples.last().unwrap();
        let energies = [last.kinetic, last.potential, last.account.contact_loss];
        let held: Vec<_> = found.samples.iter().map(|it| it.held.len()).collect();
        (energies.map(|it| it / (s * s * s)), held, found.steps)
    };
    let (whole, held, steps) = ends(1.0);
    assert!(whole[2] > 0.0 && steps > 10, "{whole:?} {steps}");
    for s in [1.0 / 64.0, 2.0] {
        let (scaled, held_there, steps_there) = ends(s);
        assert_eq!((&held, steps), (&held_there, steps_there), "{s}");
        for (a, b) in whole.iter().zip(scaled) {
            assert!(
                (a - b).abs() < 1e-6 * whole[0].abs().max(a.abs()),
                "{s} {a} {b}"
            );
        }
    }
}

/// One tile against a fixed one moves as one against a tile that is so heavy that nothing moves it.
#[test]
fn a_fixed_tile_is_like_a_very_heavy_one() {
    let heavy = |mass: f64| {
        let mut tiles = [square(0.43, "NNNS", &[0]), square(0.43, "NSSS", &[2])];
        tiles[0].mass = mass;
        problem(tiles, MagnetModel::Dipole, [2.0; 2])
    };
    let problem = heavy(1e9);
    let crowd = crowd(&problem, MagnetModel::Dipole);
    for (law, place, velocity) in [
        ([0.3, 0.01], [0.4301, 0.02, 0.0], [0.0, 0.0, 0.0]),
        ([0.3, 0.5], [0.46, 0.03, 0.1], [-0.3, 0.05, 0.2]),
        ([0.0, 0.0], [0.4301, 0.02, 0.0], [0.0, 0.05, 0.0]),
        ([1.0, 0.01], [0.47, -0.05, -0.2], [-0.4, 0.1, 0.0]),
    ] {
        let settings = settings(0.4, law);
        let movers = vec![mover(0, [0.0; 3], [0.0; 3]), mover(1, place, velocity)];
        let start = Start::Given(movers);
        let found = run(&crowd, &settings, (1, 0), &start, false).unwrap();
        let end = found.movers[1];
        let motion = MotionSettings {
            drag: 0.0,
            friction: law[0],
            restitution: law[1],
            walls: false,
            ..MotionSettings::default()
        };
        let body = Body::of_tile(&problem.pair.as_ref().unwrap().moving);
        let simulation = Simulation::new(&problem, body, &motion).unwrap();
        let start = Motion {
            configuration: place.into(),
            velocity: velocity.into(),
        };
        let alone = simulation.run(&start, 0.4, &mut stream(1), &mut |_| false);
        let Motion { configuration, .. } = alone.last.motion;
        let off = configuration.step_to(&end.motion(&crowd).configuration);
        assert!(
            off.xy().norm() + 0.3 * off.z.abs() < 1e-4,
            "{law:?} {place:?}: {off:?} {alone:?}"
        );
    }
}
