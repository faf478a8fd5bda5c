//! The energy of two tiles near a state, for any errors of their magnets: a sum over pairs of
//! magnets of second-order expansions.
//!
//! The energy of two magnets depends on the place and the direction of the second in the frame of
//! the first, r = (x, y, angle), and is proportional to both moments. For each pair at the state
//!
//! ```text
//! u(r) = u(r0) + T(r) - T(r0),    T(r) = g.(r - rb) + (r - rb).H (r - rb) / 2
//! ```
//!
//! u(r0) is exact, g and H are derivatives at rb. Errors and motions of the moving tile enter by r,
//! which is computed exactly from them. rb is r0 itself for point dipoles. For bodies it is pulled
//! back from the first magnet's face by the typical size of the errors: at contact of two pole faces
//! the second derivative is infinite, and beyond contact there is nothing to be expanded.
//!
//! With shields, a pair's factor ([`Shield::factor`](physics::potential::shielding::Shield::factor))
//! is expanded to first order in the second magnet's place and the tile's turn.

use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};

use super::made::{Change, Draw};
use super::request::MakingErrors;
use crate::design::Design;
use physics::configuration::Configuration;
use physics::potential::interaction::bare;
use physics::potential::shielding::{ShieldRule, nearest_faces};
use physics::potential::{Interaction, MagnetModel, Potential};
use physics::tile::{Magnet, Pair, Tile};

/// Least steps of the second differences (m, rad).
const LEAST_STEPS: [f64; 2] = [2e-6, 1e-4];
/// Step of the first differences of shields' factors, as a share of the distance, and in rad.
const FACTOR_STEP: f64 = 1e-5;

/// The energies of pairs of magnets, by their kinds.
pub struct Pairs<'a> {
    pair: &'a Pair,
    interaction: &'a Interaction,
    /// The kind of each magnet of either tile.
    kinds: [Vec<usize>; 2],
    /// Of each kind of the fixed tile and each of the moving one, with moments of 1 A m^2, both at
    /// the origin.
    potentials: Vec<Vec<Box<dyn Potential + Send>>>,
    /// How far (m) errors typically move a point of a magnet, and turn a magnet (rad).
    typical: [f64; 2],
}

/// Magnets that differ only in place, direction and moment.
fn kinds(magnets: &[Magnet]) -> (Vec<usize>, Vec<Magnet>) {
    let mut found: Vec<Magnet> = Vec::new();
    let kind = |magnet: &Magnet| {
        let is_like = |it: &Magnet| (it.size, it.form) == (magnet.size, magnet.form);
        found.iter().position(is_like).unwrap_or_else(|| {
            found.push(Magnet {
                position: Vector2::zeros(),
                angle: 0.0,
                moment: 1.0,
                ..magnet.clone()
            });
            found.len() - 1
        })
    };
    let of = magnets.iter().map(kind).collect();
    (of, found)
}

impl<'a> Pairs<'a> {
    /// The pairs of a design's magnets, for these errors.
    pub fn new(design: &'a Design, making: &MakingErrors) -> Self {
        let (pair, interaction) = (&*design.pair, &design.interaction);
        let sizes = [&pair.fixed, &pair.moving].map(Tile::largest_magnet);
        let typical = making.typical(sizes[0].max(sizes[1]));
        let (first, of_fixed) = kinds(&pair.fixed.magnets);
        let (second, of_moving) = kinds(&pair.moving.magnets);
        let between = |a: &Magnet, b: &Magnet| {
            let [a, b] = [a, b].map(std::slice::from_ref);
            bare(interaction.model, a, b)
        };
        let row = |a| of_moving.iter().map(|b| between(a, b)).collect();
        Self {
            pair,
            interaction,
            kinds: [first, second],
            potentials: of_fixed.iter().map(row).collect(),
            typical: [typical, making.turn.unwrap_or_default()],
        }
    }

    /// The expansion about a configuration.
    pub fn at(&self, q: &Configuration) -> Expansion {
        let nominal = Placed::of(self.pair, &unchanged(self.pair)).seen(q);
        let factors = self.factors(q);
        let mut pairs = Vec::new();
        for (i, first) in nominal.fixed.iter().enumerate() {
            for (j, second) in nominal.moving.iter().enumerate() {
                let at = first.see(second);
                pairs.push(PairExpansion {
                    second: second.place - first.place,
                    factor: factors
                        .as_ref()
                        .map(|all| all[i * nominal.moving.len() + j]),
                    ..self.expand((i, j), at)
                });
            }
        }
        Expansion {
            q: *q,
            pairs,
            moving: nominal.moving.len(),
        }
    }

