//! Words and their crosstalk against plain definitions.

use std::cell::RefCell;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::Configuration;
use tilebind::design::WordSet;
use tilebind::words::constraint::Constraints;
use tilebind::words::crosstalk::Proof;
use tilebind::words::lag::{Correlations, Lags};
use tilebind::words::{Bar, Rules, Word};

/// A word with magnets at some of its places.
fn some(random: &mut ChaCha8Rng, places: usize, share: f64) -> Word {
    let mut place = |_| match random.random_range(0.0..1.0) < share {
        true => ["N", "S"][random.random_range(0..2)],
        false => ".",
    };
    let text: String = (0..places).map(&mut place).collect();
    Word::parse(&text).unwrap()
}

/// The word with one magnet, its north pole out.
fn single(place: usize, places: usize) -> Word {
    let text = |k| if k == place { "N" } else { "." };
    Word::parse(&(0..places).map(text).collect::<String>()).unwrap()
}

/// The product of poles, place by place, with the second word moved on by a lag.
fn plain_correlation(u: Word, v: Word, lag: i32) -> i32 {
    let places = u.places() as i32;
    let at = |w: Word, k: i32| match (0..places).contains(&k) {
        true => w.at(k as usize),
        false => 0,
    };
    (0..places).map(|k| at(u, k) * at(v, k + lag)).sum()
}

/// Correlations are plain sums, with few magnets and with many, and the energy of a slide is the
/// sum over them.
#[test]
fn correlations_are_plain_sums() {
    let mut random = ChaCha8Rng::seed_from_u64(3);
    for places in [5, 12, 30] {
        let lags = Lags::new(&Bar::paper(), places);
        for share in [0.15, 0.3, 1.0] {
            for _ in 0..40 {
                let [u, v] = [0, 1].map(|_| some(&mut random, places, share));
                let all = Correlations::new(u, v);
                let last = places as i32 - 1;
                for lag in -last..=last {
                    let plain = plain_correlation(u, v, lag);
                    assert_eq!(u.correlation(v, lag), plain, "{u:?} {v:?} {lag}");
                }
                // The energy is linear: that of single magnets, added up.
                for slide in [-last, -1, 0, 2.min(last), last] {
                    let mut sum = 0.0;
                    for i in 0..places {
                        for j in 0..places {
                            if u.at(i) * v.at(j) != 0 {
                                let [one, other] = [i, j].map(|k| single(k, places));
                                let pair = Correlations::new(one, other);
                                let pole = f64::from(u.at(i) * v.at(j));
                                sum += pole * lags.energy(&pair, slide);
                            }
                        }
                    }
                    let energy = lags.energy(&all, slide);
                    let scale = lags.contact() * places as f64;
                    assert!((energy - sum).abs() <= 1e-12 * scale, "{energy} {sum}");
                }
            }
        }
    }
}

/// The smallest distance of two magnets, their longest run and excess, by looking at every place.
#[test]
fn what_is_said_of_a_word_is_counted() {
    let mut random = ChaCha8Rng::seed_from_u64(4);
    for _ in 0..2000 {
        let word = some(&mut random, 11, 0.35);
        let held: Vec<usize> = (0..11).filter(|k| word.at(*k) != 0).collect();
        let apart = held.windows(2).map(|two| two[1] - two[0]).min();
        assert_eq!(
            word.least_spacing(),
            apart.unwrap_or(usize::MAX),
            "{word:?}"
        );
        assert_eq!(word.magnets() as usize, held.len());
        let poles: Vec<i32> = held.iter().map(|k| word.at(*k)).collect();
        assert_eq!(word.excess(), poles.iter().sum::<i32>());
        let longest = poles.chunk_by(|a, b| a == b).map(<[i32]>::len).max();
        assert_eq!(word.longest_run(), longest.unwrap_or(0));
        assert_eq!(word.mate().mate(), word);
    }
}

/// Requirements of slides are those of every single slide, either way and with the mate: places
/// that do not face an equal pole are mismatches.
#[test]
fn slides_are_allowed_one_by_one() {
    let places = 8;
    let lags = Lags::new(&Bar::paper(), places);
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let mut numbers = [0; 2];
    for least in 2..6 {
        let constraints = Constraints {
            slide_mismatches: least,
            ..Constraints::default()
        };
        for _ in 0..300 {
            let [u, v] = [0, 1].map(|_| some(&mut random, places, 1.0));
            let apart = |other: Word| {
                let last = places as i32 - 1;
                (-last..=last)
                    .filter(|lag| *lag != 0 || u != other)
                    .all(|lag| {
                        let faced = (0..=last).filter(|k| (0..=last).contains(&(k + lag)));
                        let equal = |k: &i32| u.at(*k as usize) * other.at((k + lag) as usize) == 1;
                        places - faced.filter(equal).count() >= least
                    })
            };
            let asked = apart(v) && apart(v.mate());
            let found = constraints.allow_both(&lags, &Rules::default(), u, v);
            assert_eq!(found, asked, "{u:?} {v:?} {least}");
            numbers[usize::from(found)] += 1;
        }
    }
    assert!(numbers.iter().all(|number| *number > 50), "{numbers:?}");
}

const SET: &str = "\
words = [\"NSSNS\", \"NNNSS\"]
[magnet]
size = [0.01, 0.01, 0.003]
remanence = 1.2
pitch = 0.04
[tile]
side = 0.22
[potential]
model = \"dipole\"
";

