//! The page of a set of words judged over all poses.

use super::meetings::{Carrier, Met};
use super::word_charts::histogram;
use super::{Fact, Illustration, Meetings, Page};
use crate::crosstalk::{face_name, faces, headline, is_bond};
use jobs::design::WordSet;
use physics::units::si;
use physics::words::Word;
use physics::words::crosstalk::Crosstalk;

/// Sets of more words have no map.
const MOST_DRAWN: usize = 80;

impl Page {
    /// The page of the crosstalk of a set.
    pub fn of_crosstalk(set: &WordSet, found: &Crosstalk) -> Self {
        let fact = |name: &str, value: String, note: &str| Fact {
            name: name.to_owned(),
            value,
            note: note.to_owned(),
        };
        let mut facts = vec![fact("words", found.words.len().to_string(), "")];
        if let (Some((_, bond)), Some(gap)) = (found.weakest_bond(), found.gap()) {
            facts.push(fact("gap", format!("{gap:.4}"), "over sampled poses"));
            facts.push(fact("weakest bond", si(-bond, "J", 4), ""));
        }
        if let Some(([i, j], energy, _)) = found.strongest_wrong() {
            let note = format!(
                "{} on {}",
                face_name(set, found, i),
                face_name(set, found, j)
            );
            facts.push(fact("strongest wrong meeting", si(energy, "J", 4), &note));
        }
        let drawn = (1..=MOST_DRAWN).contains(&found.words.len());
        Self {
            subtitle: headline(set, found),
            facts,
            meetings: drawn.then(|| meetings(set, found)),
            pictures: vec![Illustration {
                is_titled: false,
                title: "Gaps of all pairs of faces".to_owned(),
                svg: histogram(&gaps(found)),
            }],
            origin: format!(
                "tilebind {}; {} magnets; all poses in which two faces can meet",
                env!("CARGO_PKG_VERSION"),
                set.stage.interaction.model.name()
            ),
            ..Self::titled(format!("Crosstalk of {} words", found.words.len()))
        }
    }
}

/// 1 less the share of the weakest bond of every two faces that are no word and its own mate, and of
/// traps.
fn gaps(found: &Crosstalk) -> Vec<f64> {
    let bond = found.weakest_bond().map_or(-1.0, |bond| bond.1);
    let n = found.strongest.len();
    let pairs = (0..n).flat_map(|i| (i..n).map(move |j| (i, j)));
    let others = pairs
        .filter(|(i, j)| !is_bond(found, *i, *j))
        .map(|(i, j)| found.strongest[i][j]);
    let traps = found.traps.iter().flatten().map(|trap| trap.0);
    others
        .chain(traps)
        .map(|energy| 1.0 - energy.min(0.0) / bond)
        .collect()
}

fn meetings(set: &WordSet, found: &Crosstalk) -> Meetings {
    let pair = &set.stage.pair;
    let face = pair.target_face();
    let magnets = &pair.fixed.magnets;
    let along = face.tangent();
    let places = magnets
        .iter()
        .map(|magnet| (magnet.position - face.middle()).dot(&along))
        .collect();
    let carrier = Carrier::of_magnets(face.length(), face.normal(), magnets, places);
    let m = found.words.len();
    let of: Vec<Word> = found
        .words
        .iter()
        .copied()
        .chain(found.words.iter().map(|word| word.mate()))
        .collect();
    let faces: Vec<(String, String, Word)> = faces(found)
        .into_iter()
        .enumerate()
        .map(|(k, code)| (face_name(set, found, k), code, of[k]))
        .collect();
    let met = |i: usize, j: usize| {
        if is_bond(found, i, j) {
            let (energy, pose) = found.traps[i.min(j)]?;
            let pose = found.seen_from(&pose, i < m);
            return Some(Met {
                energy,
                lower: None,
                pose,
                over: false,
            });
        }
        Some(Met {
            energy: found.strongest[i][j],
            lower: found.lower.as_ref().map(|lower| lower[i][j]),
            pose: found.poses[i][j],
            over: false,
        })
    };
    let bond = found.weakest_bond().map_or(1.0, |bond| -bond.1);
    Meetings::new(&carrier, &faces, bond, met).titled(
        "Strongest wrong meeting of every two faces, over all poses",
        "Rows and columns are words and their mates; a number is the attraction as a share of the \
         weakest bond, slid, tilted or drawn back. Framed: a word and its own mate, in their deepest \
         trap. Click a cell to see the tiles.",
    )
}
