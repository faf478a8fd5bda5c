//! Chains and rings of equal tiles that bind with two faces.

use std::f64::consts::TAU;

use nalgebra::Vector3;
use rand::RngExt;
use tilebind::Configuration;
use tilebind::design::Design;
use tilebind::dynamics::docking::stream;
use tilebind::kinetics::population::PairRates;
use tilebind::kinetics::population::rows::{Growth, Joints, Spreads};

/// A sector of a ring of `count`, of which the cuts carry these codes.
fn sector(count: f64, codes: [&str; 2], target: &str) -> Design {
    let half = TAU / count / 2.0;
    let corner = |r: f64, turn: f64| format!("[{:?}, {:?}]", r * turn.cos(), r * turn.sin());
    let corners = [(0.03, -half), (0.07, -half), (0.07, half), (0.03, half)];
    let corners = corners.map(|(r, turn)| corner(r, turn)).join(", ");
    let [first, second] = codes;
    Design::parse(
        &format!(
            "[table]\nsize = [2.0, 2.0]\n[magnet]\nsize = [0.003, 0.005, 0.003]\nremanence = 1.2\n\
             pitch = 0.012\ninset = 0.0005\n[potential]\nmodel = \"dipole\"\n\
             [tile]\nvertices = [{corners}]\nthickness = 0.006\nmass = 0.02\n\
             [tile.faces]\n0 = {{ code = \"{first}\" }}\n2 = {{ code = \"{second}\" }}\n\
             [target]\nfaces = {target}\n"
        ),
        "sector.toml",
    )
    .unwrap()
}

fn directed(count: f64) -> Design {
    sector(count, ["S", "N"], "[\"0\", \"2\"]")
}

/// Sectors close exactly where their turn divides the circle, and have no room for one tile more.
#[test]
fn chains_close_where_the_turn_of_the_bond_divides_the_circle() {
    for count in 3..=12 {
        let design = directed(count as f64);
        let problem = design.problem();
        let joints = Joints::of(&problem).expect("two binding faces");
        assert_eq!(joints.ways(), 2);
        assert_eq!(joints.longest(20), Some(count), "{count}");
        let kt = -problem.energy(&design.pair.bound) / 12.0;
        let spreads = Spreads::sampled(&joints, kt, 0.0, &mut stream(1, 0));
        let area = |size: usize| {
            let row = joints.uniform(size).unwrap();
            1.0 / (TAU * spreads.density(&joints, &row))
        };
        assert!(area(count) < 1e-3, "{count}: {}", area(count));
        if count > 3 {
            assert!(area(count - 1) > 1e3 * area(count), "{count}");
        }
    }
    // A turn of 50 degrees: seven sectors have room, and do not close.
    let design = directed(7.2);
    let problem = design.problem();
    let joints = Joints::of(&problem).expect("two binding faces");
    assert_eq!(joints.longest(20), Some(7));
    let kt = -problem.energy(&design.pair.bound) / 100.0;
    let spreads = Spreads::sampled(&joints, kt, 0.0, &mut stream(1, 0));
    let row = joints.uniform(7).unwrap();
    assert!(spreads.density(&joints, &row) < 1e-6);
}

/// Both cuts bind both: four ways, and rows turn either way.
#[test]
fn faces_that_bind_their_own_kind_join_in_four_ways() {
    let design = sector(8.0, ["NS", "NS"], "[\"0\"]");
    let problem = design.problem();
    let joints = Joints::of(&problem).expect("two binding faces");
    assert_eq!(joints.ways(), 4);
    assert_eq!(joints.longest(20), Some(8));
    // A zigzag has room for ever.
    let zigzag: Vec<bool> = (0..20).map(|k| k % 2 == 1).collect();
    assert!(joints.fit(&zigzag, 10));
    // One binding face makes pairs alone, four make sheets.
    assert!(Joints::of(&sector(8.0, ["NS", "N"], "[\"0\"]").problem()).is_none());
}

