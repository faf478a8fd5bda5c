//! The summary: about ten lines for the terminal.
//!
//! It starts with the ends of tiles that start far apart. The absence of a barrier on the way into
//! the bond means little: many starts may still end in traps.

use ordered_float::OrderedFloat;

use crate::document::Table;
use crate::dynamics;
use crate::figures::percent;
use crate::states::{self, pose};
use jobs::design::Design;
use jobs::inspection;
use jobs::pipeline::Analysis;
use physics::budget::{Allowance, Ended};
use physics::landscape::results::SAME_ENERGY;
use physics::landscape::{Barrier, Catalogue, Kind, LeftOut, Place, Proportion};
use physics::order::Order;
use physics::units::{counted, share_with, si, si_range};

/// Number of traps listed individually.
const LISTED: usize = 4;
/// Significant digits of energies.
const DIGITS: usize = 4;

/// The kinds of traps in the order of the list, by captures; the deepest is always among the first.
fn traps<'a>(analysis: &'a Analysis) -> Vec<Kind<'a>> {
    let kinds = analysis.catalogue.kinds();
    let mut traps: Vec<Kind> = kinds.filter(|kind| !kind.is_bond()).collect();
    traps.order_by_key(|kind| std::cmp::Reverse(kind.captured().count));
    let deepest = traps.iter().enumerate().skip(LISTED);
    let deepest = deepest.min_by_key(|(_, kind)| OrderedFloat(kind.first().energy));
    let listed_energies = traps.iter().take(LISTED).map(|kind| kind.first().energy);
    let lowest_listed = listed_energies.fold(f64::INFINITY, f64::min);
    if let Some((k, _)) = deepest.filter(|(_, kind)| kind.first().energy < lowest_listed) {
        let kind = traps.remove(k);
        traps.insert(LISTED - 1, kind);
    }
    traps
}

fn bond(analysis: &Analysis) -> Option<Kind<'_>> {
    analysis.catalogue.kinds().find(Kind::is_bond)
}

/// Relative error of dipoles above which there is a warning.
const DOUBTFUL: f64 = 0.2;

/// For dipoles: the bond's energy in both models, and the largest error if it is large.
fn models(design: &Design, analysis: &Analysis) -> String {
    let states = analysis.catalogue.states.iter();
    let kinds = states.filter(|state| state.id == state.class);
    let off = kinds.filter_map(|state| {
        let share = state.dipole_error()?.abs() / state.block_energy?.abs();
        Some((state, share))
    });
    let mut lines = String::new();
    let bodies = design.pair.bodies();
    let bond = bond(analysis);
    if let Some((own, blocks)) = bond.and_then(|kind| {
        let bond = kind.first();
        Some((bond.energy, bond.block_energy?))
    }) {
        let [own, blocks] = [own, blocks].map(|energy| si(energy, "J", DIGITS));
        lines += &format!(
            "{}: bond energy {own} with magnets as point dipoles, {blocks} as {bodies}\n",
            design.name
        );
    }
    let off: Vec<_> = off.collect();
    let most = off.iter().map(|(_, share)| *share).fold(0.0, f64::max);
    // The first of several equal errors, independent of rounding.
    let worst = off.iter().find(|(_, share)| *share >= 0.99 * most);
    if let Some((state, share)) = worst.filter(|_| most > DOUBTFUL) {
        lines += &format!(
            "! dipoles are off by {} at {}: real magnets are {bodies} (--model cuboid)\n",
            share_with(*share, 0),
            analysis.catalogue.name_of(Place::State(state.id)),
        );
    }
    lines
}

/// The ends of far starts; for dipoles, preceded by the bond's energy in both models.
pub fn answer(design: &Design, analysis: &Analysis) -> String {
    let of = analysis.uncaptured.gone.of;
    let captured = |kinds: &[Kind]| kinds.iter().map(|kind| kind.captured().count).sum();
    let bound = bond(analysis).map_or(0, |kind| kind.captured().count);
    let models = models(design, analysis);
    format!(
        "{models}{}: of {of} far starts {} end in the bond, {} in traps,\n{} stopped in a shallow \
         minimum, {} drifted away",
        design.name,
        percent(&Proportion::new(bound, of)),
        percent(&Proportion::new(captured(&traps(analysis)), of)),
        percent(&analysis.uncaptured.at_rest),
        percent(&analysis.uncaptured.gone),
    )
}

