//! The text of an assembly's summary.

use jobs::assembly::built::{GrowthVerdict, MOST_MEETINGS, Shaken};
use jobs::assembly::choice::{Choice, WordsVerdict};
use jobs::assembly::kinetic::Growth as Kinetic;
use jobs::assembly::slides;
use jobs::assembly::{Assembly, Growing, SIDES, Tau, TileSet, TileType, lattice};
use physics::units::{counted, plain, share_with, si, si_range};

/// Largest number of reasons given why nothing attaches to the seed.
const MOST_REASONS: usize = 6;

/// One sentence that says whether the set can be built.
pub(super) fn headline(assembly: &Assembly) -> String {
    let built = &assembly.built;
    let set = &built.set;
    let what = format!(
        "{}: {} with {} of {}",
        set.name,
        counted(set.tiles.len(), "tile"),
        counted(built.wiring.bonds.len(), "word"),
        counted(
            built.matrix.words.first().map_or(0, |word| word.places()),
            "position"
        ),
    );
    let Some(growing) = &assembly.growing else {
        let tiles: usize = assembly.counts().iter().sum();
        return format!(
            "{what}, for {tiles} tiles laid by hand (--kt also simulates growth); the weakest bond \
             is {}",
            si(built.unit, "J", 4)
        );
    };
    let shaken = &growing.shaken;
    let told;
    let verdict = match growing.verdict(built) {
        GrowthVerdict::Stuck => "beside the point: nothing attaches to the seed",
        GrowthVerdict::TooHard => {
            "too hard: bonds of strength tau do not hold a tile, and growth does not end right"
        }
        GrowthVerdict::MoreHold => {
            "hard: bonds of strength tau do not hold a tile, but stronger ones do, and growths end right"
        }
        GrowthVerdict::FewerHold => "too soft: fewer bonds than tau also hold, so anything grows",
        GrowthVerdict::FewerSuffice => {
            "soft: fewer bonds than tau also hold, but nothing else fits, and growths end right"
        }
        GrowthVerdict::MismatchHolds => {
            "too soft: a single aligned mismatch also holds a tile, so errors grow"
        }
        GrowthVerdict::TauHolds => {
            "right: bonds of strength tau hold a tile and weaker ones do not"
        }
        GrowthVerdict::OneHolds => "right, so one bond holds a tile",
        GrowthVerdict::ErrorsStay => {
            told = format!(
                "too soft: {} of {} simulated growths end with errors that remain",
                growing.growth.wrong, growing.growth.runs
            );
            &told
        }
        GrowthVerdict::Slow => "too hard: growth does not finish",
    };
    format!(
        "{what}; at kT = {} and {} coverage Gse (a bond) is {} kT and Gmc (docking) {:.2} kT; \
         shaking is {verdict}",
        si(shaken.shaking.kt, "J", 3),
        share_with(shaken.shaking.coverage, 1),
        match shaken.gse {
            ..1e4 => format!("{:.2}", shaken.gse),
            _ => plain(shaken.gse, 3),
        },
        shaken.gmc,
    )
}

/// The tiles from which growth starts; the first of the set if its file names none.
pub(super) fn seeds<'a>(assembly: &'a Assembly) -> Vec<(&'a String, &'a TileType)> {
    let set = &assembly.built.set;
    let named = |tile: usize| (&set.tiles[tile].name, &set.tiles[tile]);
    match set.seed.is_empty() {
        true => vec![named(0)],
        false => set.seed.iter().map(|(.., tile)| named(*tile)).collect(),
    }
}

