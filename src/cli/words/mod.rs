//! `tilebind words`.

mod asked;
mod continuous;
pub(super) mod values;

use std::path::PathBuf;

use clap::Args;
use tilebind::budget::Budget;
use tilebind::design::MagnetModel;
use tilebind::report::files::WORDS;
use tilebind::report::words as report;
use tilebind::request;
use tilebind::word_sets::Request;
use tilebind::words::search::Effort;
use tilebind::words::{Faces, Fault, Lags, Question, Rules, Shape, Task, answer};

use super::options::WorkOptions;
use super::results::ResultOptions;
use super::{Failure, input, interrupt};
use values::{faces, fault, gap, mismatches, range, shape, whole_range};

/// Find sets of barcodes that bind their mates and nothing else
#[derive(Args)]
#[command(after_help = "\
The gap of a set of words is 1 less the strongest wrong attraction over the weakest right bond, in
energies of flush faces at contact, at every slide by whole places, magnets at all lags. It judges
aligned and slid faces, not tilted ones: `tilebind crosstalk` does those. Wrong is every meeting but
that of a word and its own mate at slide 0. With --gap the answer is the largest set, with --count
the widest gap, with neither the number of words for every number of contacts. Where counted
contacts make a tie, energies decide it; --contacts counts instead.

Examples:
  tilebind words --length 8 --gap 0.45
  tilebind words --length 8 --count 5 --out target/words
  tilebind words --length 8                                # gap against number of words
  tilebind words --length 12 --gap 0.8 --shape polar
  tilebind words --slots 28 --magnets 4 --pitch 0.015 --gap 0.45 --seconds 60
  tilebind words --continuous --magnets 4 --pitch 0.02 --count 4
  tilebind words shapes/paper-tile.toml --length 6 --faces mates --contacts 2")]
pub struct Words {
    /// The design file from whose target face magnets and pitch are taken [default: the paper's
    /// tile]
    design: Option<PathBuf>,

    /// Magnets of a word
    #[arg(long, value_name = "L", value_parser = request::count, required_unless_present_any = ["slots", "magnets"])]
    length: Option<usize>,

    /// Least gap, from 0 to 1
    #[arg(long, value_name = "G", value_parser = gap)]
    gap: Option<f64>,

    /// Words wanted: with the widest gap
    #[arg(long, value_name = "M", value_parser = request::count, conflicts_with = "gap")]
    count: Option<usize>,

