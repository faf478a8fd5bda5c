//! The request of a search for words.

use super::least_spacing;
use crate::design::MagnetModel;
use crate::request::{self, Word, options};
use physics::words::word::MOST_PLACES;
use physics::words::{Bar, Constraints, FaceShape, Faces, Fault, Rules};

options! {
    /// The options of a search for words.
    #[derive(Clone, Debug)]
    pub struct Request {
        /// Magnets per word
        pub length: Option<usize> = value("L", request::count)
            .required_unless(&["slots", "magnets"]),

        /// Smallest gap, 0 to 1: find the largest set
        pub gap: Option<f64> = value("G", gap),

        /// Number of words: find the set with the widest gap
        pub count: Option<usize> = value("M", request::count).conflicts(&["gap"]),

        /// Count contacts: at most T more matches than mismatches in wrong meetings
        pub contacts: Option<usize> = value("T", request::count_or_none)
            .conflicts(&["gap", "count"]),

        /// Words that bind their own kind and nothing else: for one kind of tile
        ///
        /// There are no mates: every face can meet every face, and the bond is that of a word with
        /// itself.
        pub own: bool = flag().named("self")
            .conflicts(&["faces", "continuous", "word_word", "word_mate", "mate_mate"]),

        /// Which faces can meet: all, or mates (words meet only mates)
        pub faces: Faces = value("WHICH", Word::new(&Faces::NAMES, "faces are all or mates")).or("all"),

        /// Complementary shapes of the faces: none, shared or polar
        ///
        /// shared: all faces have one shape, which prevents slides. polar: words have knobs and mates have
        /// slots.
        pub shape: FaceShape = value("KIND", shape()).or("none"),

        /// Tiles can lie upside down: every face can also be turned over
        pub flip: bool = flag(),

        /// Spacing is part of the code: words have N positions, most of them empty
        pub slots: Option<usize> = value("N", request::count),

        /// Magnets per word with --slots or --continuous [default: --length]
        pub magnets: Option<usize> = value("K", request::count),

        /// Place magnets anywhere along the face; needs --gap or --count
        ///
        /// Positions and poles are optimised together. Wrong meetings are searched over all poses,
        /// including tilted ones.
        pub continuous: bool = flag().conflicts(&[
            "slots", "contacts", "shape", "min_mismatch", "consecutive", "min_bond", "tolerate",
            "word_word", "word_mate", "mate_mate",
        ]),

        /// Face length (m) with --continuous [default: the design's, or 0.43]
        pub face: Option<f64> = value("M", request::length).requires("continuous"),

        /// Keep the gap even if one magnet per face is missing or flipped: missing=1 or flipped=1
        ///
        /// Bonds and wrong meetings are evaluated with the worst such fault on every face.
        pub tolerate: Option<Fault> = value("FAULT", fault()).conflicts(&["contacts"]),

        /// Distance between positions (m) [default: the design's, or 0.04]
        ///
        /// With --continuous, the smallest distance.
        pub pitch: Option<f64> = value("M", request::length),

        /// As many north poles as south poles, or one more
        pub balanced: bool = flag(),

        /// Longest run of equal poles
        pub max_run: Option<usize> = value("N", request::count),

        /// Smallest numbers of mismatches: words aligned, word and complement aligned, any slide
        ///
        /// A: between two aligned words. C: between an aligned word and complement. S: of either at any
        /// slide, where overhanging magnets count as mismatches.
        pub min_mismatch: Option<[usize; 3]> = value("A,C,S", mismatches),

        /// Range of the longest run of consecutive matches of two words over all slides
        pub consecutive: Option<[usize; 2]> = value("A:B", whole_range),

        /// Smallest depth of a bond (J)
        pub min_bond: Option<f64> = value("E_J", request::energy),

        /// Range of the lowest energy (J) of two words over all slides
        pub word_word: Option<[f64; 2]> = value("E_J:E_J", range).signed(),

        /// Range of the lowest energy (J) of a word and another word's mate
        pub word_mate: Option<[f64; 2]> = value("E_J:E_J", range).signed(),

        /// Range of the lowest energy (J) of two mates
        pub mate_mate: Option<[f64; 2]> = value("E_J:E_J", range).signed(),

        /// Magnet model, dipole or cuboid [default: the design's]
        pub model: Option<MagnetModel> = value("MODEL", request::model()),

        /// Search effort in core-seconds, counted in steps
        ///
        /// Steps are counted, not timed, so the same effort gives the same words on any machine.
        pub seconds: f64 = value("S", request::time).or(20.0),

        /// Random seed; the same seed gives the same results
        pub seed: u64 = value("N", request::seed).or(1),
    }
}