#[test]
fn a_face_has_a_code_or_magnets() {
    let face = "[faces]\nA = { code = \"NSN\", magnets = [{ at = 0.02, pole = \"N\" }] }\n";
    let (_, rest) = SET.split_once('\n').unwrap();
    let fault = WordSet::parse(&format!("{rest}{face}"), "words.toml", None).unwrap_err();
    assert!(fault.message.contains("both place the magnets"), "{fault}");
    assert_eq!(fault.place.map(|place| place.line), Some(10));
}

/// No sampled or random pose attracts more than the proved bounds say, and settled bounds are as
/// narrow as requested.
#[test]
fn proved_crosstalk_lies_below_every_pose() {
    let set = WordSet::parse(SET, "words.toml", None).unwrap();
    let stage = set.carriers();
    let words = &set.words[..];
    let tolerance = 0.4 * stage.contact_energy().abs();
    let proofs = RefCell::new(Vec::new());
    let proving = |proof| proofs.borrow_mut().push(proof);
    let found = stage.crosstalk(words, Some((tolerance, 2_000_000)), &proving);
    assert!(found.settled && found.cells > 100);
    let proofs: Vec<Proof> = proofs.into_inner();
    assert!(proofs.is_sorted_by(|a, b| a.cells < b.cells && a.within >= b.within));
    assert_eq!(proofs.last().unwrap().cells, found.cells);
    assert_eq!(proofs.last().unwrap().within, tolerance);
    let lower = found.lower.as_ref().unwrap();
    let mut random = ChaCha8Rng::seed_from_u64(6);
    let all: Vec<Word> = words
        .iter()
        .copied()
        .chain(words.iter().map(|w| w.mate()))
        .collect();
    for (i, first) in all.iter().enumerate() {
        for (j, second) in all.iter().enumerate() {
            let (low, sampled) = (lower[i][j], found.strongest[i][j]);
            assert!(low <= sampled + 1e-12, "{i} {j}: {low} {sampled}");
            assert!(
                sampled.min(0.0) - low <= 1.001 * tolerance,
                "{i} {j}: {low} {sampled}"
            );
            let problem = stage.problem_of(*first, *second);
            let pose = found.poses[i][j];
            assert!((problem.energy(&pose) - sampled).abs() <= 1e-9 * tolerance);
            for _ in 0..300 {
                let near = |at: f64, by: f64, random: &mut ChaCha8Rng| {
                    at + by * random.random_range(-1.0..1.0)
                };
                let q = Configuration::new(
                    near(pose.x, 0.02, &mut random),
                    near(pose.y, 0.1, &mut random),
                    near(pose.theta, 0.1, &mut random),
                );
                if problem.is_clear(&q) {
                    assert!(problem.energy(&q) >= low - 1e-12, "{q:?}");
                }
            }
        }
    }
}

/// Three words of seven to nine magnets a pitch apart, or of three magnets anywhere, as a file.
fn random_set(random: &mut ChaCha8Rng, size: f64, side: f64, spaced: bool) -> String {
    let pole = |random: &mut ChaCha8Rng| ["N", "S"][random.random_range(0..2)];
    let mut text = format!("[magnet]\nsize = [{size}, {size}, 0.003]\npitch = 0.03\n");
    text += &format!("[tile]\nside = {side}\n[faces]\n");
    let places = random.random_range(7..10);
    for name in ["A", "B", "C"] {
        let face = match spaced {
            true => {
                let third = |k: i32| side * (f64::from(k) + random.random_range(-0.3..0.3)) / 3.0;
                let magnets = [-1, 0, 1].map(third);
                let magnets =
                    magnets.map(|at| format!("{{ at = {at}, pole = \"{}\" }}", pole(random)));
                format!("magnets = [{}]", magnets.join(", "))
            }
            false => {
                let code: String = (0..places).map(|_| pole(random)).collect();
                format!("code = \"{code}\"")
            }
        };
        text += &format!("{name} = {{ {face} }}\n");
    }
    text
}

/// No slide of flush faces attracts more than crosstalk says, however long the faces are, and also
/// if few slides lie far below all others.
#[test]
fn no_slide_of_flush_faces_attracts_more_than_crosstalk_says() {
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let mut sets = vec![
        "words = [\"SNNNNN\", \"NSSSSS\"]\n[tile]\nside = 0.43\n".to_owned(),
        "words = [\"NNNSNNSSNS\", \"NSNNNNSSSN\"]\n[magnet]\nsize = [0.004, 0.004, 0.003]\n\
         pitch = 0.03\n[tile]\nside = 0.32\n"
            .to_owned(),
    ];
    for size in [0.004, 0.01, 0.02] {
        for side in [0.28, 0.43] {
            for spaced in [false, true] {
                sets.push(random_set(&mut random, size, side, spaced));
            }
        }
    }
    for text in sets {
        let set = WordSet::parse(&text, "words.toml", None).unwrap();
        let stage = set.carriers();
        let found = stage.crosstalk(&set.words, None, &|_| ());
        let faces: Vec<Word> = found.faces().collect();
        let side = set.stage.pair.target_face().length();
        for (i, first) in faces.iter().enumerate() {
            for (j, second) in faces.iter().enumerate().skip(i) {
                let problem = stage.problem_of(*first, *second);
                let at = |k: i32| Configuration::new(side, f64::from(k) * 1e-4, 0.0);
                let last = (side / 1e-4) as i32;
                let slides = (-last..=last).map(|k| problem.energy(&at(k)));
                let lowest = slides.fold(f64::INFINITY, f64::min);
                let strongest = found.strongest[i][j];
                assert!(
                    strongest <= lowest + 1e-6 * lowest.abs(),
                    "{text}{first} on {second}: {strongest} {lowest}"
                );
            }
        }
    }
}
