//! The page of a set of words.

use serde_json::{Value, json};

use super::meetings::{Carrier, Met};
use super::word_charts::{frontier, histogram};
use super::{Column, Fact, Illustration, Meetings, Page, Table};
use crate::words::{Request, headline, meetings, name};
use physics::units::si;
use physics::words::{Answer, Word};

/// Sets of more words have no heat map.
const MOST_DRAWN: usize = 80;

impl Page {
    /// The page of an answer.
    pub fn of_words(request: &Request, answer: &Answer) -> Self {
        let mut facts = vec![Fact {
            name: "words".to_owned(),
            value: answer.words.len().to_string(),
            note: match answer.proved {
                true => "proved".to_owned(),
                false => format!("at most {}", answer.upper),
            },
        }];
        if let Some(judgement) = &answer.judgement {
            let fact = |name: &str, value, note: &str| Fact {
                name: name.to_owned(),
                value,
                note: note.to_owned(),
            };
            facts.push(fact("gap", format!("{:.4}", judgement.gap), ""));
            facts.push(fact(
                "weakest bond",
                si(judgement.bond, "J", 4),
                "flush, at contact",
            ));
            if let Some(worst) = judgement.worst {
                let note = format!("{} on {}", worst.first, worst.second);
                facts.push(fact(
                    "strongest wrong meeting",
                    si(worst.energy, "J", 4),
                    &note,
                ));
            }
        }
        let mut pictures = Vec::new();
        if (1..=MOST_DRAWN).contains(&answer.words.len()) {
            pictures.push(Illustration {
                is_titled: false,
                title: "Gaps of all pairs of words".to_owned(),
                svg: histogram(&gaps(request, answer)),
            });
        }
        if !answer.frontier.is_empty() {
            pictures.push(Illustration {
                is_titled: false,
                title: "Number of words against the gap".to_owned(),
                svg: frontier(answer),
            });
        }
        let bar = &request.bar;
        let title = format!(
            "{} words of {} magnets",
            answer.words.len(),
            request.task.magnets
        );
        Self {
            subtitle: headline(request, answer),
            facts,
            meetings: (1..=MOST_DRAWN)
                .contains(&answer.words.len())
                .then(|| meetings_of(request, answer)),
            pictures,
            tables: vec![words(request, &answer.words)],
            origin: format!(
                "tilebind {}, seed {}; {}; {} magnets, places {} apart",
                env!("CARGO_PKG_VERSION"),
                request.seed,
                meetings(request),
                bar.model.name(),
                si(bar.pitch, "m", 3)
            ),
            ..Self::titled(title)
        }
    }
}

/// All faces against all, flush.
fn meetings_of(request: &Request, answer: &Answer) -> Meetings {
    let (task, bar, words) = (&request.task, &request.bar, &answer.words);
    let middle = (task.places as f64 - 1.0) / 2.0;
    let place = |k: usize| (k as f64 - middle) * bar.pitch;
    let carrier = Carrier {
        side: request.side(),
        places: (0..task.places).map(place).collect(),
        size: [bar.size[0], bar.size[1]],
        inset: bar.inset,
    };
    let named = words.iter().enumerate();
    let (own, mates): (Vec<_>, Vec<_>) = named
        .map(|(k, word)| {
            let face = |name, word: Word| (name, word.to_string(), word);
            (face(name(k), *word), face(name(k) + "*", word.mate()))
        })
        .unzip();
    let faces = [own, mates].concat();
    let m = words.len();
    let met = |i: usize, j: usize| {
        // Where words meet mates only, two words do not, nor two mates.
        if !task.rules.words_meet() && (i < m) == (j < m) {
            return None;
        }
        let worst = task
            .rules
            .strongest_of(&request.energies, faces[i].2, faces[j].2)?;
        Some(Met {
            energy: worst.energy,
            lower: None,
            pose: carrier.flush(f64::from(worst.slide) * bar.pitch),
            over: worst.flipped,
        })
    };
    let bond = answer.judgement.as_ref().map_or(1.0, |it| it.bond);
    Meetings::new(&carrier, &faces, bond, met).titled(
        "Strongest wrong meeting of every two faces",
        "Rows and columns are words and their mates; a number is the attraction as a share of the \
         weakest bond, of flush faces at every slide by whole places. Framed: a word and its own \
         mate, slid. Click a cell to see the tiles.",
    )
}

fn words(request: &Request, words: &[Word]) -> Table {
    let rows = words.iter().enumerate().map(|(k, word)| {
        let worst = words
            .iter()
            .filter_map(|other| {
                request
                    .task
                    .rules
                    .strongest(&request.energies, *word, *other)
            })
            .min_by(|a, b| a.energy.total_cmp(&b.energy));
        vec![
            json!(name(k)),
            json!(word.to_string()),
            json!(word.mate().to_string()),
            json!(-request.task.rules.bond(&request.energies, *word)),
            worst.map_or(Value::Null, |it| json!(it.energy)),
            worst.map_or(Value::Null, |it| json!(it.second.to_string())),
            worst.map_or(Value::Null, |it| json!(it.slide)),
        ]
    });
    Table {
        title: "Words".to_owned(),
        note: "Read counter-clockwise. The worst meeting is the wrong one that attracts most, by \
               energies of flush faces; slides in places."
            .to_owned(),
        columns: vec![
            Column::new("name", ""),
            Column::new("word", ""),
            Column::new("mate", ""),
            Column::new("bond", "J"),
            Column::new("worst meeting", "J"),
            Column::new("with", ""),
            Column::new("slide", ""),
        ],
        rows: rows.collect(),
        states: Vec::new(),
        paths: Vec::new(),
    }
}

/// The attractions of all pairs as shares of the weakest bond.
fn shares(request: &Request, words: &[Word]) -> Vec<Vec<f64>> {
    let bonds = words
        .iter()
        .map(|word| request.task.rules.bond(&request.energies, *word));
    let weakest = bonds.fold(f64::INFINITY, f64::min);
    let share = |u: &Word, v: &Word| {
        let worst = request.task.rules.strongest(&request.energies, *u, *v);
        worst.map_or(0.0, |it| (-it.energy / weakest).max(0.0))
    };
    words
        .iter()
        .map(|u| words.iter().map(|v| share(u, v)).collect())
        .collect()
}

/// 1 less the share of the weakest bond of every two words.
fn gaps(request: &Request, answer: &Answer) -> Vec<f64> {
    let all = shares(request, &answer.words);
    let above = all.iter().enumerate().flat_map(|(i, row)| &row[i..]);
    above.map(|share| 1.0 - share).collect()
}
