//! Several SIMD vectors processed together.

use crate::potential::simd::lanes::Arithmetic;

/// `M` times `N` vectors on which every operation is done in turn. A vector operation takes several
/// cycles, but another one can start in each. Interleaving several independent chains of operations
/// therefore uses the CPU better than its own reordering does.
#[derive(Clone, Copy)]
pub struct Bundle<L, const N: usize, const M: usize>(pub L);

/// Does the same to every vector of a bundle.
macro_rules! each {
    ($lanes:ident.$op:ident($($x:ident),*)) => {{
        let mut result = [[$lanes.0.splat(0.0); N]; M];
        for (j, row) in result.iter_mut().enumerate() {
            for (k, entry) in row.iter_mut().enumerate() {
                *entry = $lanes.0.$op($($x[j][k]),*);
            }
        }
        result
    }};
}

impl<L: Arithmetic, const N: usize, const M: usize> Bundle<L, N, M> {
    /// Row j has the j-th value in all lanes.
    #[inline(always)]
    pub fn rows(self, values: [f64; M]) -> [[L::F; N]; M] {
        let mut result = self.splat(0.0);
        for (row, value) in result.iter_mut().zip(values) {
            *row = [self.0.splat(value); N];
        }
        result
    }
}

impl<L: Arithmetic, const N: usize, const M: usize> Arithmetic for Bundle<L, N, M> {
    type F = [[L::F; N]; M];

    #[inline(always)]
    fn splat(self, value: f64) -> Self::F {
        [[self.0.splat(value); N]; M]
    }

    #[inline(always)]
    fn add(self, a: Self::F, b: Self::F) -> Self::F {
        each!(self.add(a, b))
    }

    #[inline(always)]
    fn sub(self, a: Self::F, b: Self::F) -> Self::F {
        each!(self.sub(a, b))
    }

    #[inline(always)]
    fn mul(self, a: Self::F, b: Self::F) -> Self::F {
        each!(self.mul(a, b))
    }

    #[inline(always)]
    fn mul_add(self, a: Self::F, b: Self::F, c: Self::F) -> Self::F {
        each!(self.mul_add(a, b, c))
    }

    #[inline(always)]
    fn neg_mul_add(self, a: Self::F, b: Self::F, c: Self::F) -> Self::F {
        each!(self.neg_mul_add(a, b, c))
    }

    #[inline(always)]
    fn min(self, a: Self::F, b: Self::F) -> Self::F {
        each!(self.min(a, b))
    }

    #[inline(always)]
    fn reciprocal_sqrt_guess(self, a: Self::F) -> Self::F {
        each!(self.reciprocal_sqrt_guess(a))
    }

    #[inline(always)]
    fn reciprocal_single(self, a: Self::F) -> Self::F {
        each!(self.reciprocal_single(a))
    }
}
