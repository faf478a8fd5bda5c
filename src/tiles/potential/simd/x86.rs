//! The implementations with AVX2 and FMA, and with AVX-512.

#![allow(unsafe_code)]

use std::arch::x86_64::*;

use super::lanes::{Arithmetic, GUESS, Lanes, Task, WIDTH};

/// Eight lanes as two halves. Only [`Avx2::detect`] creates a value, so code that has one runs on a
/// CPU with AVX2.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Avx2(());

/// Eight lanes. Only [`Avx512::detect`] creates a value, so code that has one runs on a CPU with
/// AVX-512.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Avx512(());

/// Calls intrinsics of the instruction set of an available [`Lanes`] value.
macro_rules! with {
    ($lanes:ident: $call:expr) => {{
        let _proof: Self = $lanes;
        // SAFETY: the only condition of these functions is that the CPU has their instruction set,
        // and a value of `Self` exists only if `detect` found it. Those that take a pointer get a
        // slice that the caller checked to be long enough.
        unsafe { $call }
    }};
}

/// Operations that are one intrinsic each.
macro_rules! intrinsics {
    ($($name:ident($($x:ident),*) = $call:expr;)*) => {$(
        #[inline(always)]
        fn $name(self, $($x: Self::F),*) -> Self::F {
            with!(self: $call($($x),*))
        }
    )*};
}

/// The same, on either half.
macro_rules! intrinsics_on_halves {
    ($($name:ident($($x:ident),*) = $call:expr;)*) => {$(
        #[inline(always)]
        fn $name(self, $($x: Self::F),*) -> Self::F {
            with!(self: [$call($($x[0]),*), $call($($x[1]),*)])
        }
    )*};
}

/// The bits of a number below its exponent.
const FRACTION: i64 = (1 << 52) - 1;

/// An integer up to 2^52 with the bits of 2^52 above it is, as a number, 2^52 plus it.
const SHIFT: f64 = 4503599627370496.0;

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
        let has = is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx2")
            && is_x86_feature_detected!("fma");
        has.then_some(Self(()))
    }

    #[inline]
    pub fn run<T: Task>(self, task: T) -> T::Output {
        #[target_feature(enable = "avx512f,avx2,fma")]
        fn compiled<T: Task>(lanes: Avx512, task: T) -> T::Output {
            task.run(lanes)
        }
        with!(self: compiled(self, task))
    }
}

impl Arithmetic for Avx2 {
    type F = [__m256d; 2];

    #[inline(always)]
    fn splat(self, value: f64) -> Self::F {
        with!(self: [_mm256_set1_pd(value); 2])
    }

    intrinsics_on_halves! {
        add(a, b) = _mm256_add_pd;
        sub(a, b) = _mm256_sub_pd;
        mul(a, b) = _mm256_mul_pd;
        mul_add(a, b, c) = _mm256_fmadd_pd;
        neg_mul_add(a, b, c) = _mm256_fnmadd_pd;
        min(a, b) = _mm256_min_pd;
    }

    #[inline(always)]
    fn reciprocal_sqrt_guess(self, a: Self::F) -> Self::F {
        with!(self: [guess(a[0]), guess(a[1])])
    }

    #[inline(always)]
    fn reciprocal_single(self, a: Self::F) -> Self::F {
        with!(self: {
            let singles = _mm256_set_m128(_mm256_cvtpd_ps(a[1]), _mm256_cvtpd_ps(a[0]));
            let y = _mm256_div_ps(_mm256_set1_ps(1.0), singles);
            let upper = _mm256_extractf128_ps(y, 1);
            [_mm256_cvtps_pd(_mm256_castps256_ps128(y)), _mm256_cvtps_pd(upper)]
        })
    }
}

impl Lanes for Avx2 {
    // A vector takes two of sixteen registers.
    const AT_ONCE: usize = 1;

    #[inline(always)]
    fn load(self, values: &[f64]) -> Self::F {
        let values = &values[..WIDTH];
        with!(self: [
            _mm256_loadu_pd(values.as_ptr()),
            _mm256_loadu_pd(values[WIDTH / 2..].as_ptr()),
        ])
    }

    #[inline(always)]
    fn store(self, lanes: Self::F, values: &mut [f64]) {
        let values = &mut values[..WIDTH];
        with!(self: {
            _mm256_storeu_pd(values.as_mut_ptr(), lanes[0]);
            _mm256_storeu_pd(values[WIDTH / 2..].as_mut_ptr(), lanes[1]);
        })
    }

