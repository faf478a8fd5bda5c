//! The portable implementation in plain Rust, for every machine.

use super::lanes::{
    Arithmetic, GUESS, Lanes, Task, WIDTH, angle, ln_ratio, reciprocal_sqrt, sin_cos,
};
#[cfg(target_arch = "x86_64")]
use super::x86::Avx2;

/// Eight lanes in plain Rust.
///
/// On x86-64 it is built for tests only, so its operations are not inlined there: inlined, with a call for each lane of a fused operation, they would double
/// the code of all tasks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Portable;

impl Portable {
    #[inline(never)]
    pub fn run<T: Task>(self, task: T) -> T::Output {
        task.run(self)
    }
}

type F = [f64; WIDTH];

/// `a b + c`, rounded once. A processor that has an instruction for it, and runs this level as a check
/// of the others, uses it: the bits are those of the software, which takes ten times as long.
#[cfg(target_arch = "x86_64")]
struct Fused(F, F, F);

#[cfg(target_arch = "x86_64")]
impl Task for Fused {
    type Output = F;

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> F {
        let Self(a, b, c) = self;
        let mut sums = [0.0; WIDTH];
        l.store(l.mul_add(l.load(&a), l.load(&b), l.load(&c)), &mut sums);
        sums
    }
}

/// Operations, lane by lane.
macro_rules! lane_by_lane {
    ($($name:ident($($x:ident),*) = $lane:expr;)*) => {$(
        #[cfg_attr(target_arch = "x86_64", inline(never))]
        #[cfg_attr(not(target_arch = "x86_64"), inline(always))]
        fn $name(self, $($x: F),*) -> F {
            std::array::from_fn(|i| {
                $(let $x = $x[i];)*
                $lane
            })
        }
    )*};
}

impl Arithmetic for Portable {
    type F = F;

    #[inline(always)]
    fn splat(self, value: f64) -> F {
        [value; WIDTH]
    }

    #[cfg_attr(target_arch = "x86_64", inline(never))]
    fn reciprocal_sqrt(self, a: F) -> F {
        reciprocal_sqrt(self, a)
    }

    #[cfg_attr(target_arch = "x86_64", inline(never))]
    #[cfg_attr(not(target_arch = "x86_64"), inline(always))]
    fn mul_add(self, a: F, b: F, c: F) -> F {
        #[cfg(target_arch = "x86_64")]
        if let Some(lanes) = Avx2::detect() {
            return lanes.run(Fused(a, b, c));
        }
        std::array::from_fn(|i| a[i].mul_add(b[i], c[i]))
    }

    #[inline(always)]
    fn neg_mul_add(self, a: F, b: F, c: F) -> F {
        self.mul_add(a.map(|a| -a), b, c)
    }

    lane_by_lane! {
        add(a, b) = a + b;
        sub(a, b) = a - b;
        mul(a, b) = a * b;
        min(a, b) = smaller(a, b);
        reciprocal_sqrt_guess(a) = f64::from_bits((GUESS as u64).wrapping_sub(a.to_bits() >> 1));
        reciprocal_single(a) = f64::from(1.0 / a as f32);
    }
}

impl Lanes for Portable {
    const AT_ONCE: usize = 1;

    #[inline(always)]
    fn load(self, values: &[f64]) -> F {
        std::array::from_fn(|i| values[i])
    }

    #[inline(always)]
    fn store(self, lanes: F, values: &mut [f64]) {
        values[..WIDTH].copy_from_slice(&lanes);
    }

    lane_by_lane! {
        div(a, b) = a / b;
        sqrt(a) = a.sqrt();
        select(condition, a, b) = if condition.is_sign_positive() { a } else { b };
    }

    #[cfg_attr(target_arch = "x86_64", inline(never))]
    fn sin_cos(self, angle: F) -> (F, F) {
        sin_cos(self, angle)
    }

    #[cfg_attr(target_arch = "x86_64", inline(never))]
    fn ln_ratio(self, a: F, b: F) -> F {
        ln_ratio(self, a, b)
    }

    #[cfg_attr(target_arch = "x86_64", inline(never))]
    fn angle(self, x: F, y: F) -> F {
        angle(self, x, y)
    }

    fn mantissa_and_exponent(self, a: F) -> (F, F) {
        const FRACTION: u64 = (1 << 52) - 1;
        (
            a.map(|a| f64::from_bits(a.to_bits() & FRACTION | 1.0f64.to_bits())),
            a.map(|a| (a.to_bits() >> 52) as f64 - 1023.0),
        )
    }

    fn turn(self, quarters: F, sin: F, cos: F) -> (F, F) {
        let turned = |i: usize| match quarters[i].to_bits() & 3 {
            0 => (sin[i], cos[i]),
            1 => (cos[i], -sin[i]),
            2 => (-sin[i], -cos[i]),
            _ => (-cos[i], sin[i]),
        };
        (
            std::array::from_fn(|i| turned(i).0),
            std::array::from_fn(|i| turned(i).1),
        )
    }

    fn least(self, lanes: F) -> f64 {
        halved(lanes, smaller)
    }

    fn sum(self, lanes: F) -> f64 {
        halved(lanes, |a, b| a + b)
    }

    #[inline(always)]
    fn first(self, lanes: F) -> f64 {
        lanes[0]
    }
}

/// `b` if either is NaN or if they are equal.
fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// Combines the lower half of the lanes with the upper half until one is left.
fn halved(mut lanes: F, both: impl Fn(f64, f64) -> f64) -> f64 {
    let mut width = WIDTH / 2;
    while width > 0 {
        for i in 0..width {
            lanes[i] = both(lanes[i], lanes[i + width]);
        }
        width /= 2;
    }
    lanes[0]
}