/// The density of a chain's ends, taken as normal, is right to a factor of two: against poses of bonds that
/// are drawn and composed.
#[test]
fn the_ends_of_a_chain_are_as_near_as_drawn_bonds_say() {
    for count in [4, 8] {
        let design = directed(count as f64);
        let problem = design.problem();
        let joints = Joints::of(&problem).expect("two binding faces");
        let bound = design.pair.bound;
        let kt = -problem.energy(&bound) / 15.0;
        let spreads = Spreads::sampled(&joints, kt, 0.0, &mut stream(1, 0));
        let density = spreads.density(&joints, &joints.uniform(count).unwrap());
        // An independent sampler: steps of all coordinates at once.
        let mut rng = stream(7, 1);
        let (mut here, mut poses) = (bound, Vec::new());
        for sweep in 0..400_000 {
            let mut by = |length: f64| length * (2.0 * rng.random::<f64>() - 1.0);
            // About the tile's middle, which the turn moves least.
            let turn = Configuration::new(0.05, 0.0, 0.0);
            let step = Configuration::new(by(1e-3), by(1e-3), by(0.02));
            let there = here.compose(&turn).compose(&step).compose(&turn.inverse());
            let rise = problem.energy(&there) - problem.energy(&here);
            // The play within 8 kT, as documented.
            let is_near = problem.energy(&there) < problem.energy(&bound) + 8.0 * kt;
            if is_near && problem.is_free(&there) && rng.random::<f64>() < (-rise / kt).exp() {
                here = there;
            }
            if sweep > 2000 && sweep % 10 == 0 {
                poses.push(here);
            }
        }
        // The intended bond or its exchange leads around the ring, and the closed ring's motion is none.
        let draw = |rng: &mut rand_chacha::ChaCha8Rng| {
            let mut all = Configuration::new(0.0, 0.0, 0.0);
            for _ in 0..count {
                all = all.compose(&poses[rng.random_range(0..poses.len())]);
            }
            Vector3::new(all.x, all.y, all.theta)
        };
        let drawn: Vec<Vector3<f64>> = (0..400_000).map(|_| draw(&mut rng)).collect();
        let sd = |k: usize| (drawn.iter().map(|it| it[k] * it[k]).sum::<f64>() / 4e5).sqrt();
        let half = [0, 1, 2].map(|k| 0.3 * sd(k));
        let inside = drawn
            .iter()
            .filter(|it| (0..3).all(|k| it[k].abs() < half[k]))
            .count();
        let counted = inside as f64 / 4e5 / (8.0 * half[0] * half[1] * half[2]);
        let ratio = density / counted;
        assert!((0.5..2.0).contains(&ratio), "{count}: {ratio}");
    }
}

/// Rows in equilibrium have the numbers that follow from counting labelled chains and rings: N tiles in
/// m chains can be ordered in N! / m! (N - 1 over m - 1) ways.
#[test]
fn rows_in_equilibrium_are_counted_right() {
    let design = directed(4.0);
    let problem = design.problem();
    let joints = Joints::of(&problem).expect("two binding faces");
    let kt = -problem.energy(&design.pair.bound) / 12.0;
    let spreads = Spreads::sampled(&joints, kt, 0.0, &mut stream(1, 0));
    let (on, area) = (0.01, 0.5);
    let ring = joints.uniform(4).unwrap();
    let closed = TAU * spreads.density(&joints, &ring) * area;
    // The ring is as likely as its open chains.
    let off = 0.5 * on / area * closed / 4.0 / 2.0;
    // Chains of half the tiles' speed change times, not equilibrium.
    for slowing in [0.0, 0.5, 1.0] {
        let rates = PairRates::through_free(vec![on], vec![off]);
        let growth = Growth {
            joints: &joints,
            spreads: &spreads,
            rates: &rates,
            area,
            slowing,
        };
        // z: one way of two chains over the opening of their bond.
        let z = 0.5 * on / area / off;
        let weights = [1.0, 12.0 * z, 36.0 * z * z, 24.0 * z * z * z];
        let of_ring = 6.0 * z * z * z * (growth.closing(&ring) / off);
        let all: f64 = weights.iter().sum::<f64>() + of_ring;
        let expected = [
            of_ring / all,
            (weights[1] + 2.0 * weights[2] + 3.0 * weights[3] + 4.0 * of_ring) / all,
        ];
        let time = 60.0 / off;
        let runs = 3000;
        let ends: Vec<_> = (0..runs)
            .map(|run| growth.simulate(4, &[time], &mut stream(2, run)).unwrap()[0].clone())
            .collect();
        let mean = |of: &dyn Fn(&tilebind::kinetics::population::rows::Census) -> f64| {
            ends.iter().map(of).sum::<f64>() / runs as f64
        };
        let rings = mean(&|it| *it.rings.get(&4).unwrap_or(&0) as f64);
        let bonds = mean(&|it| it.bonds() as f64);
        assert!((rings - expected[0]).abs() < 0.035, "{rings} {expected:?}");
        assert!((bonds - expected[1]).abs() < 0.12, "{bonds} {expected:?}");
    }
}
