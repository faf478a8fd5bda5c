//! How soon a tile leaves a configuration, and where it comes first.

use super::certify::{Certify, narrowed};
use super::corridor::Way;
use super::ends::Ends;
use super::field::{DIVIDED, Earlier, Field};
use super::mesh::{Nodes, Unsolved};
use super::proof::{self, Capacity};
use super::rates::{DEEPEST, enough};
use crate::configuration::Configuration;
use crate::problem::Problem;
use crate::units::si;

/// Meshes at least: from the last two the error is told.
const MESHES: usize = 3;
/// What is asked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExitSettings {
    /// Effective energy of shaking (J).
    pub kt: f64,
    /// Where the tile starts.
    pub start: Configuration,
    /// The tile is bound where U (J) is lower, in the basin of the bond.
    pub basin_energy: f64,
    /// The tile is free where the reference points are so far apart (m).
    pub free_at: f64,
    /// Estimated relative error of the solution's energy at which the mesh is fine enough.
    pub tolerance: f64,
    /// Unknowns at which it is fine enough anyway, if they are half as many again as the first
    /// mesh's or more.
    pub unknowns: usize,
    /// Relative distance of the bounds of the mean exit time that is asked for; without it none are found.
    pub certify: Option<Certify>,
}

impl ExitSettings {
    /// Of a start, kT (J) and the ends; the mesh as fine as it is worth.
    pub fn new(kt: f64, start: Configuration, basin_energy: f64, free_at: f64) -> Self {
        Self {
            kt,
            start,
            basin_energy,
            free_at,
            tolerance: 0.015,
            unknowns: 60_000,
            certify: Some(Certify::default()),
        }
    }
}

/// Half the bond's energy (J), below which a tile is bound where nothing else is asked.
pub fn half_bond(problem: &Problem, bound: &Configuration) -> f64 {
    0.5 * problem.energy(bound)
}

/// What one mesh says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshExit {
    /// Mean exit time times D (m^2).
    pub time: f64,
    /// Probability that the tile is bound before it is free.
    pub bound: f64,
    /// Unknowns of the mesh.
    pub unknowns: usize,
    /// Estimated relative error of the solution's energy.
    pub error: f64,
    /// What of it is due to the bond's basin being made of whole cells.
    pub of_rims: f64,
}

/// The exit from a configuration.
#[derive(Clone, Debug, PartialEq)]
pub struct Exit {
    /// What the meshes say, each finer than the last.
    pub meshes: Vec<MeshExit>,
    /// Bounds of the mean exit time times D (m^2) on other meshes, each finer than the last: of a
    /// tile that starts in the well about the start, where it is last left. They hold but for what
    /// the integrals over cells are off by. None where the start lies in no well; from below only,
    /// the upper ones infinite, where rays may leave contact more than once.
    pub bounds: Vec<[f64; 2]>,
    /// What lies midway between the bounds, if the finest mesh's mean exit time does not lie between
    /// them: far below the passes cells that do not begin at contact may be too coarse for what the
    /// well holds.
    pub midway: Option<f64>,
    /// Proved bounds of the capacity of the well about the start, half way up to the pass, against
    /// the ends, where they are asked for and can be had.
    pub proved: Option<Capacity>,
    /// Whether a way leads from the start to free tiles.
    pub way: Way,
}

impl Exit {
    /// The mean exit time times D (m^2).
    pub fn time(&self) -> f64 {
        self.midway.unwrap_or(self.finest().time)
    }

    /// What the finest mesh says.
    pub fn finest(&self) -> MeshExit {
        *self.meshes.last().expect("there is a mesh")
    }

    /// The narrowest bounds of the mean exit time times D (m^2).
    pub fn bracket(&self) -> Option<[f64; 2]> {
        self.bounds.last().copied()
    }

    /// By how much the two finest meshes differ: in the mean exit time, relative, and in the
    /// probability. An estimate of the error, no bound.
    pub fn spread(&self) -> [f64; 2] {
        let [.., before, last] = self.meshes[..] else {
            return [f64::INFINITY; 2];
        };
        [
            ((last.time - before.time) / last.time).abs(),
            (last.bound - before.bound).abs(),
        ]
    }
}

/// Why there is no answer.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ExitError {
    /// The tiles overlap at the start, with this clearance (m).
    #[error(
        "the tiles overlap by {:.4} mm at the start {},{},{}: choose a pose whose clearance is not \
         negative (`tilebind energy` prints it)", -1e3 * .1, .0.x, .0.y, .0.theta
    )]
    Overlap(Configuration, f64),
    /// A pose lies beyond the distance (m) at which tiles are free.
    #[error(
        "the centres are {:.4} m apart at {}, and tiles count as free from {:.4} m on: choose a \
         larger --free-at or another start", .0, .1, .2
    )]
    Free(f64, &'static str, f64),
    /// The limit (J) of the bond's basin is not above the bond's energy (J).
    #[error(
        "no configuration of the bond lies below the basin energy of {}: the bond has {}; choose a \
         --basin-energy between that and 0", si(*.0, "J", 4), si(*.1, "J", 4)
    )]
    NoBasin(f64, f64),
    /// The start lies in the bond's basin.
    #[error(
        "the start lies in the bond's basin, which reaches up to {}: choose a lower --basin-energy \
         or another start", si(*.0, "J", 4)
    )]
    Bound(f64),
    /// The bond's basin reaches to where tiles are free.
    #[error(
        "configurations below the basin energy of {} lead from the bond to where tiles are free: \
         choose a lower --basin-energy", si(*.0, "J", 4)
    )]
    Open(f64),
    /// The mesh has no way from the start to an end.
    #[error(
        "no way leads from the start to the bond or to where tiles are free; {}", .0.told()
    )]
    Closed(Way),
    /// At this kT (J) the start lies so many kT deep.
    #[error(
        "at kT = {} the start is {:.0} kT deep, and no tile ever leaves it; exits are told up to \
         {DEEPEST} kT: choose a larger --kt", si(*.0, "J", 4), .1
    )]
    Cold(f64, f64),
    /// The mean exit time is no number any more.
    #[error("at kT = {} no tile ever leaves: choose a larger --kt", si(*.0, "J", 4))]
    Never(f64),
    /// A linear system could not be solved.
    #[error(transparent)]
    Unsolved(#[from] Unsolved),
}

