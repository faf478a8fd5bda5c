//! What is told of an assembly in words.

use std::fmt::Write;

use super::Assembly;
use jobs::assembly::Built;
use jobs::assembly::choice::{Choice, Verdict};
use jobs::assembly::slides::Slid;
use physics::units::{plain, si, si_range};

/// What may be asked of slid meetings.
pub(crate) struct SlidFacts {
    /// J.
    pub deepest: f64,
    /// Pairs of faces that one slid meeting holds against Gmc, of so many.
    pub holding: usize,
    /// See there.
    pub pairs: usize,
    /// Of a word and its mate: the mean share of slides that lead to slid meetings among those that
    /// lead anywhere.
    pub share: f64,
}

pub(crate) fn slid(assembly: &Assembly, slides: &[(usize, usize, Slid)]) -> Option<SlidFacts> {
    let built = assembly.built;
    let n = built.matrix.words.len();
    let depth = |slid: &Slid| slid.deepest.map_or(0.0, |it| it.1);
    let deepest = slides
        .iter()
        .map(|(_, _, slid)| depth(slid))
        .reduce(f64::min)?;
    let holds = |slid: &Slid| -depth(slid) / built.shaking.kt > built.gmc;
    let own = slides.iter().filter(|(i, j, _)| j - i == n);
    let shares = own.map(|(_, _, it)| it.captured[1] / (it.captured[0] + it.captured[1]));
    Some(SlidFacts {
        deepest,
        holding: slides.iter().filter(|it| holds(&it.2)).count(),
        pairs: slides.len(),
        share: shares.sum::<f64>() / n as f64,
    })
}