/// A note on the seed and on tau, and why nothing attaches to the seed if that is so.
fn start(assembly: &Assembly) -> Vec<String> {
    let set = &assembly.built.set;
    let seeds = seeds(assembly);
    let first = seeds[0].0;
    let seed = match (set.seed.len(), seeds.len()) {
        (0, _) => format!(
            "the file names no seed: growth starts from its first tile, `{first}`; choose another \
             with seed: [row, column, tile]"
        ),
        (_, 1) => format!("growth starts from the seed of the file, `{first}`"),
        (_, count) => format!("growth starts from the {count} seed tiles of the file"),
    };
    let (tau, from) = set.tau_from();
    let tau_told = match from {
        Tau::Stated => None,
        Tau::OfEnergies => Some(format!(
            "tau is {tau}, which follows from Gmc / Gse of the file"
        )),
        Tau::Assumed => Some(format!(
            "the file states neither tau nor Gmc and Gse: {tau} is assumed; write tau: 1 if one \
             bond is to hold a tile"
        )),
    };
    let stuck = assembly.built.grown.is_stuck().then(|| {
        let mut reasons = Vec::new();
        for (name, tile) in &seeds {
            for (side, glue) in tile.glues.iter().enumerate() {
                let Some(glue) = *glue else { continue };
                reasons.push(partner(set, name, side, glue));
            }
        }
        reasons.truncate(MOST_REASONS);
        if reasons.is_empty() {
            reasons.push("its faces have no glues".to_owned());
        }
        format!(
            "nothing attaches to the seed with strength tau = {tau}: {}",
            reasons.join("; ")
        )
    });
    [Some(seed), tau_told, stuck]
        .into_iter()
        .flatten()
        .collect()
}

/// How strongly a glue of a seed's face binds any tile that is on the table.
fn partner(set: &TileSet, seed: &str, side: usize, glue: usize) -> String {
    let strengths = set.strengths();
    let across = (side + 2) % 4;
    let on_table = set.tiles.iter().filter(|tile| tile.stoic > 0.0);
    let held = on_table.filter_map(|tile| Some((tile, strengths[glue][tile.glues[across]?])));
    let most = held.reduce(|most, it| if it.1 > most.1 { it } else { most });
    let face = format!(
        "glue `{}` on the {} face of `{seed}`",
        set.glues[glue].name, SIDES[side]
    );
    match most.filter(|it| it.1 > 0.0) {
        None => format!(
            "{face} has no partner: no loose tile has a glue on its {} face that binds it",
            SIDES[across]
        ),
        Some((tile, strength)) => {
            format!("{face} binds `{}` with only {strength}", tile.name)
        }
    }
}

/// The number of every tile, and what follows for the designs, if tiles are laid by hand.
fn laid(assembly: &Assembly) -> Vec<String> {
    let built = &assembly.built;
    let shares = built.set.tiles.iter().map(|tile| tile.stoic);
    let counted = match shares.clone().all(|share| share == 1.0) {
        true => "one of each tile, as the file states no other number (stoic)",
        false if shares.clone().all(|share| share == share.round()) => {
            "as many of each tile as its share (stoic) in the file"
        }
        false => "one of each tile: the shares (stoic) of the file are not whole numbers",
    };
    let clipped = (built.meetings.len() >= MOST_MEETINGS).then(|| {
        format!("there are designs for the first {MOST_MEETINGS} pairs of tiles that bind only")
    });
    let mut notes = vec![
        counted.to_owned(),
        "without --kt there are no files for xgrow and rgrow, whose energies are in kT".to_owned(),
    ];
    notes.extend(clipped);
    notes
}