/// Remarks on far starts, and on other faces that bind as strongly.
pub fn remarks(design: &Design, analysis: &Analysis) -> Vec<String> {
    let [inner, outer] = analysis.ring;
    let model = design.interaction.model.plural(&design.pair);
    let starts = format!(
        "({model}, overdamped, from {} away, any angle; 95 % intervals in brackets)",
        si_range(inner, outer, "m", 3)
    );
    let rivals = inspection::rivals(analysis.problem.rivals().len());
    [starts].into_iter().chain(rivals).collect()
}

/// The bond and some traps.
pub fn listed(design: &Design, analysis: &Analysis) -> Table {
    let traps = traps(analysis).into_iter().take(LISTED);
    states::listed(
        design,
        analysis,
        bond(analysis).into_iter().chain(traps),
        DIGITS,
    )
}

/// Notes of one or two lines each.
pub fn notes(design: &Design, analysis: &Analysis) -> Vec<String> {
    let (bond, traps) = (bond(analysis), traps(analysis));
    let mut notes = Vec::new();
    if traps.len() > LISTED {
        notes.push(rest(&traps[LISTED..]));
    }
    notes.push(way_in(analysis, bond.as_ref()));
    notes.push(deepest(&analysis.catalogue, bond.as_ref(), &traps));
    notes.extend(completeness(analysis));
    notes.extend(dipole_error(design, analysis));
    let uncertified = analysis.uncertified;
    notes.extend(uncertified.map(|why| format!("barriers are not certified: {why}")));
    notes.extend(analysis.certificate_ended.map(|ended| {
        let ended = ended_by(ended, "certify", analysis.request.certify.allowed());
        format!("some barriers' bounds are wider than requested: {ended}")
    }));
    notes.extend(dynamics::notes(analysis));
    notes
}

/// The note on found but unlisted states, of which the lowest has this energy.
pub(super) fn left_out(left: LeftOut, lowest: &str) -> String {
    let more = match left.kinds {
        1 => "1 more kind of trap was".to_owned(),
        kinds => format!("{kinds} more kinds of trap were"),
    };
    format!("{more} found, {lowest} at the lowest, and not analysed (--kinds N: the N deepest)")
}

/// Whether states may be missing from the list.
fn completeness(analysis: &Analysis) -> Vec<String> {
    let left = analysis.counts.left_out;
    let left = left.map(|left| left_out(left, &si(left.lowest, "J", 4)));
    let mut notes: Vec<String> = left.into_iter().collect();
    let known = match &analysis.completeness {
        Ok(known) => known,
        Err(why) => {
            notes.push(format!(
                "the list of states is sampled and may be incomplete: {why};\nan estimated {} of \
                 further far starts would end in kinds not seen yet (Good-Turing)",
                percent(&analysis.catalogue.unseen())
            ));
            return notes;
        }
    };
    let [below, escape] = [known.below, known.escape].map(|energy| si(energy, "J", 3));
    let claim = format!("no other state below {below} needs more than {escape} to escape");
    notes.push(match known.open.first() {
        None => format!("complete, proved: {claim}"),
        Some(lowest) => format!(
            "{claim}, proved except in {} ({:.1e} of the space)\nthat may hide states no \
             deeper than {}, the deepest at {}",
            counted(known.open.len(), "region"),
            known.share,
            si(lowest.lowest, "J", 3),
            pose(&lowest.pose),
        ),
    });
    let allowed = analysis.request.completeness().allowed;
    let ended = known.ended;
    notes.extend(ended.map(|ended| ended_by(ended, "complete", allowed)));
    notes
}

