//! Tests of enclosures against the values they enclose, and of bounds against known capacities.

use std::f64::consts::TAU;

use nalgebra::{Vector2, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::cell::{Cell, Quadratic};
use crate::configuration::ConfigurationSpace;
use crate::kinetics::proof::expansion::Expansion;
use crate::potential::bounds::Enclosure;
use crate::potential::{CellBounds, Potential};
use crate::problem::{Problem, Symmetry};
use crate::sample;

#[test]
fn walls_are_where_tiles_touch_with_their_slopes() {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    for (name, problem) in [
        ("paper tile", sample::paper_tile()),
        ("hexagon", sample::hexagon()),
    ] {
        let contact = problem.contact.as_ref().unwrap();
        let wall = Wall::new(Some(contact), 0.0).unwrap();
        let landing = |phi: f64, theta: f64| {
            let (sin, cos) = libm::sincos(phi);
            let q = Configuration::new(0.0, 0.0, theta);
            contact.landing(&q, Vector2::new(cos, sin)).unwrap()
        };
        let mut close = 0;
        for k in 0..400 {
            let mut draw = || rng.random_range(-1.0..=1.0f64);
            let half = [0.03, 0.003, 0.0003][k % 3];
            let (phi, theta) = (3.2 * draw(), 3.2 * draw());
            let at = |value, axis| Expansion::along(value, axis, half);
            let Some(found) = wall.over(at(phi, 1), at(theta, 2)) else {
                panic!("{name}: no wall at {phi} {theta}");
            };
            let inside = |it: &Expansion, d: [f64; 2], value: f64, room: f64| {
                let linear = it.value + it.slopes[1] * d[0] + it.slopes[2] * d[1];
                assert!(
                    (value - linear).abs() <= it.rest + room,
                    "{name} at {phi} {theta} {half}: {value} {it:?}"
                );
            };
            for _ in 0..20 {
                let d = [draw(), draw()];
                let (a, b) = (phi + half * d[0], theta + half * d[1]);
                inside(&found.at, d, landing(a, b), 1e-12);
                let step = 1e-7;
                let slopes = [
                    (landing(a + step, b) - landing(a - step, b)) / (2.0 * step),
                    (landing(a, b + step) - landing(a, b - step)) / (2.0 * step),
                ];
                // But for steps across an edge between two surfaces.
                for (slope, value) in found.slopes.iter().zip(slopes) {
                    inside(slope, d, value, 1e-6);
                }
            }
            close += usize::from(found.at.rest < 2.0 * half * half);
        }
        assert!(close > 250, "{name}: {close} of 400 are of second order");
    }
}

/// `slope` times the centres' distance (J).
struct Slope(f64);

impl Potential for Slope {
    fn energy(&self, q: &Configuration) -> f64 {
        self.0 * libm::hypot(q.x, q.y)
    }

    fn energy_and_gradient(&self, q: &Configuration) -> (f64, Vector3<f64>) {
        let r = libm::hypot(q.x, q.y);
        (self.0 * r, Vector3::new(q.x, q.y, 0.0) * (self.0 / r))
    }

    fn curvature_bound(&self, _: &Configuration, _: f64) -> f64 {
        f64::INFINITY
    }

    fn displacement(&self, step: Vector3<f64>) -> f64 {
        step.norm()
    }
}

impl CellBounds for Slope {
    fn enclose(&self, cell: &Cell) -> Enclosure {
        let (value, slope) = self.energy_and_gradient(&cell.centre);
        let far = cell.travel();
        let least = libm::hypot(cell.centre.x, cell.centre.y) - far;
        // The first derivative of a distance is 1, the second no greater than one over it.
        let off = match least > far {
            true => 0.5 * self.0 * far * far / least * (1.0 + 1e-9) + 1e-15,
            false => 2.0 * self.0 * far + 1e-15,
        };
        Enclosure {
            form: Quadratic {
                value,
                gradient: slope.into(),
                ..Quadratic::default()
            },
            low: -off,
            high: off,
            ..Enclosure::default()
        }
    }
}

/// Turns taken for symmetries.
const TURNS: usize = 60;

#[test]
fn a_linear_well_within_a_circle_is_left_as_its_quadrature_says() {
    let (slope, kt, radius) = (6e-3, 1e-3, 0.5);
    let space = ConfigurationSpace {
        half_size: [1.0, 1.0],
        rho: 0.1,
        free_distance: radius,
    };
    let problem = Problem::without_contact(space, Box::new(Slope(slope)));
    let mut problem = problem.bounded_by(Box::new(Slope(slope)));
    let turn = |k: usize| TAU * k as f64 / TURNS as f64;
    for k in 1..TURNS {
        for (fixed, moving) in [(turn(k), 0.0), (0.0, turn(k))] {
            problem.symmetries.push(Symmetry { fixed, moving });
        }
    }
    let seed = Configuration::new(0.05, 0.0, 0.0);
    let mut field = Field::fitted(&problem, kt, radius, 0.0, &[]).unwrap();
    field.set_level(slope * radius);
    // A hair beyond a side of cells, so that sets are made of whole ones on one side.
    let reach = 0.5 * radius + 1e-4;
    let set = Set {
        at: seed,
        below: slope * reach,
        wide: slope * reach,
    };
    let asked = Closeness {
        apart: 0.03,
        pieces: 400_000,
    };
    let found = capacity(&mut field, &[set], asked).unwrap();
    let hole = field.mesh.chart.circle();
    let sum = |from: f64, to: f64, f: &dyn Fn(f64) -> f64| {
        let n = 20_000;
        let step = (to - from) / f64::from(n);
        (0..n)
            .map(|k| f(from + step * (f64::from(k) + 0.5)))
            .sum::<f64>()
            * step
    };
    let barrier = sum(reach, radius, &|r| libm::exp(slope * r / kt) / r);
    let part = (TAU / TURNS as f64).powi(2);
    let weight = |r: f64| libm::exp(-slope * r / kt) * r;
    let held = part * sum(hole, reach, &weight);
    let around = part * sum(hole, radius, &weight);
    for (exact, [low, high], most) in [
        (part / barrier, found.capacity, 1.2),
        (held, found.held, 1.1),
        (around, [held, found.around], 1.1 * around / held),
    ] {
        assert!(low <= exact && exact <= high, "{exact} {low} {high}");
        assert!(high < most * low, "{low} {high}");
    }
    // From the set's rim to the circle.
    let step = (radius - reach) / 20_000.0;
    let (mut below, mut time) = (held / part, 0.0);
    for k in 0..20_000 {
        let own = weight(reach + step * (f64::from(k) + 0.5));
        below += 0.5 * step * own;
        time += step * below / own;
        below += 0.5 * step * own;
    }
    let [least, most] = found.mean_exit();
    assert!(least <= time && time <= most, "{time} {least} {most}");
    assert!(most < 1.3 * least * around / held, "{least} {most}");
}

#[test]
fn enclosed_sums_hold_what_gauss_rule_gives() {
    let problem = sample::paper_tile();
    let trap = Configuration::new(0.43, -0.04, 0.0);
    let kt = 8e-3;
    let mut field = Field::fitted(&problem, kt, 0.75, 0.0, &[trap]).unwrap();
    field.set_level(-1e-3);
    let mesh = &field.mesh;
    let nodes = Nodes::new(mesh);
    let held = mesh.holding(&trap);
    let pins = nodes.pins(mesh, 1, |id| held.contains(&id).then_some(0));
    let trial = System::new(mesh, &nodes, &pins).committor(0, None).unwrap();
    let inside = |id: usize| held.contains(&id).then_some(0);
    let (network, profile) = field
        .network_between(&nodes, &inside, &|_| false, 1, &trial)
        .unwrap();
    let flux = network
        .from(0, &network.potentials(&nodes, &trial))
        .unwrap();
    let mut roles: Vec<(Piece, Role)> = Vec::new();
    for (cell, sides) in network.upwards(&flux) {
        let role = Role {
            values: Some(nodes.of(cell, &trial)),
            fluxes: Some(sides),
            load: Some(Load::All),
            around: true,
        };
        roles.push((Piece::whole(cell, &mesh.leaves[cell]), role));
    }
    let scale = libm::exp(field.level() / kt);
    let known = |id: usize| mesh.leaves[id].element.as_ref().unwrap();
    let load = |(piece, _): &(Piece, Role)| mesh.held(piece.cell);
    let load = scale * roles.iter().map(load).sum::<f64>();
    let sizes = [
        roles
            .iter()
            .map(|(piece, role)| known(piece.cell).energy(&role.values.unwrap()))
            .sum(),
        flux.cost,
        load,
        load,
    ];
    let wall = Wall::new(problem.contact.as_ref(), 0.0).unwrap();
    let ground = Ground {
        bounds: problem.bounds().unwrap(),
        wall: &wall,
        chart: &mesh.chart,
        kt,
        level: field.level(),
        rho: mesh.rho,
        profile,
    };
    let asked = Closeness {
        apart: 0.15,
        pieces: 100_000,
    };
    let found = bounded(&ground, mesh, &roles, sizes, asked);
    for ([low, high], size) in found.into_iter().zip(sizes) {
        // Gauss' rule is off by less than a hundredth.
        assert!(
            low < 1.01 * size && 0.99 * size < high,
            "{low} {size} {high}"
        );
        assert!(high < 1.15 * low, "{low} {high}");
    }
    // A flux that goes astray carries less by what it loses, and nothing where it loses all.
    let mut out = flux.out.clone();
    let strongest = (0..out.len()).max_by(|a, b| out[*a].amax().total_cmp(&out[*b].amax()));
    out[strongest.unwrap()] *= 0.9;
    let told = |out| network.weighed(out, &|_| 0.0, &network.given(0));
    let astray = told(out);
    assert!(
        astray.carried < 0.995 * flux.carried,
        "{} {}",
        astray.carried,
        flux.carried
    );
    let out = flux.out.iter().enumerate();
    let out = out.map(|(k, own)| if k % 2 == 0 { *own } else { -own });
    assert_eq!(told(out.collect()).carried, 0.0);
}
