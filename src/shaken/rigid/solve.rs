//! Contact impulses where tiles touch each other or the rim.
//!
//! Let v0 be the velocities that the tiles would have without contact, and for each contact point
//! let n and t be the normal and the tangent as rows over the velocities of both tiles. Then there
//! are impulses p, f with
//!
//! `v = v0 + M^-1 sum (n p + t f)`, `n.v >= l` and `p >= 0`, one of them with equality,
//! `|f| <= mu p`, and `t.v = 0` unless `f = -+ mu p` holds against the sliding
//!
//! (Stewart and Trinkle 1996, Int. J. Numer. Meth. Eng. 39, 2673; Anitescu and Potra 1997,
//! Nonlinear Dynamics 14, 231). They are found by [`sweeps`](super::sweeps), from the impulses of the previous
//! solution. Where they are not, they are by pivots, which take [turns](super::turns) with the friction on a table.
//! The impulses on two tiles act at the same point and are equal and opposite.

use nalgebra::Vector3;

use super::clusters::{Cluster, Clusters, from_both_halves};
use super::hold::Hold;
use super::point::{SolverPoint, four};
use super::rest::{Four, Rest, RestPoint};
use super::sweeps::Sweeps;
use super::turns::Turns;
use tiles::potential::simd::Level;

/// Largest number of points that are solved by pivots: their work grows with the cube of it.
const PIVOTED: usize = 100;

/// The solver of a set of points: what it makes of them is kept, as they are often solved for several times.
#[derive(Default)]
pub struct Solver {
    friction: f64,
    clusters: Clusters,
    /// What is made of each cluster, with room for more.
    prepared: Vec<Prepared>,
    /// The number of each tile in its cluster.
    local: Vec<usize>,
}

impl Solver {
    /// Prepares for points of this many tiles.
    pub fn prepare(&mut self, tiles: usize, (holds, rests): (&[Hold], &[Rest]), friction: f64) {
        self.friction = friction;
        self.clusters.find(tiles, holds, rests);
        let count = self.clusters.found().len();
        if self.prepared.len() < count {
            self.prepared.resize_with(count, Prepared::default);
        }
        for it in &mut self.prepared[..count] {
            it.is_made = false;
        }
        self.local.resize(tiles, usize::MAX);
    }

    /// Changes the velocities by the impulses of all points; returns whether they were found. The points are
    /// those that were prepared for, with other impulses or least velocities. The impulses are stored in the
    /// holds; the solver starts from the stored ones. Sweeps end when the velocities are known to `error`
    /// (m/s), judged by how fast they converge. `rests` are the points at which tiles lie on the table.
    pub fn hold_back(
        &mut self,
        inverse: &[Vector3<f64>],
        velocities: &mut [Vector3<f64>],
        (holds, rests): (&mut [Hold], &mut [Rest]),
        error: f64,
    ) -> bool {
        let mut is_found = true;
        for (cluster, prepared) in self.clusters.found().iter().zip(&mut self.prepared) {
            let is_right = |k: &usize| holds[*k].rate(velocities) >= holds[*k].least - error;
            if cluster.lying.is_empty() && cluster.points.iter().all(is_right) {
                for k in &cluster.points {
                    holds[*k].impulses = [0.0; 2];
                }
                continue;
            }
            if prepared.is_made {
                prepared.start_from(holds);
            } else {
                prepared.make(
                    cluster,
                    (holds, rests),
                    inverse,
                    self.friction,
                    &mut self.local,
                );
            }
            is_found &= prepared.solve(cluster, velocities, (holds, rests), error);
        }
        is_found
    }
}

/// A cluster with the data of the solver.
#[derive(Default)]
struct Prepared {
    is_made: bool,
    /// Its tiles in a row, with the inverse roots of their masses.
    tiles: Vec<usize>,
    roots: Vec<Vector3<f64>>,
    /// Its points by their indices, in the order of their solution.
    order: Vec<usize>,
    points: Vec<SolverPoint>,
    /// The numbers of the points that a sweep takes.
    taken: Vec<usize>,
    /// The numbers of the tiles of its points on the table.
    under: Vec<usize>,
    rests: Vec<RestPoint>,
    /// The velocities without impulses, with them, before and after the last sweep.
    free: Vec<Four>,
    velocities: Vec<Four>,
    before: Vec<Four>,
    swept: Vec<Four>,
}