    /// Expands the energy of a pair without shields about (x, y, angle).
    fn expand(&self, (i, j): (usize, usize), at: Vector3<f64>) -> PairExpansion {
        let potential = &self.potentials[self.kinds[0][i]][self.kinds[1][j]];
        let (first, second) = (&self.pair.fixed.magnets[i], &self.pair.moving.magnets[j]);
        let moments = first.moment * second.moment;
        let of = |r: &Vector3<f64>| Configuration::new(r.x, r.y, r.z);
        let [typical, turn] = self.typical;
        let steps = [
            (typical / 2.0).max(LEAST_STEPS[0]),
            (turn / 2.0).max(LEAST_STEPS[1]),
        ];
        let back = match self.interaction.model {
            MagnetModel::Dipole => Vector3::zeros(),
            MagnetModel::Cuboid => {
                let normal = self.pair.fixed.faces[first.face].normal();
                let (sin, cos) = libm::sincos(first.angle);
                let seen = Vector2::new(
                    cos * normal.x + sin * normal.y,
                    cos * normal.y - sin * normal.x,
                );
                // Towards the side on which the second magnet is.
                let side = if seen.dot(&at.xy()) < 0.0 { -1.0 } else { 1.0 };
                Vector3::new(seen.x, seen.y, 0.0) * (side * (steps[0] + typical))
            }
        };
        let base = at + back;
        let slope = |r: Vector3<f64>| potential.energy_and_gradient(&of(&r)).1;
        let along = |k: usize| {
            let mut step = Vector3::zeros();
            step[k] = steps[usize::from(k == 2)];
            (slope(base + step) - slope(base - step)) / (2.0 * step[k])
        };
        let bend = Matrix3::from_columns(&[along(0), along(1), along(2)]);
        let gradient = slope(base) * moments;
        let bend = (bend + bend.transpose()) * (0.5 * moments);
        PairExpansion {
            exact: potential.energy(&of(&at)) * moments
                - (gradient.dot(&-back) + 0.5 * back.dot(&(bend * back))),
            at,
            back,
            gradient,
            bend,
            second: Vector2::zeros(),
            factor: None,
        }
    }

    /// The factors of all pairs with their gradients by the second magnets' places (x, y) and the
    /// moving tile's turn; `None` without shields.
    fn factors(&self, q: &Configuration) -> Option<Vec<(f64, Vector3<f64>)>> {
        let shields = &self.interaction.shields;
        if shields.is_none() {
            return None;
        }
        let [fixed, moving] = [&self.pair.fixed, &self.pair.moving];
        let middles = [fixed, moving]
            .map(|tile| -> Vec<_> { tile.faces.iter().map(|face| face.middle()).collect() });
        let nearest = (shields.rule == ShieldRule::NearestFace)
            .then(|| nearest_faces(middles.each_ref().map(Vec::as_slice), q));
        let factor = |first: &Magnet, second: &Magnet, shift: Vector3<f64>| {
            if let Some(nearest) = nearest {
                return f64::from(u8::from((first.face, second.face) == nearest));
            }
            let way = q.transform(second.position) + shift.xy() - first.position;
            let (r, d) = (way.norm(), way.normalize());
            let turned = Configuration::new(0.0, 0.0, q.theta + shift.z);
            let ahead = fixed.faces[first.face].normal().dot(&d);
            let behind = -turned.transform(moving.faces[second.face].normal()).dot(&d);
            let of = |shields: &[Option<_>], face: usize, cosine: f64| {
                let shield: Option<physics::potential::shielding::Shield> =
                    shields.get(face).copied().flatten();
                shield.map_or(1.0, |shield| shield.factor(r, cosine))
            };
            of(&shields.fixed, first.face, ahead) * of(&shields.moving, second.face, behind)
        };
        let mut all = Vec::new();
        for first in &fixed.magnets {
            for second in &moving.magnets {
                let r = (q.transform(second.position) - first.position).norm();
                let slope = |k: usize| {
                    let mut step = Vector3::zeros();
                    step[k] = if k == 2 { FACTOR_STEP } else { FACTOR_STEP * r };
                    let difference = factor(first, second, step) - factor(first, second, -step);
                    difference / (2.0 * step[k])
                };
                let gradient = Vector3::new(slope(0), slope(1), slope(2));
                all.push((factor(first, second, Vector3::zeros()), gradient));
            }
        }
        Some(all)
    }
}

/// The draw without errors.
pub fn unchanged(pair: &Pair) -> Draw {
    [&pair.fixed, &pair.moving].map(|tile| vec![Change::NONE; tile.magnets.len()])
}

/// The magnets of a draw, each in its tile's frame.
pub struct Placed {
    fixed: Vec<Seen>,
    moving: Vec<Seen>,
}

