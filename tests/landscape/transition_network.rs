//! Networks: links whose cost is computed on demand, and copies that share all results.

use std::collections::HashSet;

use petgraph::algo::dijkstra;
use petgraph::graphmap::DiGraphMap;
use rayon::prelude::*;
use tilebind::Configuration;
use tilebind::landscape::exploration::ExplorationSettings;
use tilebind::landscape::transition_network::{Cost, Network};
use tilebind::pipeline::Request;
use tilebind::problem::Problem;
use tilebind::roadmap::{Roadmap, RoadmapSettings};

use crate::designs;
use crate::surveys;

fn paper_tile(milestones: usize) -> (Problem, RoadmapSettings) {
    let problem = designs::load("shapes/paper-tile.toml").problem();
    let request = Request::default().surveyed(milestones, 0);
    let roadmap = request.roadmap(&problem);
    (problem, roadmap)
}

/// The same roadmap, whose motions are weighed on demand.
fn untried(built: &Roadmap) -> Roadmap {
    let ends = built.edges.iter().map(|edge| (edge.from, edge.to));
    Roadmap {
        milestones: built.milestones.clone(),
        edges: Vec::new(),
        untried: ends.collect(),
    }
}

/// The cost of the cheapest route in a network all of whose links are weighed, by Dijkstra's
/// algorithm, which does not use the goal.
fn cheapest_blindly(network: &Network, from: usize, to: usize, cost: Cost) -> f64 {
    let mut ways = DiGraphMap::<usize, f64>::new();
    for (number, link) in network.links.iter().enumerate() {
        let ends = [link.from, link.to].map(|node| node as usize);
        let costs = network.costs(number);
        for (way, [here, there]) in [ends, [ends[1], ends[0]]].into_iter().enumerate() {
            let least = match cost {
                Cost::Work => costs.work[way],
                Cost::Probability => costs.minus_ln_probability[way],
                Cost::Below { highest, .. } if costs.peak > highest => continue,
                Cost::Below { per_metre, .. } => costs.work[way] + per_metre * costs.length,
            };
            ways.add_edge(here, there, least);
        }
    }
    dijkstra(&ways, from, Some(to), |(_, _, least)| *least)[&to]
}

/// Two networks: one with the weighed free motions of a roadmap, the other with the motions of all
/// neighbours, including blocked ones.
#[test]
fn what_is_tried_when_asked_for_gives_the_same_routes() {
    const MILESTONES: usize = 600;
    let (problem, settings) = paper_tile(MILESTONES);
    let start = problem.evaluations();
    let built = surveys::weighed(&problem, &settings);
    let all = problem.evaluations() - start;
    let left = Roadmap::untried(&problem, &settings, &mut |_| {});
    assert!(left.untried.len() > built.edges.len());
    let start = problem.evaluations();
    let networks = [built, left].map(|roadmap| Network::new(&problem, roadmap, &settings.edges));
    // Minimax paths need few.
    let spanned = problem.evaluations() - start;
    assert!(2 * spanned < all, "{spanned} of {all}");
    let [weighed, asked] = &networks;
    assert_eq!(weighed.motions(), asked.motions());
    assert_eq!(weighed.links.len(), asked.motions());
    assert_eq!(weighed.local_minima(), asked.local_minima());
    assert_eq!(weighed.joined_to(3), asked.joined_to(3));
    let labelled: Vec<(usize, f64)> = (0..MILESTONES)
        .step_by(7)
        .map(|node| (node, weighed.nodes[node].unwrap().1))
        .collect();
    let merges = |network: &Network| -> Vec<_> {
        let merges = network.merges(&labelled).into_iter();
        let link = |number: usize| (network.links[number].from, network.links[number].to);
        let told = merges.map(|merge| (link(merge.link), merge.lower, merge.upper));
        told.collect()
    };
    assert_eq!(merges(weighed), merges(asked));
    let depth = problem.depth();
    let mut compared = 0;
    for (from, to) in (0..MILESTONES)
        .step_by(97)
        .zip([11, 222, 333, 444, 555, 599, 5])
    {
        let goals = HashSet::from([to]);
        let highest = weighed.minimax(from, &goals);
        assert_eq!(highest, asked.minimax(from, &goals));
        let Some(highest) = highest else { continue };
        let below = Cost::Below {
            highest: highest + 1e-3 * depth,
            per_metre: 1e-3 * depth,
        };
        for cost in [Cost::Work, Cost::Probability, below] {
            let found = |network: &Network| network.cheapest(from, &goals, cost).unwrap();
            let [of_weighed, of_asked] = networks.each_ref().map(found);
            assert_eq!(of_weighed.0, to);
            let blind = cheapest_blindly(weighed, from, to, cost);
            assert!((of_weighed.1 - blind).abs() <= 1e-9 * blind, "{cost:?}");
            assert!((of_weighed.1 - of_asked.1).abs() <= 1e-9 * of_weighed.1);
            // The same, searched from the other end.
            let (total, route) = asked.cheapest_into(from, to, cost).unwrap();
            assert!(
                (total - of_asked.1).abs() <= 1e-9 * total,
                "{cost:?}: {total}"
            );
            let ends = |&(link, forwards): &(usize, bool)| {
                let link = &asked.links[link];
                let [a, b] = [link.from, link.to].map(|node| node as usize);
                if forwards { [a, b] } else { [b, a] }
            };
            let ends: Vec<[usize; 2]> = route.iter().map(ends).collect();
            assert_eq!((ends[0][0], ends[ends.len() - 1][1]), (from, to));
            assert!(ends.windows(2).all(|pair| pair[0][1] == pair[1][0]));
            compared += 1;
        }
    }
    assert!(compared >= 9, "{compared}");
}

