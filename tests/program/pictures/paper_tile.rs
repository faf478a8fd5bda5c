//! The paper's tiles with hand-made states and pathways.

use ordered_float::OrderedFloat;

use std::sync::OnceLock;

use tilebind::design::Design;
use tilebind::landscape::minimum::descend;
use tilebind::landscape::{
    Barrier, Catalogue, Pathway, PathwayPoint, Place, SaddleBounds, State, StateKind,
};
use tilebind::{Configuration, Problem};

use crate::designs;

const SIDE: f64 = 0.43;
/// Turns that map the square onto itself.
const TURNS: usize = 4;

pub struct Pair {
    pub design: Design,
    pub problem: Problem,
    pub catalogue: Catalogue,
}

pub const BOUND: Configuration = Configuration::new(SIDE, 0.0, 0.0);

/// The pair, put together once.
pub fn pair() -> &'static Pair {
    static PAIR: OnceLock<Pair> = OnceLock::new();
    PAIR.get_or_init(Pair::new)
}

impl Pair {
    fn new() -> Self {
        let design = designs::load("shapes/paper-tile.toml");
        let mut pair = Self {
            problem: design.problem(),
            design,
            catalogue: Catalogue {
                bound_state: Some(0),
                ..Catalogue::default()
            },
        };
        pair.add_states();
        pair.add_escapes();
        pair
    }

    fn add_states(&mut self) {
        let tilt = 1.1f64.to_radians();
        let poses = [
            (BOUND, true),
            (Configuration::new(SIDE, 0.0400, 0.0), false),
            (Configuration::new(SIDE, -0.0400, 0.0), false),
            (Configuration::new(0.434, 0.0761, -tilt), false),
            (Configuration::new(0.4325, -0.0843, -tilt), false),
            (Configuration::new(SIDE, 0.140, 0.0), false),
            (Configuration::new(SIDE, -0.140, 0.0), false),
            (Configuration::new(SIDE, 0.1003, 0.0), false),
            (Configuration::new(SIDE, -0.1003, 0.0), false),
        ];
        for (q, bound) in poses {
            let q = self.minimum(q);
            let class = self.catalogue.states.len();
            for side in 0..TURNS {
                for turn in 0..TURNS {
                    let turned = Configuration::new(0.0, 0.0, side as f64 * 90f64.to_radians());
                    let p = turned.transform(q.position());
                    let theta = q.theta + (side + turn) as f64 * 90f64.to_radians();
                    let q = Configuration::from([p.x, p.y, theta]);
                    self.catalogue.states.push(State {
                        id: self.catalogue.states.len(),
                        kind: if bound {
                            StateKind::Bond
                        } else {
                            StateKind::Trap
                        },
                        configuration: q,
                        energy: self.problem.energy(&q),
                        class,
                        faces: vec![(side, (2 + 4 - turn) % 4)],
                        attracting: 4,
                        repelling: 0,
                        block_energy: None,
                        capture: None,
                        sideways: None,
                    });
                }
            }
        }
    }

    /// The local minimum below a configuration.
    fn minimum(&self, q: Configuration) -> Configuration {
        descend(&self.problem, &q).way.last().unwrap().q
    }

    fn add_escapes(&mut self) {
        let copies = TURNS * TURNS;
        let off = Configuration::new(0.52, 0.02, 0.02);
        let far = Configuration::new(0.90, 0.42, 0.9);
        self.add(0, Place::Free, &[off, far], None);
        let pivot = |sign: f64| Configuration::new(0.447, -0.006 * sign, 0.085 * sign);
        let bound = Place::State(0);
        self.add(copies, bound, &[pivot(1.0), BOUND], Some(0.01));
        self.add(2 * copies, bound, &[pivot(-1.0), BOUND], Some(0.01));
        let slid = Place::State(copies);
        let end = Configuration::new(SIDE, 0.0400, 0.0);
        let between = Configuration::new(0.45, 0.06, 0.06);
        self.add(3 * copies, slid, &[between, end], None);
        let other = Configuration::new(SIDE, -0.0400, 0.0);
        let between = Configuration::new(0.45, -0.06, 0.06);
        self.add(
            4 * copies,
            Place::State(2 * copies),
            &[between, other],
            None,
        );
        for (from, y) in [(5, 0.16), (6, -0.16)] {
            let lift = Configuration::new(0.48, y, 0.02 * y.signum());
            let near = Configuration::new(0.47, 0.5 * y, 0.05);
            self.add(
                from * copies,
                Place::State(3 * copies),
                &[lift, near, end],
                None,
            );
        }
        let near = Configuration::new(0.445, 0.09, 0.03);
        self.add(7 * copies, Place::State(3 * copies), &[near, end], None);
    }

    fn add(&mut self, from: usize, to: Place, waypoints: &[Configuration], width: Option<f64>) {
        let start = self.catalogue.states[from].configuration;
        let pathway = self.pathway(start, waypoints);
        let saddle = *pathway
            .iter()
            .max_by_key(|p| OrderedFloat(p.energy))
            .unwrap();
        let margin = width.map(|share| share * saddle.energy.abs().max(1e-3));
        self.catalogue.barriers.push(Barrier {
            from: Place::State(from),
            to,
            saddle_energy: saddle.energy,
            saddle: saddle.configuration,
            bounds: SaddleBounds {
                lower: margin.map(|m| saddle.energy - 40.0 * m),
                upper: margin.map(|m| saddle.energy + m),
                caged: false,
            },
            from_energy: self.catalogue.states[from].energy,
            to_energy: match to {
                Place::Free => 0.0,
                Place::State(id) => self.catalogue.states[id].energy,
            },
            spread: None,
            pathway,
        });
    }

    /// Straight motions from point to point, moved out along x until they are free.
    fn pathway(&self, start: Configuration, waypoints: &[Configuration]) -> Pathway {
        let mut corners = vec![start];
        corners.extend(waypoints);
        let mut pathway: Pathway = Vec::new();
        for pair in corners.windows(2) {
            for k in 0..100 {
                let mut q = pair[0].interpolate(&pair[1], k as f64 / 99.0);
                while self.problem.clearance(&q) < -1e-9 {
                    q.x += 1e-5;
                }
                let s = pathway.last().map_or(0.0, |last| {
                    last.s + self.problem.space.distance(&last.configuration, &q)
                });
                pathway.push(PathwayPoint {
                    s,
                    configuration: q,
                    energy: self.problem.energy(&q),
                    clearance: self.problem.clearance(&q),
                });
            }
        }
        pathway
    }
}