/// The note that a proof ended early, and the option that continues it.
pub(super) fn ended_by(ended: Ended, stage: &str, allowed: Allowance) -> String {
    let (limit, option, note) = match ended {
        Ended::Work => (allowed.work, "work", "raise it to continue"),
        Ended::Clock => (allowed.seconds, "seconds", "another run may differ"),
    };
    let limit = limit.unwrap_or(f64::INFINITY);
    format!("{} (--{stage}-{option} {limit}): {note}", ended.describe())
}

/// The largest error of the dipoles' energy over all states.
fn dipole_error(design: &Design, analysis: &Analysis) -> Option<String> {
    let states = analysis.catalogue.states.iter();
    let (state, blocks, error) = states
        .filter(|state| state.id == state.class)
        .filter_map(|state| Some((state, state.block_energy?, state.dipole_error()?)))
        .max_by_key(|(.., error)| OrderedFloat(error.abs()))?;
    Some(format!(
        "dipoles are off by up to {}: at {}, where {} have {} (--model cuboid)",
        si(error, "J", DIGITS),
        analysis.catalogue.name_of(Place::State(state.id)),
        design.pair.bodies(),
        si(blocks, "J", DIGITS),
    ))
}

fn rest(rest: &[Kind]) -> String {
    let deepest = rest.iter().map(|t| t.first().energy).fold(0.0, f64::min);
    let captured: usize = rest.iter().map(|t| t.captured().count).sum();
    format!(
        "and {} more kind{} of trap, down to {}, capturing {} in total",
        rest.len(),
        if rest.len() == 1 { "" } else { "s" },
        si(deepest, "J", DIGITS),
        percent(&Proportion::new(captured, rest[0].captured().of)),
    )
}

/// The best path from far starts into the bond.
fn way_in(analysis: &Analysis, bond: Option<&Kind>) -> String {
    if bond.is_none() {
        let energy = si(analysis.bound.1, "J", DIGITS);
        return format!(
            "no bond: nothing holds the tile where the target faces coincide ({energy})"
        );
    }
    match analysis.catalogue.way_out_of_the_bond() {
        Some(way) if way.bounds.caged => {
            "proved: no path leads from far apart into the bond, or out of it".to_owned()
        }
        Some(way) if way.saddle_energy <= 0.0 => format!(
            "no barrier on the best path from far apart into the bond{}",
            work_and_length(way)
        ),
        Some(way) if way.has_way() => format!(
            "a barrier of {} on the best path from far apart into the bond{}",
            si(way.saddle_energy, "J", DIGITS),
            work_and_length(way)
        ),
        _ => "no path from far apart into the bond was found".to_owned(),
    }
}

/// The work and length of the best path out of the bond in reverse; negligible climbs count as
/// zero.
fn work_and_length(way_out: &Barrier) -> String {
    let Some(([_, climbs], length)) = way_out.work().zip(way_out.length()) else {
        return String::new();
    };
    let work = if climbs < 1e-5 * way_out.forward() {
        0.0
    } else {
        climbs
    };
    let [work, length] = [si(work, "J", 3), si(length, "m", 3)];
    format!(": work {work}, length {length}")
}

fn deepest(catalogue: &Catalogue, bond: Option<&Kind>, traps: &[Kind]) -> String {
    let energy = |kind: &Kind| kind.first().energy;
    let lowest = traps.iter().map(energy).fold(f64::INFINITY, f64::min);
    // The first of twins, independent of rounding of their energies.
    let is_lowest = |kind: &&Kind| energy(kind) - lowest <= SAME_ENERGY * lowest.abs();
    let deepest = traps.iter().find(is_lowest);
    let name = |kind: &Kind| catalogue.name_of(Place::State(kind.first().id));
    match (deepest, bond) {
        (None, _) => "no traps".to_owned(),
        (Some(deepest), None) => format!("deepest: {}", name(deepest)),
        (Some(deepest), Some(bond)) => format!(
            "deepest: {}; selectivity {:.3} (energy of the bond / energy of the deepest trap)",
            name(deepest),
            bond.first().energy / deepest.first().energy,
        ),
    }
}
