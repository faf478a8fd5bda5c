//! A step of the table, island by island: tiles that may touch move together, all others glide.

use nalgebra::{Vector2, Vector3};
use petgraph::unionfind::UnionFind;

use super::crowd::Crowd;
use super::pairs::SHARE_OF_NEAR;
use super::scratch::Scratch;
use super::stepper::{StepError, Stepper};
use crate::rigid::{Account, Island, Mover, SHORTEST_TRIED, Two, Winds, rim_room};
use tiles::parallel;

/// Islands per task of a thread.
const BATCH: usize = 8;
/// Islands are shared among threads if they and their pairs are this many: with fewer, threads wait longer than
/// they work.
const WORTH_SHARING: usize = 512;

impl Stepper<'_> {
    /// Advances every island independently.
    pub(super) fn move_all(&mut self, scratch: &Scratch) -> Result<(), StepError> {
        let Scratch {
            poses,
            steady,
            halfway,
            ..
        } = scratch;
        let n = self.riders.len();
        let margins = self.margins;
        let mut tied = UnionFind::<usize>::new(n);
        let mut is_tied = vec![false; n];
        for near in self.near.iter().filter(|near| near.is_tied) {
            tied.union(near.two.first, near.two.second);
            is_tied[near.two.first] = true;
            is_tied[near.two.second] = true;
        }
        let mut number = vec![usize::MAX; n];
        let mut islands: Vec<Island<Crowd>> = Vec::new();
        let laws = self.laws();
        let mut members: Vec<Vec<usize>> = Vec::new();
        let mut local = vec![0; n];
        for k in 0..n {
            if !is_tied[k] && self.is_alone(k, &halfway[k].0, &steady[k]) {
                self.glide(k, &halfway[k].0, &steady[k]);
                continue;
            }
            let top = tied.find_mut(k);
            if number[top] == usize::MAX {
                number[top] = islands.len();
                members.push(Vec::new());
                islands.push(Island {
                    world: self.crowd,
                    laws,
                    time: self.time,
                    margins: &margins,
                    riders: Vec::new(),
                    still: Vec::new(),
                    poses: Vec::new(),
                    steady: Vec::new(),
                    pairs: Vec::new(),
                    account: Account::default(),
                    steps: 0,
                    is_solved: true,
                    solver: self.solvers.pop().unwrap_or_default(),
                });
            }
            let island = number[top];
            local[k] = members[island].len();
            members[island].push(k);
            islands[island].riders.push(self.riders[k]);
            islands[island].poses.push(poses[k]);
            islands[island].steady.push(steady[k]);
        }
        for near in self.near.iter_mut().filter(|near| near.is_tied) {
            let top = tied.find_mut(near.two.first);
            let two = Two {
                first: local[near.two.first],
                second: local[near.two.second],
            };
            islands[number[top]].pairs.push((two, near));
        }
        let work: usize = islands.iter().map(|it| 1 + it.pairs.len()).sum();
        if work < WORTH_SHARING {
            islands.iter_mut().for_each(Island::advance);
        } else {
            let mut parts: Vec<&mut [Island<Crowd>]> = islands.chunks_mut(BATCH).collect();
            parallel::for_each(&mut parts, |part| part.iter_mut().for_each(Island::advance));
        }
        for (island, members) in islands.into_iter().zip(members) {
            self.account.add(&island.account);
            self.steps += island.steps;
            if !island.is_solved {
                return Err(StepError::Unsolved {
                    time: self.time,
                    tile: members[0],
                    tiles: members.len(),
                    step: self.settings.step * SHORTEST_TRIED,
                });
            }
            self.solvers.push(island.solver);
            for (rider, k) in island.riders.into_iter().zip(members) {
                self.riders[k] = rider;
            }
        }
        Ok(())
    }

    /// Whether a tile meets nothing in a step: neither the rim nor a fan that needs shorter steps, nor
    /// friction on the table.
    fn is_alone(&self, tile: usize, halfway: &Mover, steady: &Vector3<f64>) -> bool {
        let speed = halfway.velocity.xy().norm();
        let longest = self
            .winds()
            .longest(self.masses[tile].x, halfway.place.xy(), speed);
        self.settings.table_friction == 0.0
            && longest >= self.settings.step
            && self.is_off_the_rim(tile, steady)
    }

    /// Advances a tile that meets nothing, by the forces in the middle of the step.
    fn glide(&mut self, tile: usize, halfway: &Mover, steady: &Vector3<f64>) {
        let h = self.settings.step;
        let mut a = *steady;
        let mut swing = Vector2::zeros();
        let mover = &mut self.riders[tile].mover;
        if !self.settings.fans.is_empty() {
            let winds = Winds(&self.settings.fans);
            let wind = winds.wind(halfway.place.xy(), self.time + 0.5 * h);
            a += wind.whole().push(0.0) / self.masses[tile].x;
            swing = wind.swing;
        }
        // Half of the drag has been applied, half of it follows: v0 goes as far as (1 - exp(-c h)) v0 / c.
        let half = match self.settings.shaking {
            None => 0.5 * self.settings.drag * h,
            Some(_) => 0.0,
        };
        let stretch = if half > 0.0 {
            libm::sinh(half) / half
        } else {
            1.0
        };
        let way = (mover.velocity * stretch + a * (0.5 * h)) * h;
        mover.place += way;
        self.account.work += swing.dot(&way.xy());
        mover.velocity += a * h;
    }

    /// Whether a tile cannot reach the rim within a step.
    fn is_off_the_rim(&self, tile: usize, steady: &Vector3<f64>) -> bool {
        if !self.settings.walls {
            return true;
        }
        let h = self.settings.step;
        let rider = &self.riders[tile];
        let speed = rider.mover.velocity.xy().norm() + h * steady.xy().norm();
        rim_room(self.crowd, &rider.mover) > 3.0 * speed * h + self.least_near * SHARE_OF_NEAR
    }
}