/// Far configurations are joined to `free`, but no route leads from one to another via it: a motion
/// between them counts although they are already joined.
#[test]
fn motions_beside_free_are_weighed_when_a_route_needs_them() {
    let (problem, settings) = paper_tile(50);
    let roadmap = untried(&surveys::weighed(&problem, &settings));
    let mut network = Network::new(&problem, roadmap, &settings.edges);
    let free = network.add_node(None);
    let far = [0.0, 0.1].map(|y| Configuration::new(0.9, y, 0.3));
    let [from, to] = far.map(|q| {
        let energy = problem.energy(&q);
        let node = network.add_node(Some((q, energy)));
        network.add_same(node, free, energy);
        node
    });
    network.add_untried(from, to);
    network.span();
    let highest = network.minimax(from, &HashSet::from([to]));
    let ends = far.map(|q| problem.energy(&q));
    assert!(highest.is_some_and(|highest| highest >= ends[0].max(ends[1])));
}

/// Routes requested in parallel, while links are being weighed, are the same as those requested one
/// by one.
#[test]
fn routes_asked_for_at_once_are_those_asked_for_one_by_one() {
    const MILESTONES: usize = 500;
    let (problem, settings) = paper_tile(MILESTONES);
    let built = surveys::weighed(&problem, &settings);
    let left = untried(&built);
    let networks = [built, left].map(|roadmap| Network::new(&problem, roadmap, &settings.edges));
    let costs = |network: &Network, from: usize| {
        let goals = HashSet::from([(from * 7 + 3) % MILESTONES]);
        let found = network.cheapest(from, &goals, Cost::Probability);
        found.map(|(_, cost, route)| (cost, route))
    };
    let threads = rayon::ThreadPoolBuilder::new()
        .num_threads(8)
        .build()
        .unwrap();
    let all = || {
        (0..MILESTONES)
            .into_par_iter()
            .map(|from| costs(&networks[1], from))
            .collect()
    };
    let at_once: Vec<_> = threads.install(all);
    for (from, found) in at_once.into_iter().enumerate() {
        assert_eq!(found, costs(&networks[0], from), "{from}");
    }
}

/// States and transition states come with all their images, an image joins the images of the states
/// that its original joins, and the exits of all copies of a state are equally low.
#[test]
fn what_is_found_once_is_known_of_all_copies() {
    let (problem, roadmap) = paper_tile(400);
    let settings = ExplorationSettings {
        edge: roadmap.edges,
        settled: 0.005,
        most_kinds: None,
        added_milestones: 100,
        most_rounds: 8,
        seed: 1,
    };
    let built = surveys::weighed(&problem, &roadmap);
    let survey = surveys::survey(&problem, built, &settings);
    assert_eq!(problem.symmetries.len(), 16);
    assert_eq!(survey.states.len() % 16, 0);
    let class = |node: u32| {
        let state = survey
            .states
            .iter()
            .find(|state| state.node == node as usize);
        state.map(|state| state.class)
    };
    for state in &survey.states {
        for symmetry in &problem.symmetries {
            let image = symmetry.apply(&state.minimum.point.q);
            let copy = &survey.states[survey.state_at(&image, 1e-9).unwrap()];
            assert_eq!(copy.class, state.class);
            let energies = [copy, state].map(|state| state.minimum.point.energy);
            assert!((energies[0] - energies[1]).abs() <= 1e-12 * energies[0].abs());
        }
    }
    let free = HashSet::from([survey.free]);
    let out = |state: usize| {
        survey
            .network
            .minimax(survey.states[state].node, &free)
            .unwrap()
    };
    for (number, state) in survey.states.iter().enumerate() {
        let [own, first] = [number, state.class].map(out);
        assert!(
            (own - first).abs() <= 1e-8 * state.minimum.point.energy.abs(),
            "{own} {first}"
        );
    }
    assert!(!survey.transition_states.is_empty());
    for (saddle, link) in &survey.transition_states {
        let joined = |link: usize| {
            let link = &survey.network.links[link];
            let mut classes = [link.from, link.to].map(class);
            classes.sort_unstable();
            classes
        };
        for symmetry in &problem.symmetries {
            let image = symmetry.apply(&saddle.point.q);
            let is_there = |q| problem.space.distance(q, &image) < 1e-9;
            let mut copies = survey.transition_states.iter();
            let copy = copies.find(|(copy, _)| is_there(&copy.point.q));
            assert_eq!(joined(copy.expect("an image").1), joined(*link));
        }
    }
}
