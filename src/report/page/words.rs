//! The page of a set of words.

use serde_json::{Value, json};

use super::{Column, Fact, Illustration, Page, Table};
use crate::report::words::{Request, headline, meetings, name};
use crate::units::si;
use crate::words::rules::bond;
use crate::words::{Answer, Word};

/// Sets of more words have no heat map.
const MOST_DRAWN: usize = 150;

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
                title: "Strongest wrong attraction of every two words, with their mates".to_owned(),
                svg: heat_map(request, &answer.words),
            });
            pictures.push(Illustration {
                title: "Gaps of all pairs of words".to_owned(),
                svg: histogram(request, answer),
            });
        }
        if !answer.frontier.is_empty() {
            pictures.push(Illustration {
                title: "Number of words against the gap".to_owned(),
                svg: frontier(answer),
            });
        }
        let bar = &request.bar;
        Self {
            title: format!(
                "{} words of {} magnets",
                answer.words.len(),
                request.task.magnets
            ),
            subtitle: headline(request, answer),
            facts,
            landscape: None,
            charts: None,
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
        }
    }
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
            json!(-bond(&request.energies, *word)),
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
    }
}

/// The attractions of all pairs as shares of the weakest bond.
fn shares(request: &Request, words: &[Word]) -> Vec<Vec<f64>> {
    let bonds = words.iter().map(|word| bond(&request.energies, *word));
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

const OPEN: &str = "<svg xmlns=\"http://www.w3.org/2000/svg\" font-family=\"Noto Sans, Helvetica, \
                    Arial, sans-serif\"";

/// White to dark blue: readable in grey and to the colour-blind.
fn colour(share: f64) -> String {
    let t = share.clamp(0.0, 1.0);
    let mix = |from: f64, to: f64| (from + (to - from) * t).round();
    format!(
        "rgb({},{},{})",
        mix(247.0, 8.0),
        mix(251.0, 48.0),
        mix(255.0, 107.0)
    )
}

fn heat_map(request: &Request, words: &[Word]) -> String {
    use std::fmt::Write;
    let shares = shares(request, words);
    let n = words.len();
    let cell = (560.0 / n as f64).clamp(5.0, 44.0);
    let (left, size) = (56.0, cell * n as f64);
    let (width, height) = (left + size + 120.0, left + size + 20.0);
    let mut svg = format!(
        "{OPEN} viewBox=\"0 0 {width:.0} {height:.0}\" width=\"{width:.0}\" \
         height=\"{height:.0}\"><rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>"
    );
    let every = (14.0 / cell).ceil() as usize;
    for (i, row) in shares.iter().enumerate() {
        let middle = left + cell * (i as f64 + 0.5);
        if i % every == 0 {
            let name = name(i);
            let _ = write!(
                svg,
                "<text x=\"{:.1}\" y=\"{:.1}\" font-size=\"12\" text-anchor=\"end\" \
                 fill=\"#222\">{name}</text><text x=\"{middle:.1}\" y=\"{:.1}\" font-size=\"12\" \
                 text-anchor=\"middle\" fill=\"#222\">{name}</text>",
                left - 6.0,
                middle + 4.0,
                left - 8.0
            );
        }
        for (j, share) in row.iter().enumerate() {
            let (x, y) = (left + cell * j as f64, left + cell * i as f64);
            let meeting = request
                .task
                .rules
                .strongest(&request.energies, words[i], words[j]);
            let told = meeting.map_or(String::new(), |it| {
                format!(
                    "{} on {}, slide {}: {}",
                    it.first,
                    it.second,
                    it.slide,
                    si(it.energy, "J", 4)
                )
            });
            let _ = write!(
                svg,
                "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{cell:.1}\" height=\"{cell:.1}\" \
                 fill=\"{}\" stroke=\"#fff\" stroke-width=\"0.5\"><title>{told}</title></rect>",
                colour(*share)
            );
            if cell >= 30.0 {
                let ink = if *share > 0.5 { "#fff" } else { "#222" };
                let _ = write!(
                    svg,
                    "<text x=\"{:.1}\" y=\"{:.1}\" font-size=\"11\" text-anchor=\"middle\" \
                     fill=\"{ink}\" pointer-events=\"none\">{share:.2}</text>",
                    x + cell / 2.0,
                    y + cell / 2.0 + 4.0
                );
            }
        }
    }
    let x = left + size + 24.0;
    for k in 0..=10 {
        let (share, y) = (k as f64 / 10.0, left + 14.0 * f64::from(10 - k));
        let _ = write!(
            svg,
            "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"18\" height=\"14\" fill=\"{}\"/>",
            colour(share)
        );
        if k % 5 == 0 {
            let _ = write!(
                svg,
                "<text x=\"{:.1}\" y=\"{:.1}\" font-size=\"12\" fill=\"#222\">{share}</text>",
                x + 24.0,
                y + 11.0
            );
        }
    }
    let _ = write!(
        svg,
        "<text x=\"{x:.1}\" y=\"{:.1}\" font-size=\"12\" fill=\"#222\">of the</text>\
         <text x=\"{x:.1}\" y=\"{:.1}\" font-size=\"12\" fill=\"#222\">weakest bond</text></svg>",
        left + 172.0,
        left + 187.0
    );
    svg
}

/// The plot area of the small charts (pixels): left, top, width, height.
const AREA: [f64; 4] = [64.0, 20.0, 560.0, 260.0];

fn chart(x_name: &str, y_name: &str, inner: &str) -> String {
    let [left, top, width, height] = AREA;
    let (w, h) = (left + width + 20.0, top + height + 56.0);
    format!(
        "{OPEN} viewBox=\"0 0 {w} {h}\" width=\"{w}\" height=\"{h}\"><rect width=\"100%\" \
         height=\"100%\" fill=\"#fff\"/>{inner}<path d=\"M{left},{top}V{bottom}H{right}\" \
         fill=\"none\" stroke=\"#222\"/><text x=\"{middle}\" y=\"{below}\" font-size=\"14\" \
         text-anchor=\"middle\" fill=\"#222\">{x_name}</text><text x=\"16\" y=\"{half}\" \
         font-size=\"14\" text-anchor=\"middle\" fill=\"#222\" \
         transform=\"rotate(-90 16 {half})\">{y_name}</text></svg>",
        bottom = top + height,
        right = left + width,
        middle = left + width / 2.0,
        below = top + height + 44.0,
        half = top + height / 2.0
    )
}

fn label(x: f64, y: f64, anchor: &str, text: &str) -> String {
    format!(
        "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"12\" text-anchor=\"{anchor}\" \
         fill=\"#222\">{text}</text>"
    )
}

fn histogram(request: &Request, answer: &Answer) -> String {
    use std::fmt::Write;
    const BINS: usize = 40;
    let [left, top, width, height] = AREA;
    let mut counts = [0usize; BINS];
    for (i, row) in shares(request, &answer.words).iter().enumerate() {
        for share in &row[i..] {
            let gap = (1.0 - share).clamp(0.0, 1.0);
            counts[((gap * BINS as f64) as usize).min(BINS - 1)] += 1;
        }
    }
    let most = counts.iter().copied().max().unwrap_or(1).max(1);
    let step = width / BINS as f64;
    let mut inner = String::new();
    for (k, count) in counts.iter().enumerate() {
        let tall = height * *count as f64 / most as f64;
        let _ = write!(
            inner,
            "<rect x=\"{:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{tall:.1}\" \
             fill=\"#0072b2\"><title>{count}</title></rect>",
            left + step * k as f64,
            top + height - tall,
            step - 1.0
        );
    }
    for k in 0..=4 {
        let share = f64::from(k) / 4.0;
        inner += &label(
            left + width * share,
            top + height + 18.0,
            "middle",
            &share.to_string(),
        );
    }
    inner += &label(left - 6.0, top + 10.0, "end", &most.to_string());
    chart("gap of the pair", "pairs", &inner)
}

/// Proved points are filled, others open with a line up to their bound.
fn frontier(answer: &Answer) -> String {
    use std::fmt::Write;
    let [left, top, width, height] = AREA;
    let counts = answer
        .frontier
        .iter()
        .map(|it| it.0.found.upper.min(1 << 20));
    let most = counts.max().unwrap_or(1).max(2) as f64;
    let x = |gap: f64| left + width * gap;
    // From none on, then by factors.
    let y = |count: usize| {
        let level = (1.0 + (count as f64).min(most)).ln() / (1.0 + most).ln();
        top + height * (1.0 - level)
    };
    let mut inner = String::new();
    for (point, _) in &answer.frontier {
        let (count, upper) = (point.found.words.len(), point.found.upper);
        let at = x(point.asked);
        if !point.found.is_proved() {
            let (high, low) = (y(upper), y(count));
            let _ = write!(
                inner,
                "<path d=\"M{at:.1},{high:.1}V{low:.1}M{:.1},{high:.1}h10\" stroke=\"#d55e00\" \
                 fill=\"none\"/>",
                at - 5.0
            );
        }
        let fill = if point.found.is_proved() {
            "#0072b2"
        } else {
            "#fff"
        };
        let stroke = if point.found.is_proved() {
            "#0072b2"
        } else {
            "#d55e00"
        };
        let _ = write!(
            inner,
            "<circle cx=\"{at:.1}\" cy=\"{:.1}\" r=\"5\" fill=\"{fill}\" stroke=\"{stroke}\" \
             stroke-width=\"2\"><title>{count} to {upper}</title></circle>",
            y(count)
        );
        inner += &label(at + 8.0, y(count) - 6.0, "start", &count.to_string());
    }
    for k in 0..=4 {
        let gap = f64::from(k) / 4.0;
        inner += &label(x(gap), top + height + 18.0, "middle", &gap.to_string());
    }
    let mut tick = 1usize;
    while (tick as f64) <= most {
        inner += &label(left - 6.0, y(tick) + 4.0, "end", &tick.to_string());
        tick *= 10;
    }
    inner += &label(
        left + width,
        top + 4.0,
        "end",
        "filled: proved; open: found, line: at most",
    );
    chart("gap asked for", "words", &inner)
}