impl Request {
    /// Numbers of places and magnets of a word.
    pub(super) fn places(&self) -> Result<(usize, usize), String> {
        let wrong = |message: String| Err(message);
        let (places, magnets) = match (self.slots, self.magnets, self.length) {
            (Some(slots), Some(magnets), Some(length)) if length != magnets && length != slots => {
                return wrong(format!(
                    "--length {length} is neither --magnets {magnets} nor --slots {slots}: leave \
                     it out"
                ));
            }
            (Some(slots), Some(magnets), _) | (Some(slots), None, Some(magnets)) => {
                (slots, magnets)
            }
            (Some(_), None, None) => {
                return wrong("give the number of magnets in the slots: --magnets 4".to_owned());
            }
            (None, Some(magnets), Some(length)) if self.continuous && length != magnets => {
                return wrong(format!(
                    "--length {length} differs from --magnets {magnets}: leave it out"
                ));
            }
            (None, Some(magnets), _) if self.continuous => (magnets, magnets),
            (None, Some(_), _) => {
                return wrong(
                    "--magnets needs --slots or --continuous; otherwise use --length".to_owned(),
                );
            }
            (None, None, Some(length)) => (length, length),
            (None, None, None) => return wrong("give the length of words: --length 8".to_owned()),
        };
        if places > MOST_PLACES {
            return wrong(format!(
                "a word of {places} positions is too long: use at most {MOST_PLACES}"
            ));
        }
        if magnets > places {
            return wrong(format!(
                "{magnets} magnets do not fit into {places} slots: use --slots {magnets} or more"
            ));
        }
        match self.contacts.filter(|most| *most >= magnets) {
            None => Ok((places, magnets)),
            Some(most) => wrong(format!(
                "--contacts {most} excludes nothing: words of {magnets} magnets have at most \
                 {magnets}; use fewer"
            )),
        }
    }

    /// Which contacts are wrong.
    pub(super) fn rules(&self) -> Result<Rules, String> {
        if self.own && self.shape == FaceShape::Polar {
            return Err(
                "--self: a knob does not meet its own kind; use --shape shared or leave it out"
                    .to_owned(),
            );
        }
        Ok(Rules {
            faces: if self.own { Faces::Own } else { self.faces },
            shape: self.shape,
            flip: self.flip,
            fault: self.tolerate,
        })
    }

    pub(super) fn constraints(
        &self,
        bar: &Bar,
        places: usize,
        magnets: usize,
    ) -> Result<Constraints, String> {
        let least_spacing = least_spacing(bar);
        if (magnets - 1) * least_spacing >= places {
            let width = bar.size[1];
            return Err(format!(
                "magnets {} mm wide do not fit side by side {} mm apart: use --pitch {width} or \
                 more, or more --slots",
                1e3 * width,
                1e3 * bar.pitch
            ));
        }
        let [mismatches, complement_mismatches, slide_mismatches] =
            self.min_mismatch.unwrap_or_default();
        let range = |range: Option<[f64; 2]>| range.map(|[low, high]| low..=high);
        Ok(Constraints {
            balanced: self.balanced,
            longest_run: self.max_run,
            least_spacing,
            mismatches,
            complement_mismatches,
            slide_mismatches,
            consecutive: self.consecutive.map(|[low, high]| low..=high),
            least_bond: self.min_bond,
            ranges: [self.word_word, self.word_mate, self.mate_mate].map(range),
        })
    }
}

/// A gap.
pub fn gap(text: &str) -> Result<f64, String> {
    let gap = request::share(text);
    gap.map_err(|_| "a gap is between 0 (a wrong meeting as strong as a bond) and 1".to_owned())
}

/// A complementary shape.
pub fn shape() -> Word<FaceShape> {
    Word::new(&FaceShape::NAMES, "a shape is none, shared or polar")
}

fn fault() -> Word<Fault> {
    let short = [("missing", Fault::Missing), ("flipped", Fault::Flipped)];
    Word::new(
        &[Fault::NAMES, short].concat(),
        "tolerate missing=1 or flipped=1",
    )
}

fn mismatches(text: &str) -> Result<[usize; 3], String> {
    let parts = text.split(',').map(|part| part.trim().parse().ok());
    let parts: Option<Vec<usize>> = parts.collect();
    parts
        .and_then(|parts| parts.try_into().ok())
        .ok_or_else(|| "three whole numbers are needed, such as 2,2,0".to_owned())
}

fn whole_range(text: &str) -> Result<[usize; 2], String> {
    let wrong = "a range is A:B in whole numbers, such as 0:3";
    ends(text, |part| part.parse().ok()).ok_or_else(|| wrong.to_owned())
}

fn range(text: &str) -> Result<[f64; 2], String> {
    let wrong = "a range is E:E in J, lower value first, such as -0.02:0 or \"-20 mJ:0\"";
    ends(text, request::any_energy).ok_or_else(|| wrong.to_owned())
}

/// The ends of `A:B`, in Python `A,B`.
fn ends<T: PartialOrd>(text: &str, read: impl Fn(&str) -> Option<T>) -> Option<[T; 2]> {
    let (low, high) = text.split_once([':', ','])?;
    let [low, high] = [low, high].map(|part| read(part.trim()));
    Some([low?, high?]).filter(|[low, high]| low <= high)
}
