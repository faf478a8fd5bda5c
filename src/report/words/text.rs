//! The summary of a search for words.

use jobs::word_sets::Sought;
use physics::units::{counted, si};
use physics::words::set::name;
use physics::words::{FaceShape, Fault, Question, Rules, Word, WrongContact};

/// The headline: the number of words and its certainty, the weakest bond and the strongest wrong
/// contact.
pub(super) fn headline(sought: &Sought) -> String {
    let answer = &sought.answer;
    let many = match sought.question {
        Question::Gap(_) => how_many(answer.words.len(), answer.upper),
        Question::Count(count) if answer.words.is_empty() => match answer.proved {
            true => format!("proved: no set of {count} words has a positive gap"),
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
            let asked = answer.frontier.iter().map(|it| it.asked);
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
                describe(&worst, sought)
            )
        }
        Some(_) => "no wrong meeting is attractive".to_owned(),
        None => "no wrong meeting is possible".to_owned(),
    };
    format!(
        "{many}; gap {:.4}; weakest bond {bond}; {wrong}",
        judgement.gap
    )
}

pub(super) fn how_many(count: usize, upper: usize) -> String {
    match (count, upper) {
        (0, 0) => "none exists, proved".to_owned(),
        (0, _) => format!("none found, at most {upper}"),
        (count, upper) if count == upper => format!("{}, proved maximal", counted(count, "word")),
        (count, upper) => format!("at least {}, at most {upper}", counted(count, "word")),
    }
}

/// The name of a face of the set: `A`, or `A*` for a mate.
pub(super) fn face(word: Word, sought: &Sought) -> String {
    let find = |word| sought.answer.words.iter().position(|other| *other == word);
    let own = find(word).map(name);
    let named = own.or_else(|| find(word.mate()).map(|k| name(k) + "*"));
    named.unwrap_or_else(|| word.to_string())
}

/// `A on B*, slid 40 mm`.
pub(super) fn describe(meeting: &WrongContact, sought: &Sought) -> String {
    let [first, second] = [meeting.first, meeting.second].map(|word| face(word, sought));
    let slide = match meeting.slide {
        0 => "not slid".to_owned(),
        slide => format!("slid {}", si(f64::from(slide) * sought.bar.pitch, "m", 3)),
    };
    let flipped = if meeting.flipped { ", turned over" } else { "" };
    format!("{first} on {second}{flipped}, {slide}")
}

/// A description of how faces can meet.
pub(super) fn meetings(rules: &Rules) -> String {
    let who = match (rules.own(), rules.words_meet()) {
        (true, _) => "every word is to bind its own kind",
        (_, true) => "every face can meet every face",
        (_, false) => "words meet only mates",
    };
    let slides = match rules.shape {
        FaceShape::None => "at every slide by whole positions",
        _ => "held in place by their shape",
    };
    let flip = if rules.flip { ", also turned over" } else { "" };
    let fault = rules.fault.map_or("", |fault| match fault {
        Fault::Missing => ", one magnet per face missing",
        Fault::Flipped => ", one magnet per face reversed",
    });
    format!("{who}, {slides}{flip}{fault}")
}