    /// Judge by counted contacts: wrong meetings have at most T matches more than mismatches
    #[arg(long, value_name = "T", value_parser = request::count_or_none,
          conflicts_with_all = ["gap", "count"])]
    contacts: Option<usize>,

    /// Which faces can meet: all, or words mates only
    #[arg(long, value_name = "WHICH", default_value = "all", value_parser = faces(),
          hide_possible_values = true)]
    faces: Faces,

    /// Complementary shapes: none; shared, one that any two faces have and that forbids slides;
    /// polar, knobs on words and slots on mates
    #[arg(long, value_name = "KIND", default_value = "none", value_parser = shape(),
          hide_possible_values = true)]
    shape: Shape,

    /// Tiles may lie upside down: every face may also be turned over
    #[arg(long)]
    flip: bool,

    /// Spacing is code: words have N places, most of them empty
    #[arg(long, value_name = "N", value_parser = request::count)]
    slots: Option<usize>,

    /// Magnets of a word with --slots or --continuous [default: --length]
    #[arg(long, value_name = "K", value_parser = request::count)]
    magnets: Option<usize>,

    /// Magnets may lie anywhere along the face: positions and poles are found together, with wrong
    /// meetings judged over all poses, tilted ones too. Takes --gap or --count
    #[arg(long, conflicts_with_all = ["slots", "contacts", "shape", "min_mismatch", "consecutive",
          "min_bond", "tolerate", "word_word", "word_mate", "mate_mate"])]
    continuous: bool,

    /// Length of the face (m) with --continuous [default: the design's, or 0.43]
    #[arg(long, value_name = "M", value_parser = request::length, requires = "continuous")]
    face: Option<f64>,

    /// The gap holds though one magnet of every face is missing (missing=1) or the wrong way round
    /// (flipped=1): bonds and wrong meetings are those of the worst such faults
    #[arg(long, value_name = "FAULT", value_parser = fault(), conflicts_with = "contacts",
          hide_possible_values = true)]
    tolerate: Option<Fault>,

    /// From place to place (m), the least spacing with --continuous [default: the design's, or 0.04]
    #[arg(long, value_name = "M", value_parser = request::positive)]
    pitch: Option<f64>,

    /// As many north as south poles, or one more
    #[arg(long)]
    balanced: bool,

    /// Longest run of equal poles
    #[arg(long, value_name = "N", value_parser = request::count)]
    max_run: Option<usize>,

    /// Least mismatches of two words aligned, of a word and a complement aligned, and of either
    /// over every slide (what hangs over counts)
    #[arg(long, value_name = "A,C,S", value_parser = mismatches)]
    min_mismatch: Option<[usize; 3]>,

    /// Longest run of consecutive matches of two words over all slides, from A to B
    #[arg(long, value_name = "A:B", value_parser = whole_range)]
    consecutive: Option<[usize; 2]>,

    /// Least depth of a bond (J)
    #[arg(long, value_name = "E_J", value_parser = request::positive)]
    min_bond: Option<f64>,

    /// Range of the lowest energy (J) of two words over all slides
    #[arg(long, value_name = "E_J:E_J", value_parser = range, allow_hyphen_values = true)]
    word_word: Option<[f64; 2]>,

    /// Range of the lowest energy (J) of a word and another's mate
    #[arg(long, value_name = "E_J:E_J", value_parser = range, allow_hyphen_values = true)]
    word_mate: Option<[f64; 2]>,

    /// Range of the lowest energy (J) of two mates
    #[arg(long, value_name = "E_J:E_J", value_parser = range, allow_hyphen_values = true)]
    mate_mate: Option<[f64; 2]>,

    /// Model of the magnets, dipole or cuboid [default: the design's]
    #[arg(long, value_name = "MODEL", value_parser = input::model(),
          hide_possible_values = true)]
    model: Option<MagnetModel>,

    /// Work to spend, as what takes about so many seconds of a core; it is counted, so that the
    /// same work gives the same words everywhere
    #[arg(long, value_name = "S", default_value_t = 20.0, value_parser = request::positive)]
    seconds: f64,

    #[command(flatten)]
    work: WorkOptions,

    #[command(flatten)]
    results: ResultOptions,
}

impl Words {
    pub fn run(self) -> Result<(), Failure> {
        interrupt::prepare()?;
        let (places, magnets) = self.places()?;
        let (bar, face, design) = self.bar()?;
        let read = self.design.as_ref().zip(design.as_ref());
        let inputs = read.map(|(path, design)| input::files_of(path, design));
        let output = self.results.output(&WORDS, inputs.unwrap_or_default())?;
        self.work.use_threads()?;
        if self.continuous {
            let face = self.face.unwrap_or(face);
            return self.run_continuous(magnets, bar, face, output);
        }
        let progress = self.results.progress();
        let energies = Lags::new(&bar, places);
        let rules = Rules {
            faces: self.faces,
            shape: self.shape,
            flip: self.flip,
            fault: self.tolerate,
        };
        let (question, lags) = match (self.contacts, self.gap, self.count) {
            (Some(most), _, _) => {
                let gap = 1.0 - (most as f64 + 0.5) / magnets as f64;
                (Question::Gap(gap.max(0.0)), Lags::contacts(places))
            }
            (_, Some(gap), _) => (Question::Gap(gap), energies.clone()),
            (_, _, Some(count)) => (Question::Count(count), energies.clone()),
            _ => (Question::Frontier, energies.clone()),
        };
        let task = Task {
            places,
            magnets,
            lags,
            rules,
            constraints: self.constraints(&bar, places, magnets)?,
        };
        let mut effort = Effort {
            seed: self.work.seed,
            budget: Budget::seconds(self.seconds),
        };
        let answer = answer(&task, question, &energies, &mut effort);
        let request = Request {
            design: design.map(|design| design.name),
            bar,
            task,
            question,
            contacts: self.contacts,
            seed: self.work.seed,
            seconds: self.seconds,
            energies,
        };
        let document = report::document(&request, &answer);
        self.results.deliver(&document, output, &progress)
    }
}