/// A magnet in the frame in use.
#[derive(Clone, Copy)]
struct Seen {
    place: Vector2<f64>,
    /// Its direction (rad), and its cosine and sine.
    angle: f64,
    direction: [f64; 2],
    /// From the tile's reference point, in the fixed tile's frame; 0 for the fixed tile.
    arm: Vector2<f64>,
    /// The moment over the nominal one, negative with exchanged poles.
    factor: f64,
}

impl Seen {
    /// Another magnet in the frame of this one. Angles are not wrapped.
    fn see(&self, other: &Self) -> Vector3<f64> {
        let way = other.place - self.place;
        let [cos, sin] = self.direction;
        Vector3::new(
            cos * way.x + sin * way.y,
            cos * way.y - sin * way.x,
            other.angle - self.angle,
        )
    }
}

impl Placed {
    /// The magnets of a draw.
    pub fn of(pair: &Pair, draw: &Draw) -> Self {
        let tile = |tile: &Tile, changes: &[Change]| {
            let magnets = tile.magnets.iter().zip(changes);
            let seen = magnets.map(|(magnet, change)| {
                let angle = magnet.angle + change.turn;
                let (sin, cos) = libm::sincos(angle);
                Seen {
                    place: magnet.position + change.shift(),
                    angle,
                    direction: [cos, sin],
                    arm: Vector2::zeros(),
                    factor: change.factor(),
                }
            });
            seen.collect()
        };
        Self {
            fixed: tile(&pair.fixed, &draw[0]),
            moving: tile(&pair.moving, &draw[1]),
        }
    }

    /// The same with the moving tile at a configuration.
    fn seen(&self, q: &Configuration) -> Self {
        let rotation = q.rotation();
        let moved = |it: &Seen| {
            let arm = rotation * it.place;
            Seen {
                place: q.position() + arm,
                angle: it.angle + q.theta,
                arm,
                ..*it
            }
        };
        Self {
            fixed: self.fixed.clone(),
            moving: self.moving.iter().map(moved).collect(),
        }
    }
}

/// The expansion of the energy about a configuration.
pub struct Expansion {
    /// The configuration.
    pub q: Configuration,
    pairs: Vec<PairExpansion>,
    /// Number of magnets of the moving tile.
    moving: usize,
}

/// The expansion of a pair's energy, with the nominal moments.
struct PairExpansion {
    /// The energy at `at` minus that of the expansion there.
    exact: f64,
    /// The second magnet in the frame of the first: x, y (m), angle (rad).
    at: Vector3<f64>,
    /// From there to where the energy is expanded.
    back: Vector3<f64>,
    gradient: Vector3<f64>,
    bend: Matrix3<f64>,
    /// From the first magnet to the second (m).
    second: Vector2<f64>,
    /// The shields' factor and its gradient.
    factor: Option<(f64, Vector3<f64>)>,
}

/// A sum of energies (J), its gradient by the configuration, and its second derivatives.
pub type Slopes = (f64, Vector3<f64>, Matrix3<f64>);

impl Expansion {
    /// The energy (J) of a draw with the moving tile at `q`.
    pub fn energy(&self, placed: &Placed, q: &Configuration) -> f64 {
        self.sum::<false>(placed, q).0
    }

    /// The energy (J), its gradient and its second derivatives by (x, y, theta).
    pub fn slopes(&self, placed: &Placed, q: &Configuration) -> Slopes {
        self.sum::<true>(placed, q)
    }

    fn sum<const SLOPES: bool>(&self, placed: &Placed, q: &Configuration) -> Slopes {
        let placed = placed.seen(q);
        let mut sum = (0.0, Vector3::zeros(), Matrix3::zeros());
        let mut pairs = self.pairs.iter();
        for first in &placed.fixed {
            for (second, pair) in placed.moving.iter().zip(pairs.by_ref()) {
                let factor = first.factor * second.factor;
                let (energy, gradient, bend) = self.pair::<SLOPES>(pair, [first, second], q);
                sum.0 += factor * energy;
                if SLOPES {
                    sum.1 += gradient * factor;
                    sum.2 += bend * factor;
                }
            }
        }
        sum
    }

