//! AVX2 with FMA, and AVX-512.

#![allow(unsafe_code)]

use std::arch::x86_64::*;

use super::lanes::{Arithmetic, Lanes, Task};
use super::sin_cos::{QuarterTurns, sin_cos};

/// Four lanes. Only [`Avx2::detect`] makes one, so whoever holds one runs on a CPU that has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Avx2(());

/// Eight lanes. Only [`Avx512::detect`] makes one, so whoever holds one runs on a CPU that has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Avx512(());

/// Calls intrinsics of the instruction set whose [`Lanes`] value is at hand.
macro_rules! with {
    ($lanes:ident: $call:expr) => {{
        let _proof: Self = $lanes;
        // SAFETY: these functions have no other condition than that the CPU has their
        // instruction set, and a value of `Self` exists only where `detect` found that it does.
        // The ones that take a pointer are given a slice that the caller checked to be long
        // enough.
        unsafe { $call }
    }};
}

impl Avx2 {
    pub fn detect() -> Option<Self> {
        (is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma")).then_some(Self(()))
    }

    #[inline]
    pub fn run<T: Task>(self, task: T) -> T::Output {
        #[target_feature(enable = "avx2,fma")]
        fn compiled<T: Task>(lanes: Avx2, task: T) -> T::Output {
            task.run(lanes)
        }
        with!(self: compiled(self, task))
    }
}

impl Avx512 {
    pub fn detect() -> Option<Self> {
        (is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("fma")).then_some(Self(()))
    }

    #[inline]
    pub fn run<T: Task>(self, task: T) -> T::Output {
        #[target_feature(enable = "avx512f,fma")]
        fn compiled<T: Task>(lanes: Avx512, task: T) -> T::Output {
            task.run(lanes)
        }
        with!(self: compiled(self, task))
    }
}

impl Arithmetic for Avx2 {
    type F = __m256d;
    const ESTIMATE_IS_EXACT: bool = false;

    #[inline(always)]
    fn splat(self, value: f64) -> __m256d {
        with!(self: _mm256_set1_pd(value))
    }

    #[inline(always)]
    fn add(self, a: __m256d, b: __m256d) -> __m256d {
        with!(self: _mm256_add_pd(a, b))
    }

    #[inline(always)]
    fn sub(self, a: __m256d, b: __m256d) -> __m256d {
        with!(self: _mm256_sub_pd(a, b))
    }

    #[inline(always)]
    fn mul(self, a: __m256d, b: __m256d) -> __m256d {
        with!(self: _mm256_mul_pd(a, b))
    }

    #[inline(always)]
    fn mul_add(self, a: __m256d, b: __m256d, c: __m256d) -> __m256d {
        with!(self: _mm256_fmadd_pd(a, b, c))
    }

    #[inline(always)]
    fn neg_mul_add(self, a: __m256d, b: __m256d, c: __m256d) -> __m256d {
        with!(self: _mm256_fnmadd_pd(a, b, c))
    }

    #[inline(always)]
    fn min(self, a: __m256d, b: __m256d) -> __m256d {
        with!(self: _mm256_min_pd(a, b))
    }

    /// In single precision, with a relative error of at most 1.5 / 2^12.
    #[inline(always)]
    fn reciprocal_sqrt_estimate(self, a: __m256d) -> __m256d {
        with!(self: _mm256_cvtps_pd(_mm_rsqrt_ps(_mm256_cvtpd_ps(a))))
    }

    /// In single precision, with a relative error of at most 1.5 / 2^12.
    #[inline(always)]
    fn reciprocal_estimate(self, a: __m256d) -> __m256d {
        with!(self: _mm256_cvtps_pd(_mm_rcp_ps(_mm256_cvtpd_ps(a))))
    }
}

impl Lanes for Avx2 {
    const WIDTH: usize = 4;

