//! Every two tiles that meet, and how deep their bond is with all faces of either.

use super::{Assembly, designs};
use crate::csv::table;

/// A line a pair: its design, the word of its bond, the energy of the two faces that meet (the
/// matrix's), of all other faces, and of the whole tiles, which `tilebind energy` has of the design.
pub(super) fn csv(assembly: &Assembly) -> String {
    let built = assembly.built;
    let rows = designs::named(assembly)
        .into_iter()
        .filter_map(|(name, met)| {
            let (bond, rest) = built.whole(&met)?;
            let faces = -built.matrix.bond(bond);
            let mut row = vec![format!("designs/{name}.toml"), assembly.face(bond)];
            row.extend(
                [faces, rest, faces + rest, (faces + rest) / built.shaking.kt]
                    .map(|x| x.to_string()),
            );
            Some(row)
        });
    let header = [
        "design",
        "word",
        "faces_J",
        "other_faces_J",
        "tiles_J",
        "tiles_kT",
    ];
    table(header.map(str::to_owned), rows)
}

/// By which share of its depth a bond is deeper in whole tiles than of two faces: the least and the
/// most of all pairs.
pub(crate) fn deeper(assembly: &Assembly) -> Option<[f64; 2]> {
    let built = assembly.built;
    let met = built.grown.meetings().into_keys();
    let shares = met.filter_map(|met| {
        let (bond, rest) = built.whole(&met)?;
        Some(-rest / built.matrix.bond(bond))
    });
    shares.fold(None, |range, share| {
        let [low, high] = range.unwrap_or([share; 2]);
        Some([share.min(low), share.max(high)])
    })
}

/// The same in words.
pub(super) fn sentence(assembly: &Assembly) -> Option<String> {
    let [least, most] = deeper(assembly)?;
    let percent = |share: f64| format!("{:.1} %", 100.0 * share.abs());
    // Less than a tenth of a percent is neither.
    let told = match (least < -5e-4, most > 5e-4) {
        (true, true) => format!(
            "from {} shallower to {} deeper",
            percent(least),
            percent(most)
        ),
        (true, false) => format!("up to {} shallower and none deeper", percent(least)),
        (false, true) => format!("up to {} deeper and none shallower", percent(most)),
        (false, false) => "as deep".to_owned(),
    };
    Some(format!(
        "in whole tiles bonds are {told} than of two faces, as engines have them"
    ))
}