    fn pair<const SLOPES: bool>(
        &self,
        pair: &PairExpansion,
        [first, second]: [&Seen; 2],
        q: &Configuration,
    ) -> Slopes {
        let d = first.see(second) - pair.at - pair.back;
        let bent = pair.bend * d;
        let bare = pair.exact + pair.gradient.dot(&d) + 0.5 * d.dot(&bent);
        let (mut sum, mut slope, mut bend) = (bare, Vector3::zeros(), Matrix3::zeros());
        // A motion of the tile moves the magnet's centre by (dx, dy) + dtheta * across.
        let across = Vector2::new(-second.arm.y, second.arm.x);
        let by_motion = |v: Vector3<f64>| Vector3::new(v.x, v.y, v.z + v.xy().dot(&across));
        if SLOPES {
            let [cos, sin] = first.direction;
            let turn = Matrix2::new(cos, -sin, sin, cos);
            let force = pair.gradient + bent;
            let pull = turn * force.xy();
            slope = by_motion(Vector3::new(pull.x, pull.y, force.z));
            let mut motion = Matrix3::identity();
            motion
                .fixed_view_mut::<2, 2>(0, 0)
                .copy_from(&turn.transpose());
            let turned = turn.transpose() * across;
            (motion[(0, 2)], motion[(1, 2)]) = (turned.x, turned.y);
            bend = motion.transpose() * pair.bend * motion;
            bend[(2, 2)] -= pull.dot(&second.arm);
        }
        if let Some((factor, by)) = pair.factor {
            let moved = second.place - first.place - pair.second;
            let moved = Vector3::new(moved.x, moved.y, q.theta - self.q.theta);
            let factor = factor + by.dot(&moved);
            sum = bare * factor;
            if SLOPES {
                let by = by_motion(by);
                bend = bend * factor + slope * by.transpose() + by * slope.transpose();
                bend[(2, 2)] -= bare * by.xy().dot(&second.arm);
                slope = slope * factor + by * bare;
            }
        }
        (sum, slope, bend)
    }

    /// The derivatives of the nominal energy by each magnet's errors.
    pub fn gradients(&self, pair: &Pair) -> Gradients {
        let nominal = Placed::of(pair, &unchanged(pair)).seen(&self.q);
        let mut all =
            [&nominal.fixed, &nominal.moving].map(|it| vec![Gradient::default(); it.len()]);
        let rotation = self.q.rotation();
        for (k, term) in self.pairs.iter().enumerate() {
            let (i, j) = (k / self.moving, k % self.moving);
            let (first, second) = (&nominal.fixed[i], &nominal.moving[j]);
            let (energy, ..) = self.pair::<false>(term, [first, second], &self.q);
            let d = -term.back;
            let force = term.gradient + term.bend * d;
            let [cos, sin] = first.direction;
            let mut pull = Matrix2::new(cos, -sin, sin, cos) * force.xy();
            let mut turn = force.z;
            let way = second.place - first.place;
            // Turning the first magnet turns all it sees the other way.
            let mut back = -(turn + way.x * pull.y - way.y * pull.x);
            if let Some((factor, by)) = term.factor {
                let bare = term.exact + term.gradient.dot(&d) + 0.5 * d.dot(&(term.bend * d));
                pull = pull * factor + by.xy() * bare;
                turn *= factor;
                back *= factor;
            }
            all[0][i].add(energy, -pull, back);
            all[1][j].add(energy, rotation.inverse() * pull, turn);
        }
        Gradients(all)
    }
}

/// The derivatives of the energy by the errors of all magnets of either tile.
pub struct Gradients(pub [Vec<Gradient>; 2]);

/// Number of kinds of errors.
pub const ERRORS: usize = 6;

impl Gradients {
    /// The first-order effect (J) of the changes of each magnet of either tile on the energy: by
    /// the strength in common, its own strength, place, turn, gap and flip.
    pub fn effects(&self, draw: &Draw) -> [Vec<[f64; ERRORS]>; 2] {
        [0, 1].map(|tile| {
            let magnets = draw[tile].iter().zip(&self.0[tile]);
            let effects = magnets.map(|(change, by)| {
                let flipped = if change.is_flipped { -2.0 } else { 0.0 };
                [
                    by.strength * change.strengths[0],
                    by.strength * change.strengths[1],
                    by.shift.dot(&change.place),
                    by.turn * change.turn + by.shift.dot(&change.pushed),
                    by.shift.dot(&change.layer),
                    by.strength * flipped,
                ]
            });
            effects.collect()
        })
    }
}

/// The derivatives of the energy by the errors of a magnet.
#[derive(Clone, Copy, Default)]
pub struct Gradient {
    /// By its relative strength (J): the sum over its pairs.
    pub strength: f64,
    /// By its place, in its tile's frame (J/m).
    pub shift: Vector2<f64>,
    /// By its angle (J/rad).
    pub turn: f64,
}

impl Gradient {
    fn add(&mut self, strength: f64, shift: Vector2<f64>, turn: f64) {
        self.strength += strength;
        self.shift += shift;
        self.turn += turn;
    }
}
