//! The links that minimax paths use, and where basins meet.

use std::cmp::Reverse;
use std::collections::binary_heap::PeekMut;
use std::collections::{BinaryHeap, HashSet};

use ordered_float::OrderedFloat;
use petgraph::unionfind::UnionFind;

use super::ahead::Ends;
use super::{Link, Network, Route};
use tiles::parallel;

/// Two basins that meet, in ascending order of the energy at which they do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Merge {
    /// The link that joins them.
    pub link: usize,
    /// The labelled node with the lowest energy in either basin: this one is the lower.
    pub lower: usize,
    /// The labelled node with the lowest energy in the other basin.
    pub upper: usize,
}

/// A link ordered by its peak (J), then by its length (m), which determines the work to weigh it,
/// then by its number.
type ByPeak = (OrderedFloat<f64>, OrderedFloat<f64>, u32);

/// The links that may lead out of a part, the lowest first.
type Queue = BinaryHeap<Reverse<ByPeak>>;

/// Links weighed at the same time, if there are so many that may turn out lowest.
const BATCH: usize = 64;

/// The parts of a forest, with the links that may lead out of each.
struct Parts {
    joined: UnionFind<u32>,
    /// By the node that stands for the part.
    outwards: Vec<Queue>,
    /// By the same, the links looked at since it was last joined to another.
    looked_at: Vec<usize>,
    /// Parts that have such links.
    left: Vec<u32>,
}

impl Parts {
    fn new(network: &Network, tree: &[u32], mut links: Vec<u32>) -> Self {
        let mut joined = UnionFind::<u32>::new(network.nodes.len());
        let ends = |number: u32| {
            let Link { from, to, .. } = network.links[number as usize];
            [from, to]
        };
        for number in tree {
            let [from, to] = ends(*number);
            joined.union(from, to);
        }
        let mut parts_of = |number: &u32| ends(*number).map(|node| joined.find_mut(node) as usize);
        links.retain(|number| {
            let [a, b] = parts_of(number);
            a != b
        });
        let by_peak = parallel::map(&links, |&number| Reverse(network.by_peak(number)));
        // With the room they need and no more: there are millions.
        let mut counts = vec![0; network.nodes.len()];
        for part in links.iter().flat_map(&mut parts_of) {
            counts[part] += 1;
        }
        let mut outwards: Vec<Vec<_>> = counts.into_iter().map(Vec::with_capacity).collect();
        for (number, by_peak) in links.iter().zip(by_peak) {
            for part in parts_of(number) {
                outwards[part].push(by_peak);
            }
        }
        let outwards: Vec<_> = outwards.into_iter().map(BinaryHeap::from).collect();
        let mut left: Vec<u32> = (0..network.nodes.len() as u32).collect();
        left.retain(|part| !outwards[*part as usize].is_empty());
        Self {
            joined,
            looked_at: vec![0; outwards.len()],
            outwards,
            left,
        }
    }

    /// The lowest links out of the parts, and the links that must be weighed to know the others.
    fn lowest_links(&mut self, network: &Network) -> (Vec<u32>, Vec<usize>) {
        let (mut lowest, mut open) = (Vec::new(), Vec::new());
        let mut left = std::mem::take(&mut self.left);
        left.retain(|part| self.joined.find_mut(*part) == *part);
        // From a single part none leads out; its queue, which has most links, need not be emptied.
        if left.len() < 2 {
            return (lowest, open);
        }
        // As many at once as were weighed before: hardly more than twice as many as needed.
        let most = (BATCH / left.len()).max(1);
        let part = |part: &u32| {
            let part = *part as usize;
            let ahead = self.looked_at[part].clamp(1, most);
            (std::mem::take(&mut self.outwards[part]), ahead, Vec::new())
        };
        let mut parts: Vec<(Queue, usize, Vec<u32>)> = left.iter().map(part).collect();
        let joined = &self.joined;
        parallel::for_each(&mut parts, |(queue, ahead, found)| {
            *found = leading_out(network, joined, queue, *ahead);
        });
        for (part, (queue, _, found)) in left.into_iter().zip(parts) {
            self.outwards[part as usize] = queue;
            match found[..] {
                [] => continue,
                [number] if network.is_weighed(number as usize) => lowest.push(number),
                _ => open.extend(found.iter().map(|number| *number as usize)),
            }
            self.looked_at[part as usize] += found.len();
            self.left.push(part);
        }
        open.sort_unstable();
        open.dedup();
        (lowest, open)
    }