    #[inline(always)]
    fn load(self, values: &[f64]) -> __m256d {
        let values = &values[..Self::WIDTH];
        with!(self: _mm256_loadu_pd(values.as_ptr()))
    }

    #[inline(always)]
    fn store(self, lanes: __m256d, values: &mut [f64]) {
        let values = &mut values[..Self::WIDTH];
        with!(self: _mm256_storeu_pd(values.as_mut_ptr(), lanes))
    }

    #[inline(always)]
    fn sin_cos(self, angle: __m256d) -> (__m256d, __m256d) {
        sin_cos(self, angle)
    }

    #[inline(always)]
    fn least(self, lanes: __m256d) -> f64 {
        with!(self: {
            let pair = _mm_min_pd(_mm256_castpd256_pd128(lanes), _mm256_extractf128_pd(lanes, 1));
            _mm_cvtsd_f64(_mm_min_sd(pair, _mm_unpackhi_pd(pair, pair)))
        })
    }

    #[inline(always)]
    fn div(self, a: __m256d, b: __m256d) -> __m256d {
        with!(self: _mm256_div_pd(a, b))
    }

    #[inline(always)]
    fn sqrt(self, a: __m256d) -> __m256d {
        with!(self: _mm256_sqrt_pd(a))
    }

    #[inline(always)]
    fn select(self, condition: __m256d, a: __m256d, b: __m256d) -> __m256d {
        with!(self: _mm256_blendv_pd(a, b, condition))
    }

    #[inline(always)]
    fn mantissa_and_exponent(self, a: __m256d) -> (__m256d, __m256d) {
        // An integer up to 2^52 with the bits of 2^52 above it is, as a number, 2^52 plus it.
        const SHIFT: f64 = 4503599627370496.0;
        with!(self: {
            let exponent = _mm256_castsi256_pd(_mm256_srli_epi64(_mm256_castpd_si256(a), 52));
            let exponent = _mm256_or_pd(exponent, _mm256_set1_pd(SHIFT));
            let fraction = _mm256_set1_pd(f64::from_bits((1 << 52) - 1));
            (
                _mm256_or_pd(_mm256_and_pd(a, fraction), _mm256_set1_pd(1.0)),
                _mm256_sub_pd(exponent, _mm256_set1_pd(SHIFT + 1023.0)),
            )
        })
    }
}

impl QuarterTurns for Avx2 {
    #[inline(always)]
    fn turn(self, quarters: __m256d, sin: __m256d, cos: __m256d) -> (__m256d, __m256d) {
        with!(self: {
            let quarters = _mm256_castpd_si256(quarters);
            let sign = _mm256_set1_epi64x(i64::MIN);
            let odd = _mm256_castsi256_pd(_mm256_slli_epi64(quarters, 63));
            let half = _mm256_slli_epi64(quarters, 62);
            let other = _mm256_xor_si256(half, _mm256_castpd_si256(odd));
            let flip = |x, bits| {
                _mm256_xor_pd(x, _mm256_castsi256_pd(_mm256_and_si256(bits, sign)))
            };
            (
                flip(_mm256_blendv_pd(sin, cos, odd), half),
                flip(_mm256_blendv_pd(cos, sin, odd), other),
            )
        })
    }
}

impl Arithmetic for Avx512 {
    type F = __m512d;
    const ESTIMATE_IS_EXACT: bool = false;

    #[inline(always)]
    fn splat(self, value: f64) -> __m512d {
        with!(self: _mm512_set1_pd(value))
    }

    #[inline(always)]
    fn add(self, a: __m512d, b: __m512d) -> __m512d {
        with!(self: _mm512_add_pd(a, b))
    }

    #[inline(always)]
    fn sub(self, a: __m512d, b: __m512d) -> __m512d {
        with!(self: _mm512_sub_pd(a, b))
    }

    #[inline(always)]
    fn mul(self, a: __m512d, b: __m512d) -> __m512d {
        with!(self: _mm512_mul_pd(a, b))
    }

