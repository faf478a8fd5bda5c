//! Runs long work on threads of its own, without the interpreter's lock; it shows progress and
//! heeds ctrl-C.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use pyo3::prelude::*;
use tilebind::interruption::{Interrupted, Interruption};
use tilebind::memory;
use tilebind::observer::Observer;
use tilebind::request::Unanswered;

use crate::fault;

/// Interval of checking signals and progress.
const LOOK: Duration = Duration::from_millis(50);

/// The progress reported by the work.
#[derive(Default)]
pub struct Told(Mutex<(f64, String)>, Mutex<Vec<String>>);

impl Told {
    /// Reports the finished share (0 to 1) and the name of the next stage.
    pub fn tell(&self, share: f64, text: String) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = (share, text);
    }

    fn last(&self) -> (f64, String) {
        self.0
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone()
    }
}

impl Observer for Told {
    fn stage(&self, name: &'static str, share: f64) {
        self.tell(share, name.to_owned());
    }

    fn part(&self, name: &'static str, done: usize, count: usize) {
        let mut told = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        told.1 = format!("{name}, {done} of {count}");
    }

    fn warn(&self, what: &str) {
        let mut warnings = self.1.lock().unwrap_or_else(PoisonError::into_inner);
        warnings.push(what.to_owned());
    }
}

/// Threads of a job: `RAYON_NUM_THREADS`, or else all cores. (No pool is shared: a forked process
/// would wait for its threads forever.)
pub fn threads() -> usize {
    let asked = std::env::var("RAYON_NUM_THREADS").ok();
    let asked = asked.and_then(|text| text.parse().ok()).filter(|n| *n > 0);
    asked.unwrap_or_else(|| thread::available_parallelism().map_or(1, usize::from))
}

/// Runs long work, with a bar unless `progress` is false (or `None` and nobody would see it).
pub fn run<T: Send>(
    py: Python<'_>,
    progress: Option<bool>,
    work: impl FnOnce(&Told) -> T + Send,
) -> PyResult<T> {
    let bar = match progress {
        Some(false) => None,
        _ => {
            let module = py.import("tilebind._progress")?;
            let bar = module.call_method1("bar", (progress,))?;
            (!bar.is_none()).then(|| bar.unbind())
        }
    };
    let done = attend(py, bar.as_ref(), work);
    if let Some(bar) = bar {
        bar.call_method0(py, "close")?;
    }
    done
}

/// Runs long work that can fail, with a bar as for [`run`].
pub fn answer<T: Send, E: Unanswered + Send>(
    py: Python<'_>,
    progress: Option<bool>,
    work: impl FnOnce(&Told) -> Result<T, E> + Send,
) -> PyResult<T> {
    run(py, progress, work)?.map_err(fault::of)
}

/// The same without a progress bar.
pub fn quietly<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    attend(py, None, |_| work())
}

fn attend<T: Send>(
    py: Python<'_>,
    bar: Option<&Py<PyAny>>,
    work: impl FnOnce(&Told) -> T + Send,
) -> PyResult<T> {
    check_memory(memory::check_threads(threads()))?;
    let (told, interruption) = (Told::default(), Interruption::default());
    let (told, interruption) = (&told, &interruption);
    let done = py.detach(|| {
        thread::scope(|scope| {
            let (finished, waits) = channel::<()>();
            let worker = scope.spawn(move || {
                let _finished = finished;
                catch_unwind(AssertUnwindSafe(|| {
                    interruption.run(threads(), || work(told))
                }))
            });
            // The channel ends with the worker.
            let mut stopped = None;
            while waits.recv_timeout(LOOK) == Err(RecvTimeoutError::Timeout) {
                if stopped.is_none()
                    && let Err(error) = Python::attach(|py| look(py, bar, told))
                {
                    interruption.ask();
                    stopped = Some(error);
                }
            }
            let done = worker.join().unwrap_or_else(Err);
            match (stopped, done) {
                (Some(error), _) => Err(error),
                (None, Ok(Ok(result))) => Ok(result),
                (None, Ok(Err(Interrupted))) => Err(fault::run(Interrupted)),
                (None, Err(payload)) => Err(broken(payload.as_ref())),
            }
        })
    });
    let warnings = told.1.lock().unwrap_or_else(PoisonError::into_inner);
    for warning in warnings.iter() {
        fault::warn(py, warning)?;
    }
    done
}

/// Handles signals and shows progress.
fn look(py: Python<'_>, bar: Option<&Py<PyAny>>, told: &Told) -> PyResult<()> {
    py.check_signals()?;
    match bar {
        Some(bar) => bar.call_method1(py, "show", told.last()).map(drop),
        None => Ok(()),
    }
}

fn broken(payload: &(dyn Any + Send)) -> PyErr {
    let text = payload
        .downcast_ref::<&str>()
        .map(|text| (*text).to_owned());
    let text = text.or_else(|| payload.downcast_ref::<String>().cloned());
    let text = text.unwrap_or_else(|| "no message".to_owned());
    fault::run(format!(
        "a bug in tilebind, please report it with the design: {text}"
    ))
}

/// A `ValueError` if the machine does not have the memory for a job.
pub fn check_memory<T>(checked: Result<T, String>) -> PyResult<()> {
    checked.map(drop).map_err(fault::of)
}
