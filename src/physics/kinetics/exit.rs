//! How soon a tile leaves a configuration, and where it comes first.

use super::certify::narrowed;
use super::corridor::Way;
use super::ends::Ends;
use super::field::{DIVIDED, Earlier, Field};
use super::mesh::Nodes;
use super::proof::{self, Capacity};
use super::results::{DEEPEST, MESHES, enough};
pub use super::results::{Exit, ExitError, ExitSettings, MeshExit, half_bond};
use crate::configuration::Configuration;
use crate::problem::Problem;

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
