//! A problem: a space of configurations, the energy on it, and the contact that blocks part of it.

mod equals;
mod room;
mod symmetry;

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};

use nalgebra::{Matrix3, Rotation2, Vector2, Vector3};

use crate::configuration::{Configuration, ConfigurationSpace};
use crate::contact::matching::matches;
use crate::contact::{Contact, Halves, Known};
use crate::interruption;
use crate::parallel;
use crate::potential::{
    BoxedBounds, CellBounds, Energy, Interaction, LazyBounds, Potential, Unbounded,
};
use crate::scale::Scale;
use crate::tile::{Face, Pair, face_to_face};

pub use equals::{Bond, Equal, of_faces};
pub use room::{NoRoom, Room};
pub use symmetry::Symmetry;

/// Counters for energy evaluations are spread over this many cache lines, so that threads do not
/// wait for each other.
const COUNTERS: usize = 64;

/// Fewer configurations are evaluated individually; the bits are the same.
const WORTH_A_BATCH: usize = 5;

/// More symmetries than these are very many: those of two tiles with eleven equal sides each, say.
const MANY_COPIES: usize = 100;

/// Two faces count as binding as strongly as the target from this fraction of its energy on.
const AS_STRONG: f64 = 0.95;
/// Configurations closer than this (m, metric of the space) are the same meeting.
const SAME: f64 = 1e-3;

/// Two faces, set flush against each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlushFaces {
    /// Which face of the fixed tile, which of the moving one.
    pub faces: (usize, usize),
    /// The configuration of the moving tile.
    pub configuration: Configuration,
    /// U there (J).
    pub energy: f64,
}

#[repr(align(128))]
#[derive(Default)]
struct Counter(AtomicU64);

/// An energy landscape over free configurations.
pub struct Problem {
    /// The space of configurations of the moving tile.
    pub space: ConfigurationSpace,
    /// The two tiles; `None` for analytic landscapes.
    pub pair: Option<Arc<Pair>>,
    /// `None` if nothing blocks a configuration (analytic landscapes).
    pub contact: Option<Contact>,
    /// Maps of configurations that change neither energy nor clearance, the identity first.
    pub symmetries: Vec<Symmetry>,
    /// The map that exchanges two equal tiles. It changes neither energy nor clearance, but is no
    /// turn of the plane: steps and gradients are not mapped by it.
    pub exchange: Option<Equal>,
    bonds: OnceLock<Vec<Bond>>,
    energy: Energy,
    centre_of_mass: Vector2<f64>,
    flush_meetings: OnceLock<Vec<Configuration>>,
    depth: OnceLock<f64>,
    evaluations: Vec<Counter>,
}

impl Problem {
    /// The problem of two tiles.
    pub fn new(space: ConfigurationSpace, pair: Arc<Pair>, interaction: &Interaction) -> Self {
        let energy = interaction.between(&pair.fixed, &pair.moving);
        Self {
            symmetries: match pair.only {
                true => vec![Symmetry::IDENTITY],
                false => Symmetry::all(&pair, &interaction.shields),
            },
            exchange: equals::exchange(&pair, &interaction.shields),
            ..Self::bare(space, energy).with_tiles(pair)
        }
    }

    /// The same energy with the contact of two tiles. No symmetry of the energy is assumed.
    pub fn with_tiles(self, pair: Arc<Pair>) -> Self {
        Self {
            contact: Some(Contact::new(&pair.fixed.outline, &pair.moving.outline)),
            centre_of_mass: pair.moving.outline.centroid(),
            pair: Some(pair),
            ..self
        }
    }

    /// An energy landscape without contact and without bounds.
    pub fn without_contact(
        space: ConfigurationSpace,
        potential: Box<dyn Potential + Send>,
    ) -> Self {
        let bounds = Err(Unbounded::Unknown);
        Self::bare(space, Energy { potential, bounds })
    }

    /// The same with bounds of its energy over cells.
    pub fn bounded_by(mut self, bounds: BoxedBounds) -> Self {
        self.energy.bounds = Ok(LazyBounds::new(Box::new(move || bounds)));
        self
    }

    fn bare(space: ConfigurationSpace, energy: Energy) -> Self {
        Self {
            space,
            pair: None,
            contact: None,
            symmetries: vec![Symmetry::IDENTITY],
            exchange: None,
            bonds: OnceLock::new(),
            energy,
            centre_of_mass: Vector2::zeros(),
            flush_meetings: OnceLock::new(),
            depth: OnceLock::new(),
            evaluations: (0..COUNTERS).map(|_| Counter::default()).collect(),
        }
    }

