//! Matrix products with the same bits on every processor.
//!
//! nalgebra multiplies matrices of more than five rows by the crate `matrixmultiply`, whose kernels,
//! and with them the rounding, depend on the processor.

use nalgebra::allocator::Allocator;
use nalgebra::{DefaultAllocator, Dim, OMatrix};

/// `a b`: each entry is summed in the order of a's columns. Panics if the number of a's columns
/// differs from the number of b's rows.
pub fn product<R: Dim, K: Dim, C: Dim>(
    a: &OMatrix<f64, R, K>,
    b: &OMatrix<f64, K, C>,
) -> OMatrix<f64, R, C>
where
    DefaultAllocator: Allocator<R, K> + Allocator<K, C> + Allocator<R, C>,
{
    assert_eq!(a.ncols(), b.nrows(), "as many columns as rows");
    let mut product = OMatrix::zeros_generic(a.shape_generic().0, b.shape_generic().1);
    for (mut column, weights) in product.column_iter_mut().zip(b.column_iter()) {
        for (part, weight) in a.column_iter().zip(weights.iter()) {
            column.axpy(*weight, &part, 1.0);
        }
    }
    product
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DMatrix;

    #[test]
    fn products_are_those_of_nalgebra_but_for_rounding() {
        let a = DMatrix::from_fn(9, 12, |i, k| libm::sin((5 * i + k) as f64));
        let b = DMatrix::from_fn(12, 7, |k, j| libm::cos((3 * k + j) as f64));
        let found = product(&a, &b);
        assert!((found - a * b).amax() < 1e-14);
    }
}