    /// Joins the parts of two nodes; returns whether they were two.
    fn join(&mut self, network: &Network, from: u32, to: u32) -> bool {
        let [a, b] = [from, to].map(|node| self.joined.find_mut(node));
        if !self.joined.union(a, b) {
            return false;
        }
        let mut queues = [a, b].map(|part| std::mem::take(&mut self.outwards[part as usize]));
        queues.sort_by_key(BinaryHeap::len);
        let [few, mut many] = queues;
        let joined = self.joined.find_mut(a) as usize;
        let leads_out = |link: &Reverse<ByPeak>| {
            let Link { from, to, .. } = network.links[link.0.2 as usize];
            [from, to].map(|node| self.joined.find_mut(node) as usize) != [joined; 2]
        };
        many.extend(few.into_iter().filter(leads_out));
        self.outwards[joined] = many;
        self.looked_at[joined] = 0;
        true
    }
}

/// The lowest link that leads out of a part, if it is weighed; otherwise this one and others that
/// may turn out lower, up to `most` in all.
fn leading_out(
    network: &Network,
    joined: &UnionFind<u32>,
    queue: &mut Queue,
    most: usize,
) -> Vec<u32> {
    let (mut found, mut open) = (Vec::new(), Vec::new());
    while found.len() < most
        && let Some(number) = head(network, joined, queue)
    {
        let is_weighed = network.is_weighed(number as usize);
        if found.is_empty() || !is_weighed {
            found.push(number);
        }
        if is_weighed {
            break;
        }
        open.extend(queue.pop());
    }
    queue.extend(open);
    found
}

/// The link at the head of a part's queue that leads out of it.
fn head(network: &Network, joined: &UnionFind<u32>, queue: &mut Queue) -> Option<u32> {
    while let Some(mut head) = queue.peek_mut() {
        let Reverse(known) = *head;
        let Link { from, to, .. } = network.links[known.2 as usize];
        let leads_out = joined.find(from) != joined.find(to);
        if !leads_out || network.is_blocked(known.2 as usize) {
            PeekMut::pop(head);
            continue;
        }
        let now = network.by_peak(known.2);
        if now == known {
            return Some(known.2);
        }
        *head = Reverse(now);
    }
    None
}