    /// Faces of the fixed and of the moving tile, for proposals near contact; none for analytic
    /// landscapes.
    pub fn faces(&self) -> [&[Face]; 2] {
        self.pair
            .as_ref()
            .map_or([&[], &[]], |pair| [&pair.fixed.faces, &pair.moving.faces])
    }

    /// Configurations near which minima are expected: the bound one, and every pair of faces flush
    /// against each other, pushed out into contact if their shapes overlap. None for analytic
    /// landscapes.
    pub fn flush_meetings(&self) -> &[Configuration] {
        self.flush_meetings.get_or_init(|| {
            let mut all: Vec<Configuration> = self.pair.iter().map(|pair| pair.bound).collect();
            let [fixed, moving] = self.faces();
            for fixed in fixed {
                for moving in moving {
                    let flush = face_to_face(fixed, moving, 0.0, 0.0);
                    let lift = self.lift(&flush, fixed.normal());
                    let position = flush.position() + fixed.normal() * lift;
                    let q = Configuration::new(position.x, position.y, flush.theta);
                    if self.is_free(&q) {
                        all.push(q);
                    }
                }
            }
            all
        })
    }

    /// The contacts that count as the bond, the intended one first: those equal to it by turns of
    /// the tiles onto themselves, by exchange of equal tiles, or because other faces are drawn alike
    /// and carry the same magnets. None for analytic landscapes.
    pub fn bonds(&self) -> &[Bond] {
        self.bonds.get_or_init(|| equals::bonds(self))
    }

    /// The distance (m, metric of the space) to the nearest contact that counts as the bond.
    pub fn distance_to_bond(&self, q: &Configuration) -> f64 {
        let distances = self
            .bonds()
            .iter()
            .map(|it| self.space.distance(q, &it.pose));
        distances.fold(f64::INFINITY, f64::min)
    }

    /// The configurations in which the outlines, regardless of magnets, touch along the greatest
    /// lengths, at most this many. None for analytic landscapes.
    pub fn matches(&self, most: usize) -> Vec<Configuration> {
        let found = self.contact.iter().flat_map(|it| matches(it, most));
        found.map(|it| it.pose).collect()
    }

    /// Whether one of the tiles has no magnets: U is zero everywhere.
    pub fn is_inert(&self) -> bool {
        let has_none =
            |pair: &Arc<Pair>| pair.fixed.magnets.is_empty() || pair.moving.magnets.is_empty();
        self.pair.as_ref().is_some_and(has_none)
    }

    /// The depth (J) by which energies are measured: that of the bound configuration or, if this
    /// does not attract, of the deepest flush contact of two faces.
    pub fn depth(&self) -> f64 {
        *self.depth.get_or_init(|| {
            let depths = self.flush_meetings().iter().map(|q| self.energy(q).abs());
            depths.fold(f64::MIN_POSITIVE, f64::max)
        })
    }

    /// The size of the tiles.
    #[inline]
    pub fn scale(&self) -> Scale {
        self.contact.as_ref().map_or(Scale::NONE, Contact::scale)
    }

    /// A length (m) given for the paper's tiles, scaled to these ([`Scale`]).
    #[inline]
    pub fn scaled(&self, told: f64) -> f64 {
        self.scale().length(told)
    }

    /// Whether an energy takes so long, because of very many magnets, that as few as possible are
    /// to be computed.
    pub fn is_expensive(&self) -> bool {
        self.potential().is_expensive()
    }

    /// Whether each state has so many copies that few of them are searched on their own.
    pub fn has_many_copies(&self) -> bool {
        self.symmetries.len() > MANY_COPIES
    }

    /// How far (m) the moving tile must move in a direction until the tiles do not overlap.
    pub fn lift(&self, q: &Configuration, direction: Vector2<f64>) -> f64 {
        self.contact
            .as_ref()
            .map_or(0.0, |contact| contact.lift(q, direction))
    }

    /// The energy's bounds over cells.
    ///
    /// # Errors
    /// If no such bounds are known.
    pub fn bounds(&self) -> Result<&dyn CellBounds, Unbounded> {
        match &self.energy.bounds {
            Ok(bounds) => Ok(bounds.as_ref()),
            Err(why) => Err(*why),
        }
    }

    /// The potential, whose evaluations are not counted.
    #[inline]
    pub fn potential(&self) -> &dyn Potential {
        self.energy.potential.as_ref()
    }

    /// U (J), counted.
    #[inline]
    pub fn energy(&self, q: &Configuration) -> f64 {
        self.count(1);
        self.energy.potential.energy(q)
    }

