//! The motion of an island at one time, the way to the next, and its bookkeeping.

use nalgebra::{Vector2, Vector3};

use super::World;
use super::fan::Wind;
use super::hold::{Hold, kinetic};
use super::mover::Mover;
use super::rest::Rest;
use super::short::Each;

/// The largest share of the kinetic energy that a step in contact corrects.
const MOST_SCALED: f64 = 0.02;

/// The own force of a pair of tiles.
#[derive(Clone, Copy)]
pub struct Strength {
    /// The relative acceleration (m/s^2) of the tiles' fastest points by it.
    pub acceleration: f64,
    /// On the second tile, in the frame of the first (N).
    pub force: Vector2<f64>,
}

/// The motion at one time.
pub struct State {
    /// Since the start of the step of the table (s).
    pub time: f64,
    pub velocities: Each<Vector3<f64>>,
    pub accelerations: Each<Vector3<f64>>,
    pub pulls: Each<Strength>,
    /// What fans do to each tile; empty without fans.
    pub winds: Vec<Wind>,
    /// The potential energy of the pairs and in the fans (J).
    pub potential: f64,
    /// The correction of kinetic energy that is still outstanding (J).
    pub debt: f64,
    /// Steps are halved this often, as contact was not solved in longer ones.
    pub halvings: i32,
    /// The longest step (s) from here.
    pub longest: f64,
    /// The same, if the step of the table did not end: what is slow must not depend on this.
    pub unhurried: f64,
    /// The points that touch or may come into contact within it.
    pub holds: Vec<Hold>,
    /// The last friction (N) of the points at which tiles lie on the table.
    pub rubs: Vec<Vector2<f64>>,
}

/// The forces at one time.
pub struct Forces {
    pub accelerations: Each<Vector3<f64>>,
    pub pulls: Each<Strength>,
    pub winds: Vec<Wind>,
    pub potential: f64,
}

impl State {
    pub fn new(time: f64, velocities: Each<Vector3<f64>>, forces: Forces) -> Self {
        Self {
            time,
            velocities,
            accelerations: forces.accelerations,
            pulls: forces.pulls,
            winds: forces.winds,
            potential: forces.potential,
            debt: 0.0,
            halvings: 0,
            longest: 0.0,
            unhurried: 0.0,
            holds: Vec::new(),
            rubs: Vec::new(),
        }
    }

    /// The velocities after half a step (s) without contact.
    pub fn halfway(&self, h: f64) -> Each<Vector3<f64>> {
        let each = self.velocities.iter().zip(&self.accelerations);
        each.map(|(v, a)| v + a * (0.5 * h)).collect()
    }
}

/// The impulses of contact were not found.
pub struct Unsolved;

/// A way to make a step.
pub struct StepWay {
    /// The mean velocities.
    pub velocities: Each<Vector3<f64>>,
    /// The points that last, with their impulses.
    pub holds: Vec<Hold>,
    /// The points at which tiles lie on the table, with theirs.
    pub rests: Vec<Rest>,
    /// The length (s) of the step.
    pub h: f64,
}

/// An upper bound of the speed or acceleration of a tile's fastest point.
pub fn fastest(world: &impl World, mover: &Mover, of: &Vector3<f64>) -> f64 {
    of.xy().norm() + world.reach(mover.kind) * of.z.abs()
}

/// The same of the second of two tiles, relative to the first one in its rotating frame.
pub fn relative(world: &impl World, [first, second]: [&Mover; 2], of: [Vector3<f64>; 2]) -> f64 {
    let between = (second.place - first.place).xy();
    let [a, b] = of;
    let carried = Vector2::new(-between.y, between.x) * a.z;
    (b.xy() - a.xy() - carried).norm() + world.reach(second.kind) * (b.z - a.z).abs()
}

/// Corrects the velocities along the forces of the pairs, by less than a step (s) changed them, so
/// that the kinetic energy (J) matches the change of the potential; what cannot be corrected now is
/// carried over.
pub fn put_right(
    state: &mut State,
    (masses, steady): (&[Vector3<f64>], &[Vector3<f64>]),
    energy: f64,
    h: f64,
) {
    let velocities = &mut state.velocities;
    let now = kinetic(masses, velocities);
    let wanted = energy + state.debt - now;
    let pulls = state.accelerations.iter().zip(steady);
    let pulls: Each<Vector3<f64>> = pulls.map(|(all, steady)| all - steady).collect();
    let square = 2.0 * kinetic(masses, &pulls);
    if square == 0.0 {
        state.debt = wanted;
        return;
    }
    let each = masses.iter().zip(velocities.iter()).zip(&pulls);
    let along: f64 = each
        .map(|((mass, v), a)| mass.component_mul(v).dot(a))
        .sum();
    // The root closest to 0 of `along x + square x^2 / 2 = wanted`.
    let root = (along * along + 2.0 * square * wanted).max(0.0).sqrt();
    let x = 2.0 * wanted / (along + root.copysign(along));
    let most = 0.5 * h;
    let x = if x.is_finite() {
        x.clamp(-most, most)
    } else {
        0.0
    };
    for (v, a) in state.velocities.iter_mut().zip(&pulls) {
        *v += a * x;
    }
    state.debt = energy + state.debt - kinetic(masses, &state.velocities);
}

