//! The text of an assembly's summary.

use jobs::assembly::built::Verdict as Growth;
use jobs::assembly::choice::{Choice, Verdict};
use jobs::assembly::kinetic::Growth as Kinetic;
use jobs::assembly::slides;
use jobs::assembly::{Assembly, lattice};
use physics::units::{plain, si, si_range};

/// One sentence that says whether the set can be built.
pub(super) fn headline(assembly: &Assembly) -> String {
    let built = &assembly.built;
    let (set, gse) = (&built.set, built.gse());
    let told;
    let verdict = match assembly.verdict() {
        Growth::TooHard => {
            "too hard: bonds of strength tau do not hold a tile, and growth does not end right"
        }
        Growth::MoreHold => {
            "hard: bonds of strength tau do not hold a tile, but stronger ones do, and growths end right"
        }
        Growth::FewerHold => "too soft: fewer bonds than tau also hold, so anything grows",
        Growth::MismatchHolds => {
            "too soft: a single aligned mismatch also holds a tile, so errors grow"
        }
        Growth::TauHolds => "right: bonds of strength tau hold a tile and weaker ones do not",
        Growth::OneHolds => "right, so one bond holds a tile",
        Growth::ErrorsStay => {
            told = format!(
                "too soft: {} of {} simulated growths end with errors that remain",
                assembly.growth.wrong, assembly.growth.runs
            );
            &told
        }
        Growth::Slow => "too hard: growth does not finish",
    };
    format!(
        "{}: {} with {} words of {} positions; at kT = {} and {:.1} % coverage Gse (a bond) is {} kT \
         and Gmc (docking) {:.2} kT; shaking is {verdict}",
        set.name,
        match set.tiles.len() {
            1 => "1 tile".to_owned(),
            count => format!("{count} tiles"),
        },
        built.wiring.bonds.len(),
        built.matrix.words.first().map_or(0, |word| word.places()),
        si(built.shaking.kt, "J", 3),
        100.0 * built.shaking.coverage,
        match gse {
            ..1e4 => format!("{gse:.2}"),
            _ => plain(gse, 3),
        },
        built.gmc,
    )
}

/// The comments above the set in files for engines.
pub(super) fn for_engines(assembly: &Assembly) -> [String; 8] {
    let built = &assembly.built;
    let (name, version) = (&built.set.name, env!("CARGO_PKG_VERSION"));
    let (kt, coverage) = (built.shaking.kt, built.shaking.coverage);
    [
        format!("{name} as magnets build it, by tilebind {version}"),
        format!("kT {kt:e} J, coverage {coverage}; energies are Gse times a strength, in kT"),
        "X is a word on east or north faces, X* its mate on west or south faces;".to_owned(),
        "wrong contacts have their own energies; repulsive ones are negative (0 in the xgrow file)"
            .to_owned(),
        "letters as in words.toml, matrix.csv and sheet.md".to_owned(),
        "rgrow: import rgrow; system, state = \
         rgrow.rgrow.TileSet.from_file('assembly.yaml').create_system_and_state()"
            .to_owned(),
        "       system.evolve(state, for_events=100000); print(state.canvas_view)".to_owned(),
        "xgrow: xgrow assembly.tiles (with -nw: without a window)".to_owned(),
    ]
}

/// Further notes.
pub(super) fn known(assembly: &Assembly) -> Vec<String> {
    let built = &assembly.built;
    let grown = &built.grown;
    let window = built.window().map(|[low, high]| match low > 0.0 {
        true => format!(
            "bonds of strength tau hold a tile, and weaker ones do not, at kT from {} at this coverage",
            si_range(low, high, "J", 3)
        ),
        false => format!(
            "bonds of strength tau hold a tile at kT below {} at this coverage",
            si(high, "J", 3)
        ),
    });
    let lattice = assembly.request.lattice.map(|[rows, columns]| {
        let needed = lattice::words(rows, columns);
        format!("a lattice of {rows} x {columns} distinct tiles needs {needed} words")
    });
    let mismatch = match built.strongest_wrong() {
        Some((i, j, energy)) => format!(
            "strongest aligned mismatch: {} on {}, {} ({:.0} % of a bond)",
            assembly.face(i),
            assembly.face(j),
            si(energy, "J", 4),
            -100.0 * energy / built.unit
        ),
        None => "no aligned mismatch attracts".to_owned(),
    };
    let slid = slides::summary(built, &assembly.slides).map(|slid| {
        format!(
            "not in the engines' model: faces slid by whole positions bind with up to {} ({:.1} \
             kT, Gmc {:.1}); {} of {} pairs of faces hold a tile alone in this way; {:.0} % of \
             the tiles that bind from a slid start remain slid",
            si(slid.deepest, "J", 4),
            -slid.deepest / built.shaking.kt,
            built.gmc,
            slid.holding,
            slid.pairs,
            100.0 * slid.share
        )
    });
    let tiles = grown.tiles.len();
    let ends = match grown.complete {
        true => format!("without errors growth ends with {tiles} tiles"),
        false => format!(
            "without errors growth never ends; the first {tiles} tiles were \
            computed"
        ),
    };
    let choices = (grown.choices > 0).then(|| {
        format!(
            "at {} places more than one tile fits: the tile set is not directed",
            grown.choices
        )
    });
    let before = [window, lattice, found(assembly), Some(mismatch)];
    let after = [
        built.deeper().map(whole),
        Some(grown_at(built.shaking.kt, &assembly.growth)),
        Some(proposal(assembly)),
        strengths(assembly),
        repelled(assembly),
        passed_over(assembly),
        canvas(assembly),
        slid,
        Some(ends),
        choices,
    ];
    before.into_iter().chain(after).flatten().collect()
}