impl Prepared {
    fn make(
        &mut self,
        Cluster { points, lying }: &Cluster,
        (holds, rests): (&[Hold], &[Rest]),
        inverse: &[Vector3<f64>],
        friction: f64,
        local: &mut [usize],
    ) {
        self.tiles.clear();
        let touching = points.iter().flat_map(|k| holds[*k].tiles).flatten();
        for tile in touching.chain(lying.iter().map(|k| rests[*k].tile)) {
            if self.tiles.get(local[tile]) != Some(&tile) {
                local[tile] = self.tiles.len();
                self.tiles.push(tile);
            }
        }
        let roots = self.tiles.iter().map(|tile| inverse[*tile].map(f64::sqrt));
        self.roots.clear();
        self.roots.extend(roots);
        self.order.clear();
        from_both_halves(points, &mut self.order);
        let point = |k: &usize| {
            // The part of a row that is of no tile is zero, so it can be assigned to any.
            let [first, second] = holds[*k].tiles.map(|it| it.map(|tile| local[tile]));
            let second = second.or(first).unwrap_or(0);
            let tiles = [first.unwrap_or(second), second];
            SolverPoint::new(&holds[*k], tiles, &self.roots, friction)
        };
        self.points.clear();
        self.points.extend(self.order.iter().map(point));
        self.under.clear();
        self.under
            .extend(lying.iter().map(|k| local[rests[*k].tile]));
        self.is_made = true;
    }

    /// Starts from the impulses of points that have not changed otherwise.
    fn start_from(&mut self, holds: &[Hold]) {
        for (k, point) in self.order.iter().zip(&mut self.points) {
            point.start_from(&holds[*k]);
        }
    }

    fn solve(
        &mut self,
        cluster: &Cluster,
        velocities: &mut [Vector3<f64>],
        (holds, rests): (&mut [Hold], &mut [Rest]),
        error: f64,
    ) -> bool {
        let lie = cluster.lying.iter().zip(&self.under);
        self.rests.clear();
        self.rests
            .extend(lie.map(|(k, tile)| RestPoint::new(&rests[*k], *tile, &self.roots[*tile])));
        let own = self.tiles.iter().zip(&self.roots);
        let own = own.map(|(tile, root)| four(velocities[*tile].component_div(root)));
        self.free.clear();
        self.free.extend(own);
        self.velocities.clone_from(&self.free);
        let sweeps = Sweeps {
            roots: &self.roots,
            velocities: &mut self.velocities,
            before: &mut self.before,
            swept: &mut self.swept,
            points: &mut self.points,
            taken: &mut self.taken,
            rests: &mut self.rests,
            error,
        };
        let mut is_found = Level::best().run(sweeps).is_some();
        if !is_found && self.points.len() <= PIVOTED {
            let turns = Turns {
                roots: &self.roots,
                free: &self.free,
                velocities: &mut self.velocities,
                before: &mut self.before,
                points: &mut self.points,
                rests: &mut self.rests,
                error,
            };
            is_found = turns.pivot().is_some();
        }
        for (k, point) in self.order.iter().zip(&self.points) {
            holds[*k].impulses = point.impulses;
        }
        for (k, point) in cluster.lying.iter().zip(&self.rests) {
            rests[*k].impulse = point.impulse.into();
        }
        let own = self.tiles.iter().zip(&self.velocities).zip(&self.roots);
        for ((tile, [x, y, turn, _]), root) in own {
            velocities[*tile] = Vector3::new(*x, *y, *turn).component_mul(root);
        }
        is_found
    }
}

#[cfg(test)]
mod tests {
    use super::super::pivot::by_pivots;
    use super::*;
    use nalgebra::Vector2;
    use rand::{RngExt, SeedableRng};
    use std::f64::consts::TAU;
    use tiles::contact::TurnsWith;

    const SIDE: f64 = 0.4;
    const COUNT: usize = 5;
    const ERROR: f64 = 1e-6;

    /// Solves once for some points.
    fn hold_back(
        inverse: &[Vector3<f64>],
        velocities: &mut [Vector3<f64>],
        (holds, rests): (&mut [Hold], &mut [Rest]),
        [friction, error]: [f64; 2],
    ) -> bool {
        let mut solver = Solver::default();
        solver.prepare(inverse.len(), (holds, rests), friction);
        solver.hold_back(inverse, velocities, (holds, rests), error)
    }

    /// Squares of 100 g in a block, every two neighbours touching with two corners each.
    fn block() -> (Vec<Vector3<f64>>, Vec<Hold>) {
        let centre =
            |tile: usize| Vector2::new((tile % COUNT) as f64, (tile / COUNT) as f64) * SIDE;
        let mut holds = Vec::new();
        for tile in 0..COUNT * COUNT {
            let neighbours: [(bool, usize, Vector2<f64>); 2] = [
                (tile % COUNT + 1 < COUNT, tile + 1, Vector2::x()),
                (tile / COUNT + 1 < COUNT, tile + COUNT, Vector2::y()),
            ];
            for (_, other, axis) in neighbours.into_iter().filter(|it| it.0) {
                for end in [-0.5, 0.5] {
                    let along = Vector2::new(-axis.y, axis.x) * end;
                    let point = centre(tile) + (axis * 0.5 + along) * SIDE;
                    let tiles = [Some(tile), Some(other)];
                    holds.push(Hold::new(
                        tiles,
                        point,
                        (axis, TurnsWith::Behind),
                        0.0,
                        centre,
                    ));
                }
            }
        }
        let inertia = 0.1 * SIDE * SIDE / 6.0;
        let inverse = Vector3::new(10.0, 10.0, 1.0 / inertia);
        (vec![inverse; COUNT * COUNT], holds)
    }

