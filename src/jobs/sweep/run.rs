//! Computes the points of a sweep.

use std::any::Any;
use std::collections::HashSet;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use super::plan::Plan;
use super::point::SweepPoint;
use super::store::Outcome;
use crate::comparison;
use physics::interruption;
use physics::observer::Silent;

/// Computes points, up to `threads` at a time; calls `finished` for each, from any thread. Points
/// with the same name are computed once.
///
/// # Errors
/// The first error of `finished`, after which no further point is started.
pub fn run<E: Send>(
    plan: &Plan,
    points: &[SweepPoint],
    threads: usize,
    finished: impl Fn(&SweepPoint, &Outcome) -> Result<(), E> + Sync,
) -> Result<(), E> {
    let mut names = HashSet::new();
    let points: Vec<&SweepPoint> = points.iter().filter(|p| names.insert(&p.name)).collect();
    let workers = threads.clamp(1, points.len().max(1));
    let next = AtomicUsize::new(0);
    let stopped = AtomicBool::new(false);
    let failure = Mutex::new(None);
    let work = || {
        while !stopped.load(Ordering::Relaxed) {
            let Some(point) = points.get(next.fetch_add(1, Ordering::Relaxed)) else {
                return;
            };
            let Some(outcome) = outcome(plan, point) else {
                stopped.store(true, Ordering::Relaxed);
                return;
            };
            if let Err(error) = finished(point, &outcome) {
                stopped.store(true, Ordering::Relaxed);
                let mut failure = failure.lock().unwrap_or_else(PoisonError::into_inner);
                failure.get_or_insert(error);
            }
        }
    };
    // Each worker has a thread pool of its own: in a shared one, a worker that waits for part of
    // its point would start another point meanwhile.
    let interruption = interruption::current();
    let pool = || interruption::pool(threads / workers, interruption.clone());
    std::thread::scope(|scope| {
        for _ in 0..workers {
            scope.spawn(|| match pool() {
                Ok(pool) => pool.install(work),
                // Without a pool of its own the worker uses the common one.
                Err(_) => work(),
            });
        }
    });
    interruption::check();
    let failure = failure.into_inner().unwrap_or_else(PoisonError::into_inner);
    failure.map_or(Ok(()), Err)
}

/// The outcome of a point; `None` if the work was interrupted.
fn outcome(plan: &Plan, point: &SweepPoint) -> Option<Outcome> {
    let assessed = catch_unwind(AssertUnwindSafe(|| {
        let design = plan.design(point)?;
        Ok(comparison::assess(
            &design,
            &plan.settings,
            plan.seed,
            &Silent,
        ))
    }));
    Some(match assessed {
        Ok(Ok(result)) => Outcome::Done {
            result: Box::new(result),
        },
        Ok(Err(reason)) => Outcome::Impossible { reason },
        Err(fault) if interruption::is_interrupted(fault.as_ref()) => return None,
        Err(panic) => Outcome::Failed {
            reason: message(panic.as_ref()),
        },
    })
}

/// The message of a panic.
fn message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned())
        .unwrap_or_else(|| "the analysis crashed".to_owned())
}
