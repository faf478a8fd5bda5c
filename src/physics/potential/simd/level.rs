//! The instruction sets, and the choice between them.

use std::fmt;
use std::sync::LazyLock;

use super::lanes::Task;
use super::portable::Portable;
#[cfg(target_arch = "x86_64")]
use super::x86::{Avx2, Avx512};

/// An instruction set of this machine. Results are the same bits with each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Level(Kind);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Portable(Portable),
    #[cfg(target_arch = "x86_64")]
    Avx2(Avx2),
    #[cfg(target_arch = "x86_64")]
    Avx512(Avx512),
}

/// The environment variable that names the level to use.
const VARIABLE: &str = "TILEBIND_KERNEL";

/// The names of the levels in it, fastest first.
const WORDS: [&str; 3] = ["avx512", "avx2", "portable"];

impl Level {
    /// The levels of this machine, slowest first; plain Rust is always available.
    pub fn available() -> Vec<Self> {
        let mut levels = vec![Self(Kind::Portable(Portable))];
        #[cfg(target_arch = "x86_64")]
        {
            levels.extend(Avx2::detect().map(|lanes| Self(Kind::Avx2(lanes))));
            levels.extend(Avx512::detect().map(|lanes| Self(Kind::Avx512(lanes))));
        }
        levels
    }

    /// The level requested by the environment variable `TILEBIND_KERNEL` (`avx512`, `avx2` or
    /// `portable`), or the fastest of this machine.
    ///
    /// # Errors
    /// If the variable has an unknown value or names a level that this processor lacks; the text
    /// says how to fix it.
    pub fn chosen() -> Result<Self, String> {
        let mut levels = Self::available().into_iter().rev();
        let Some(word) = std::env::var_os(VARIABLE) else {
            return Ok(levels.next().expect("plain Rust is everywhere"));
        };
        let here = levels
            .clone()
            .map(Self::word)
            .collect::<Vec<_>>()
            .join(", ");
        let fix = format!("leave {VARIABLE} unset, or set it to one of: {here}");
        match levels.find(|level| word == level.word()) {
            Some(level) => Ok(level),
            None if WORDS.iter().any(|known| word == *known) => Err(format!(
                "{VARIABLE} asks for {}, which this processor lacks; {fix}",
                word.display()
            )),
            None => Err(format!(
                "{VARIABLE} is '{}', which is not an instruction set of tilebind; {fix}",
                word.display()
            )),
        }
    }

    /// The [chosen](Self::chosen) level, determined once per process. If that is an error (which
    /// the program and the Python package report before they compute anything), the fastest: the
    /// results are the same.
    pub fn best() -> Self {
        static BEST: LazyLock<Level> = LazyLock::new(|| {
            let fastest = || Level::available().pop().expect("plain Rust is everywhere");
            Level::chosen().unwrap_or_else(|_| fastest())
        });
        *BEST
    }

    /// Its name in the environment variable.
    pub fn word(self) -> &'static str {
        match self.0 {
            #[cfg(target_arch = "x86_64")]
            Kind::Avx512(_) => WORDS[0],
            #[cfg(target_arch = "x86_64")]
            Kind::Avx2(_) => WORDS[1],
            Kind::Portable(_) => WORDS[2],
        }
    }

    /// Runs a task compiled for this instruction set.
    #[inline]
    pub fn run<T: Task>(self, task: T) -> T::Output {
        // To compile a task for all instruction sets takes long. This crate's own tests do with plain
        // Rust; `tests/physics` tries every level.
        if cfg!(test) {
            return Portable.run(task);
        }
        match self.0 {
            Kind::Portable(lanes) => lanes.run(task),
            #[cfg(target_arch = "x86_64")]
            Kind::Avx2(lanes) => lanes.run(task),
            #[cfg(target_arch = "x86_64")]
            Kind::Avx512(lanes) => lanes.run(task),
        }
    }
}

impl fmt::Display for Level {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self.word() {
            "avx512" => "AVX-512",
            "avx2" => "AVX2",
            word => word,
        })
    }
}
