//! What is told of an assembly in words.

use jobs::assembly::choice::{Choice, Verdict};
use jobs::assembly::slides::{self, Slid};
use jobs::assembly::{Assembly, lattice};
use physics::units::{plain, si, si_range};

/// One sentence that answers whether it can be built.
pub(super) fn headline(assembly: &Assembly) -> String {
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
pub(super) fn for_engines(assembly: &Assembly) -> Vec<String> {
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

/// What else to know of it.
pub(super) fn known(assembly: &Assembly, slides: &[(usize, usize, Slid)]) -> Vec<String> {
    let built = assembly.built;
    let mut lines = Vec::new();
    let mut line = |words: String| lines.push(words);
    if let Some([low, high]) = built.window() {
        line(match low > 0.0 {
            true => format!(
                "it grows between kT {} at this coverage",
                si_range(low, high, "J", 3)
            ),
            false => format!("it grows below kT {} at this coverage", si(high, "J", 3)),
        });
    }
    if let Some([rows, columns]) = assembly.lattice {
        let needed = lattice::words(rows, columns);
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
    if let Some(whole) = whole(assembly) {
        line(whole);
    }
    line(format!(
        "errors a tile, grown just above standstill: {:.2e}; faster growth makes more of them",
        built.errors_at_standstill()
    ));
    if let Some(slid) = slides::summary(built, slides) {
        line(format!(
            "outside of the model: slid by whole places faces hold with up to {} ({:.1} kT, Gmc \
             {:.1}); {} of {} pairs of faces would so hold a tile alone, and of a word's slides along \
             its mate {:.0} % of those that hold end slid",
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
    lines
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

/// How much deeper bonds are in whole tiles.
fn whole(assembly: &Assembly) -> Option<String> {
    let [least, most] = assembly.built.deeper()?;
    let percent = |share: f64| format!("{:.1} %", 100.0 * share.abs());
    // Less than a tenth of a percent is neither.
    let told = match (least < -5e-4, most > 5e-4) {
        (true, true) => format!(
            "from {} shallower to {} deeper",
            percent(least),
            percent(most)
        ),
        (true, false) => format!("up to {} shallower and none deeper", percent(least)),
        (false, true) => format!("up to {} deeper and none shallower", percent(most)),
        (false, false) => "as deep".to_owned(),
    };
    Some(format!(
        "in whole tiles bonds are {told} than of two faces, as engines have them"
    ))
}
