//! Curves of a sweep.
