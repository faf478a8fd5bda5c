//! Many designs from one.
