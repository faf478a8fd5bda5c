//! How many vector operations the dipole kernel does for a pair of dipoles: what the bench measures
//! its ceiling with. A test of `potential::batch` counts them in the kernel's own arithmetic.

/// Numbers of vector operations.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Operations {
    /// Additions, subtractions, multiplications.
    pub simple: usize,
    /// Multiplications with an addition or subtraction.
    pub fused: usize,
    /// Estimates of `1 / sqrt` and of reciprocals.
    pub estimates: usize,
}

impl Operations {
    /// What one pair of dipoles takes (as many pairs as there are lanes, to be precise), with or
    /// without the gradient, where the estimate of `1 / sqrt` has to be refined or is exact.
    pub const fn per_pair(gradient: bool, exact_estimate: bool) -> Self {
        let (simple, fused) = match (gradient, exact_estimate) {
            (false, false) => (9, 10),
            (false, true) => (7, 6),
            (true, false) => (13, 16),
            (true, true) => (11, 12),
        };
        Self {
            simple,
            fused,
            estimates: 1,
        }
    }
}
