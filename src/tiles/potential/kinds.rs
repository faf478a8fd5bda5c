//! Kinds of magnets: their numbers, and what is made of each once.

use std::sync::Arc;

/// The number of the first kind that an item belongs to; a new one, made from its number, if there is none.
pub fn number_of<K>(
    kinds: &mut Vec<K>,
    belongs: impl FnMut(&K) -> bool,
    new: impl FnOnce(usize) -> K,
) -> usize {
    let number = kinds.iter().position(belongs).unwrap_or(kinds.len());
    if number == kinds.len() {
        kinds.push(new(number));
    }
    number
}

/// What is made of kinds, each once.
pub struct Made<K, T>(Vec<(K, Arc<T>)>);

impl<K, T> Default for Made<K, T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<K: PartialEq, T> Made<K, T> {
    /// What is made of a kind, which was made before or is now.
    pub fn of(&mut self, kind: K, make: impl FnOnce() -> T) -> Arc<T> {
        if let Some((_, made)) = self.0.iter().find(|(known, _)| *known == kind) {
            return Arc::clone(made);
        }
        let made = Arc::new(make());
        self.0.push((kind, Arc::clone(&made)));
        made
    }
}
