//! An independent brute-force answer: a dense grid over the configuration space. Each of its steps
//! and cells has a rigorous bound computed only from clearances, gradients and the potential's
//! bound of its curvature.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use ordered_float::OrderedFloat;
use rayon::prelude::*;
use tilebind::configuration::Configuration;

use super::scene::Scene;

pub struct Grid<'a> {
    scene: &'a Scene,
    counts: [usize; 3],
    half: [f64; 3],
    nodes: Vec<Node>,
}

struct Node {
    configuration: Configuration,
    free: bool,
    energy: f64,
    /// No free configuration of the node's cell has a lower energy; infinite if there is none.
    lower: f64,
}

impl<'a> Grid<'a> {
    pub fn new(scene: &'a Scene, counts: [usize; 3]) -> Self {
        let [x, y] = scene.space.half_size;
        let extent = [x, y, std::f64::consts::PI];
        let half: [f64; 3] = std::array::from_fn(|i| extent[i] / counts[i] as f64);
        let nodes = (0..counts.iter().product())
            .into_par_iter()
            .map(|k| {
                let index = [
                    k % counts[0],
                    k / counts[0] % counts[1],
                    k / counts[0] / counts[1],
                ];
                let at = |i: usize| -extent[i] + half[i] * (2 * index[i] + 1) as f64;
                Node::new(scene, Configuration::new(at(0), at(1), at(2)), &half)
            })
            .collect();
        Self {
            scene,
            counts,
            half,
            nodes,
        }
    }

    /// Lower and upper bound of the minimax energy between two free configurations; the upper one
    /// is infinite where the grid finds no way.
    pub fn bracket(&self, from: &Configuration, to: &Configuration) -> (f64, f64) {
        let holds = |q: &Configuration, k: usize| {
            let step = self.nodes[k].configuration.step_to(q);
            (0..3).all(|i| step[i].abs() <= self.half[i] * (1.0 + 1e-9))
        };
        let holding = |q: &Configuration| -> Vec<usize> {
            (0..self.nodes.len()).filter(|&k| holds(q, k)).collect()
        };
        let lower = self.minimax(
            &holding(from),
            &holding(to),
            &|k| self.nodes[k].lower,
            &|_, _| f64::NEG_INFINITY,
        );
        let reach = |q: &Configuration| -> Vec<(usize, f64)> {
            let around = |k: &usize| self.scene.space.distance(&self.nodes[*k].configuration, q);
            let mut near: Vec<usize> = (0..self.nodes.len())
                .filter(|&k| self.nodes[k].free)
                .collect();
            near.sort_by_key(|k| OrderedFloat(around(k)));
            near.truncate(30);
            near.into_iter()
                .map(|k| (k, self.step(q, &self.nodes[k].configuration)))
                .filter(|(_, highest)| highest.is_finite())
                .collect()
        };
        let (starts, ends) = (reach(from), reach(to));
        let mut upper = f64::INFINITY;
        // The best of the few ways between grid and ends: those over the lowest steps.
        let least =
            |steps: &[(usize, f64)]| steps.iter().map(|s| s.1).fold(f64::INFINITY, f64::min);
        let lowest = |steps: &[(usize, f64)]| -> Vec<usize> {
            let bound = least(steps);
            steps
                .iter()
                .filter(|s| s.1 <= bound + 1e-12)
                .map(|s| s.0)
                .collect()
        };
        if !starts.is_empty() && !ends.is_empty() {
            let between = self.minimax(
                &lowest(&starts),
                &lowest(&ends),
                &|k| {
                    if self.nodes[k].free {
                        self.nodes[k].energy
                    } else {
                        f64::INFINITY
                    }
                },
                &|a, b| self.step(&self.nodes[a].configuration, &self.nodes[b].configuration),
            );
            upper = between.max(least(&starts)).max(least(&ends));
        }
        (lower, upper)
    }

    /// A bound of the highest energy on the straight way; infinite where it is not free.
    fn step(&self, a: &Configuration, b: &Configuration) -> f64 {
        if !self.scene.contact.motion_is_free(a, b) {
            return f64::INFINITY;
        }
        let potential = &self.scene.potential;
        let length = potential.displacement(a.step_to(b));
        let steepest = potential.curvature_bound(&a.interpolate(b, 0.5), length / 2.0);
        potential.energy(a).max(potential.energy(b)) + steepest * length * length / 8.0
    }

    fn minimax(
        &self,
        from: &[usize],
        to: &[usize],
        at: &dyn Fn(usize) -> f64,
        between: &dyn Fn(usize, usize) -> f64,
    ) -> f64 {
        let mut best = vec![f64::INFINITY; self.nodes.len()];
        let mut queue = BinaryHeap::new();
        let key = |x: f64| {
            let bits = x.to_bits();
            if bits >> 63 == 1 {
                !bits
            } else {
                bits | 1 << 63
            }
        };
        for &k in from {
            best[k] = at(k);
            queue.push(Reverse((key(best[k]), k)));
        }
        while let Some(Reverse((level, k))) = queue.pop() {
            if level > key(best[k]) || best[k] == f64::INFINITY {
                continue;
            }
            if to.contains(&k) {
                return best[k];
            }
            for n in self.around(k) {
                if at(n).max(best[k]) >= best[n] {
                    continue;
                }
                let level = best[k].max(at(n)).max(between(k, n));
                if level < best[n] {
                    best[n] = level;
                    queue.push(Reverse((key(level), n)));
                }
            }
        }
        f64::INFINITY
    }

    fn around(&self, k: usize) -> Vec<usize> {
        let [nx, ny, nt] = self.counts.map(|n| n as isize);
        let (x, y, t) = (k as isize % nx, k as isize / nx % ny, k as isize / nx / ny);
        let mut found = Vec::new();
        for step in 0..27 {
            let (dx, dy, dt) = (step % 3 - 1, step / 3 % 3 - 1, step / 9 - 1);
            let (x, y, t) = (x + dx, y + dy, (t + dt).rem_euclid(nt));
            if step != 13 && (0..nx).contains(&x) && (0..ny).contains(&y) {
                found.push((x + nx * (y + ny * t)) as usize);
            }
        }
        found
    }
}

impl Node {
    fn new(scene: &Scene, q: Configuration, half: &[f64; 3]) -> Self {
        let turn = scene.tiles[1].outline.circumradius() * half[2];
        let travel = half[0].hypot(half[1]) + turn;
        let clearance = scene.contact.clearance(&q);
        let (energy, gradient) = scene.potential.energy_and_gradient(&q);
        let lower = if clearance < -travel - 1e-8 {
            f64::INFINITY
        } else {
            let reach = scene.potential.displacement((*half).into());
            let slope: f64 = (0..3).map(|i| gradient[i].abs() * half[i]).sum();
            let bend = scene.potential.curvature_bound(&q, reach) * reach * reach / 2.0;
            energy - slope - bend
        };
        Self {
            configuration: q,
            free: clearance >= 0.0,
            energy,
            lower,
        }
    }
}
