//! The instruction sets, and the choice between them.

use std::ffi::OsStr;
use std::fmt;
use std::sync::LazyLock;

use super::lanes::Task;
#[cfg(any(not(target_arch = "x86_64"), test, feature = "portable"))]
use super::portable::Portable;
#[cfg(target_arch = "x86_64")]
use super::x86::{Avx2, Avx512};

/// An instruction set of this machine. Results are the same bits with each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Level(InstructionSet);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum InstructionSet {
    #[cfg(any(not(target_arch = "x86_64"), test, feature = "portable"))]
    Portable(Portable),
    #[cfg(target_arch = "x86_64")]
    Avx2(Avx2),
    #[cfg(target_arch = "x86_64")]
    Avx512(Avx512),
}

/// The environment variable that names the level to use.
const VARIABLE: &str = "TILEBIND_KERNEL";

/// The names of the levels in it, fastest first.
const WORDS: [&str; 3] = ["avx512", "avx2", PORTABLE];
const PORTABLE: &str = "portable";

impl Level {
    /// The levels of this machine, slowest first. Plain Rust is the only one of other architectures
    /// than x86-64; there it is built for tests, with the feature `portable`.
    pub fn available() -> Vec<Self> {
        let mut levels = Vec::new();
        #[cfg(any(not(target_arch = "x86_64"), test, feature = "portable"))]
        levels.push(Self(InstructionSet::Portable(Portable)));
        #[cfg(target_arch = "x86_64")]
        {
            levels.extend(Avx2::detect().map(|lanes| Self(InstructionSet::Avx2(lanes))));
            levels.extend(Avx512::detect().map(|lanes| Self(InstructionSet::Avx512(lanes))));
        }
        levels
    }

    /// The level requested by the environment variable `TILEBIND_KERNEL` (`avx512` or `avx2`;
    /// elsewhere than on x86-64 `portable`), or the fastest of this machine.
    ///
    /// # Errors
    /// If the processor has neither, or the variable has an unknown value or names a level that is
    /// not here; the text says how to fix it.
    pub fn chosen() -> Result<Self, String> {
        choose(&Self::available(), std::env::var_os(VARIABLE).as_deref())
    }

    /// The [chosen](Self::chosen) level, determined once per process. If that is an error (which
    /// the program and the Python package report before they compute anything), the fastest: the
    /// results are the same.
    pub fn best() -> Self {
        static BEST: LazyLock<Level> = LazyLock::new(|| {
            Level::chosen().unwrap_or_else(|why| Level::available().pop().expect(&why))
        });
        *BEST
    }

    /// Its name in the environment variable.
    pub fn word(self) -> &'static str {
        match self.0 {
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx512(_) => WORDS[0],
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx2(_) => WORDS[1],
            #[cfg(any(not(target_arch = "x86_64"), test, feature = "portable"))]
            InstructionSet::Portable(_) => PORTABLE,
        }
    }

    /// Runs a task compiled for this instruction set.
    #[inline]
    pub fn run<T: Task>(self, task: T) -> T::Output {
        // To compile a task for all instruction sets takes long. This crate's own tests do with plain
        // Rust; `tests/physics` tries every level.
        #[cfg(test)]
        if cfg!(test) {
            return Portable.run(task);
        }
        match self.0 {
            #[cfg(any(not(target_arch = "x86_64"), test, feature = "portable"))]
            InstructionSet::Portable(lanes) => lanes.run(task),
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx2(lanes) => lanes.run(task),
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx512(lanes) => lanes.run(task),
        }
    }
}

/// The level with a name among those of a machine, slowest first, or the fastest.
fn choose(available: &[Level], asked: Option<&OsStr>) -> Result<Level, String> {
    let Some(&fastest) = available.last() else {
        return Err(
            "this processor has neither AVX-512 nor AVX2 with FMA, which tilebind needs on \
                    x86-64: use a processor from 2013 or later, or build tilebind with \
                    --features portable"
                .to_owned(),
        );
    };
    let Some(word) = asked else {
        return Ok(fastest);
    };
    if let Some(level) = available.iter().find(|level| word == level.word()) {
        return Ok(*level);
    }
    let here = available.iter().rev().map(|level| level.word());
    let here = here.collect::<Vec<_>>().join(", ");
    let why = match WORDS.iter().find(|known| word == **known) {
        Some(&PORTABLE) => {
            "asks for portable, which is built on x86-64 only with --features portable".to_owned()
        }
        Some(known) => format!("asks for {known}, which this processor lacks"),
        None => format!(
            "is '{}', which is not an instruction set of tilebind",
            word.display()
        ),
    };
    Err(format!(
        "{VARIABLE} {why}; leave {VARIABLE} unset, or set it to one of: {here}"
    ))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_processor_without_any_level_is_refused_whatever_is_asked() {
        for asked in [None, Some("avx2"), Some("portable")] {
            let said = choose(&[], asked.map(OsStr::new)).unwrap_err();
            assert!(
                said.contains("AVX2") && said.contains("--features portable"),
                "{said}"
            );
        }
    }

    #[test]
    fn levels_that_are_not_there_are_named_with_those_that_are() {
        let there = [Level(InstructionSet::Portable(Portable))];
        assert_eq!(choose(&there, None), Ok(there[0]));
        assert_eq!(choose(&there, Some(OsStr::new(PORTABLE))), Ok(there[0]));
        for (asked, why) in [("avx512", "lacks"), ("sse2", "not an instruction set")] {
            let said = choose(&there, Some(OsStr::new(asked))).unwrap_err();
            assert!(
                said.contains(why) && said.ends_with("one of: portable"),
                "{said}"
            );
        }
    }
}
