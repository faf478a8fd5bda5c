//! Stable sorting whose code is compiled only once: it sorts the items' indices.
//!
//! The standard library's stable sort is about 9 kB of code for each type of item and each order,
//! and faster if very many items are sorted very often.

use std::cmp::Ordering;

/// Up to this many items are sorted in place, without indices.
const FEW: usize = 20;

/// Lists that can be sorted stably.
pub trait Order<T> {
    /// By a total order.
    fn order_by(&mut self, compare: impl Fn(&T, &T) -> Ordering);

    /// By a key, ascending.
    fn order_by_key<K: Ord>(&mut self, key: impl Fn(&T) -> K);
}

impl<T> Order<T> for [T] {
    fn order_by(&mut self, compare: impl Fn(&T, &T) -> Ordering) {
        ordered(self, &compare);
    }

    fn order_by_key<K: Ord>(&mut self, key: impl Fn(&T) -> K) {
        ordered(self, &|a, b| key(a).cmp(&key(b)));
    }
}

fn ordered<T>(items: &mut [T], compare: &dyn Fn(&T, &T) -> Ordering) {
    if items.len() <= FEW {
        for end in 1..items.len() {
            let mut at = end;
            while at > 0 && compare(&items[at], &items[at - 1]) == Ordering::Less {
                items.swap(at, at - 1);
                at -= 1;
            }
        }
        return;
    }
    let mut from = places(items.len(), &|a, b| compare(&items[a], &items[b]));
    for start in 0..items.len() {
        // Follows a cycle of items that replace each other.
        let mut at = start;
        while from[at] != start {
            let next = std::mem::replace(&mut from[at], at);
            items.swap(at, next);
            at = next;
        }
        from[at] = at;
    }
}

/// The sorted indices of this many items.
fn places(count: usize, compare: &dyn Fn(usize, usize) -> Ordering) -> Vec<usize> {
    let mut places: Vec<usize> = (0..count).collect();
    places.sort_by(|&a, &b| compare(a, b));
    places
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_of_any_length_are_sorted_as_the_standard_library_sorts_them() {
        for count in (0..50).chain([1000]) {
            let mut items: Vec<(usize, usize)> = (0..count).map(|k| (k * k * 7 % 13, k)).collect();
            let mut expected = items.clone();
            expected.sort_by_key(|(key, _)| *key);
            items.order_by_key(|(key, _)| *key);
            assert_eq!(items, expected);
            expected.sort_by_key(|item| std::cmp::Reverse(item.0));
            items.order_by(|a, b| b.0.cmp(&a.0));
            assert_eq!(items, expected);
        }
    }
}
