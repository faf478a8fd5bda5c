//! Lists that are mostly short.

use smallvec::SmallVec;

/// A value of each tile; up to four need no allocation.
pub type Each<T> = SmallVec<[T; 4]>;
/// A value of each point of contact.
pub type Points<T> = SmallVec<[T; 8]>;
