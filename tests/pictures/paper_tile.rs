//! A pair of tiles with its states and pathways, put together by hand: 43 cm squares, four magnets
//! a face, NNNS against NSSS.

use nalgebra::Vector2;
use tilebind::landscape::{Barrier, Pathway, PathwayPoint, Place, State, StateKind};
use tilebind::potential::{DipolePotential, Potential};
use tilebind::tile::{Face, Magnet, Outline, Tile};
use tilebind::units::MU0;
use tilebind::{Configuration, ConfigurationSpace};

const SIDE: f64 = 0.43;
const TURNS: usize = 4;

pub struct Pair {
    pub fixed: Tile,
    pub moving: Tile,
    pub potential: DipolePotential,
    pub space: ConfigurationSpace,
    pub states: Vec<State>,
    pub barriers: Vec<Barrier>,
}

pub const BOUND: Configuration = Configuration::new(SIDE, 0.0, 0.0);

/// A square tile with the same code on every face, read counter-clockwise.
pub fn tile(code: &str) -> Tile {
    let h = SIDE / 2.0;
    let corners = [[h, -h], [h, h], [-h, h], [-h, -h]].map(|[x, y]| Vector2::new(x, y));
    let faces: Vec<_> = ["east", "north", "west", "south"]
        .iter()
        .enumerate()
        .map(|(k, name)| Face {
            name: (*name).to_owned(),
            start: corners[k],
            end: corners[(k + 1) % 4],
        })
        .collect();
    let size = [0.010, 0.010, 0.003];
    let mut magnets = Vec::new();
    for (number, face) in faces.iter().enumerate() {
        for (k, pole) in code.chars().enumerate() {
            let out = face.normal() * if pole == 'N' { 1.0 } else { -1.0 };
            magnets.push(Magnet {
                position: face.point((k as f64 - 1.5) * 0.040, -0.005),
                angle: out.y.atan2(out.x),
                moment: 1.2 * size.iter().product::<f64>() / MU0,
                size,
                face: number,
            });
        }
    }
    Tile {
        outline: Outline::new(corners.to_vec()).unwrap(),
        faces,
        magnets,
        mass: 0.1,
        thickness: 0.013,
    }
}

/// Signed clearance (m) of two squares: their distance, or minus the depth of the overlap along
/// the best separating normal.
pub fn clearance(fixed: &Tile, moving: &Tile, q: &Configuration) -> f64 {
    let a = fixed.outline.vertices().to_vec();
    let b: Vec<_> = moving
        .outline
        .vertices()
        .iter()
        .map(|v| q.transform(*v))
        .collect();
    let normals = fixed.outline.normals().iter().copied().chain(
        moving
            .outline
            .normals()
            .iter()
            .map(|normal| q.rotation() * normal),
    );
    let separation = normals
        .flat_map(|n| [n, -n])
        .map(|n| {
            let low = b.iter().map(|p| n.dot(p)).fold(f64::INFINITY, f64::min);
            let high = a.iter().map(|p| n.dot(p)).fold(f64::NEG_INFINITY, f64::max);
            low - high
        })
        .fold(f64::NEG_INFINITY, f64::max);
    if separation <= 0.0 {
        return separation;
    }
    let from_fixed = a
        .iter()
        .map(|p| moving.outline.signed_distance(q.inverse_transform(*p)));
    let from_moving = b.iter().map(|p| fixed.outline.signed_distance(*p));
    from_fixed.chain(from_moving).fold(f64::INFINITY, f64::min)
}

impl Pair {
    pub fn new() -> Self {
        let (fixed, moving) = (tile("NNNS"), tile("NSSS"));
        let space = ConfigurationSpace {
            half_size: [1.0, 1.0],
            rho: moving.radius_of_gyration(),
            free_distance: 0.9,
        };
        let mut pair = Self {
            potential: DipolePotential::new(&fixed.magnets, &moving.magnets),
            fixed,
            moving,
            space,
            states: Vec::new(),
            barriers: Vec::new(),
        };
        pair.add_states();
        pair.add_barriers();
        pair
    }

    fn add_states(&mut self) {
        let tilt = 1.1f64.to_radians();
        let poses = [
            (BOUND, true),
            (Configuration::new(SIDE, 0.0400, 0.0), false),
            (Configuration::new(SIDE, -0.0400, 0.0), false),
            (Configuration::new(0.4341, 0.0761, tilt), false),
            (Configuration::new(0.4341, -0.0843, tilt), false),
            (Configuration::new(SIDE, 0.140, 0.0), false),
            (Configuration::new(SIDE, -0.140, 0.0), false),
            (Configuration::new(SIDE, 0.1003, 0.0), false),
            (Configuration::new(SIDE, -0.1003, 0.0), false),
        ];
        for (q, bound) in poses {
            let class = self.states.len();
            for side in 0..TURNS {
                for turn in 0..TURNS {
                    let turned = Configuration::new(0.0, 0.0, side as f64 * 90f64.to_radians());
                    let p = turned.transform(q.position());
                    let theta = q.theta + (side + turn) as f64 * 90f64.to_radians();
                    let q = Configuration::from([p.x, p.y, theta]);
                    self.states.push(State {
                        id: self.states.len(),
                        kind: if bound {
                            StateKind::Bound
                        } else {
                            StateKind::Misbound
                        },
                        configuration: q,
                        energy: self.potential.energy(&q),
                        class,
                        faces: vec![(side, (2 + 4 - turn) % 4)],
                        attracting: 4,
                        repelling: 0,
                        capture: None,
                    });
                }
            }
        }
    }

    fn add_barriers(&mut self) {
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
        let start = self.states[from].configuration;
        let pathway = self.pathway(start, waypoints);
        let saddle = *pathway
            .iter()
            .max_by(|a, b| a.energy.total_cmp(&b.energy))
            .unwrap();
        let margin = width.map(|share| share * saddle.energy.abs().max(1e-3));
        self.barriers.push(Barrier {
            from: Place::State(from),
            to,
            saddle_energy: saddle.energy,
            saddle: saddle.configuration,
            lower: margin.map(|m| saddle.energy - 40.0 * m),
            upper: margin.map(|m| saddle.energy + m),
            from_energy: self.states[from].energy,
            to_energy: match to {
                Place::Free => 0.0,
                Place::State(id) => self.states[id].energy,
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
                while clearance(&self.fixed, &self.moving, &q) < -1e-9 {
                    q.x += 1e-5;
                }
                let s = pathway.last().map_or(0.0, |last| {
                    last.s + self.space.distance(&last.configuration, &q)
                });
                pathway.push(PathwayPoint {
                    s,
                    configuration: q,
                    energy: self.potential.energy(&q),
                    clearance: clearance(&self.fixed, &self.moving, &q),
                });
            }
        }
        pathway
    }
}