    #[inline(always)]
    fn mul_add(self, a: __m512d, b: __m512d, c: __m512d) -> __m512d {
        with!(self: _mm512_fmadd_pd(a, b, c))
    }

    #[inline(always)]
    fn neg_mul_add(self, a: __m512d, b: __m512d, c: __m512d) -> __m512d {
        with!(self: _mm512_fnmadd_pd(a, b, c))
    }

    #[inline(always)]
    fn min(self, a: __m512d, b: __m512d) -> __m512d {
        with!(self: _mm512_min_pd(a, b))
    }

    /// With a relative error of at most 1 / 2^14.
    #[inline(always)]
    fn reciprocal_sqrt_estimate(self, a: __m512d) -> __m512d {
        with!(self: _mm512_rsqrt14_pd(a))
    }

    /// With a relative error of at most 1 / 2^14.
    #[inline(always)]
    fn reciprocal_estimate(self, a: __m512d) -> __m512d {
        with!(self: _mm512_rcp14_pd(a))
    }
}

impl Lanes for Avx512 {
    const WIDTH: usize = 8;

    #[inline(always)]
    fn load(self, values: &[f64]) -> __m512d {
        let values = &values[..Self::WIDTH];
        with!(self: _mm512_loadu_pd(values.as_ptr()))
    }

    #[inline(always)]
    fn store(self, lanes: __m512d, values: &mut [f64]) {
        let values = &mut values[..Self::WIDTH];
        with!(self: _mm512_storeu_pd(values.as_mut_ptr(), lanes))
    }

    #[inline(always)]
    fn sin_cos(self, angle: __m512d) -> (__m512d, __m512d) {
        sin_cos(self, angle)
    }

    #[inline(always)]
    fn least(self, lanes: __m512d) -> f64 {
        with!(self: _mm512_reduce_min_pd(lanes))
    }

    #[inline(always)]
    fn div(self, a: __m512d, b: __m512d) -> __m512d {
        with!(self: _mm512_div_pd(a, b))
    }

    #[inline(always)]
    fn sqrt(self, a: __m512d) -> __m512d {
        with!(self: _mm512_sqrt_pd(a))
    }

    #[inline(always)]
    fn select(self, condition: __m512d, a: __m512d, b: __m512d) -> __m512d {
        with!(self: {
            let sign = _mm512_set1_epi64(i64::MIN);
            let negative = _mm512_test_epi64_mask(_mm512_castpd_si512(condition), sign);
            _mm512_mask_blend_pd(negative, a, b)
        })
    }

    #[inline(always)]
    fn mantissa_and_exponent(self, a: __m512d) -> (__m512d, __m512d) {
        with!(self: (
            _mm512_getmant_pd::<_MM_MANT_NORM_1_2, _MM_MANT_SIGN_ZERO>(a),
            _mm512_getexp_pd(a),
        ))
    }
}

impl QuarterTurns for Avx512 {
    #[inline(always)]
    fn turn(self, quarters: __m512d, sin: __m512d, cos: __m512d) -> (__m512d, __m512d) {
        with!(self: {
            let quarters = _mm512_castpd_si512(quarters);
            let sign = _mm512_set1_epi64(i64::MIN);
            let odd = _mm512_test_epi64_mask(quarters, _mm512_set1_epi64(1));
            let half = _mm512_slli_epi64(quarters, 62);
            let other = _mm512_xor_si512(half, _mm512_slli_epi64(quarters, 63));
            let flip = |x, bits| {
                let flipped = _mm512_xor_si512(_mm512_castpd_si512(x), _mm512_and_si512(bits, sign));
                _mm512_castsi512_pd(flipped)
            };
            (
                flip(_mm512_mask_blend_pd(odd, sin, cos), half),
                flip(_mm512_mask_blend_pd(odd, cos, sin), other),
            )
        })
    }
}