    /// They are not found, or leave velocities that are no larger than those before.
    #[test]
    fn points_that_contradict_each_other_leave_a_finite_velocity() {
        let hold = |x: f64| {
            let axis = (Vector2::new(x, 0.0), TurnsWith::Behind);
            let mut hold = Hold::new([None, Some(0)], Vector2::zeros(), axis, 0.0, |_| {
                Vector2::zeros()
            });
            hold.least = 1e-3;
            hold
        };
        let inverse = [Vector3::new(10.0, 10.0, 300.0)];
        let mut velocities = [Vector3::new(0.2, 0.1, 0.0)];
        let mut holds = [hold(1.0), hold(-1.0)];
        hold_back(
            &inverse,
            &mut velocities,
            (&mut holds, &mut []),
            [0.3, ERROR],
        );
        assert!(velocities[0].norm() < 1.0, "{velocities:?}");
    }

    /// Three squares in a row between two walls, each touching the next with a corner: with much friction sweeps
    /// go round in circles in some of these knocks. Impulses take energy, as they have no restitution; so do those
    /// of the table on which the squares lie, in two thirds of them; of these, few are not found.
    #[test]
    fn knocks_are_solved_at_any_friction() {
        let [mut missed, mut all] = [0; 2];
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
        let inertia = 0.1 * SIDE * SIDE / 6.0;
        let inverse = vec![Vector3::new(10.0, 10.0, 1.0 / inertia); 3];
        let centre = |tile: usize| Vector2::new(1.2 * SIDE * tile as f64, 0.0);
        let of = |v: &[Vector3<f64>]| {
            let each = v.iter().zip(&inverse);
            each.map(|(v, inverse)| v.component_div(inverse).dot(v))
                .sum::<f64>()
        };
        let cases =
            [0.3, 1.0, 2.0].map(|friction| [0.0, 1e-3, 1e-2].map(|limit| (friction, limit)));
        for (friction, limit) in cases.concat().repeat(1000) {
            let mut even = || rng.random::<f64>() - 0.5;
            let holds = (0..4).map(|k| {
                let tiles = [[None, Some(0)], [Some(0), Some(1)], [Some(1), Some(2)]];
                let tiles = *tiles.get(k).unwrap_or(&[None, Some(2)]);
                let point = Vector2::new((1.2 * k as f64 - 0.6) * SIDE, SIDE * even());
                let angle = 2.0 * even() + if k == 3 { TAU / 2.0 } else { 0.0 };
                let axis = Vector2::new(libm::cos(angle), libm::sin(angle));
                Hold::new(tiles, point, (axis, TurnsWith::Line), 0.0, centre)
            });
            let mut holds: Vec<Hold> = holds.collect();
            let before: Vec<_> = (0..3)
                .map(|_| Vector3::new(even(), even(), even() / SIDE))
                .collect();
            let mut now = before.clone();
            let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
            let under =
                (0..3).flat_map(|tile| corners.map(|it| (tile, 0.3 * SIDE * Vector2::from(it))));
            let rests = under.filter(|_| limit > 0.0).map(|(tile, arm)| Rest {
                tile,
                arm,
                limit,
                impulse: Vector2::zeros(),
                is_given: false,
            });
            let mut rests: Vec<Rest> = rests.collect();
            let points = (&mut holds[..], &mut rests[..]);
            let is_found = hold_back(&inverse, &mut now, points, [friction, ERROR]);
            if limit > 0.0 {
                [missed, all] = [missed + usize::from(!is_found), all + 1];
                if !is_found {
                    continue;
                }
            }
            assert!(is_found, "{friction} {before:?} {holds:?}");
            for rest in &rests {
                let (rub, slip) = (rest.impulse, rest.velocity(&now));
                assert!(rub.norm() <= limit * (1.0 + 1e-9));
                let is_against = rest.slides() && (rub / limit + slip.normalize()).norm() < 0.1;
                assert!(slip.norm() < 0.01 || is_against, "{rub} {slip} {limit}");
            }
            assert!(of(&now) <= of(&before) + ERROR);
            // Where the table rubs, sweeps end by an estimate that is often too small.
            let most = if limit > 0.0 { 1e-3 } else { 50.0 * ERROR };
            for hold in &holds {
                let ([push, rub], rate) = (hold.impulses, hold.rate(&now));
                assert!(rate > -most, "{rate}");
                assert!(
                    push == 0.0 || rate < most,
                    "{push} {rate} {friction} {holds:?} {before:?}"
                );
                assert!(push >= 0.0 && rub.abs() <= friction * push * (1.0 + 1e-9));
            }
        }
        assert!(500 * missed < all, "{missed} of {all}");
    }