    /// U (J) of many configurations, counted.
    pub fn energies(&self, qs: &[Configuration]) -> Vec<f64> {
        self.count(qs.len() as u64);
        let potential = &self.energy.potential;
        if qs.len() < WORTH_A_BATCH {
            return qs.iter().map(|q| potential.energy(q)).collect();
        }
        let mut out = vec![0.0; qs.len()];
        potential.energies(qs, &mut out);
        out
    }

    /// U (J) and its gradient, counted as one evaluation.
    #[inline]
    pub fn energy_and_gradient(&self, q: &Configuration) -> (f64, Vector3<f64>) {
        self.count(1);
        self.energy.potential.energy_and_gradient(q)
    }

    /// The same for many configurations; `out` has the length of `qs`.
    pub fn energies_and_gradients(&self, qs: &[Configuration], out: &mut [(f64, Vector3<f64>)]) {
        self.count(qs.len() as u64);
        if qs.len() >= WORTH_A_BATCH {
            self.energy.potential.energies_and_gradients(qs, out);
            return;
        }
        for (q, result) in qs.iter().zip(out) {
            *result = self.energy.potential.energy_and_gradient(q);
        }
    }

    /// How many energies have been computed so far.
    pub fn evaluations(&self) -> u64 {
        self.evaluations
            .iter()
            .map(|counter| counter.0.load(Ordering::Relaxed))
            .sum()
    }

    fn count(&self, n: u64) {
        interruption::check();
        let thread = rayon::current_thread_index().map_or(0, |i| 1 + i);
        self.evaluations[thread % COUNTERS]
            .0
            .fetch_add(n, Ordering::Relaxed);
    }

    /// Whether the configuration is on the table and the tiles do not overlap.
    pub fn is_free(&self, q: &Configuration) -> bool {
        self.space.contains(q) && self.is_clear(q)
    }

    /// Whether the tiles do not overlap.
    pub fn is_clear(&self, q: &Configuration) -> bool {
        interruption::check();
        self.contact
            .as_ref()
            .is_none_or(|contact| contact.is_free(q))
    }

    /// Signed clearance (m); infinite for a landscape without contact.
    pub fn clearance(&self, q: &Configuration) -> f64 {
        self.contact
            .as_ref()
            .map_or(f64::INFINITY, |contact| contact.clearance(q))
    }

    /// Whether the straight motion between two free configurations is free.
    pub fn motion_is_free(&self, a: &Configuration, b: &Configuration) -> bool {
        self.contact
            .as_ref()
            .is_none_or(|contact| contact.motion_is_free(a, b))
    }

    /// A cheap lower bound of the clearance (m).
    pub fn clearance_bound(&self, q: &Configuration) -> f64 {
        self.contact
            .as_ref()
            .map_or(f64::INFINITY, |contact| contact.clearance_bound(q))
    }

    /// Whether a cheap test shows that the tiles are at least `least` (m) apart.
    pub fn has_room(&self, q: &Configuration, least: f64) -> bool {
        self.contact
            .as_ref()
            .is_none_or(|contact| contact.is_clear_by(q, least))
    }

    /// The pairs of configurations, given by their indices, between which the straight motion is
    /// free, in the given order.
    pub fn free_motions(
        &self,
        configurations: &[Configuration],
        pairs: &[(u32, u32)],
    ) -> Vec<(u32, u32)> {
        // Once for each configuration, not for each pair.
        let known = parallel::map(configurations, |q| self.known(q));
        let end = |end: u32| &known[end as usize];
        let is_free = self.free_among(pairs.len(), |pair| [end(pairs[pair].0), end(pairs[pair].1)]);
        let free = pairs.iter().zip(is_free).filter(|(_, is_free)| *is_free);
        free.map(|(pair, _)| *pair).collect()
    }

    /// Whether each of this many motions is free; `ends` gives the known contact data of its start
    /// and end.
    pub fn free_among<'a>(
        &self,
        count: usize,
        ends: impl Fn(usize) -> [&'a Option<Known>; 2] + Sync,
    ) -> Vec<bool> {
        /// Number of motions that share working memory.
        const BATCH: usize = 64;
        parallel::flat_map(0..count.div_ceil(BATCH), |part| {
            let mut left = Halves::default();
            let motions = part * BATCH..count.min((part + 1) * BATCH);
            let is_free = |motion| self.known_motion_is_free(ends(motion), &mut left);
            motions.map(is_free).collect::<Vec<_>>()
        })
    }

