//! Measures how long the stages of an analysis take.

use std::time::Instant;

use super::Stage;
use physics::observer::Observer;
use physics::problem::Problem;

/// Measures the stages, and reports them to an observer.
pub struct Clock<'a> {
    problem: &'a Problem,
    /// What the stages are reported to.
    pub observer: &'a dyn Observer,
    stages: Vec<Stage>,
    running: Option<(&'static str, Instant, u64)>,
}

impl<'a> Clock<'a> {
    /// A clock that is not running yet.
    pub fn new(problem: &'a Problem, observer: &'a dyn Observer) -> Self {
        Self {
            problem,
            observer,
            stages: Vec::new(),
            running: None,
        }
    }

    /// Begins a stage, at `share` (0 to 1) of the total time. Stages with the same name are added
    /// up.
    pub fn start(&mut self, name: &'static str, share: f64) {
        self.finish();
        self.observer.stage(name, share);
        self.running = Some((name, Instant::now(), self.problem.evaluations()));
    }

    fn finish(&mut self) {
        let Some((name, since, evaluations)) = self.running.take() else {
            return;
        };
        let wall_s = since.elapsed().as_secs_f64();
        let energy_evaluations = self.problem.evaluations() - evaluations;
        match self.stages.iter_mut().find(|stage| stage.name == name) {
            Some(stage) => {
                stage.wall_s += wall_s;
                stage.energy_evaluations += energy_evaluations;
            }
            None => self.stages.push(Stage {
                name: name.into(),
                wall_s,
                energy_evaluations,
            }),
        }
    }

    /// The stages, in order.
    pub fn stop(mut self) -> Vec<Stage> {
        self.finish();
        self.stages
    }
}
