//! Parallel work on many items. Results come in the items' order, unless the work is
//! [interrupted](crate::interruption).
//!
//! What shares the work out is compiled once, for all items and all work, where each parallel
//! iterator of rayon is some 10 kB of code. Those are left where items take less than a microsecond.

use std::ops::Range;
use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

use crate::interruption;

/// Of so many parts a thread the work consists, where there are as many items: few enough that
/// sharing them out costs nothing, many enough that no thread waits long for the last.
const PARTS: usize = 256;

/// Items that threads take by their place.
pub trait Items: Sync {
    /// What a thread is given.
    type Item;
    /// How many there are.
    fn count(&self) -> usize;
    /// The one at a place.
    fn at(&self, place: usize) -> Self::Item;
}

impl<'a, I: Sync> Items for &'a [I] {
    type Item = &'a I;

    fn count(&self) -> usize {
        self.len()
    }

    fn at(&self, place: usize) -> &'a I {
        &self[place]
    }
}

impl<'a, I: Sync> Items for &'a Vec<I> {
    type Item = &'a I;

    fn count(&self) -> usize {
        self.len()
    }

    fn at(&self, place: usize) -> &'a I {
        &self[place]
    }
}

impl Items for Range<usize> {
    type Item = usize;

    fn count(&self) -> usize {
        self.len()
    }

    fn at(&self, place: usize) -> usize {
        self.start + place
    }
}

/// What `f` makes of each item.
pub fn map<I: Items, T: Send>(items: I, f: impl Fn(I::Item) -> T + Sync) -> Vec<T> {
    collected(items.count(), &|place, found| {
        found.push(f(items.at(place)))
    })
}

/// All that `f` makes of each item: none, one or many.
pub fn flat_map<I: Items, C: IntoIterator>(
    items: I,
    f: impl Fn(I::Item) -> C + Sync,
) -> Vec<C::Item>
where
    C::Item: Send,
{
    collected(items.count(), &|place, found| {
        found.extend(f(items.at(place)))
    })
}

/// Does something with each item.
pub fn for_each<I: Send>(items: &mut [I], f: impl Fn(&mut I) + Sync) {
    let parts: Vec<_> = items
        .chunks_mut(size(items.len()))
        .map(Mutex::new)
        .collect();
    shared_out(parts.len(), &|part| {
        let mut part = parts[part].lock().unwrap_or_else(PoisonError::into_inner);
        part.iter_mut().for_each(&f);
    });
}

fn collected<T: Send>(count: usize, put: &(dyn Fn(usize, &mut Vec<T>) + Sync)) -> Vec<T> {
    let size = size(count);
    let mut found: Vec<Mutex<Vec<T>>> = Vec::new();
    found.resize_with(count.div_ceil(size), Mutex::default);
    shared_out(found.len(), &|part| {
        let mut of_part = Vec::new();
        for place in part * size..count.min((part + 1) * size) {
            interruption::check();
            put(place, &mut of_part);
        }
        *found[part].lock().unwrap_or_else(PoisonError::into_inner) = of_part;
    });
    let of_part = |part: Mutex<Vec<T>>| part.into_inner().unwrap_or_else(PoisonError::into_inner);
    let found: Vec<Vec<T>> = found.into_iter().map(of_part).collect();
    let mut all = Vec::with_capacity(found.iter().map(Vec::len).sum());
    for mut part in found {
        all.append(&mut part);
    }
    all
}

/// On how many threads work is shared out.
pub fn threads() -> usize {
    rayon::current_num_threads()
}

/// How many of so many items are a part.
fn size(count: usize) -> usize {
    count.div_ceil(PARTS * rayon::current_num_threads()).max(1)
}

/// Does each of so many parts, on all threads; once one has failed or is given up, no other is begun.
fn shared_out(parts: usize, work: &(dyn Fn(usize) + Sync)) {
    let parts = (0..parts).into_par_iter().with_max_len(1);
    parts.panic_fuse().for_each(work);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_in_the_order_of_the_items() {
        for count in [0, 1, 2, 127, 1000, 12_345] {
            let mut items: Vec<usize> = (0..count).collect();
            let squares: Vec<usize> = items.iter().map(|k| k * k).collect();
            let twice: Vec<usize> = items.iter().flat_map(|&k| [k, k]).collect();
            assert_eq!(map(0..count, |k| k * k), squares);
            assert_eq!(map(&items, |k| k * k), squares);
            assert_eq!(flat_map(&items, |&k| [k, k]), twice);
            for_each(&mut items, |k| *k *= *k);
            assert_eq!(items, squares);
        }
    }
}
