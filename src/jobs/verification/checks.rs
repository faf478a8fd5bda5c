//! What is checked, and how often it held.

/// A kind of statement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Subject {
    /// Energies of states, and of the contact of the target faces.
    States,
    /// Energies of blocks beside those of dipoles.
    Blocks,
    /// States, saddles and pathways are free of overlap.
    Clearances,
    /// Energies along pathways.
    Points,
    /// Pathways start and end where they should.
    Ends,
    /// Saddles are the highest points of their pathways.
    Saddles,
    /// No pathway exceeds its upper bound.
    Upper,
    /// No pathway stays below a lower bound.
    Lower,
    /// Barriers are saddles minus states.
    Heights,
    /// Lengths and work of pathways.
    Lengths,
    /// Shares of far starts add up.
    Captures,
    /// Kinds, copies and the proof of completeness are consistent.
    Lists,
    /// Bounds of one barrier by several runs overlap.
    Brackets,
}

impl Subject {
    /// All of them, with their names and how far each may be off.
    pub const ALL: [(Self, &'static str, &'static str); 13] = [
        (
            Self::States,
            "energies of states",
            "1e-9 of the deepest; blocks 1e-5",
        ),
        (Self::Blocks, "energies as blocks", "1e-5 of the deepest"),
        (
            Self::Clearances,
            "clearances",
            "an overlap of 1.65e-6 of the tile",
        ),
        (
            Self::Points,
            "energies on pathways",
            "as of states, and ten digits of the poses",
        ),
        (
            Self::Ends,
            "ends of pathways",
            "a millionth of the tiles' size",
        ),
        (Self::Saddles, "saddles", "as of pathways"),
        (
            Self::Upper,
            "upper bounds",
            "over whole segments, 1e-7 of the deepest; blocks 1e-5",
        ),
        (Self::Lower, "lower bounds", "as upper bounds"),
        (Self::Heights, "heights of barriers", "1e-12 of the deepest"),
        (
            Self::Lengths,
            "lengths and work",
            "a thousandth; work 5e-4 of the range",
        ),
        (Self::Captures, "captures", "none"),
        (Self::Lists, "lists of states", "none"),
        (
            Self::Brackets,
            "bounds of several runs",
            "1e-9 of the deepest",
        ),
    ];
}

/// The statements of one kind.
#[derive(Clone, Debug)]
pub struct Check {
    /// Which.
    pub subject: Subject,
    /// How many hold.
    pub confirmed: usize,
    /// How many could be neither confirmed nor contradicted.
    pub open: usize,
    /// Those that do not hold, in sentences.
    pub contradicted: Vec<String>,
}

/// All statements, by kind.
#[derive(Clone, Debug)]
pub(super) struct Book(Vec<Check>);

impl Default for Book {
    fn default() -> Self {
        let empty = |(subject, ..): (Subject, &str, &str)| Check {
            subject,
            confirmed: 0,
            open: 0,
            contradicted: Vec::new(),
        };
        Self(Subject::ALL.map(empty).to_vec())
    }
}

impl Book {
    fn of(&mut self, subject: Subject) -> &mut Check {
        &mut self.0[subject as usize]
    }

    /// Notes whether a statement holds, and in a sentence how it does not.
    pub fn note(&mut self, subject: Subject, holds: bool, why: impl FnOnce() -> String) {
        let check = self.of(subject);
        match holds {
            true => check.confirmed += 1,
            false => check.contradicted.push(why()),
        }
    }

    /// Notes a statement that cannot be checked.
    pub fn leave(&mut self, subject: Subject, count: usize) {
        self.of(subject).open += count;
    }

    /// Compares a stated number with the one found here.
    pub fn compare(
        &mut self,
        subject: Subject,
        what: &str,
        [stated, found]: [f64; 2],
        allowed: f64,
    ) {
        let holds = (stated - found).abs() <= allowed;
        self.note(subject, holds, || {
            format!(
                "{what} is stated as {stated:e}, and is {found:e} here (allowed: {allowed:.1e})"
            )
        });
    }

    /// Adds the statements of another book, with a word before each contradiction.
    pub fn add(&mut self, other: Self, before: &str) {
        for (check, more) in self.0.iter_mut().zip(other.0) {
            check.confirmed += more.confirmed;
            check.open += more.open;
            let told = more.contradicted.into_iter();
            check
                .contradicted
                .extend(told.map(|it| format!("{before}{it}")));
        }
    }

    pub fn checks(self) -> Vec<Check> {
        self.0
    }
}
