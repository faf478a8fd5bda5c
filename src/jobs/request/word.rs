//! Options that take one of a few words, which shells complete.

use std::ffi::OsStr;

use clap::builder::{PossibleValue, TypedValueParser};
use clap::{Arg, Command, Error};

use crate::design::MagnetModel;

/// A magnet model by its name in design files.
pub fn model() -> Word<MagnetModel> {
    let wrong = "a model is dipole or cuboid".to_owned();
    Word::new(&MagnetModel::NAMES, wrong)
}

/// A parser of one of several names.
#[derive(Clone)]
pub struct Word<T> {
    names: Vec<(&'static str, T)>,
    /// The message for any other word.
    wrong: String,
}

impl<T: Clone> Word<T> {
    /// A parser of these names; `wrong` is the message for any other word.
    pub fn new(names: &[(&'static str, T)], wrong: String) -> Self {
        Self {
            names: names.to_vec(),
            wrong,
        }
    }

    fn read(&self, text: &str) -> Result<T, String> {
        self.names
            .iter()
            .find(|(name, _)| *name == text)
            .map(|(_, meaning)| meaning.clone())
            .ok_or_else(|| self.wrong.clone())
    }
}

impl<T: Clone + Send + Sync + 'static> TypedValueParser for Word<T> {
    type Value = T;

    fn parse_ref(
        &self,
        command: &Command,
        argument: Option<&Arg>,
        value: &OsStr,
    ) -> Result<T, Error> {
        let word = self.clone();
        (move |text: &str| word.read(text)).parse_ref(command, argument, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(
            self.names.iter().map(|(name, _)| PossibleValue::new(name)),
        ))
    }
}
