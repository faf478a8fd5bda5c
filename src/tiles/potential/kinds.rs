//! Kinds of magnets, by number.

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
