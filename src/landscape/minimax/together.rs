//! Queries answered together: their floods rise at the same time, and whatever they ask for is
//! subdivided at once.

use std::collections::{BTreeMap, VecDeque};
use std::ops::RangeInclusive;

use super::certifier::Certifier;
use super::flood::FLOODED;
use super::query::{Found, Query};
use super::{Bracket, CertifyError, Effort, End, Goal, Question};
use tiles::configuration::Configuration;
use tiles::parallel;

/// Queries open at the same time. It does not depend on the number of threads, so the results do not
/// either.
const OPEN_QUERIES: usize = 32;

/// Halvings of a leaf, one after the other, in one round.
const HALVINGS: RangeInclusive<u32> = 3..=8;

/// Leaves subdivided between two checks of the remaining effort: at most this many, and fewer
/// towards its end, when they may cost at most this fraction of it.
const BATCH: usize = 512;
const LAST: u64 = 4;

/// A query and the number of its question.
type Open<'q> = (usize, Query<'q>);

/// Why a leaf is subdivided.
struct Wish {
    /// Its parts are subdivided further as long as they may be passed at this level (J).
    level: f64,
    /// The places of the queries that asked for it; the first one's effort is spent.
    by: Vec<usize>,
}

impl Certifier<'_> {
    /// Brackets the minimax energy from `from` to `to`, alone. `known` is a pathway between them,
    /// if one is known.
    ///
    /// # Errors
    /// If an end is not free or not on the table.
    pub fn bracket(
        &mut self,
        from: &Configuration,
        to: &End,
        known: &[Configuration],
        effort: &Effort,
    ) -> Result<Bracket, CertifyError> {
        let question = Question {
            from: *from,
            to: to.into(),
            known: known.to_vec(),
            effort: *effort,
        };
        self.answer(&question)
    }

    /// Brackets one barrier.
    ///
    /// # Errors
    /// If an end is not free or not on the table.
    pub fn answer(&mut self, question: &Question) -> Result<Bracket, CertifyError> {
        let mut answers = self.answers(std::slice::from_ref(question), &|_| ());
        answers.pop().expect("one answer for each question")
    }

    /// Brackets barriers together: each makes use of the subdivision and of the bounds found for the
    /// others. `answered` is told how many are done. Where the certifier's effort is spent first, the
    /// last brackets are empty.
    ///
    /// # Errors
    /// Of each question, if one of its ends is not free or not on the table.
    pub fn answers(
        &mut self,
        questions: &[Question],
        answered: &dyn Fn(usize),
    ) -> Vec<Result<Bracket, CertifyError>> {
        let checked = questions.iter().map(|question| self.check(question));
        let mut answers: Vec<_> = checked
            .map(|checked| checked.map(|()| Bracket::default()))
            .collect();
        let sound = (0..questions.len()).filter(|&number| answers[number].is_ok());
        let mut waiting: VecDeque<usize> = sound.collect();
        let mut ready: VecDeque<Open> = VecDeque::new();
        let mut open: Vec<Open> = Vec::new();
        let mut count = 0;
        loop {
            let is_over = self.ended().is_some();
            while open.len() < OPEN_QUERIES && !is_over {
                if ready.is_empty() {
                    let next: Vec<usize> =
                        waiting.drain(..OPEN_QUERIES.min(waiting.len())).collect();
                    ready = self.begun(&next, questions);
                }
                let Some(next) = ready.pop_front() else { break };
                open.push(next);
            }
            let proofs = &self.proofs;
            parallel::for_each(&mut open, |(_, query)| query.learn(proofs));
            let (mut closed, others): (Vec<Open>, _) = open
                .into_iter()
                .partition(|(_, query)| is_over || query.is_answered());
            open = others;
            if is_over {
                closed.extend(ready.drain(..));
            }
            for (number, bracket) in self.conclude(&mut closed) {
                let Question { from, to, .. } = &questions[number];
                self.proofs
                    .add(from, to, &bracket.bounds, bracket.pathway.last());
                answers[number] = Ok(bracket);
                count += 1;
                answered(count);
            }
            if is_over || open.is_empty() && ready.is_empty() && waiting.is_empty() {
                return answers;
            }
            self.advance(&mut open);
        }
    }

    /// The lower bound (J) for paths to a goal implied by everything proved so far.
    pub fn proved(&self, from: &Configuration, to: &Goal) -> f64 {
        self.proofs.least(from, to)
    }

    fn check(&self, question: &Question) -> Result<(), CertifyError> {
        for end in std::iter::once(&question.from).chain(&question.to.places) {
            if !self.bounded.space.contains(end) {
                return Err(CertifyError::OffTheTable(*end));
            }
            let contact = self.bounded.contact;
            if contact.is_some_and(|contact| !contact.is_free(end)) {
                return Err(CertifyError::NotFree(*end));
            }
        }
        Ok(())
    }

    /// The queries of some questions, with their known pathways proved.
    fn begun<'q>(&mut self, numbers: &[usize], questions: &'q [Question]) -> VecDeque<Open<'q>> {
        let work = self.part_of(numbers.len());
        let begin = |&number: &usize| (number, Query::new(&self.bounded, &questions[number], work));
        let begun = parallel::map(numbers, begin);
        for (_, query) in &begun {
            if let Some(way) = query.best() {
                self.note_way(way);
            }
        }
        begun.into()
    }

    /// The brackets of queries, with the numbers of their questions.
    fn conclude(&mut self, closed: &mut [Open]) -> Vec<(usize, Bracket)> {
        if closed.is_empty() {
            return Vec::new();
        }
        self.ends.look(&self.store, &self.bounded);
        let brackets = of_each(closed, |query| query.conclude(self));
        let numbers = closed.iter().map(|(number, _)| *number);
        numbers.zip(brackets).collect()
    }

    /// One step of all open queries: a flood of each, and the subdivisions for which they ask.
    fn advance(&mut self, open: &mut [Open]) {
        self.ends.look(&self.store, &self.bounded);
        let known = self.passable();
        let work = self.part_of(open.len());
        let found = of_each(open, |query| query.search(self, &known, work));
        let flooded = |(flooded, _): &(usize, Found)| *flooded as u64 * FLOODED;
        let floods = found.iter().map(flooded).sum();
        let mut wishes: BTreeMap<u32, Wish> = BTreeMap::new();
        let mut asked = Vec::new();
        for (by, ((_, query), (_, found))) in open.iter_mut().zip(found).enumerate() {
            match found {
                Found::NoWay => query.has_no_way(),
                Found::Lower(way) => {
                    self.note_way(&way);
                    query.improve(way);
                }
                Found::Divide(_) if query.is_spent() => query.give_up(),
                Found::Divide(ids) => {
                    let level = query.level();
                    for &id in &ids {
                        let wish = wishes.entry(id).or_insert_with(|| Wish {
                            level,
                            by: Vec::new(),
                        });
                        wish.level = wish.level.max(level);
                        wish.by.push(by);
                    }
                    asked.push((by, ids));
                }
            }
        }
        self.spend(floods);
        self.grant(&wishes, floods, open);
        for (by, ids) in asked {
            let query = &mut open[by].1;
            if ids.iter().all(|&id| self.store.leaf(id).live) {
                query.give_up();
            } else {
                query.rounds += 1;
            }
        }
    }

    /// Subdivides leaves until the effort is spent: the fewer there are the finer, so that this costs
    /// no less than the floods (units of work) that have to be repeated afterwards.
    fn grant(&mut self, wishes: &BTreeMap<u32, Wish>, floods: u64, open: &mut [Open]) {
        let a_cell = self.bounded.work();
        let costs = |halvings: u32| (2 << halvings) * a_cell;
        let enough = |halvings: &u32| wishes.len() as u64 * costs(*halvings) >= floods;
        let halvings = HALVINGS.into_iter().find(enough).unwrap_or(*HALVINGS.end());
        let leaves: Vec<(u32, f64)> = wishes.iter().map(|(id, wish)| (*id, wish.level)).collect();
        let wishes: Vec<&Wish> = wishes.values().collect();
        let mut done = 0;
        while done < leaves.len() {
            let most = self.part_of(1) / (LAST * costs(halvings)).max(1);
            let end = leaves.len().min(done + (most as usize).clamp(1, BATCH));
            let batch = done..end;
            done = end;
            let divided = self.subdivide(&leaves[batch.clone()], halvings);
            for (&assessed, wish) in divided.iter().zip(&wishes[batch]) {
                open[wish.by[0]].1.cells += assessed;
                for &by in &wish.by {
                    open[by].1.gained += assessed;
                }
            }
            if self.ended().is_some() {
                return;
            }
        }
    }
}

/// Does something with each query, in parallel.
fn of_each<'q, T: Send>(
    open: &mut [Open<'q>],
    work: impl Fn(&mut Query<'q>) -> T + Sync,
) -> Vec<T> {
    let mut results: Vec<_> = open.iter_mut().map(|open| (open, None)).collect();
    parallel::for_each(&mut results, |((_, query), result)| {
        *result = Some(work(query))
    });
    results
        .into_iter()
        .filter_map(|(_, result)| result)
        .collect()
}