    /// The contact data of a configuration, used by every motion from or to it; `None` without
    /// contact.
    #[inline]
    pub fn known(&self, q: &Configuration) -> Option<Known> {
        self.contact.as_ref().map(|contact| contact.known(*q))
    }

    /// Whether the straight motion between two free configurations is free, given their contact
    /// data; `left` is working memory.
    pub fn known_motion_is_free(&self, [a, b]: [&Option<Known>; 2], left: &mut Halves) -> bool {
        interruption::check();
        let (Some(contact), Some(a), Some(b)) = (&self.contact, a, b) else {
            return true;
        };
        contact.known_motion_overlaps_at_most([a, b], contact.touch(), left)
    }

    /// Whether the tiles overlap by at most `allowed` (m) all along the straight motion between two
    /// free configurations.
    pub fn motion_overlaps_at_most(
        &self,
        a: &Configuration,
        b: &Configuration,
        allowed: f64,
    ) -> bool {
        self.contact
            .as_ref()
            .is_none_or(|contact| contact.motion_overlaps_at_most(a, b, allowed))
    }

    /// The pairs of faces that unintentionally bind as strongly as the target: flush against each
    /// other, pushed out into contact if their shapes overlap, they have at least 0.95 of the
    /// bond's energy. Contacts that count as the bond are not included. Slid and tilted contacts are
    /// not considered.
    pub fn rivals(&self) -> Vec<FlushFaces> {
        let Some(pair) = &self.pair else {
            return Vec::new();
        };
        let potential = self.potential();
        let bond = potential.energy(&pair.bound);
        if bond >= 0.0 {
            return Vec::new();
        }
        let [fixed, moving] = self.faces();
        let pairs = (0..fixed.len()).flat_map(|f| (0..moving.len()).map(move |m| (f, m)));
        let meetings = pairs.map(|(f, m)| {
            let flush = face_to_face(&fixed[f], &moving[m], 0.0, 0.0);
            let lift = self.lift(&flush, fixed[f].normal());
            let position = flush.position() + fixed[f].normal() * lift;
            let configuration = Configuration::new(position.x, position.y, flush.theta);
            FlushFaces {
                faces: (f, m),
                configuration,
                energy: potential.energy(&configuration),
            }
        });
        let is_wanted = |meeting: &FlushFaces| {
            meeting.faces == pair.target
                || self.distance_to_bond(&meeting.configuration) < self.scaled(SAME)
        };
        let is_strong = |meeting: &FlushFaces| {
            meeting.energy <= AS_STRONG * bond && self.is_free(&meeting.configuration)
        };
        meetings
            .filter(|meeting| is_strong(meeting) && !is_wanted(meeting))
            .collect()
    }

    /// The moving tile's mass matrix over its mass, about its reference point: kinetic energy is
    /// `m/2 v^T M v` for v = (dx/dt, dy/dt, dtheta/dt). With the centre of mass at c (world
    /// frame) and the radius of gyration rho about the reference point,
    /// `M = [[1, 0, -c_y], [0, 1, c_x], [-c_y, c_x, rho^2]]`.
    #[inline]
    pub fn mass_metric(&self, theta: f64) -> Matrix3<f64> {
        let mut c = self.centre_of_mass;
        if c != Vector2::zeros() {
            c = Rotation2::new(theta) * c;
        }
        let rho2 = self.space.rho * self.space.rho;
        Matrix3::new(1.0, 0.0, -c.y, 0.0, 1.0, c.x, -c.y, c.x, rho2)
    }

    /// The diffusion of (x, y, theta) over that of the moving tile's centre of mass, with drag in
    /// proportion to the mass: the inverse of [`Self::mass_metric`]. If both tiles move, a step (a, b)
    /// and a turn w of the fixed one about its centre of mass f change a configuration at p, which is
    /// seen from it, by `(-a + w (p - f)_y, -b - w (p - f)_x, -w)`.
    pub fn mobility(&self, q: &Configuration, both_move: bool) -> Matrix3<f64> {
        let inverse = self.mass_metric(q.theta).try_inverse();
        let own = inverse.unwrap_or_else(Matrix3::identity);
        let Some(pair) = self.pair.as_deref().filter(|_| both_move) else {
            return own;
        };
        let tile = &pair.fixed;
        let arm = q.position() - tile.outline.centroid();
        let turn = Vector3::new(arm.y, -arm.x, -1.0);
        let steps = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 0.0));
        let others = steps + turn * turn.transpose() * (tile.mass / tile.inertia());
        own + others * (pair.moving.mass / tile.mass)
    }
}
