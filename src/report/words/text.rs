//! The answer in words.

use std::fmt::Write;

use super::{Request, fault, name};
use physics::units::si;
use physics::words::{Answer, Faces, Fault, Meeting, Question, Shape, Word};

/// What the terminal is told.
pub fn summary(request: &Request, answer: &Answer) -> String {
    let mut text = headline(request, answer) + "\n";
    if let Some(kind) = request.task.rules.fault {
        let _ = writeln!(
            text,
            "All figures with the worst of {} in every face.",
            fault(kind)
        );
    }
    if !answer.frontier.is_empty() {
        text += "\ngap asked   words   at most   gap reached\n";
        for (point, judgement) in &answer.frontier {
            let count = point.found.words.len();
            let most = match point.found.is_proved() {
                true => "proved".to_owned(),
                false => point.found.upper.to_string(),
            };
            let gap = judgement
                .as_ref()
                .map_or("-".to_owned(), |it| format!("{:.4}", it.gap));
            let _ = writeln!(text, "{:>9.4}{count:>8}{most:>10}{gap:>14}", point.asked);
        }
        text.push('\n');
    } else if !answer.words.is_empty() && answer.words.len() <= LISTED {
        for (k, word) in answer.words.iter().enumerate() {
            let _ = writeln!(text, "  {:<3} {word}   mate {}", name(k), word.mate());
        }
    }
    if let Some((point, Some(judgement))) = &answer.beyond
        && point.found.words.len() > answer.words.len()
    {
        let many = how_many(point.found.words.len(), point.found.upper);
        let _ = writeln!(
            text,
            "This gap is a tie of contacts, which neighbours' magnets decide: {many} with the gap \
             {:.4}.",
            judgement.gap
        );
    }
    if !answer.complete {
        let _ = writeln!(
            text,
            "Chosen from {} words drawn at random: there are too many to look at all.",
            answer.candidates
        );
    }
    text
}

/// Sets of more words are not listed on the terminal.
const LISTED: usize = 40;

/// The first sentence: how many words, how sure, the weakest bond and the strongest wrong meeting.
pub fn headline(request: &Request, answer: &Answer) -> String {
    let many = match request.question {
        Question::Gap(_) => how_many(answer.words.len(), answer.upper),
        Question::Count(count) if answer.words.is_empty() => match answer.proved {
            true => format!("no {count} words have a gap, proved"),
            false => format!("no {count} words found, nothing proved"),
        },
        Question::Count(count) => {
            let gap = answer.judgement.as_ref().map_or(0.0, |it| it.gap);
            match answer.proved {
                true => format!("{count} words with the gap {gap:.4}, proved widest"),
                false => {
                    let upper = answer.gap_upper.unwrap_or(1.0);
                    format!("{count} words with the gap {gap:.4}, at most {upper:.4}")
                }
            }
        }
        Question::Frontier => {
            let asked = answer.frontier.iter().map(|it| it.0.asked);
            let nearest = asked.min_by(|a, b| (a - 0.5).abs().total_cmp(&(b - 0.5).abs()));
            let many = how_many(answer.words.len(), answer.upper);
            format!("at the gap {:.4}: {many}", nearest.unwrap_or(0.5))
        }
    };
    let Some(judgement) = &answer.judgement else {
        return many;
    };
    let bond = si(judgement.bond, "J", 4);
    let wrong = match judgement.worst {
        Some(worst) if worst.energy < 0.0 => {
            let attraction = si(-worst.energy, "J", 4);
            format!(
                "strongest wrong meeting {attraction}: {}",
                told(&worst, request, answer)
            )
        }
        Some(_) => "nothing wrong attracts".to_owned(),
        None => "nothing wrong meets".to_owned(),
    };
    format!(
        "{many}; gap {:.4}; weakest bond {bond}; {wrong}",
        judgement.gap
    )
}

fn how_many(count: usize, upper: usize) -> String {
    let words = |count| if count == 1 { "word" } else { "words" };
    match (count, upper) {
        (0, 0) => "none exists, proved".to_owned(),
        (0, _) => format!("none found, at most {upper}"),
        (count, upper) if count == upper => format!("{count} {}, proved largest", words(count)),
        (count, upper) => format!("at least {count} {}, at most {upper}", words(count)),
    }
}

/// `A on B*, slid 40 mm`.
fn told(meeting: &Meeting, request: &Request, answer: &Answer) -> String {
    let face = |word: Word| {
        let find = |word| answer.words.iter().position(|other| *other == word);
        find(word)
            .map(name)
            .or_else(|| find(word.mate()).map(|k| name(k) + "*"))
    };
    let [first, second] =
        [meeting.first, meeting.second].map(|word| face(word).unwrap_or(word.to_string()));
    let slide = match meeting.slide {
        0 => "not slid".to_owned(),
        slide => format!("slid {}", si(f64::from(slide) * request.bar.pitch, "m", 3)),
    };
    let flipped = if meeting.flipped { ", turned over" } else { "" };
    format!("{first} on {second}{flipped}, {slide}")
}

/// How faces meet, in words.
pub fn meetings(request: &Request) -> String {
    let rules = &request.task.rules;
    let who = match (rules.faces, rules.words_meet()) {
        (Faces::All, true) | (_, true) => "every face can meet every face",
        _ => "words meet mates only",
    };
    let slides = match rules.shape {
        Shape::None => "at every slide by whole places",
        _ => "held by their shape, without slides",
    };
    let flip = if rules.flip { ", also turned over" } else { "" };
    let fault = rules.fault.map_or("", |fault| match fault {
        Fault::Missing => ", one magnet of each face missing",
        Fault::Flipped => ", one magnet of each face the wrong way round",
    });
    format!("{who}, {slides}{flip}{fault}")
}
