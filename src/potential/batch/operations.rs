//! How much arithmetic the kernel does.

use std::cell::Cell;

use super::field::{Source, TOGETHER, field};
use super::lanes::Arithmetic;

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
    ///
    /// Found by running the kernel's own arithmetic and counting.
    pub fn per_pair(gradient: bool, exact_estimate: bool) -> Self {
        let counts = |sources: usize| match (gradient, exact_estimate) {
            (false, false) => Self::of_field::<false, false>(sources),
            (false, true) => Self::of_field::<false, true>(sources),
            (true, false) => Self::of_field::<true, false>(sources),
            (true, true) => Self::of_field::<true, true>(sources),
        };
        let (none, some) = (counts(0), counts(TOGETHER));
        Self {
            simple: (some.simple - none.simple) / TOGETHER,
            fused: (some.fused - none.fused) / TOGETHER,
            estimates: (some.estimates - none.estimates) / TOGETHER,
        }
    }

    fn of_field<const SLOPE: bool, const EXACT: bool>(sources: usize) -> Self {
        let counted = Cell::new(Self::default());
        let source = Source {
            position: [0.0; 2],
            moment: [0.0; 2],
            thrice: [0.0; 2],
            magnitude: 0.0,
        };
        field::<_, 1, SLOPE>(
            Counter::<EXACT>(&counted),
            &vec![source; sources],
            &[[(); 2]],
        );
        counted.get()
    }
}

/// Arithmetic that computes nothing, but counts.
#[derive(Clone, Copy)]
struct Counter<'a, const EXACT: bool>(&'a Cell<Operations>);

impl<const EXACT: bool> Counter<'_, EXACT> {
    fn simple(self) {
        let mut counted = self.0.get();
        counted.simple += 1;
        self.0.set(counted);
    }

    fn fused(self) {
        let mut counted = self.0.get();
        counted.fused += 1;
        self.0.set(counted);
    }

    fn estimate(self) {
        let mut counted = self.0.get();
        counted.estimates += 1;
        self.0.set(counted);
    }
}

impl<const EXACT: bool> Arithmetic for Counter<'_, EXACT> {
    type F = ();
    const ESTIMATE_IS_EXACT: bool = EXACT;

    fn splat(self, _: f64) {}

    fn add(self, _: (), _: ()) {
        self.simple();
    }

    fn sub(self, _: (), _: ()) {
        self.simple();
    }

    fn mul(self, _: (), _: ()) {
        self.simple();
    }

    fn mul_add(self, _: (), _: (), _: ()) {
        self.fused();
    }

    fn neg_mul_add(self, _: (), _: (), _: ()) {
        self.fused();
    }

    fn min(self, _: (), _: ()) {
        self.simple();
    }

    fn reciprocal_sqrt_estimate(self, _: ()) {
        self.estimate();
    }

    fn reciprocal_estimate(self, _: ()) {
        self.estimate();
    }
}
