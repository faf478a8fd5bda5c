//! The choice of words for a tile set: as many of each strength as it needs.
//!
//! A bond of half the strength has half the magnets on a face of the same length: its word has
//! empty places, whose positions are part of the code. In all wrong contacts of all words, slid
//! ones included, the attraction is at most (1 - gap) times the weakest bond of strength 1.

use std::collections::BTreeMap;

use super::Request;
use super::wiring::LinkedBonds;
use crate::word_sets::least_spacing;
use physics::budget::Budget;
use physics::observer::Observer;
use physics::order::Order;
use physics::words::candidates::{Candidates, number};
use physics::words::frontier;
use physics::words::graph::Graph;
use physics::words::search;
use physics::words::{Bar, Constraints, Effort, Lags, Task, Word, local};

/// Whether there is a set of words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WordsVerdict {
    /// A set was found.
    Found,
    /// It is proved that there is none.
    Refuted,
    /// Neither was found or refuted.
    Open,
}

/// The answer for a face with a given number of places.
#[derive(Clone, Debug)]
pub struct Choice {
    /// Places of the face.
    pub places: usize,
    /// The requested gap, or the widest one reached.
    pub gap: f64,
    /// Whether there are such words.
    pub verdict: WordsVerdict,
    /// The words found, strongest first.
    pub words: Vec<Word>,
    /// The results for each strength, strongest first.
    pub classes: Vec<Class>,
    /// Whether it is proved that no such words have a wider gap.
    pub widest: bool,
}

/// Words of one strength.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Class {
    /// Magnets of a word.
    pub magnets: usize,
    /// Words needed.
    pub needed: usize,
    /// Words found, compatible with those of the stronger classes.
    pub found: usize,
    /// Upper bound of their number, independent of the other classes; `usize::MAX` if unknown.
    /// Bounds are computed only if too few words were found.
    pub upper: usize,
}

/// Lower bound of a bond's depth relative to the sum of its contacts: neighbours with equal poles
/// weaken it.
const WEAKER: f64 = 0.97;
/// Share of the work reserved for bounds if there are several strengths.
const FOR_BOUNDS: f64 = 0.3;
/// Largest number of weaker words tested against the stronger ones, and smallest number to choose
/// from.
const MOST_JUDGED: usize = 1 << 16;
const LEAST_BESIDE: usize = 256;
/// Relative tolerance of strengths as numbers of magnets when the length is to be found.
const NEAR: f64 = 0.1;
/// The progress stage while increasingly long faces are tried.
const PLACES: &str = "words";
/// Share of the effort with which all lengths are tried first.
const QUICK: f64 = 0.05;
/// The longest face that is tried.
pub const MOST_PLACES: usize = 48;

/// The requirements of words on a face.
struct Requirements<'a> {
    /// Strengths and the number of words needed of each, strongest first.
    demand: &'a [(f64, usize)],
    /// Groups of words that must bind each other's mates.
    groups: &'a [LinkedBonds],
    places: usize,
    bar: &'a Bar,
    request: &'a Request,
}

impl Requirements<'_> {
    /// The number of magnets of a word of a given strength.
    fn magnets(&self, strength: f64) -> usize {
        let most = self.request.magnets.unwrap_or(self.places).min(self.places);
        let strongest = self.demand.first().map_or(1.0, |first| first.0);
        ((most as f64 * strength / strongest).round() as usize).clamp(1, most)
    }

    /// Whether any two strengths that differ by more than [`NEAR`] have different numbers of
    /// magnets, and none deviates by more than that.
    fn tells_apart(&self) -> bool {
        let strongest = self.demand.first().map_or(1.0, |first| first.0);
        let all = self.demand.iter().map(|it| it.0);
        let most = self.magnets(strongest) as f64;
        let off = |strength: f64| {
            let got = self.magnets(strength) as f64 / most * strongest;
            (got / strength - 1.0).abs()
        };
        all.map(off).all(|off| off <= NEAR)
    }

    /// The numbers of magnets needed, with the number of words of each, most magnets first.
    /// Strengths that round to the same number of magnets share their words.
    fn classes(&self) -> Vec<Class> {
        let mut classes: Vec<Class> = Vec::new();
        for (strength, needed) in self.demand {
            let magnets = self.magnets(*strength);
            match classes.last_mut().filter(|last| last.magnets == magnets) {
                Some(last) => last.needed += needed,
                None => classes.push(Class {
                    magnets,
                    needed: *needed,
                    found: 0,
                    upper: usize::MAX,
                }),
            }
        }
        classes
    }

    fn task(&self, magnets: usize) -> Task {
        Task {
            places: self.places,
            magnets,
            stands: self.bar.form.stands.is_some(),
            lags: Lags::new(self.bar, self.places),
            rules: self.request.rules(),
            constraints: Constraints {
                least_spacing: least_spacing(self.bar),
                ..Constraints::default()
            },
        }
    }
}

