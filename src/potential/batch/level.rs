//! The instruction sets, and the choice between them.

use std::fmt;

use super::lanes::{Lanes, Task};
use super::portable::Portable;
#[cfg(target_arch = "x86_64")]
use super::x86::{Avx2, Avx512};

/// An instruction set this machine has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Level(Kind);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Portable,
    #[cfg(target_arch = "x86_64")]
    Avx2(Avx2),
    #[cfg(target_arch = "x86_64")]
    Avx512(Avx512),
}

impl Level {
    /// Plain Rust, four lanes, on every machine.
    pub const PORTABLE: Self = Self(Kind::Portable);

    /// What this machine has, slowest first.
    pub fn available() -> Vec<Self> {
        let mut levels = vec![Self::PORTABLE];
        #[cfg(target_arch = "x86_64")]
        {
            levels.extend(Avx2::detect().map(|lanes| Self(Kind::Avx2(lanes))));
            levels.extend(Avx512::detect().map(|lanes| Self(Kind::Avx512(lanes))));
        }
        levels
    }

    /// The fastest this machine has.
    pub fn best() -> Self {
        Self::available().pop().unwrap_or(Self::PORTABLE)
    }

    /// How many f64 lanes a vector has.
    pub fn width(self) -> usize {
        match self.0 {
            Kind::Portable => Portable::WIDTH,
            #[cfg(target_arch = "x86_64")]
            Kind::Avx2(_) => Avx2::WIDTH,
            #[cfg(target_arch = "x86_64")]
            Kind::Avx512(_) => Avx512::WIDTH,
        }
    }

    /// Runs a task compiled for this instruction set.
    #[inline]
    pub fn run<T: Task>(self, task: T) -> T::Output {
        match self.0 {
            Kind::Portable => task.run(Portable),
            #[cfg(target_arch = "x86_64")]
            Kind::Avx2(lanes) => lanes.run(task),
            #[cfg(target_arch = "x86_64")]
            Kind::Avx512(lanes) => lanes.run(task),
        }
    }
}

impl fmt::Display for Level {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self.0 {
            Kind::Portable => "portable",
            #[cfg(target_arch = "x86_64")]
            Kind::Avx2(_) => "AVX2",
            #[cfg(target_arch = "x86_64")]
            Kind::Avx512(_) => "AVX-512",
        })
    }
}
