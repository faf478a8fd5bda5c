//! Tests that count the arithmetic operations of the kernel.

use std::cell::Cell;

use super::field::{BATCH, FieldDipole, field};
use crate::potential::simd::lanes::Arithmetic;

#[path = "../../../../tests/bench/operations.rs"]
mod known;

use known::Operations;

/// A change of these numbers changes the kernel's speed; the bench measures how much.
#[test]
fn operations_a_pair() {
    check::<false>();
    check::<true>();
}

fn check<const SLOPE: bool>() {
    let (none, some) = (of_field::<SLOPE>(0), of_field::<SLOPE>(BATCH));
    let a_pair = Operations {
        simple: (some.simple - none.simple) / BATCH,
        fused: (some.fused - none.fused) / BATCH,
        guesses: (some.guesses - none.guesses) / BATCH,
    };
    assert_eq!(a_pair, Operations::per_pair(SLOPE));
}

fn of_field<const SLOPE: bool>(sources: usize) -> Operations {
    let counted = Cell::default();
    let source = FieldDipole {
        position: [0.0; 2],
        moment: [0.0; 2],
        thrice: [0.0; 2],
        magnitude: 0.0,
    };
    field::<_, 1, SLOPE>(Counter(&counted), &vec![source; sources], &[[(); 2]]);
    counted.get()
}

/// Arithmetic that only counts operations.
#[derive(Clone, Copy)]
struct Counter<'a>(&'a Cell<Operations>);

impl Counter<'_> {
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

    fn guess(self) {
        let mut counted = self.0.get();
        counted.guesses += 1;
        self.0.set(counted);
    }
}

impl Arithmetic for Counter<'_> {
    type F = ();

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

    fn reciprocal_sqrt_guess(self, _: ()) {
        self.guess();
    }

    fn reciprocal_single(self, _: ()) {
        self.guess();
    }
}