/// The kT (J) between which bonds of strength tau hold a tile and weaker ones do not; Z0 is taken to
/// grow as kT^(5/2), as at a flush edge.
pub fn window(built: &Built) -> Option<[f64; 2]> {
    let tau = built.set.tau();
    let less = built.wiring.least_strength();
    // ln K of bonds of a strength; it falls with kT.
    let ln_k = |strength: f64, kt: f64| {
        let gmc = built.gmc - 2.5 * libm::log(kt / built.shaking.kt);
        strength * built.unit / kt - gmc
    };
    let end = |strength: f64| {
        let (mut low, mut high) = (
            libm::log(built.unit / 400.0),
            libm::log(built.unit * tau.max(1.0)),
        );
        if ln_k(strength, libm::exp(low)) < 0.0 {
            return None;
        }
        for _ in 0..80 {
            let middle = (low + high) / 2.0;
            if ln_k(strength, libm::exp(middle)) > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        Some(libm::exp(low))
    };
    let lower = if tau > less { end(tau - less)? } else { 0.0 };
    Some([lower, end(tau)?])
}

/// One sentence that answers whether it can be built.
pub fn headline(assembly: &Assembly) -> String {
    let built = assembly.built;
    let (set, n) = (&built.set, built.wiring.bonds.len());
    let (gse, gmc, tau) = (built.gse(), built.gmc, set.tau());
    let less = built.wiring.least_strength();
    // Depth in kT.
    let wrong = built.matrix.strongest_wrong();
    let mismatch = wrong.map_or(0.0, |(.., energy)| -energy / built.shaking.kt);
    let verdict = match () {
        () if gmc > tau * gse => "too hard: nothing holds, so nothing grows",
        () if tau > less && gmc < (tau - less) * gse => {
            "too softly: fewer bonds than tau hold as well, so anything grows"
        }
        () if mismatch > gmc => {
            "too softly: a single aligned mismatch holds a tile as well, so errors grow"
        }
        () if tau > less => "right: bonds of tau hold a tile and weaker ones do not",
        () => "right: one bond holds a tile",
    };
    let tiles = |count: usize| {
        if count == 1 {
            "1 tile".to_owned()
        } else {
            format!("{count} tiles")
        }
    };
    format!(
        "{}: {} with {n} words of {} places; shaken at {} with {:.1} % covered Gse (a bond) is {} \
         kT and Gmc (docking) {gmc:.2} kT, which is {verdict}",
        set.name,
        tiles(set.tiles.len()),
        built.matrix.words.first().map_or(0, |word| word.places()),
        si(built.shaking.kt, "J", 3),
        100.0 * built.shaking.coverage,
        match gse {
            ..1e4 => format!("{gse:.2}"),
            _ => plain(gse, 3),
        },
    )
}

/// What files of engines say above the set.
pub(super) fn remarks(assembly: &Assembly) -> Vec<String> {
    let built = assembly.built;
    vec![
        format!(
            "{} as magnets build it, by tilebind {}",
            built.set.name,
            env!("CARGO_PKG_VERSION")
        ),
        format!(
            "kT {:e} J, coverage {}; energies are Gse times a strength, in kT",
            built.shaking.kt, built.shaking.coverage
        ),
        "X is a word on east or north faces, X* its mate on west or south faces;".to_owned(),
        "wrong meetings have their own energies, below 0 where they repel (for xgrow 0)".to_owned(),
    ]
}

/// For the terminal.
pub fn summary(assembly: &Assembly) -> String {
    let built = assembly.built;
    let mut text = headline(assembly) + ".\n";
    let mut line = |words: String| {
        let _ = writeln!(text, "{words}");
    };
    if let Some([low, high]) = window(built) {
        line(match low > 0.0 {
            true => format!(
                "it grows between kT {} at this coverage",
                si_range(low, high, "J", 3)
            ),
            false => format!("it grows below kT {} at this coverage", si(high, "J", 3)),
        });
    }
    if let Some([rows, columns]) = assembly.lattice {
        let needed = jobs::assembly::lattice::words(rows, columns);
        line(format!(
            "a lattice of {rows} x {columns} tiles with places of their own needs {needed} words"
        ));
    }
    if let Some(found) = found(assembly) {
        line(found);
    }
    match built.matrix.strongest_wrong() {
        Some((i, j, energy)) => line(format!(
            "strongest aligned mismatch: {} on {}, {} ({:.0} % of a bond)",
            assembly.face(i),
            assembly.face(j),
            si(energy, "J", 4),
            -100.0 * energy / built.unit
        )),
        None => line("no aligned mismatch attracts".to_owned()),
    }
    if let Some(whole) = super::pairs::sentence(assembly) {
        line(whole);
    }
    line(format!(
        "errors a tile, grown just above standstill: {:.2e}; faster growth makes more of them",
        built.errors_at_standstill()
    ));
    if let Some(slid) = slid(assembly, &assembly.slides()) {
        line(format!(
            "outside of the model: slid by whole places faces hold with up to {} ({:.1} kT, Gmc \
             {:.1});\n{} of {} pairs of faces would so hold a tile alone, and of a word's slides along \
             its mate {:.0} %\nof those that hold end slid",
            si(slid.deepest, "J", 4),
            -slid.deepest / built.shaking.kt,
            built.gmc,
            slid.holding,
            slid.pairs,
            100.0 * slid.share
        ));
    }
    let grown = &built.grown;
    line(match grown.complete {
        true => format!("without errors it ends as {} tiles", grown.tiles.len()),
        false => format!(
            "without errors it grows on; {} tiles were looked at",
            grown.tiles.len()
        ),
    });
    if grown.choices > 0 {
        line(format!(
            "at {} places more than one tile fits: the set is not directed",
            grown.choices
        ));
    }
    text
}

/// What the search for words says, if there was one.
fn found(assembly: &Assembly) -> Option<String> {
    let (last, before) = assembly.tried.split_last()?;
    let failed = || before.iter().filter(|it| it.verdict != Verdict::Found);
    let refuted = |it: &&Choice| it.verdict == Verdict::Refuted;
    let shorter = || failed().filter(|it| it.places != last.places);
    let shorter = match (shorter().count(), shorter().filter(refuted).count()) {
        (0, _) => String::new(),
        (all, proved) if all == proved => "; on fewer places there are none, proved".to_owned(),
        (all, proved) => format!(
            "; fewer: {proved} lengths proved impossible, {} open",
            all - proved
        ),
    };
    // Trials end with the narrowest gap that failed, and those that did not.
    let wider = failed().rfind(|it| it.places == last.places);
    let wider = wider.map_or(String::new(), |it| {
        let how = match it.verdict {
            Verdict::Refuted => "there are none, proved",
            _ => "none were found",
        };
        format!("; with {:.3} {how}", it.gap)
    });
    Some(format!(
        "words found with a gap of {:.3} on {} places{shorter}{wider}",
        last.gap, last.places
    ))
}