/// Chooses words for a face with a given number of places, with the requested gap or the widest
/// possible one. Returns all trials, of which the last is the answer. `demand` is as from
/// [`super::Wiring::demand`].
pub fn choose(
    (demand, groups): (&[(f64, usize)], &[LinkedBonds]),
    places: usize,
    bar: &Bar,
    request: &Request,
) -> Vec<Choice> {
    let asked = Requirements {
        demand,
        groups,
        places,
        bar,
        request,
    };
    let unit = asked.magnets(demand.last().map_or(1.0, |last| last.0));
    let trial = |gap: f64, trials: f64| {
        let budget = Budget::seconds(request.seconds / trials);
        at_gap(&asked, gap, &mut Effort::new(request.seed, budget))
    };
    if let Some(gap) = request.least_gap() {
        return vec![trial(gap, 1.0)];
    }
    if groups.is_empty()
        && let [class] = asked.classes()[..]
    {
        return vec![widest(&asked, class)];
    }
    // Of several strengths, by the net number of contacts of wrong meetings.
    let (mut low, mut high) = (0, unit);
    let count = f64::from(usize::BITS - unit.leading_zeros());
    let mut trials: Vec<Choice> = Vec::new();
    while low < high {
        let contacts = (low + high) / 2;
        let choice = trial(1.0 - (contacts as f64 + 0.5) / unit as f64, count);
        match choice.verdict {
            WordsVerdict::Found => high = contacts,
            _ => low = contacts + 1,
        }
        trials.push(choice);
    }
    // The set with the widest gap, otherwise the failed trial with the narrowest one.
    let last = |choice: &Choice| match choice.verdict {
        WordsVerdict::Found => (true, choice.gap),
        _ => (false, -choice.gap),
    };
    trials.order_by(|a, b| {
        let (a, b) = (last(a), last(b));
        a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
    });
    trials
}

/// The words of one strength with the widest gap, by energies.
fn widest(asked: &Requirements, class: Class) -> Choice {
    let budget = Budget::seconds(asked.request.seconds);
    let task = asked.task(class.magnets);
    let mut effort = Effort::new(asked.request.seed, budget);
    let found = frontier::widest(&task, class.needed, &mut effort);
    let known = found
        .words
        .len()
        .max(found.found.words.len().min(class.needed));
    Choice {
        places: asked.places,
        gap: found.gap,
        verdict: match (found.words.len() == class.needed, found.proved) {
            (true, _) => WordsVerdict::Found,
            (false, true) => WordsVerdict::Refuted,
            (false, false) => WordsVerdict::Open,
        },
        classes: vec![Class {
            found: known,
            upper: found.found.upper,
            ..class
        }],
        widest: found.proved,
        words: found.words,
    }
}

/// The answers for faces of different lengths; the last is that of the shortest face on which the
/// words were found, or of the longest one.
///
/// Words are found sooner on faces that are not the shortest possible ones. So all lengths are tried
/// with a small effort first, up to one that carries the words, and then shorter ones, one by one,
/// with the whole effort.
pub fn shortest(
    (demand, groups): (&[(f64, usize)], &[LinkedBonds]),
    most: usize,
    bar: &Bar,
    request: &Request,
    observer: &dyn Observer,
) -> Vec<Choice> {
    let asked = |places: usize| Requirements {
        demand,
        groups,
        places,
        bar,
        request,
    };
    // Different strengths need enough magnets to differ.
    let tells_apart = |places: &usize| asked(*places).tells_apart();
    let first = request.magnets.unwrap_or(1);
    let first = (first..=most).find(tells_apart).unwrap_or(first);
    let mut tried: BTreeMap<usize, Vec<Choice>> = BTreeMap::new();
    let mut attempt = |places: usize, share: f64| {
        observer.part(PLACES, places, most);
        let request = Request {
            seconds: share * request.seconds,
            ..request.clone()
        };
        let choices = choose((demand, groups), places, bar, &request);
        let verdict = choices.last().map(|it| it.verdict);
        tried.insert(places, choices);
        let is_found = |it: &&Choice| it.verdict == WordsVerdict::Found;
        let refuted = tried.values().flatten();
        let refuted = refuted.filter(|it| it.verdict == WordsVerdict::Refuted);
        observer.known(&match tried.values().flatten().find(is_found) {
            Some(known) => format!(
                "words are known on faces of {0} positions, and shorter ones are being tried; \
                 --length {0} uses them",
                known.places
            ),
            None => format!(
                "no such words are known on faces of up to {places} positions ({} of {} lengths \
                 are proved impossible); continue with --length {}",
                refuted.count(),
                tried.len(),
                places + 1
            ),
        });
        verdict
    };
    // The lengths on which words were neither found nor proved impossible, shortest first.
    let mut open = Vec::new();
    let mut best = None;
    for places in first..=most {
        match attempt(places, QUICK) {
            Some(WordsVerdict::Found) => {
                best = Some(places);
                break;
            }
            Some(WordsVerdict::Open) => open.push(places),
            _ => {}
        }
    }
    let mut carries = |places: &usize| attempt(*places, 1.0) == Some(WordsVerdict::Found);
    match best {
        Some(_) => {
            let shorter = open.into_iter().rev();
            best = shorter.take_while(|places| carries(places)).last().or(best);
        }
        // Faces of limited length, for which the small effort did not suffice.
        None => best = open.into_iter().find(|places| carries(places)),
    }
    tried.retain(|places, _| best.is_none_or(|best| *places <= best));
    tried.into_values().flatten().collect()
}

