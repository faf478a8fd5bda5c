//! Soft-iron shields: named by the design file's grammar, not modelled yet.

use super::DesignError;
use super::reader::Entry;

/// The fault of a `shield` key, wherever it stands.
pub(super) fn refused(entry: &Entry) -> DesignError {
    entry.key_error(
        "shields are not supported yet",
        "take `shield` away; the energy is then that of the bare magnets",
    )
}
