//! Certified pathways joined at the states they share.

use petgraph::algo::{astar, min_spanning_tree};
use petgraph::data::FromElements;
use petgraph::graph::{NodeIndex, UnGraph};

use crate::catalogue::Catalogue;
use crate::pathway;
use crate::results::{Barrier, Pathway, Place};
use tiles::configuration::ConfigurationSpace;

/// Places, joined by barriers of these upper bounds (J) and numbers.
type Places = UnGraph<Place, (f64, usize)>;

/// Replaces the pathways of barriers by chains of other barriers over states between their ends, if
/// these are proved to be lower by more than `gain` (J), and for `free` by more than the tolerance
/// of far configurations.
///
/// The minimax energy from A to C is at most the greater of those from A to B and from B to C, and
/// so is the bound of the two pathways, one after the other: both are proved from and to B itself,
/// independent of gaps between the ends of the descents that found it. `free` stands for many
/// configurations: a chain may end there, but not lead through it.
pub fn take_over_chains(space: &ConfigurationSpace, catalogue: &mut Catalogue, gain: f64) {
    let before = catalogue.barriers.clone();
    let to_free = spanning_tree(catalogue, &before, |_| true);
    let between_states = spanning_tree(catalogue, &before, |place| place != Place::Free);
    for barrier in &mut catalogue.barriers {
        let tree = match barrier.to {
            Place::Free => &to_free,
            Place::State(_) => &between_states,
        };
        let ends = [barrier.from, barrier.to];
        let Some((upper, pathway)) = chain(space, tree, &before, ends) else {
            continue;
        };
        let known = barrier.bounds.upper;
        let gain = match barrier.to {
            Place::Free => gain.max(pathway::AMONG_FAR * barrier.forward()),
            Place::State(_) => gain,
        };
        if known.is_none_or(|known| upper < known - gain) {
            barrier.bounds.upper = Some(upper);
            barrier.lead_along(pathway);
        }
    }
}

/// The barriers that are joined to the lowest chains between any two places; the upper bounds of
/// all others are no lower than those of the chain between their ends.
fn spanning_tree(
    catalogue: &Catalogue,
    barriers: &[Barrier],
    holds: impl Fn(Place) -> bool,
) -> Places {
    let mut places = Places::default();
    for state in &catalogue.states {
        places.add_node(Place::State(state.id));
    }
    places.add_node(Place::Free);
    for (number, barrier) in barriers.iter().enumerate() {
        let ends = [barrier.from, barrier.to];
        if let Some(upper) = barrier
            .bounds
            .upper
            .filter(|_| ends.into_iter().all(&holds))
        {
            let [a, b] = ends.map(|place| node(&places, place));
            places.add_edge(a, b, (upper, number));
        }
    }
    Places::from_elements(min_spanning_tree(&places))
}

/// States stand under their numbers, `free` behind them.
fn node(places: &Places, place: Place) -> NodeIndex {
    match place {
        Place::State(id) => NodeIndex::new(id),
        Place::Free => NodeIndex::new(places.node_count() - 1),
    }
}

/// The greatest upper bound (J) on the way through a tree, and the pathway; `None` if there is no
/// way, or its pathways do not end where the next ones begin.
fn chain(
    space: &ConfigurationSpace,
    tree: &Places,
    barriers: &[Barrier],
    ends: [Place; 2],
) -> Option<(f64, Pathway)> {
    let [start, end] = ends.map(|place| node(tree, place));
    let (_, nodes) = astar(tree, start, |n| n == end, |_| 1, |_| 0)?;
    let mut greatest = f64::NEG_INFINITY;
    let mut joined = Pathway::new();
    for pair in nodes.windows(2) {
        let (upper, number) = tree[tree.find_edge(pair[0], pair[1])?];
        let barrier = &barriers[number];
        let is_forward = barrier.from == tree[pair[0]];
        let next = if is_forward {
            barrier.pathway.clone()
        } else {
            pathway::reversed(&barrier.pathway)
        };
        greatest = greatest.max(upper);
        joined = pathway::joined(space, joined, next)?;
    }
    Some((greatest, joined))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{PathwayPoint, SaddleBounds, State, StateKind};
    use tiles::configuration::Configuration;

    fn at(x: f64) -> Configuration {
        Configuration::new(x, 0.0, 0.0)
    }

    fn state(id: usize) -> State {
        State::new(id, StateKind::Trap, at(id as f64), -1.0)
    }

    /// A barrier whose path leads over a point of its own height, and through it at `upper`.
    fn barrier(from: usize, to: Option<usize>, upper: f64) -> Barrier {
        let place = to.map_or(Place::Free, Place::State);
        let (start, end) = (from as f64, to.map_or(9.0, |id| id as f64));
        let middle = (start + end) / 2.0;
        let points = [(start, -1.0), (middle, upper), (end, -1.0)];
        let point = |(x, energy): (f64, f64)| PathwayPoint {
            s: (x - start).abs(),
            configuration: at(x),
            energy,
            clearance: 0.0,
        };
        Barrier {
            from: Place::State(from),
            to: place,
            saddle_energy: upper,
            saddle: at(middle),
            bounds: SaddleBounds {
                upper: Some(upper),
                ..SaddleBounds::default()
            },
            from_energy: -1.0,
            to_energy: -1.0,
            spread: None,
            pathway: points.map(point).to_vec(),
        }
    }

    fn taken_over(barriers: Vec<Barrier>) -> Vec<Barrier> {
        let mut catalogue = Catalogue {
            states: (0..3).map(state).collect(),
            barriers,
            ..Catalogue::default()
        };
        let space = ConfigurationSpace {
            half_size: [10.0, 10.0],
            rho: 0.1,
            free_distance: 1.0,
        };
        take_over_chains(&space, &mut catalogue, 1e-6);
        catalogue.barriers
    }

    #[test]
    fn a_lower_way_over_other_states_is_taken_over() {
        // The one between runs the other way.
        let chain = [barrier(2, Some(0), 1.0), barrier(2, None, 2.0)];
        let [direct, ..] = &taken_over([&[barrier(0, None, 5.0)], &chain[..]].concat())[..] else {
            panic!("a barrier is lost");
        };
        assert_eq!(
            (direct.bounds.upper, direct.saddle_energy),
            (Some(2.0), 2.0)
        );
        assert_eq!(direct.saddle, at(5.5));
        let way: Vec<(f64, f64)> = direct
            .pathway
            .iter()
            .map(|point| (point.s, point.configuration.x))
            .collect();
        assert_eq!(
            way,
            [(0.0, 0.0), (1.0, 1.0), (2.0, 2.0), (5.5, 5.5), (9.0, 9.0)]
        );
    }

    #[test]
    fn a_chain_that_is_no_lower_or_leads_through_free_is_not() {
        let before = vec![
            barrier(0, Some(1), 5.0),
            barrier(0, None, 1.0),
            barrier(1, None, 1.0),
            barrier(2, Some(1), 5.0),
            barrier(2, Some(0), 5.0),
        ];
        assert_eq!(taken_over(before.clone()), before);
    }

    #[test]
    fn pathways_with_a_gap_between_them_are_not_joined() {
        let mut second = barrier(1, None, 1.0);
        second.pathway[0].configuration.y = 1e-3;
        let before = vec![barrier(0, None, 5.0), barrier(0, Some(1), 1.0), second];
        assert_eq!(taken_over(before.clone()), before);
    }
}
