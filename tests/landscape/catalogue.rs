//! Names of states, and the lowest ways out of them.

use tilebind::landscape::{Barrier, Catalogue, Place, Proportion, State, StateKind};
use tilebind::potential::DipolePotential;
use tilebind::{Configuration, ConfigurationSpace, Problem};

fn state(kind: StateKind, energy: f64) -> State {
    State::new(0, kind, Configuration::new(0.0, 0.0, 0.0), energy)
}

/// A barrier between places with these energies, over a separate saddle.
fn barrier(to: Option<(usize, f64)>, saddle_energy: f64) -> Barrier {
    let start = Configuration::new(0.0, 0.0, 0.0);
    let to = to.map_or((Place::Free, 0.0), |(id, energy)| {
        (Place::State(id), energy)
    });
    Barrier {
        saddle_energy,
        ..Barrier::without_a_way((Place::State(0), -1.0), start, to)
    }
}

/// No forces and no contact.
fn empty() -> Problem {
    let space = ConfigurationSpace {
        half_size: [10.0, 10.0],
        rho: 0.1,
        free_distance: 1.0,
    };
    let energy = DipolePotential::new(&[], &[]);
    Problem::without_contact(space, Box::new(energy))
}

#[test]
fn letters_go_by_depth_and_twins_share_one() {
    let state = |id: usize, class: usize, kind: StateKind, energy: f64| State {
        id,
        class,
        ..state(kind, energy)
    };
    let [bond, trap] = [StateKind::Bond, StateKind::Trap];
    let states = vec![
        state(0, 0, bond, -2.0),
        state(1, 0, bond, -2.0),
        // Deeper than the bond, as with a wrong partner.
        state(2, 2, trap, -3.0),
        state(3, 3, trap, -1.0),
        state(4, 3, trap, -1.0),
        state(5, 5, trap, -1.0 + 1e-9),
        state(6, 6, trap, -0.5),
    ];
    let mut catalogue = Catalogue {
        states,
        ..Catalogue::default()
    };
    let names = ["A", "A.2", "B", "C", "C.2", "C'", "D"];
    assert_eq!(catalogue.names(), names);
    assert_eq!(catalogue.name_of(Place::State(5)), "trap C'");
    assert_eq!(catalogue.name_of(Place::Free), "free");
    // Without a bond no state is called A; after Z comes AA.
    let traps = (0..27).map(|id| state(id, id, trap, id as f64 - 40.0));
    catalogue.states = traps.collect();
    assert_eq!(catalogue.names()[0], "B");
    assert_eq!(catalogue.names()[25..], ["AA", "AB"]);
    // Energies are as different as their ratio, whatever their size.
    let traps = (0..3).map(|id| state(id, id, trap, 1e-9 * (id as f64 * 1e-3 - 1.0)));
    catalogue.states = traps.collect();
    assert_eq!(catalogue.names(), ["B", "C", "D"]);
}

#[test]
fn an_escape_is_the_lowest_known_way_down() {
    let problem = empty();
    let to_lower = barrier(Some((1, -2.0)), 3.0);
    let to_higher = barrier(Some((2, -0.5)), 1.0);
    let mut catalogue = Catalogue {
        states: vec![state(StateKind::Bond, -1.0)],
        barriers: vec![barrier(None, 5.0), to_lower.clone(), to_higher],
        ..Catalogue::default()
    };
    assert_eq!(catalogue.escape(&problem, 0), Some(to_lower));
    // The only barrier shows that this is a cage.
    catalogue.barriers = vec![barrier(None, f64::INFINITY)];
    catalogue.barriers[0].bounds.caged = true;
    assert!(catalogue.escape(&problem, 0).unwrap().bounds.caged);
}

#[test]
fn what_one_start_only_ended_in_tells_how_much_is_unseen() {
    let caught = |id: usize, class: usize, count: usize| State {
        id,
        class,
        capture: Some(Proportion::new(count, 200)),
        ..state(StateKind::Trap, -1.0)
    };
    let unseen = |states: Vec<State>| {
        let catalogue = Catalogue {
            states,
            ..Catalogue::default()
        };
        catalogue.unseen()
    };
    // Copies count together: two starts in two copies of one kind are not single ones.
    let few = unseen(vec![
        caught(0, 0, 1),
        caught(1, 0, 1),
        caught(2, 2, 1),
        caught(3, 3, 0),
    ]);
    assert_eq!((few.count, few.of), (1, 200));
    let none = unseen(vec![caught(0, 0, 150), caught(1, 1, 50)]);
    assert_eq!((none.count, none.of), (0, 200));
    assert!(none.high > 0.0 && none.high < 0.05);
}

#[test]
fn another_run_widens_the_spread_of_the_barriers_between_the_same_places() {
    let problem = empty();
    let at = |id: usize, x: f64| State {
        id,
        class: id,
        configuration: Configuration::new(x, 0.0, 0.0),
        ..state(StateKind::Trap, -1.0)
    };
    let run = |places: [f64; 2], saddles: [f64; 2]| Catalogue {
        states: vec![at(0, places[0]), at(1, places[1])],
        barriers: vec![
            barrier(None, saddles[0]),
            barrier(Some((1, -1.0)), saddles[1]),
        ],
        ..Catalogue::default()
    };
    let mut catalogue = run([0.0, 0.5], [0.1, 0.2]);
    assert!(catalogue.barriers.iter().all(|one| one.spread.is_none()));
    catalogue.widen_spread(&problem, &run([0.0, 0.5], [0.15, 0.18]));
    let spread = |catalogue: &Catalogue, k: usize| catalogue.barriers[k].spread;
    assert_eq!(spread(&catalogue, 0), Some((0.1, 0.15)));
    assert_eq!(spread(&catalogue, 1), Some((0.18, 0.2)));
    // The second state lies elsewhere: that is another barrier.
    catalogue.widen_spread(&problem, &run([0.0, 0.9], [0.05, 0.9]));
    assert_eq!(spread(&catalogue, 0), Some((0.05, 0.15)));
    assert_eq!(spread(&catalogue, 1), Some((0.18, 0.2)));
}
