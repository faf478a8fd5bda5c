//! The designs of the repository.

use std::path::Path;

use tilebind::design::Design;

/// The design of a file, named from the root of the repository.
pub fn load(file: &str) -> Design {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    Design::load(&path).unwrap_or_else(|error| panic!("{error}"))
}