fn at_gap(asked: &Requirements, gap: f64, effort: &mut Effort) -> Choice {
    let mut choice = Choice {
        places: asked.places,
        gap,
        verdict: WordsVerdict::Found,
        words: Vec::new(),
        classes: asked.classes(),
        widest: false,
    };
    let count = choice.classes.len();
    let unit = choice.classes.last().map_or(1, |last| last.magnets) as f64;
    // With several strengths, bounds are searched separately.
    let several = count > 1;
    let for_bounds = effort.budget.share(if several { FOR_BOUNDS } else { 0.0 });
    let mut proof = Effort::new(effort.seed, for_bounds);
    // Words that bind each other's mates come first; all others must be compatible with them.
    let limit = |task: &Task| (1.0 - gap) * unit * WEAKER * task.lags.contact();
    for group in asked.groups {
        let found = linked(asked, group, &choice.words, &limit, effort);
        if found.len() < group.bonds.len() {
            choice.verdict = WordsVerdict::Open;
            return choice;
        }
        for word in &found {
            let magnets = word.magnets() as usize;
            let class = choice.classes.iter_mut().find(|it| it.magnets == magnets);
            class.into_iter().for_each(|class| class.found += 1);
        }
        choice.words.extend(found);
    }
    for part in 0..count {
        let Class {
            magnets,
            needed,
            found: already,
            ..
        } = choice.classes[part];
        let needed = needed - already;
        if needed == 0 {
            continue;
        }
        let task = asked.task(magnets);
        let words = if choice.words.is_empty() {
            // The gap refers to the weakest bond.
            let own_gap = 1.0 - (1.0 - gap) * unit / magnets as f64;
            let found = effort.share(1.0 / count as f64, |part| {
                search::largest(&task, own_gap, needed, part)
            });
            if !several {
                choice.classes[0].upper = found.upper;
            }
            found.words
        } else {
            beside(&task, &choice.words, limit(&task), needed, unit, effort)
        };
        choice.words.extend(words.iter().take(needed));
        choice.classes[part].found = already + words.len().min(needed);
        if words.len() < needed {
            if several {
                bound(&mut choice, asked, &mut proof);
            }
            let refuted = choice.classes.iter().any(|it| it.upper < it.needed);
            choice.verdict = match refuted {
                true => WordsVerdict::Refuted,
                false => WordsVerdict::Open,
            };
            break;
        }
    }
    choice
}

/// Words for linked bonds, whose words bind each other's mates as strongly as required: the first
/// solution in order, or fewer words than bonds if there is none.
fn linked(
    asked: &Requirements,
    group: &LinkedBonds,
    there: &[Word],
    limit: &dyn Fn(&Task) -> f64,
    effort: &mut Effort,
) -> Vec<Word> {
    let strongest = asked.demand.first().map_or(1.0, |first| first.0);
    let a_unit = asked.magnets(strongest) as f64 / strongest;
    let lists: Vec<(Task, Vec<Word>)> = (0..group.bonds.len())
        .map(|k| {
            let task = asked.task(asked.magnets(group.strengths[k][k]));
            let all = match few(&task) {
                true => Candidates::new(&task, limit(&task), effort.seed, u64::MAX),
                false => Candidates::sampled(&task, limit(&task), effort.seed, 2 * MOST_JUDGED),
            };
            effort.budget.spend(all.work.min(effort.budget.left() / 2));
            let goes = |word: &Word| goes_beside(&task, *word, there, limit(&task));
            let words = all.words.into_iter().filter(goes);
            // A word or its mate may be on the east or north faces.
            let both: Vec<Word> = words.flat_map(|word| [word, word.mate()]).collect();
            (task, both)
        })
        .collect();
    // The net number of contacts for a strength; `None` if no number comes close.
    let goes = |i: usize, u: Word, j: usize, v: Word| {
        let (task, strength) = (&lists[i].0, group.strengths[i][j]);
        if strength <= 0.0 {
            return u != v && u != v.mate() && task.rules.within(&task.lags, u, v, limit(task));
        }
        let contacts = f64::from(u.correlation(v, 0));
        (contacts / (strength * a_unit) - 1.0).abs() <= NEAR
            && task.rules.within_but_aligned(&task.lags, u, v, limit(task))
    };
    let mut chosen: Vec<usize> = Vec::new();
    let mut next = 0;
    loop {
        let k = chosen.len();
        if k == lists.len() {
            return chosen
                .iter()
                .zip(&lists)
                .map(|(at, list)| list.1[*at])
                .collect();
        }
        let mut rest = next..lists[k].1.len();
        let fits = rest.find(|at| {
            let word = lists[k].1[*at];
            effort
                .budget
                .spend(lists[k].0.judgement().min(effort.budget.left()));
            let mut before = chosen.iter().enumerate();
            !effort.budget.is_spent() && before.all(|(j, it)| goes(j, lists[j].1[*it], k, word))
        });
        match fits {
            Some(at) => {
                chosen.push(at);
                next = 0;
            }
            // Backtrack to the previous one and continue from there.
            None => match chosen.pop() {
                Some(at) if !effort.budget.is_spent() => next = at + 1,
                _ => return Vec::new(),
            },
        }
    }
}

