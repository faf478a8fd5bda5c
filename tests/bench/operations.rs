//! The number of vector operations that the dipole kernel needs for a pair of dipoles, from which
//! the bench computes the speed limit. A test of `potential::batch` counts them in the kernel's own
//! arithmetic.

/// Numbers of vector operations.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Operations {
    /// Additions, subtractions, multiplications.
    pub simple: usize,
    /// Multiplications with an addition or subtraction.
    pub fused: usize,
    /// First guesses of `1 / sqrt` and of reciprocals.
    pub guesses: usize,
}

impl Operations {
    /// The operations of one pair of dipoles (precisely: of as many pairs as there are lanes), with
    /// or without the gradient.
    pub const fn per_pair(gradient: bool) -> Self {
        let (simple, fused) = if gradient { (15, 19) } else { (11, 13) };
        Self {
            simple,
            fused,
            guesses: 1,
        }
    }
}
