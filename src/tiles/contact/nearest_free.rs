//! Configurations pushed out of contact.

use nalgebra::{Matrix3, Vector3};

use super::{Contact, closest_admissible};
use crate::configuration::Configuration;

/// Overlap (m) that is left in place.
const RESIDUAL: f64 = 1e-12;

/// Additional search distance (m) for contacts.
const MARGIN: f64 = 1e-6;

/// Corrections, each to first order.
const CORRECTIONS: usize = 12;

impl Contact {
    /// The nearest free configuration, where the tiles overlap by less than `size` (m); `None` if
    /// none is found. Distances are measured by the mass matrix over the mass, `metric`, at an
    /// orientation.
    pub fn nearest_free(
        &self,
        q: &Configuration,
        size: f64,
        metric: impl Fn(f64) -> Matrix3<f64>,
    ) -> Option<Configuration> {
        if self.is_free(q) {
            return Some(*q);
        }
        let mut q = *q;
        for _ in 0..CORRECTIONS {
            let near = self.constraints(&q, size + self.scaled(MARGIN));
            let deepest = near.iter().map(|c| c.gap).fold(0.0, f64::min);
            if deepest >= -self.scaled(RESIDUAL) {
                break;
            }
            let metric = metric(q.theta);
            let (push, _) =
                closest_admissible((Vector3::zeros(), self.scaled(1.0)), &metric, &near)?;
            if push.dot(&(metric * push)).max(0.0).sqrt() > 2.0 * size {
                return None;
            }
            q = q.moved(push);
        }
        self.is_free(&q).then_some(q)
    }
}
