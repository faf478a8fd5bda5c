//! Assembles a page from its parts.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use physics::order::Order;
use sha2::{Digest, Sha256};

/// The citation as BibTeX: the program, and the paper it follows.
pub const CITATION: &str = concat!(
    "@software{tilebind,\n",
    "  title   = {tilebind: how two magnetic tiles bind},\n",
    "  author  = {{The tilebind authors}},\n",
    "  version = {",
    env!("CARGO_PKG_VERSION"),
    "},\n",
    "  year    = {2026},\n",
    "}\n",
    "@misc{majumder-reif,\n",
    "  title   = {Barcoded Magnetic Tiles for Programmable Assemblies},\n",
    "  author  = {Majumder, U. and Reif, J.},\n",
    "}\n"
);

/// A template with its placeholders replaced. Each occurs once; replacements are not searched for
/// further placeholders.
pub fn filled(template: &str, parts: &[(&str, String)]) -> String {
    let mut places: Vec<_> = parts
        .iter()
        .filter_map(|(name, value)| Some((template.find(name)?, *name, value)))
        .collect();
    places.order_by_key(|(at, ..)| *at);
    let mut text = String::new();
    let mut rest = 0;
    for (at, name, value) in places {
        text.push_str(&template[rest..at]);
        text.push_str(value);
        rest = at + name.len();
    }
    text.push_str(&template[rest..]);
    text
}

/// A source of a content security policy.
pub fn hash(content: &str) -> String {
    let digest = STANDARD.encode(Sha256::digest(content.as_bytes()));
    format!("'sha256-{digest}'")
}

/// A text escaped for markup.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;")
}
