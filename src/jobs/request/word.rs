//! Options that take one of a few words, which shells complete.

use super::Reader;
use crate::design::MagnetModel;

/// A magnet model by its name in design files.
pub fn model() -> Word<MagnetModel> {
    Word::new(&MagnetModel::NAMES, "a model is dipole or cuboid")
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
    pub fn new(names: &[(&'static str, T)], wrong: impl Into<String>) -> Self {
        Self {
            names: names.to_vec(),
            wrong: wrong.into(),
        }
    }
}

impl<T: Clone + Send + Sync + 'static> Reader for Word<T> {
    type Value = T;

    fn read(&self, text: &str) -> Result<T, String> {
        self.names
            .iter()
            .find(|(name, _)| *name == text)
            .map(|(_, meaning)| meaning.clone())
            .ok_or_else(|| self.wrong.clone())
    }

    fn words(&self) -> Vec<&'static str> {
        self.names.iter().map(|(name, _)| *name).collect()
    }
}
