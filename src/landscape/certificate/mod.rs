//! Certified barriers: the minimax energy between two configurations, between two bounds.
mod flood;
mod lower;
mod store;
mod upper;

use std::time::{Duration, Instant};

use rayon::prelude::*;

use crate::cell::Cell;
use crate::configuration::{Configuration, ConfigurationSpace};
use crate::contact::Contact;
use crate::contact::cells::ContactCells;
use crate::contact::sweep::Sweep;
use crate::potential::bounds::CellBounds;

use flood::{Seeds, least_level, watershed};
use lower::{Assessment, assess};
use store::{Key, Leaf, Store};
use upper::{PathProof, ProvedPath};

/// Where a certified path ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum End {
    At(Configuration),
    /// Any configuration with the tiles far apart, as the configuration space has it.
    Free,
}

impl End {
    /// The configuration, where it is a single one.
    pub fn configuration(&self) -> Option<&Configuration> {
        match self {
            Self::At(q) => Some(q),
            Self::Free => None,
        }
    }
}

/// How narrow a bracket is wanted and how much work it is worth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Width (J) at which to stop.
    pub tolerance: f64,
    /// Cells assessed at most, in this query. The result depends on nothing else.
    pub cells: usize,
    /// Time after which to stop with what is known; makes the result depend on the machine.
    pub time: Option<Duration>,
}

/// Bounds of a barrier's highest energy.
#[derive(Clone, Debug, PartialEq)]
pub struct Bracket {
    /// Every free path between the ends reaches at least this energy (J).
    pub lower: f64,
    /// Some free path stays at or below this energy (J): the pathway. `None` where none is known.
    pub upper: Option<f64>,
    /// Proved that no free path joins the ends at all.
    pub caged: bool,
    /// The proved pathway, from end to end.
    pub pathway: Vec<Configuration>,
    /// Where the pathway is highest.
    pub saddle: Option<Configuration>,
    /// Whether the pathway was found by the certificate and is lower than the one it was given.
    pub improved: bool,
    /// Cells assessed for this query, and rounds of subdivision.
    pub cells: usize,
    pub rounds: usize,
}

/// Which of two barriers is higher.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ordering {
    Higher,
    Lower,
    Undecided,
}

impl Bracket {
    /// Width (J); infinite where there is no upper bound.
    pub fn width(&self) -> f64 {
        self.upper.map_or(f64::INFINITY, |upper| upper - self.lower)
    }

    /// Whether this barrier's highest energy is proved higher or lower than the other's. A barrier
    /// without any way over it is higher than one with a way.
    pub fn compare(&self, other: &Self) -> Ordering {
        if other.upper.is_some_and(|upper| self.lower > upper) {
            Ordering::Higher
        } else if self.upper.is_some_and(|upper| upper < other.lower) {
            Ordering::Lower
        } else {
            Ordering::Undecided
        }
    }
}

/// Why nothing could be certified.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum CertifyError {
    #[error("the tiles overlap at ({}, {}, {})", .0.x, .0.y, .0.theta)]
    NotFree(Configuration),
    #[error("({}, {}) lies off the table", .0.x, .0.y)]
    OffTheTable(Configuration),
}

/// The tiles' contact, in the forms that the two bounds need.
struct Obstacles<'a> {
    contact: &'a Contact,
    cells: ContactCells,
    sweep: Sweep,
}

impl<'a> Obstacles<'a> {
    fn new(contact: &'a Contact) -> Self {
        Self {
            contact,
            cells: ContactCells::new(contact),
            sweep: Sweep::new(contact),
        }
    }
}

/// Certifies barriers of one landscape. What one query finds out about the landscape serves the
/// next ones.
pub struct Certifier<'a> {
    bounds: &'a dyn CellBounds,
    contact: Option<Obstacles<'a>>,
    space: &'a ConfigurationSpace,
    lever: f64,
    store: Store,
    assessed: usize,
}

/// Leaves subdivided in one round at least, if the divide has as many.
const SPLITS: usize = 256;

/// Halvings of a cell of the divide in one round.
const HALVINGS: usize = 3;

impl<'a> Certifier<'a> {
    /// A certifier for the energy `bounds` over the configurations of `space` in which the tiles
    /// of `contact`, if any, do not overlap.
    pub fn new(
        bounds: &'a dyn CellBounds,
        contact: Option<&'a Contact>,
        space: &'a ConfigurationSpace,
    ) -> Self {
        let mut certifier = Self {
            bounds,
            contact: contact.map(Obstacles::new),
            space,
            lever: contact.map_or(space.rho, |contact| contact.moving().circumradius()),
            store: Store::new(space),
            assessed: 0,
        };
        let first = certifier.assess_all(Store::first_keys());
        certifier.store.fill(&first);
        certifier
    }