    intrinsics_on_halves! {
        div(a, b) = _mm256_div_pd;
        sqrt(a) = _mm256_sqrt_pd;
        select(condition, a, b) = chosen;
    }

    #[inline(always)]
    fn mantissa_and_exponent(self, a: Self::F) -> (Self::F, Self::F) {
        with!(self: {
            ([mantissa(a[0]), mantissa(a[1])], [exponent(a[0]), exponent(a[1])])
        })
    }

    #[inline(always)]
    fn turn(self, quarters: Self::F, sin: Self::F, cos: Self::F) -> (Self::F, Self::F) {
        with!(self: {
            let lower = turned(quarters[0], sin[0], cos[0]);
            let upper = turned(quarters[1], sin[1], cos[1]);
            ([lower[0], upper[0]], [lower[1], upper[1]])
        })
    }

    #[inline(always)]
    fn least(self, lanes: Self::F) -> f64 {
        with!(self: least_of_four(_mm256_min_pd(lanes[0], lanes[1])))
    }

    #[inline(always)]
    fn sum(self, lanes: Self::F) -> f64 {
        with!(self: sum_of_four(_mm256_add_pd(lanes[0], lanes[1])))
    }

    #[inline(always)]
    fn first(self, lanes: Self::F) -> f64 {
        with!(self: _mm256_cvtsd_f64(lanes[0]))
    }
}

impl Arithmetic for Avx512 {
    type F = __m512d;

    #[inline(always)]
    fn splat(self, value: f64) -> __m512d {
        with!(self: _mm512_set1_pd(value))
    }

    intrinsics! {
        add(a, b) = _mm512_add_pd;
        sub(a, b) = _mm512_sub_pd;
        mul(a, b) = _mm512_mul_pd;
        mul_add(a, b, c) = _mm512_fmadd_pd;
        neg_mul_add(a, b, c) = _mm512_fnmadd_pd;
        min(a, b) = _mm512_min_pd;
    }

    #[inline(always)]
    fn reciprocal_sqrt_guess(self, a: __m512d) -> __m512d {
        with!(self: {
            let half = _mm512_srli_epi64(_mm512_castpd_si512(a), 1);
            _mm512_castsi512_pd(_mm512_sub_epi64(_mm512_set1_epi64(GUESS), half))
        })
    }

    #[inline(always)]
    fn reciprocal_single(self, a: __m512d) -> __m512d {
        with!(self: _mm512_cvtps_pd(_mm256_div_ps(_mm256_set1_ps(1.0), _mm512_cvtpd_ps(a))))
    }
}

impl Lanes for Avx512 {
    const AT_ONCE: usize = 2;

    #[inline(always)]
    fn load(self, values: &[f64]) -> __m512d {
        let values = &values[..WIDTH];
        with!(self: _mm512_loadu_pd(values.as_ptr()))
    }

    #[inline(always)]
    fn store(self, lanes: __m512d, values: &mut [f64]) {
        let values = &mut values[..WIDTH];
        with!(self: _mm512_storeu_pd(values.as_mut_ptr(), lanes))
    }

    intrinsics! {
        div(a, b) = _mm512_div_pd;
        sqrt(a) = _mm512_sqrt_pd;
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
        with!(self: {
            let bits = _mm512_castpd_si512(a);
            let fraction = _mm512_and_si512(bits, _mm512_set1_epi64(FRACTION));
            let one = _mm512_castpd_si512(_mm512_set1_pd(1.0));
            let shift = _mm512_castpd_si512(_mm512_set1_pd(SHIFT));
            let exponent = _mm512_or_si512(_mm512_srli_epi64(bits, 52), shift);
            (
                _mm512_castsi512_pd(_mm512_or_si512(fraction, one)),
                _mm512_sub_pd(_mm512_castsi512_pd(exponent), _mm512_set1_pd(SHIFT + 1023.0)),
            )
        })
    }

    #[inline(always)]
    fn turn(self, quarters: __m512d, sin: __m512d, cos: __m512d) -> (__m512d, __m512d) {
        with!(self: {
            let quarters = _mm512_castpd_si512(quarters);
            let sign = _mm512_set1_epi64(i64::MIN);
            let odd = _mm512_test_epi64_mask(quarters, _mm512_set1_epi64(1));
            let half = _mm512_slli_epi64(quarters, 62);
            let other = _mm512_xor_si512(half, _mm512_slli_epi64(quarters, 63));
            let (half, other) = (_mm512_and_si512(half, sign), _mm512_and_si512(other, sign));
            let first = _mm512_castpd_si512(_mm512_mask_blend_pd(odd, sin, cos));
            let second = _mm512_castpd_si512(_mm512_mask_blend_pd(odd, cos, sin));
            (
                _mm512_castsi512_pd(_mm512_xor_si512(first, half)),
                _mm512_castsi512_pd(_mm512_xor_si512(second, other)),
            )
        })
    }