/// From a start to the first of two ends: the bond's basin and where tiles are free. All that the
/// pair's symmetries map onto each other is one.
///
/// # Errors
/// Where the start or an end makes no sense, and where a linear system could not be solved.
pub fn exit(
    problem: &Problem,
    bond: &Configuration,
    settings: &ExitSettings,
) -> Result<Exit, ExitError> {
    let start = settings.start;
    check(problem, bond, settings)?;
    let seeds = [start, *bond];
    let ground = problem.energy(&start);
    let mut field = Field::new(problem, settings.kt, settings.free_at, ground, &seeds);
    let way = field.open_way(&start);
    let mut earlier: Option<Earlier> = None;
    let mut meshes = Vec::new();
    let mut grows = true;
    loop {
        let ends = Ends::new(&mut field, bond, settings, way)?;
        let nodes = Nodes::new(&field.mesh);
        let (found, functions) = ends.solve(&field, &nodes, &start, earlier.as_ref())?;
        if !(found.time.is_finite() && found.time > 0.0) {
            return Err(ExitError::Never(settings.kt));
        }
        let errors = field.errors(
            &nodes,
            &ends.rims(&field),
            &functions.iter().collect::<Vec<_>>(),
        );
        meshes.push(MeshExit {
            error: errors.largest,
            of_rims: errors.of_rims,
            ..found
        });
        let is_fine = errors.largest < settings.tolerance && meshes.len() >= MESHES;
        if is_fine || found.unknowns > enough(settings.unknowns, meshes[0].unknowns) || !grows {
            let (mut bounds, proved) = bounds(problem, bond, settings)?;
            if let (Some(_), true) = (settings.certify, bounds.is_empty()) {
                let lower = ends.lower_bound(&field, &nodes)?;
                bounds.extend(lower.map(|lower| [lower, f64::INFINITY]));
            }
            let own = meshes[meshes.len() - 1].time;
            let mut midway = None;
            if let Some(&[lower, upper]) = bounds.last()
                && !(lower..=upper).contains(&own)
            {
                // A start that is not deep in its well may well take a time that the well does not.
                match ends.is_deep() && upper.is_finite() {
                    true => midway = Some((lower * upper).sqrt()),
                    false => bounds.clear(),
                }
            }
            return Ok(Exit {
                meshes,
                bounds,
                midway,
                proved,
                way,
            });
        }
        grows = field.refine(&errors.shares, DIVIDED);
        earlier = Some((nodes, functions));
    }
}

/// Bounds of the mean exit time times D (m^2), on ever finer meshes that begin at contact, and on
/// the last the proved ones of the capacity.
fn bounds(
    problem: &Problem,
    bond: &Configuration,
    settings: &ExitSettings,
) -> Result<(Vec<[f64; 2]>, Option<Capacity>), ExitError> {
    let ground = problem.energy(&settings.start);
    let seeds = [settings.start, *bond];
    let fitted = Field::fitted(problem, settings.kt, settings.free_at, ground, &seeds);
    let (Some(certify), Some(mut field)) = (settings.certify, fitted) else {
        return Ok((Vec::new(), None));
    };
    let all = narrowed(&mut field, &certify, |field| {
        let ends = Ends::new(field, bond, settings, Way::Open)?;
        let nodes = Nodes::new(&field.mesh);
        Ok::<_, ExitError>(ends.bounds(field, &nodes)?)
    })?;
    let proved = certify.proof().and_then(|asked| {
        let sets = Ends::sets(&field, bond, settings);
        proof::capacity(&mut field, &sets, asked)
    });
    Ok((all.iter().map(|step| step.bounds[0]).collect(), proved))
}

fn check(problem: &Problem, bond: &Configuration, asked: &ExitSettings) -> Result<(), ExitError> {
    for (q, name) in [(&asked.start, "the start"), (bond, "the bond")] {
        let distance = libm::hypot(q.x, q.y);
        if distance >= asked.free_at {
            return Err(ExitError::Free(distance, name, asked.free_at));
        }
    }
    if !problem.is_clear(&asked.start) {
        let clearance = problem.clearance(&asked.start);
        return Err(ExitError::Overlap(asked.start, clearance));
    }
    let depth = -problem.energy(&asked.start) / asked.kt;
    if depth > DEEPEST {
        return Err(ExitError::Cold(asked.kt, depth));
    }
    let energy = problem.energy(bond);
    if energy >= asked.basin_energy {
        return Err(ExitError::NoBasin(asked.basin_energy, energy));
    }
    Ok(())
}