impl Network<'_> {
    /// Determines the motions that minimax paths use, so that merges need only examine later links:
    /// the minimum spanning forest by peak. Links without motion are left out, because no route
    /// leads through `free`. Between any two nodes, the path in the forest has the lowest possible
    /// highest peak. Links of equal peak are ordered by their lengths and numbers, so the forest is
    /// unique, and links that were not in it before are not in it later.
    pub fn span(&mut self) {
        let links = self.hung();
        self.span_by(Vec::new(), links);
    }

    /// The same for a network that was never spanned.
    pub(super) fn span_first(&mut self) {
        let tree = self.descents();
        self.span_by(tree, (0..self.links.len() as u32).collect());
    }

    /// Extends a part of the forest, `tree`, by some links.
    ///
    /// Borůvka's algorithm: each part of the forest is joined to another by the lowest link that leads
    /// out of it. Links are queued by their peaks, unweighed ones by lower bounds of these, so only
    /// those are weighed that are at the head of a part's queue; those of all parts together. Blocked
    /// links join nothing.
    fn span_by(&mut self, mut tree: Vec<u32>, links: Vec<u32>) {
        let is_same = |number: &u32| self.is_same(*number as usize);
        let (same, left): (Vec<u32>, Vec<u32>) = links.into_iter().partition(is_same);
        let mut parts = Parts::new(self, &tree, left);
        loop {
            let (lowest, open) = parts.lowest_links(self);
            if lowest.is_empty() && open.is_empty() {
                break;
            }
            self.weigh(&open);
            for number in lowest {
                let Link { from, to, .. } = self.links[number as usize];
                // Both parts may have chosen the same link.
                if parts.join(self, from, to) {
                    tree.push(number);
                }
            }
        }
        self.around.iter_mut().for_each(Vec::clear);
        for number in tree.into_iter().chain(same) {
            self.hang(number as usize);
        }
    }

    /// The links around the nodes: the spanning forest, links without motion, and those that were added
    /// since.
    fn hung(&self) -> Vec<u32> {
        let mut links = self.around.concat();
        links.sort_unstable();
        links.dedup();
        links
    }

    /// For each node the shortest link that leads down all the way, where there is one. Its peak is
    /// at the node, which no link there undercuts, and it is the first of these: it is in the
    /// spanning forest.
    fn descents(&mut self) -> Vec<u32> {
        let energy = |node: u32| self.nodes[node as usize].map(|known| known.1);
        let mut below: Vec<Vec<(OrderedFloat<f64>, u32)>> = vec![Vec::new(); self.nodes.len()];
        for (number, Link { from, to, .. }) in self.links.iter().enumerate() {
            if let (Some(a), Some(b)) = (energy(*from), energy(*to)) {
                let upper = if a > b { from } else { to };
                below[*upper as usize].push((self.length(number), number as u32));
            }
        }
        parallel::for_each(&mut below, |links| links.sort_unstable());
        let mut found = Vec::with_capacity(self.nodes.len());
        let mut open: Vec<usize> = (0..self.nodes.len()).collect();
        // The next link of each node, all in parallel.
        for turn in 0.. {
            open.retain(|node| turn < below[*node].len());
            if open.is_empty() {
                break;
            }
            let next = |node: &usize| below[*node][turn].1 as usize;
            let links: Vec<usize> = open.iter().map(next).collect();
            self.weigh(&links);
            open.retain(|node| {
                let leads_down =
                    self.nodes[*node].is_some_and(|known| self.peak(next(node)) <= known.1);
                if leads_down {
                    found.push(next(node) as u32);
                }
                !leads_down
            });
        }
        found
    }

    fn by_peak(&self, number: u32) -> ByPeak {
        let link = number as usize;
        (OrderedFloat(self.peak(link)), self.length(link), number)
    }

    fn length(&self, link: usize) -> OrderedFloat<f64> {
        OrderedFloat(self.costs(link).length)
    }

    /// The links around the nodes that span the network including `free`, ascending.
    fn spanning_links(&self) -> Vec<u32> {
        let mut ascending = self.hung();
        ascending.sort_by_cached_key(|&number| self.by_peak(number));
        let mut joined = UnionFind::<u32>::new(self.nodes.len());
        ascending.retain(|number| {
            let link = &self.links[*number as usize];
            joined.union(link.from, link.to)
        });
        ascending
    }

    /// For each node whether free motions lead there from `node`, over whatever others.
    pub fn joined_to(&self, node: usize) -> Vec<bool> {
        let mut joined = vec![false; self.nodes.len()];
        joined[node] = true;
        let mut open = vec![node];
        while let Some(here) = open.pop() {
            for &number in &self.around[here] {
                let next = self.links[number as usize].other_end(here as u32) as usize;
                if !std::mem::replace(&mut joined[next], true) {
                    open.push(next);
                }
            }
        }
        joined
    }

    /// The lowest possible highest energy (J) on a route from a node to any of the `goals`, and such a
    /// route. Links that were added since the network was spanned count.
    pub fn lowest(&self, from: usize, goals: &HashSet<usize>) -> Option<(f64, Route)> {
        let ends = Ends { from, goals };
        // The highest energy on the path to a node, and its last link.
        let mut reached: Vec<Option<(f64, Option<u32>)>> = vec![None; self.nodes.len()];
        let mut waiting =
            BinaryHeap::from([Reverse((OrderedFloat(f64::NEG_INFINITY), None, from))]);
        while let Some(Reverse((OrderedFloat(highest), last, here))) = waiting.pop() {
            if reached[here].is_some() {
                continue;
            }
            reached[here] = Some((highest, last));
            if goals.contains(&here) {
                return Some((highest, self.route(here, |node| reached[node]?.1)));
            }
            for &number in &self.around[here] {
                let next = self.links[number as usize].other_end(here as u32) as usize;
                if reached[next].is_none() && self.is_motion(number as usize, ends) {
                    let highest = highest.max(self.peak(number as usize));
                    waiting.push(Reverse((OrderedFloat(highest), Some(number), next)));
                }
            }
        }
        None
    }

    /// The same energy (J) alone.
    pub fn minimax(&self, from: usize, goals: &HashSet<usize>) -> Option<f64> {
        self.lowest(from, goals).map(|(highest, _)| highest)
    }

    /// The merges of the basins of `labelled` nodes (with their energies, J), ascending: the merge
    /// tree. Links join basins in the order of their peaks; each basin is known by its lowest
    /// labelled node.
    pub fn merges(&self, labelled: &[(usize, f64)]) -> Vec<Merge> {
        let mut basins = UnionFind::<usize>::new(self.nodes.len());
        let mut lowest: Vec<Option<(f64, usize)>> = vec![None; self.nodes.len()];
        for &(node, energy) in labelled {
            lowest[node] = Some((energy, node));
        }
        let mut merges = Vec::new();
        for number in self.spanning_links() {
            let link = &self.links[number as usize];
            let [a, b] = [link.from, link.to].map(|node| basins.find(node as usize));
            let (first, second) = (lowest[a], lowest[b]);
            basins.union(a, b);
            let joined = basins.find(a);
            lowest[joined] = match (first, second) {
                (Some(x), Some(y)) => {
                    let (low, high) = if x <= y { (x, y) } else { (y, x) };
                    merges.push(Merge {
                        link: number as usize,
                        lower: low.1,
                        upper: high.1,
                    });
                    Some(low)
                }
                (x, y) => x.or(y),
            };
        }
        merges
    }
}
