//! A point of contact with the data of the solver, and the law that it obeys alone.

use nalgebra::Vector3;

use super::hold::Hold;
use super::rest::Four;

/// The response of a point to impulses, with the coefficient of friction mu.
pub struct Response {
    /// To a push along the normal, of the rate along it.
    pub nn: f64,
    nt: f64,
    /// The inverse of the matrix of these three, `1 / (nn tt - nt^2)` times its elements.
    stick: [f64; 3],
    pub friction: f64,
    /// Push per lack where the point slides, with the rub at -mu and at +mu times the push.
    slide: [[f64; 2]; 2],
}

impl Response {
    fn new([nn, nt, tt]: [f64; 3], friction: f64) -> Self {
        let whole = 1.0 / (nn * tt - nt * nt);
        let slide = [-friction, friction].map(|share| {
            let answer = nn + share * nt;
            if answer <= 1e-3 * nn {
                // Friction would grow without limit here (Painleve's paradox): only the normal
                // impulse acts.
                return [1.0 / nn, 0.0];
            }
            [1.0 / answer, share / answer]
        });
        Self {
            nn,
            nt,
            stick: [tt, nt, nn].map(|it| it * whole),
            friction,
            slide,
        }
    }

    /// The impulses along normal and tangent that the contact law requires, and their change, by the velocities
    /// with the impulses so far: what they lack along the normal, and the slip along the tangent.
    #[inline(always)]
    fn impulses(&self, [push, rub]: [f64; 2], lack: f64, slip: f64) -> [[f64; 2]; 2] {
        let whole = (self.nn * push + self.nt * rub) + lack;
        if whole <= 0.0 {
            return [[0.0; 2], [-push, -rub]];
        }
        let [tt, nt, nn] = self.stick;
        let change = [tt * lack + nt * slip, -(nt * lack + nn * slip)];
        let asked = [push + change[0], rub + change[1]];
        if asked[1].abs() <= self.friction * asked[0] {
            return [asked, change];
        }
        // It slides: the impulse lies on the side of the friction cone opposite to the sliding.
        let asked = self.slide[usize::from(asked[1] > 0.0)].map(|per| per * whole);
        [asked, [asked[0] - push, asked[1] - rub]]
    }
}

#[inline(always)]
pub fn four(v: Vector3<f64>) -> Four {
    [v.x, v.y, v.z, 0.0]
}

/// By how much velocities differ from those before: the sum of squares, and the largest square of one of them
/// (m^2/s^2), given the inverse roots of the masses.
#[inline(always)]
pub fn change([now, before]: [&[Four]; 2], roots: &[Vector3<f64>]) -> [f64; 2] {
    let [mut sum, mut fastest] = [0.0; 2];
    for ((now, before), root) in now.iter().zip(before).zip(roots) {
        let [x, y, turn] = [0, 1, 2].map(|k| now[k] - before[k]);
        let square = x * x + y * y + turn * turn;
        sum += square;
        fastest = f64::max(fastest, square * root.x * root.x);
    }
    [sum, fastest]
}

/// The sum of the products of both sides.
#[inline(always)]
pub fn along(row: &[Four; 2], [a, b]: [&Four; 2]) -> f64 {
    let [x, y, turn, none] = [0, 1, 2, 3].map(|k| row[0][k] * a[k] + row[1][k] * b[k]);
    (x + turn) + (y + none)
}

/// A contact point with the data of the solver, for velocities multiplied by the root of the mass (or
/// inertia): a unit impulse then changes them by the point's row.
pub struct SolverPoint {
    pub tiles: [usize; 2],
    /// Normal and tangent, for both sides.
    pub rows: [[Four; 2]; 2],
    pub response: Response,
    pub least: f64,
    pub impulses: [f64; 2],
    /// The impulses after the last sweep.
    swept: [f64; 2],
}

impl SolverPoint {
    /// The point of a hold between two tiles of a cluster; `roots` are the inverse roots of the masses.
    pub fn new(hold: &Hold, tiles: [usize; 2], roots: &[Vector3<f64>], friction: f64) -> Self {
        let rows = hold
            .rows
            .map(|row| [0, 1].map(|k| four(row[k].component_mul(&roots[tiles[k]]))));
        let product = |a: usize, b: usize| along(&rows[a], [&rows[b][0], &rows[b][1]]);
        let [nn, nt, tt] = [product(0, 0), product(0, 1), product(1, 1)];
        Self {
            tiles,
            rows,
            response: Response::new([nn, nt, tt], friction),
            least: hold.least,
            impulses: hold.impulses,
            swept: hold.impulses,
        }
    }

    /// Starts from the impulses of its hold, with its least velocity.
    pub fn start_from(&mut self, hold: &Hold) {
        self.least = hold.least;
        self.impulses = hold.impulses;
        self.swept = hold.impulses;
    }

    #[inline(always)]
    pub fn push(&self, [push, rub]: [f64; 2], velocities: &mut [Four]) {
        let [normal, tangent] = &self.rows;
        for (side, tile) in self.tiles.into_iter().enumerate() {
            let velocity = &mut velocities[tile];
            for (k, v) in velocity.iter_mut().enumerate() {
                *v += normal[side][k] * push + tangent[side][k] * rub;
            }
        }
    }

    /// Solves for the impulses of this point.
    #[inline(always)]
    pub fn solve(&mut self, velocities: &mut [Four]) {
        let both = self.tiles.map(|tile| &velocities[tile]);
        let lack = self.least - along(&self.rows[0], both);
        if lack <= 0.0 && self.impulses == [0.0; 2] {
            return;
        }
        let slip = along(&self.rows[1], both);
        let [asked, change] = self.response.impulses(self.impulses, lack, slip);
        self.push(change, velocities);
        self.impulses = asked;
    }

    /// Whether its impulses are as the law of contact has it, velocities being known to `error` (m/s).
    pub fn obeys(&self, velocities: &[Four], error: f64) -> bool {
        let both = self.tiles.map(|tile| &velocities[tile]);
        let [push, rub] = self.impulses;
        let beyond = along(&self.rows[0], both) - self.least;
        let slip = along(&self.rows[1], both);
        let most = self.response.friction * push;
        let against = rub.abs() >= most * (1.0 - 1e-9) && rub * slip <= 0.0;
        let rubs = rub.abs() <= most * (1.0 + 1e-9) && (slip.abs() <= error || against);
        beyond >= -error && (push == 0.0 || (beyond <= error && rubs))
    }

    /// Whether it has an impulse, or had one before the last sweep.
    #[inline(always)]
    pub fn carries(&self) -> bool {
        self.impulses != [0.0; 2] || self.swept != [0.0; 2]
    }

    /// After a sweep: goes on by a share of its change, within the friction cone. The velocities have
    /// done so without the cone.
    #[inline(always)]
    pub fn go_on(&mut self, share: f64, velocities: &mut [Four]) {
        let now = self.impulses;
        let [push, rub] = [0, 1].map(|row| now[row] + (now[row] - self.swept[row]) * share);
        self.swept = now;
        let pushed = push.max(0.0);
        let most = self.response.friction * pushed;
        self.impulses = [pushed, rub.clamp(-most, most)];
        if self.impulses != [push, rub] {
            self.push([pushed - push, self.impulses[1] - rub], velocities);
        }
    }
}
