//! Parallel work on many items. Results come in the items' order, unless the work is
//! [interrupted](crate::interruption).
//!
//! The distribution of work is compiled once for all items and all work, while each parallel
//! iterator of rayon is about 10 kB of code. Those are still used for items that take less than a
//! microsecond.

use std::ops::Range;
use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

use crate::interruption;

/// Number of parts per thread, if there are enough items: few enough that distribution costs
/// nothing, many enough that no thread waits long for the last part.
const PARTS: usize = 32;

/// Items that threads access by index.
pub trait Items: Sync {
    /// The type of an item.
    type Item;
    /// The number of items.
    fn count(&self) -> usize;
    /// The item at an index.
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

/// Applies `f` to each item.
pub fn map<I: Items, T: Send>(items: I, f: impl Fn(I::Item) -> T + Sync) -> Vec<T> {
    collected(items.count(), &|place, found| {
        found.push(f(items.at(place)))
    })
}

/// The same in batches of this size one after the other; `tell` gets before each how many items are done.
pub fn map_in_batches<I: Items, T: Send>(
    items: I,
    size: usize,
    mut tell: impl FnMut(usize),
    f: impl Fn(I::Item) -> T + Sync,
) -> Vec<T> {
    let count = items.count();
    let mut found = Vec::with_capacity(count);
    for first in (0..count).step_by(size) {
        tell(first);
        let batch = first..count.min(first + size);
        found.append(&mut map(batch, |place| f(items.at(place))));
    }
    found
}

/// Applies `f`, which returns any number of results, to each item.
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

/// Does something on one of the threads, so that short parallel parts of it need not wake one each time.
pub fn inside<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    rayon::scope(|_| work())
}

/// The number of threads.
pub fn threads() -> usize {
    rayon::current_num_threads()
}

/// The number of items in a part.
fn size(count: usize) -> usize {
    count.div_ceil(PARTS * threads()).max(1)
}

/// Runs this many parts on all threads; no further part starts once one has failed or was
/// interrupted.
fn shared_out(parts: usize, work: &(dyn Fn(usize) + Sync)) {
    // One thread works here, without waking another and waiting for it.
    if parts == 1 || threads() == 1 {
        (0..parts).for_each(work);
    } else {
        let parts = (0..parts).into_par_iter().with_max_len(1);
        parts.panic_fuse().for_each(work);
    }
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
            let mut told = Vec::new();
            let tell = |done| told.push(done);
            assert_eq!(map_in_batches(&items, 100, tell, |k| k * k), squares);
            assert!(told.into_iter().eq((0..count).step_by(100)));
            for_each(&mut items, |k| *k *= *k);
            assert_eq!(items, squares);
        }
    }
}
