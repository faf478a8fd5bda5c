//! Energies, forces and torques at many poses.

use std::borrow::Cow;

use pyo3::prelude::*;
use tilebind::query::poses::clearance;
use tilebind::report::{json, matching};

use super::Design;
use crate::poses::{self, Poses};
use crate::request::request_with;
use crate::{convert, job, table};

#[pymethods]
impl Design {
    /// The magnetic interaction energy.
    ///
    /// Parameters
    /// ----------
    /// poses : array_like
    ///     (..., 3): x (m), y (m), theta (rad) of the moving tile.
    /// model : {"dipole", "cuboid"}, optional
    ///     Point dipoles or uniformly magnetised blocks; the design's own by default.
    ///
    /// Returns
    /// -------
    /// float or numpy.ndarray
    ///     (...), in J; 0 at infinity. Also defined where tiles overlap; NaN where a pose is
    ///     not finite.
    ///
    /// Notes
    /// -----
    /// Many poses use all cores, with the GIL released.
    #[pyo3(signature = (poses, *, model = None))]
    fn energy<'py>(
        &self,
        py: Python<'py>,
        poses: Poses<'py>,
        model: Option<Cow<'_, str>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let problem = self.content.problem(super::model(model.as_deref())?);
        let potential = problem.potential();
        poses::numbers(py, &poses, |qs, out: &mut [[f64; 1]]| {
            potential.energies(qs, out.as_flattened_mut());
            for [energy] in out {
                *energy = json::positive_zero(*energy);
            }
        })
    }

    /// Force and torque on the moving tile.
    ///
    /// Parameters
    /// ----------
    /// poses : array_like
    ///     (..., 3): x (m), y (m), theta (rad).
    /// model : {"dipole", "cuboid"}, optional
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     (..., 3): Fx (N), Fy (N) and the torque about the tile's reference point (N m).
    #[pyo3(signature = (poses, *, model = None))]
    fn wrench<'py>(
        &self,
        py: Python<'py>,
        poses: Poses<'py>,
        model: Option<Cow<'_, str>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let problem = self.content.problem(super::model(model.as_deref())?);
        let potential = problem.potential();
        poses::numbers(py, &poses, |qs, out: &mut [[f64; 3]]| {
            let mut found = vec![Default::default(); qs.len()];
            potential.energies_and_gradients(qs, &mut found);
            for ((_, gradient), out) in found.iter().zip(out) {
                *out = [-gradient.x, -gradient.y, -gradient.z].map(json::positive_zero);
            }
        })
    }

    /// Distance between the two outlines.
    ///
    /// Parameters
    /// ----------
    /// poses : array_like
    ///     (..., 3): x (m), y (m), theta (rad).
    ///
    /// Returns
    /// -------
    /// float or numpy.ndarray
    ///     (...), in m; 0 where they touch, negative where they overlap.
    fn clearance<'py>(&self, py: Python<'py>, poses: Poses<'py>) -> PyResult<Bound<'py, PyAny>> {
        let problem = self.content.problem(None);
        poses::numbers(py, &poses, |qs, out: &mut [[f64; 1]]| {
            for (q, [out]) in qs.iter().zip(out) {
                *out = json::positive_zero(clearance(problem, q));
            }
        })
    }

    /// Whether the tiles do not overlap; touching is allowed.
    ///
    /// Parameters
    /// ----------
    /// poses : array_like
    ///     (..., 3): x (m), y (m), theta (rad).
    ///
    /// Returns
    /// -------
    /// bool or numpy.ndarray
    ///     (...), false where a pose is not finite.
    fn is_free<'py>(&self, py: Python<'py>, poses: Poses<'py>) -> PyResult<Bound<'py, PyAny>> {
        let problem = self.content.problem(None);
        poses::truths(py, &poses, |q| problem.is_clear(q))
    }

    /// List how the two outlines fit together, ignoring magnets.
    ///
    /// Parameters
    /// ----------
    /// most : int, optional
    ///     Largest number of fits to list.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     Structured, longest contact first: `x_m`, `y_m`, `theta_rad`, `contact_m`, `gap_m2`.
    #[pyo3(signature = (most = 100))]
    fn matches<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = convert::whole)] most: usize,
    ) -> PyResult<Bound<'py, PyAny>> {
        let asked: tilebind::matching::Request = request_with(py, None, "most", most)?;
        let design = &self.content.design;
        let found = job::quietly(py, || asked.matches(design))?;
        table::array(py, &matching::table(&found))
    }

    /// The time (s) of computing the energies of poses on all cores, without conversions, for the
    /// bench.
    fn _kernel_seconds(
        &self,
        py: Python<'_>,
        poses: Poses<'_>,
        model: Option<Cow<'_, str>>,
    ) -> PyResult<f64> {
        let problem = self.content.problem(super::model(model.as_deref())?);
        poses::kernel_seconds(py, &poses, problem.potential())
    }
}