/// Scales the velocities of tiles relative to their common rigid motion, so that the kinetic energy (J)
/// is the given one, which the forces and the impulses of contact make. Momentum, angular momentum and
/// the points of contact that last keep what they have; without places the common motion is to stand
/// still, as where other tiles do. What cannot be corrected now is carried over.
pub fn put_right_held(
    state: &mut State,
    (masses, places): (&[Vector3<f64>], Option<&[Vector3<f64>]>),
    energy: f64,
) {
    let wanted = energy + state.debt - kinetic(masses, &state.velocities);
    let common: Each<Vector3<f64>> = match places {
        Some(places) => {
            let common = Common::of(masses, places, &state.velocities);
            places.iter().map(|place| common.at(place)).collect()
        }
        None => masses.iter().map(|_| Vector3::zeros()).collect(),
    };
    let each = state.velocities.iter().zip(&common);
    let own: Each<Vector3<f64>> = each.map(|(v, common)| v - common).collect();
    let inner = kinetic(masses, &own);
    let most = MOST_SCALED * inner;
    if most > 0.0 {
        let share = (1.0 + wanted.clamp(-most, most) / inner).sqrt();
        for ((v, common), own) in state.velocities.iter_mut().zip(&common).zip(&own) {
            *v = common + own * share;
        }
    }
    state.debt = energy + state.debt - kinetic(masses, &state.velocities);
}

/// The motion that tiles would have if they were one rigid body with their momentum and angular momentum.
pub struct Common {
    /// The centre of mass (m).
    pub centre: Vector2<f64>,
    /// Its velocity and the angular velocity (m/s, m/s, rad/s).
    pub velocity: Vector3<f64>,
}

impl Common {
    /// Of velocities, or of accelerations.
    pub fn of(
        masses: &[Vector3<f64>],
        places: &[Vector3<f64>],
        velocities: &[Vector3<f64>],
    ) -> Self {
        let whole: f64 = masses.iter().map(|it| it.x).sum();
        let mean = |of: &[Vector3<f64>]| {
            let each = masses.iter().zip(of);
            each.map(|(mass, of)| of.xy() * mass.x)
                .sum::<Vector2<f64>>()
                / whole
        };
        let (centre, drift) = (mean(places), mean(velocities));
        let [mut inertia, mut momentum] = [0.0; 2];
        for ((mass, place), v) in masses.iter().zip(places).zip(velocities) {
            let arm = place.xy() - centre;
            inertia += mass.x * arm.norm_squared() + mass.z;
            momentum += mass.x * arm.perp(&v.xy()) + mass.z * v.z;
        }
        Self {
            centre,
            velocity: drift.push(momentum / inertia),
        }
    }

    /// The velocity of a tile at a place.
    pub fn at(&self, place: &Vector3<f64>) -> Vector3<f64> {
        let arm = place.xy() - self.centre;
        let v = self.velocity.xy() + Vector2::new(-arm.y, arm.x) * self.velocity.z;
        v.push(self.velocity.z)
    }

    /// The largest distance (m) of a tile from the centre of mass.
    pub fn reach(&self, places: &[Vector3<f64>]) -> f64 {
        let arms = places.iter().map(|it| (it.xy() - self.centre).norm());
        arms.fold(0.0, f64::max)
    }
}

/// The time at which a gap (m) that changes as `gap + u t + a t^2 / 2` closes, and its velocity
/// then (m/s).
pub fn closes(gap: f64, u: f64, a: f64) -> Option<(f64, f64)> {
    let gap = gap.max(0.0);
    let square = u * u - 2.0 * a * gap;
    if square < 0.0 || (u >= 0.0 && a >= 0.0) {
        return None;
    }
    let speed = square.sqrt();
    let time = match u < 0.0 {
        true => 2.0 * gap / (speed - u),
        false => (u + speed) / -a,
    };
    Some((time, speed))
}