/// Bounds the sizes of the classes, each independently of the others: no wrong contact among its
/// words attracts by more than (1 - gap) of the weakest bond, whose depth is bounded by the deepest
/// bond of a word of the weakest class.
fn bound(choice: &mut Choice, asked: &Requirements, effort: &mut Effort) {
    let last = choice.classes.len() - 1;
    let reach = |task: &Task, sign: f64| {
        let magnets = task.magnets as u32;
        f64::from(magnets) * task.lags.contact() + sign * task.lags.rest(magnets, magnets)
    };
    let deepest = reach(&asked.task(choice.classes[last].magnets), 1.0);
    for part in (0..=last).rev() {
        let class = &mut choice.classes[part];
        let task = asked.task(class.magnets);
        let own_gap = match part == last {
            true => choice.gap,
            false => 1.0 - (1.0 - choice.gap) * deepest / reach(&task, -1.0),
        };
        // Nothing can be proved about many words with empty places.
        let hopeless = class.magnets < choice.places && !few(&task);
        if hopeless || !(0.0..=1.0).contains(&own_gap) {
            continue;
        }
        let found = effort.share(1.0 / (part + 1) as f64, |part| {
            search::largest(&task, own_gap, class.needed, part)
        });
        class.upper = found.upper;
        if class.upper < class.needed {
            return;
        }
    }
}

/// Whether there are few enough words to enumerate them.
fn few(task: &Task) -> bool {
    number(task.places, task.magnets) <= 4.0 * MOST_JUDGED as f64
}

/// Evenly spaced words of a list: at most the given number, or [`LEAST_BESIDE`] if that is larger.
fn thinned(words: Vec<Word>, most: usize) -> Vec<Word> {
    let step = words.len().div_ceil(most.clamp(LEAST_BESIDE, MOST_JUDGED));
    words.into_iter().step_by(step.max(1)).collect()
}

/// Whether a word differs from the given ones and their mates, and is compatible with all of them.
fn goes_beside(task: &Task, word: Word, there: &[Word], limit: f64) -> bool {
    there.iter().all(|other| {
        word != *other && word != other.mate() && task.rules.within(&task.lags, word, *other, limit)
    })
}

/// Words of a weaker class that are compatible with the given ones.
fn beside(
    task: &Task,
    there: &[Word],
    limit: f64,
    needed: usize,
    unit: f64,
    effort: &mut Effort,
) -> Vec<Word> {
    let least = unit * WEAKER * task.lags.contact();
    let all = match few(task) {
        true => Candidates::new(task, limit, effort.seed, u64::MAX),
        false => Candidates::sampled(task, limit, effort.seed, 2 * MOST_JUDGED),
    };
    let mut words = thinned(all.words, MOST_JUDGED);
    let judged = words.len() as u64 * (1 + there.len() as u64) * task.judgement();
    effort
        .budget
        .spend((all.work + judged).min(effort.budget.left() / 2));
    words.retain(|word| {
        task.rules.bond(&task.lags, *word) >= least && goes_beside(task, *word, there, limit)
    });
    // At most as many as half the work suffices for.
    let pairs = effort.budget.left() / task.judgement();
    let words = thinned(words, (pairs as f64).sqrt() as usize);
    let graph = Graph::new(task, words, limit, effort.budget.left());
    effort.budget.spend(graph.work());
    let found = local::search(&graph, Vec::new(), needed, effort);
    let found = found.iter().take(needed);
    found.map(|at| graph.words[*at]).collect()
}