/// The result of growth runs at a kT (J).
fn grown_at(kt: f64, growth: &Kinetic) -> String {
    let Kinetic {
        runs, right, wrong, ..
    } = growth;
    let unfinished = match runs - right - wrong {
        0 => String::new(),
        some => format!(", {some} do not finish"),
    };
    format!(
        "kinetic growth (kTAM) at kT = {}: {right} of {runs} growths are right, {wrong} end with \
         errors ({} per tile){unfinished}",
        si(kt, "J", 3),
        plain(growth.errors_a_tile, 2)
    )
}

/// The suggested kT.
fn proposal(assembly: &Assembly) -> String {
    match assembly.proposal() {
        Some((kt, growth)) => format!("suggested: --kt {kt:.2e}; {}", grown_at(kt, &growth)),
        None => {
            let others = assembly.others.iter();
            let kts: Vec<String> = others.map(|it| si(it.0, "J", 2)).collect();
            format!(
                "most runs do not grow correctly at any kT tried ({}): widen the gap (--length) or lower \
                 the coverage to reduce errors",
                kts.join(", ")
            )
        }
    }
}

/// A note that strengths differ from the requested ones.
fn strengths(assembly: &Assembly) -> Option<String> {
    let built = &assembly.built;
    let (bond, asked, has) = built
        .unlike()
        .filter(|it| (it.2 / it.1 - 1.0).abs() > 0.01)?;
    let glue = built.wiring.bonds[bond].glues[0][0];
    Some(format!(
        "strengths differ slightly from the file, in units of the weakest bond: `{}` (word {}) \
         should have {asked} and has {has:.3}; more magnets (--length) reduce the difference",
        built.set.glues[glue].name,
        assembly.face(bond),
    ))
}

/// A note that glues without a bond have no magnets, although they repel in the file.
fn repelled(assembly: &Assembly) -> Option<String> {
    let set = &assembly.built.set;
    let binds_none = |strengths: &Vec<f64>| {
        strengths.iter().all(|it| *it <= 0.0) && strengths.iter().any(|it| *it < 0.0)
    };
    let strengths = set.strengths();
    let glues = set.glues.iter().zip(&strengths);
    let names: Vec<_> = glues
        .filter(|it| binds_none(it.1))
        .map(|it| format!("`{}`", it.0.name))
        .collect();
    (!names.is_empty()).then(|| {
        format!(
            "glues with negative strength in the file: they have no magnets, so they neither bind \
             nor repel: {}",
            names.join(", ")
        )
    })
}

/// A note on ignored entries of the file.
fn passed_over(assembly: &Assembly) -> Option<String> {
    let keys = &assembly.built.set.passed_over;
    let list = keys.join(", ");
    (!keys.is_empty())
        .then(|| format!("ignored in the file, because it only controls a simulator: {list}"))
}

/// A note that the canvas differs from the file's.
fn canvas(assembly: &Assembly) -> Option<String> {
    let built = &assembly.built;
    let [rows, columns] = built.set.size?;
    let engine = built.engine().size?;
    (engine != [rows, columns]).then(|| {
        format!(
            "the file's canvas is {rows} x {columns}, but a real table has no such limit; the engine \
             files use {} x {}, large enough for the whole growth",
            engine[0], engine[1]
        )
    })
}

/// A note on the search for words, if there was one.
fn found(assembly: &Assembly) -> Option<String> {
    let (last, before) = assembly.tried.split_last()?;
    let failed = || before.iter().filter(|it| it.verdict != Verdict::Found);
    let refuted = |it: &&Choice| it.verdict == Verdict::Refuted;
    let shorter = || failed().filter(|it| it.places != last.places);
    let shorter = match (shorter().count(), shorter().filter(refuted).count()) {
        (0, _) => String::new(),
        (all, proved) if all == proved => "; on fewer positions there are none, proved".to_owned(),
        (all, proved) => format!(
            "; on fewer positions: {proved} lengths proved impossible, {} open",
            all - proved
        ),
    };
    // The trials end with the narrowest failed gap and the successful ones.
    let wider = failed().rfind(|it| it.places == last.places);
    let wider = wider.map_or(String::new(), |it| match it.verdict {
        Verdict::Refuted => format!("; with {:.3} there are none, proved", it.gap),
        _ => format!("; with {:.3} none were found", it.gap),
    });
    Some(format!(
        "words found with a gap of {:.3} on {} positions{shorter}{wider}",
        last.gap, last.places
    ))
}

/// How much deeper bonds are between whole tiles, from the smallest to the largest difference.
fn whole(ends: [f64; 2]) -> String {
    let [least, most] = ends.map(|share| format!("{:.1} %", 100.0 * share.abs()));
    // A difference below a tenth of a per cent is ignored.
    let told = match (ends[0] < -5e-4, ends[1] > 5e-4) {
        (true, true) => format!("from {least} shallower to {most} deeper"),
        (true, false) => format!("up to {least} shallower"),
        (false, true) => format!("up to {most} deeper"),
        (false, false) => "equally deep".to_owned(),
    };
    format!(
        "bonds between whole tiles, compared with isolated pairs of faces (which the engines use): \
         {told}"
    )
}