/// The comments above the set in files for engines.
pub(super) fn for_engines(assembly: &Assembly, shaken: &Shaken) -> [String; 8] {
    let (name, version) = (&assembly.built.set.name, env!("CARGO_PKG_VERSION"));
    let (kt, coverage) = (shaken.shaking.kt, shaken.shaking.coverage);
    [
        format!("{name} as magnets build it, by tilebind {version}"),
        format!("kT {kt:e} J, coverage {coverage}; energies are Gse times a strength, in kT"),
        "X is a word, X* its mate; one is on east or north faces, the other on west or south ones;"
            .to_owned(),
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
    let lattice = assembly.request.lattice.map(|[rows, columns]| {
        let needed = lattice::words(rows, columns);
        format!("a lattice of {rows} x {columns} distinct tiles needs {needed} words")
    });
    let mismatch = match built.strongest_wrong() {
        Some((i, j, energy)) => format!(
            "strongest aligned mismatch: {} on {}, {} ({} of a bond)",
            assembly.face(i),
            assembly.face(j),
            si(energy, "J", 4),
            share_with(-energy / built.unit, 0)
        ),
        None => "no aligned mismatch attracts".to_owned(),
    };
    let shaking = match &assembly.growing {
        Some(growing) => self::growing(assembly, growing),
        None => laid(assembly),
    };
    let words = [
        lattice,
        found(assembly),
        Some(mismatch),
        built.deeper().map(whole),
    ];
    let after = [
        strengths(assembly),
        repelled(assembly),
        passed_over(assembly),
        slid(assembly),
    ];
    let words = words.into_iter().flatten();
    words
        .chain(shaking)
        .chain(after.into_iter().flatten())
        .collect()
}

/// Notes on growth.
fn growing(assembly: &Assembly, growing: &Growing) -> Vec<String> {
    let window = assembly.built.window(&growing.shaken).map(|[low, high]| match low > 0.0 {
        true => format!(
            "bonds of strength tau hold a tile, and weaker ones do not, at kT from {} at this coverage",
            si_range(low, high, "J", 3)
        ),
        false => format!(
            "bonds of strength tau hold a tile at kT below {} at this coverage",
            si(high, "J", 3)
        ),
    });
    let grown = &assembly.built.grown;
    let tiles = grown.tiles.len();
    let ends = match grown.complete {
        true => format!("without errors growth ends with {}", counted(tiles, "tile")),
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
    let mut notes = start(assembly);
    let kt = growing.shaken.shaking.kt;
    let stuck = grown.is_stuck();
    let simulated = (!stuck).then(|| grown_at(kt, &growing.growth));
    let proposed = (!stuck).then(|| proposal(growing));
    let canvas = canvas(assembly, &growing.shaken);
    let more = [window, simulated, proposed, canvas, Some(ends), choices];
    notes.extend(more.into_iter().flatten());
    notes
}

/// A note on slid contacts.
fn slid(assembly: &Assembly) -> Option<String> {
    let shaken = assembly.growing.as_ref().map(|it| &it.shaken);
    let slid = slides::summary(&assembly.built, shaken, &assembly.slides)?;
    if slid.deepest >= 0.0 {
        return Some("no two faces slid by whole positions attract each other".into());
    }
    let deepest = si(slid.deepest, "J", 4);
    let whose = match shaken {
        Some(_) => "not in the engines' model: faces slid by whole positions bind with up to",
        None => "faces slid by whole positions bind with up to",
    };
    let held = shaken.zip(slid.holding).map_or(String::new(), |(shaken, holding)| {
        format!(
            " ({:.1} kT, Gmc {:.1}); {holding} of {} pairs of faces hold a tile alone in this way",
            -slid.deepest / shaken.shaking.kt,
            shaken.gmc,
            slid.pairs
        )
    });
    Some(format!(
        "{whose} {deepest}{held}; {} of the tiles that bind from a slid start remain slid",
        share_with(slid.share, 0)
    ))
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
fn proposal(growing: &Growing) -> String {
    match growing.proposal() {
        Some((kt, growth)) => format!("suggested: --kt {kt:.2e}; {}", grown_at(kt, &growth)),
        None => {
            let others = growing.others.iter();
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
fn canvas(assembly: &Assembly, shaken: &Shaken) -> Option<String> {
    let built = &assembly.built;
    let [rows, columns] = built.set.size?;
    let engine = built.engine(shaken).size?;
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
    let failed = || before.iter().filter(|it| it.verdict != WordsVerdict::Found);
    let refuted = |it: &&Choice| it.verdict == WordsVerdict::Refuted;
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
        WordsVerdict::Refuted => format!("; with {:.3} there are none, proved", it.gap),
        _ => format!("; with {:.3} none were found", it.gap),
    });
    let wider = match last.widest {
        true => ", proved widest".to_owned(),
        false => wider,
    };
    Some(format!(
        "words found with a gap of {:.3} on {}{wider}{shorter}",
        last.gap,
        counted(last.places, "position")
    ))
}

/// How much deeper bonds are between whole tiles, from the smallest to the largest difference.
fn whole(ends: [f64; 2]) -> String {
    let [least, most] = ends.map(|share| share_with(share.abs(), 1));
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
