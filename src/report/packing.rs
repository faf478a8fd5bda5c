//! Compresses bytes.

use std::io::Write;

use flate2::Compression;
use flate2::write::ZlibEncoder;

/// In zlib's format, which PDF and browsers read.
///
/// # Panics
/// Never: writing to memory cannot fail.
pub(super) fn deflated(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::new(6));
    encoder
        .write_all(bytes)
        .and_then(|()| encoder.finish())
        .expect("memory takes all that is written")
}