    #[inline(always)]
    fn least(self, lanes: __m512d) -> f64 {
        with!(self: {
            let upper = _mm512_extractf64x4_pd(lanes, 1);
            least_of_four(_mm256_min_pd(_mm512_castpd512_pd256(lanes), upper))
        })
    }

    #[inline(always)]
    fn sum(self, lanes: __m512d) -> f64 {
        with!(self: {
            let upper = _mm512_extractf64x4_pd(lanes, 1);
            sum_of_four(_mm256_add_pd(_mm512_castpd512_pd256(lanes), upper))
        })
    }

    #[inline(always)]
    fn first(self, lanes: __m512d) -> f64 {
        with!(self: _mm512_cvtsd_f64(lanes))
    }
}

// Operations on four lanes that take more than one intrinsic. (Closures on vectors would be calls.)

#[inline]
#[target_feature(enable = "avx2")]
fn guess(a: __m256d) -> __m256d {
    let half = _mm256_srli_epi64(_mm256_castpd_si256(a), 1);
    _mm256_castsi256_pd(_mm256_sub_epi64(_mm256_set1_epi64x(GUESS), half))
}

#[inline]
#[target_feature(enable = "avx2")]
fn chosen(condition: __m256d, a: __m256d, b: __m256d) -> __m256d {
    _mm256_blendv_pd(a, b, condition)
}

#[inline]
#[target_feature(enable = "avx2")]
fn mantissa(a: __m256d) -> __m256d {
    let fraction = _mm256_castsi256_pd(_mm256_set1_epi64x(FRACTION));
    _mm256_or_pd(_mm256_and_pd(a, fraction), _mm256_set1_pd(1.0))
}

#[inline]
#[target_feature(enable = "avx2")]
fn exponent(a: __m256d) -> __m256d {
    let bits = _mm256_castsi256_pd(_mm256_srli_epi64(_mm256_castpd_si256(a), 52));
    let number = _mm256_or_pd(bits, _mm256_set1_pd(SHIFT));
    _mm256_sub_pd(number, _mm256_set1_pd(SHIFT + 1023.0))
}

#[inline]
#[target_feature(enable = "avx2")]
fn turned(quarters: __m256d, sin: __m256d, cos: __m256d) -> [__m256d; 2] {
    let quarters = _mm256_castpd_si256(quarters);
    let sign = _mm256_set1_epi64x(i64::MIN);
    let odd = _mm256_castsi256_pd(_mm256_slli_epi64(quarters, 63));
    let half = _mm256_slli_epi64(quarters, 62);
    let other = _mm256_xor_si256(half, _mm256_castpd_si256(odd));
    let (half, other) = (_mm256_and_si256(half, sign), _mm256_and_si256(other, sign));
    let swapped = [
        _mm256_blendv_pd(sin, cos, odd),
        _mm256_blendv_pd(cos, sin, odd),
    ];
    [
        _mm256_xor_pd(swapped[0], _mm256_castsi256_pd(half)),
        _mm256_xor_pd(swapped[1], _mm256_castsi256_pd(other)),
    ]
}

/// The minimum of four lanes, by halves.
#[inline]
#[target_feature(enable = "avx2")]
fn least_of_four(lanes: __m256d) -> f64 {
    let pair = _mm_min_pd(
        _mm256_castpd256_pd128(lanes),
        _mm256_extractf128_pd(lanes, 1),
    );
    _mm_cvtsd_f64(_mm_min_sd(pair, _mm_unpackhi_pd(pair, pair)))
}

/// The sum of four lanes, by halves.
#[inline]
#[target_feature(enable = "avx2")]
fn sum_of_four(lanes: __m256d) -> f64 {
    let pair = _mm_add_pd(
        _mm256_castpd256_pd128(lanes),
        _mm256_extractf128_pd(lanes, 1),
    );
    _mm_cvtsd_f64(_mm_add_sd(pair, _mm_unpackhi_pd(pair, pair)))
}