    /// Brackets the minimax energy from `from` to `to`. `known` is a pathway between them, if one
    /// is known; it need not be exactly free, as it is lifted off contact where it touches.
    ///
    /// # Errors
    /// Where an end is not free or not on the table.
    pub fn bracket(
        &mut self,
        from: &Configuration,
        to: &End,
        known: &[Configuration],
        effort: &Effort,
    ) -> Result<Bracket, CertifyError> {
        self.check(from)?;
        if let End::At(to) = to {
            self.check(to)?;
        }
        let start = Instant::now();
        let assessed = self.assessed;
        let tolerance = effort.tolerance;
        let mut best = self
            .proof()
            .prove(known, tolerance / 20.0, f64::INFINITY)
            .ok();
        // The ends are on every path.
        let floor = [Some(from), to.configuration()]
            .into_iter()
            .flatten()
            .map(|q| {
                let (value, rounding) = self.proof().value(q);
                value - rounding
            })
            .fold(f64::NEG_INFINITY, f64::max);
        let mut improved = false;
        let mut rounds = 0;
        let mut caged = false;
        loop {
            let level = best
                .as_ref()
                .map_or(f64::INFINITY, |path| path.upper - tolerance);
            let found = watershed(&self.store, &self.seeds(from, to), level);
            if std::env::var("CERT").is_ok() {
                eprintln!(
                    "round {rounds} level {:.4} pass {:?} divide {} leaves {} live {} cells {} t {:?} best {:?}",
                    level * 1e3,
                    found.pass.as_ref().map(|p| (p.0 * 1e3, p.1.len())),
                    found.divide.len(),
                    self.store.len(),
                    self.store.live().count(),
                    self.assessed - assessed,
                    start.elapsed(),
                    best.as_ref().map(|b| b.upper * 1e3)
                );
            }
            let Some((pass, chain)) = found.pass else {
                caged = best.is_none();
                break;
            };
            if level <= floor {
                break;
            }
            let mut parts = found.divide;
            parts.truncate((self.store.len() / 16).max(SPLITS));
            let worthwhile = level + 0.75 * tolerance;
            if pass < worthwhile {
                let (path, owners) = self.path_along(from, to, &chain);
                match self
                    .proof()
                    .prove(&path, tolerance / 20.0, level + 0.9 * tolerance)
                {
                    Ok(path) => {
                        improved = !known.is_empty();
                        best = Some(path);
                        continue;
                    }
                    Err(point) => {
                        let blamed =
                            owners[point.saturating_sub(1)..(point + 1).min(owners.len())].iter();
                        parts.extend(blamed);
                        parts.sort_unstable();
                        parts.dedup();
                    }
                }
            }
            let exhausted = self.assessed - assessed >= effort.cells
                || effort.time.is_some_and(|limit| start.elapsed() >= limit);
            if exhausted || !self.subdivide(&parts, level) {
                break;
            }
            rounds += 1;
        }
        let lower = least_level(&self.store, &self.seeds(from, to));
        let lower = lower.max(floor);
        let (upper, pathway, saddle) = match best {
            Some(ProvedPath {
                upper,
                peak,
                points,
            }) => (Some(upper), points, Some(peak)),
            None => (None, Vec::new(), None),
        };
        Ok(Bracket {
            lower,
            upper,
            caged,
            pathway,
            saddle,
            improved,
            cells: self.assessed - assessed,
            rounds,
        })
    }

    /// Cells assessed so far, over all queries.
    pub fn assessed(&self) -> usize {
        self.assessed
    }

    fn check(&self, q: &Configuration) -> Result<(), CertifyError> {
        if !self.space.contains(q) {
            return Err(CertifyError::OffTheTable(*q));
        }
        match &self.contact {
            Some(obstacles) if !obstacles.contact.is_free(q) => Err(CertifyError::NotFree(*q)),
            _ => Ok(()),
        }
    }