    /// Four squares in a block that fly at each other. Each two touch along whole edges, with the corners of both
    /// at the same places but for rounding.
    #[test]
    fn pivots_solve_for_points_that_are_nearly_the_same() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
        let inertia = 0.1 * SIDE * SIDE / 6.0;
        let inverse = Vector3::new(10.0, 10.0, 1.0 / inertia);
        let roots = [inverse.map(f64::sqrt); 4];
        let centre = |tile: usize| Vector2::new((tile % 2) as f64, (tile / 2) as f64) * SIDE;
        for friction in [0.1, 0.3, 1.0].repeat(200) {
            let mut even = || rng.random::<f64>() - 0.5;
            let mut points = Vec::new();
            for [one, other] in [[0, 1], [2, 3], [0, 2], [1, 3]] {
                for end in [-0.5, -0.5, 0.5, 0.5] {
                    let axis = (centre(other) - centre(one)) / SIDE;
                    let along = Vector2::new(-axis.y, axis.x);
                    let point = (centre(one) + centre(other)) * 0.5 + along * (end * SIDE);
                    let axis = (axis + along * (1e-9 * even()), TurnsWith::Behind);
                    let hold = Hold::new([Some(one), Some(other)], point, axis, 0.0, centre);
                    points.push(SolverPoint::new(&hold, [one, other], &roots, friction));
                }
            }
            let free = [0, 1, 2, 3].map(|tile| {
                let inwards = Vector2::new(0.5, 0.5) * SIDE - centre(tile);
                four(Vector3::new(
                    inwards.x + 0.2 * even(),
                    inwards.y + 0.2 * even(),
                    even(),
                ))
            });
            let impulses = by_pivots(&points, &free).unwrap();
            let mut now = free;
            for (point, impulses) in points.iter_mut().zip(impulses) {
                point.impulses = impulses;
                point.push(impulses, &mut now);
            }
            assert!(points.iter().all(|it| it.obeys(&now, 1e-9)), "{friction}");
        }
    }

    #[test]
    fn a_block_of_tiles_is_held_in_few_sweeps() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
        for friction in [0.0, 0.3] {
            let mut all = 0;
            for _ in 0..20 {
                let (inverse, mut holds) = block();
                // Every tile flies towards the middle, plus a random velocity.
                let velocities = (0..inverse.len()).map(|tile| {
                    let mut even = || rng.random::<f64>() - 0.5;
                    let [x, y] = [tile % COUNT, tile / COUNT].map(|k| 2.0 - k as f64);
                    Vector3::new(0.2 * x + even(), 0.2 * y + even(), even())
                });
                let start: Vec<_> = velocities.collect();
                let roots: Vec<_> = inverse.iter().map(|it| it.map(f64::sqrt)).collect();
                let mut points: Vec<SolverPoint> = holds
                    .iter()
                    .map(|hold| {
                        SolverPoint::new(
                            hold,
                            hold.tiles.map(|it| it.unwrap_or(0)),
                            &roots,
                            friction,
                        )
                    })
                    .collect();
                let scaled = start.iter().zip(&roots);
                let scaled: Vec<_> = scaled
                    .map(|(v, root)| four(v.component_div(root)))
                    .collect();
                let mut solve = || {
                    Level::best().run(Sweeps {
                        roots: &roots,
                        velocities: &mut scaled.clone(),
                        before: &mut Vec::new(),
                        swept: &mut Vec::new(),
                        points: &mut points,
                        taken: &mut Vec::new(),
                        rests: &mut [],
                        error: ERROR,
                    })
                };
                let sweeps = solve().unwrap();
                all += sweeps;
                let mut now = start.clone();
                hold_back(&inverse, &mut now, (&mut holds, &mut []), [friction, ERROR]);
                for hold in &holds {
                    let [push, rub] = hold.impulses;
                    assert!(hold.rate(&now) > -50.0 * ERROR, "{}", hold.rate(&now));
                    assert!(push >= 0.0 && rub.abs() <= friction * push * (1.0 + 1e-9));
                    assert!(
                        push == 0.0 || hold.rate(&now) < 50.0 * ERROR,
                        "{push} {}",
                        hold.rate(&now)
                    );
                }
                // Starting from the impulses of the solution, the solver converges at once.
                let again = solve().unwrap();
                assert!(again <= sweeps, "{again} {sweeps}");
            }
            assert!(all < 20 * 200, "{all} sweeps at {friction}");
        }
    }
}