    fn proof(&self) -> PathProof<'_> {
        PathProof {
            bounds: self.bounds,
            contact: self
                .contact
                .as_ref()
                .map(|known| (known.contact, &known.sweep)),
            rho: self.space.rho,
        }
    }

    fn assess(&self, key: &Key) -> Option<Assessment> {
        let cells = self.contact.as_ref().map(|known| &known.cells);
        assess(self.bounds, cells, self.lever, &self.store.cell(key))
    }

    fn assess_all(&mut self, keys: Vec<Key>) -> Vec<(Key, Assessment)> {
        self.assessed += keys.len();
        keys.into_par_iter()
            .filter_map(|key| Some((key, self.assess(&key)?)))
            .collect()
    }

    /// The parts of a leaf after a few halvings of what stays passable, and how many cells were
    /// assessed.
    fn parts(&self, key: &Key, axis: usize, level: f64) -> (Vec<(Key, Assessment)>, usize) {
        let mut done = Vec::new();
        let mut assessed = 0;
        let mut open = vec![(*key, axis, 0)];
        while let Some((key, axis, depth)) = open.pop() {
            let Some(halves) = key.halves(axis) else {
                continue;
            };
            assessed += 2;
            for half in halves {
                let Some(known) = self.assess(&half) else {
                    continue;
                };
                let divisible = half.halves(known.axis).is_some();
                if depth + 1 < HALVINGS && known.lower <= level && divisible {
                    open.push((half, known.axis, depth + 1));
                } else {
                    done.push((half, known));
                }
            }
        }
        (done, assessed)
    }

    /// Subdivides leaves; false if none can be.
    fn subdivide(&mut self, ids: &[u32], level: f64) -> bool {
        let divisible: Vec<u32> = ids
            .iter()
            .copied()
            .filter(|&id| {
                let leaf = self.store.leaf(id);
                leaf.key.halves(leaf.known.axis).is_some()
            })
            .collect();
        let parts: Vec<_> = divisible
            .par_iter()
            .map(|&id| {
                let leaf = self.store.leaf(id);
                self.parts(&leaf.key, leaf.known.axis, level)
            })
            .collect();
        for (&id, (parts, assessed)) in divisible.iter().zip(&parts) {
            self.store.replace(id, parts);
            self.assessed += assessed;
        }
        !divisible.is_empty()
    }

    /// The leaves that hold either end.
    fn seeds(&self, from: &Configuration, to: &End) -> Seeds {
        let holding = |holds: &dyn Fn(&Leaf, &Cell) -> Option<f64>| {
            self.store
                .live()
                .filter_map(|(id, leaf)| Some((id, holds(leaf, &self.store.cell(&leaf.key))?)))
                .collect()
        };
        let at = |q: &Configuration, cell: &Cell| cell.contains(q).then_some(f64::NEG_INFINITY);
        Seeds {
            from: holding(&|_, cell| at(from, cell)),
            to: match to {
                End::At(to) => holding(&|_, cell| at(to, cell)),
                End::Free => holding(&|leaf, cell| {
                    if self.space.is_far(&cell.centre) {
                        return Some(leaf.known.estimate);
                    }
                    let end = self.far_end(cell)?;
                    Some(self.proof().value(&end).0)
                }),
            },
        }
    }

    /// A configuration with the tiles far apart, near the middle of a cell that holds one.
    fn far_end(&self, cell: &Cell) -> Option<Configuration> {
        if !self.space.is_far(&farthest(cell)) {
            return None;
        }
        let centre = cell.centre;
        let distance = centre.x.hypot(centre.y);
        let stretch = (self.space.free_distance / distance).max(1.0) * (1.0 + 1e-12);
        let end = Configuration::new(centre.x * stretch, centre.y * stretch, centre.theta);
        [end, farthest(cell)]
            .into_iter()
            .find(|end| self.space.contains(end) && self.space.is_far(end))
    }

    /// A polyline along a chain of leaves: from end to end through the leaves' centres and the
    /// middles of what consecutive ones have in common. With each point comes its leaf.
    fn path_along(
        &self,
        from: &Configuration,
        to: &End,
        chain: &[u32],
    ) -> (Vec<Configuration>, Vec<u32>) {
        let mut path = vec![(*from, chain[0])];
        for (k, &id) in chain.iter().enumerate().skip(1) {
            path.push((self.store.between(chain[k - 1], id), id));
            if k + 1 < chain.len() {
                path.push((self.store.cell(&self.store.leaf(id).key).centre, id));
            }
        }
        let last = chain[chain.len() - 1];
        let end = match to {
            End::At(to) => Some(*to),
            End::Free => self.far_end(&self.store.cell(&self.store.leaf(last).key)),
        };
        path.extend(end.map(|end| (end, last)));
        path.into_iter().unzip()
    }
}

/// The configuration of a cell that is farthest from the origin in the plane, at the cell's middle
/// angle.
fn farthest(cell: &Cell) -> Configuration {
    let away = |c: f64, h: f64| c + h.copysign(c);
    Configuration::new(
        away(cell.centre.x, cell.half[0]),
        away(cell.centre.y, cell.half[1]),
        cell.centre.theta,
    )
}
