//! Advances all tiles step by step, and keeps the energy balance.

use std::iter::Peekable;

use nalgebra::{Vector2, Vector3};
use petgraph::unionfind::UnionFind;
use rand_chacha::ChaCha8Rng;

use super::crowd::Crowd;
use super::drive::Drive;
use super::neighbours::Neighbours;
use super::settings::TableSettings;
use crate::rigid::{
    Account, Island, Laws, Margins, Mover, NearPair, Pose, Rider, SHORTEST_TRIED, Solver, Two,
    Winds, Within, World, fastest, longest_step, on_the_table, relative, rim_room,
};
use tiles::configuration::Configuration;
use tiles::parallel;

/// Islands per task of a thread.
const BATCH: usize = 8;
/// Islands are shared among threads if they and their pairs are this many: with fewer, threads wait longer than
/// they work.
const WORTH_SHARING: usize = 512;
/// Pairs apart per task of a thread.
const APART_TOGETHER: usize = 512;
/// Usual travel of a tile in a step, as a share of the distance that counts as near; faster tiles are
/// near each other from farther on.
const SHARE_OF_NEAR: f64 = 0.25;
/// Largest travel, as a share of the same distance.
const MOST_OF_NEAR: f64 = 2.0;
/// Pairs are tied if their tiles may come this near in a step, as a share of the same distance.
const SHARE_TIED: f64 = 0.1;
/// The pull of two tiles that do not touch is computed anew after this many steps ...
const MOST_STEPS: f64 = 16.0;
/// ... or once they have moved by this share of the distance, of their circles or if they are near of their
/// outlines, over which it changes ...
const SHARE_OF_ROOM: f64 = 0.02;
/// ... and which counts as this share of the circles' radii at least, or as half a magnet's side.
const LEAST_ROOM: f64 = 0.1;
/// The share is larger for pulls weaker than this many times what the cut-off leaves out, in inverse proportion ...
const WEAK: f64 = 100.0;
/// ... up to this factor: no such pull errs by more than a few times what is left out anyway.
const MOST_WEAK: f64 = 10.0;

/// Why a run cannot go on.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum StepError {
    /// A tile became too fast.
    #[error(transparent)]
    BlowUp(#[from] BlowUp),
    /// Impulses of contact were not found.
    #[error(
        "at {time:.6} s the impulses of {tiles} touching tiles (among them tile {tile}) are not found even in steps \
         of {step:.1e} s: the run has failed; use less friction or another seed"
    )]
    Unsolved {
        /// The time (s).
        time: f64,
        /// The first of the tiles, from 0.
        tile: usize,
        /// Their number.
        tiles: usize,
        /// The shortest step (s) tried.
        step: f64,
    },
}

/// A run in progress.
pub struct Stepper<'a> {
    crowd: &'a Crowd,
    settings: &'a TableSettings,
    drive: Drive<'a>,
    riders: Vec<Rider>,
    /// Mass (kg, kg) and moment of inertia (kg m^2) of each.
    masses: Vec<Vector3<f64>>,
    /// The random numbers of each tile.
    random: Vec<ChaCha8Rng>,
    /// Since the start (s).
    pub time: f64,
    /// The energy balance.
    pub account: Account,
    /// The number of steps that islands have made within those of the table.
    pub steps: u64,
    since_kick: usize,
    neighbours: Neighbours,
    near: Vec<NearPair>,
    margins: Margins,
    least_near: f64,
    scratch: Scratch,
    /// Solvers of earlier islands, kept to save allocating what they hold.
    solvers: Vec<Solver>,
}

/// Vectors that each step fills anew, kept to save allocating them.
#[derive(Default)]
struct Scratch {
    /// The tiles before the step.
    movers: Vec<Mover>,
    poses: Vec<Pose>,
    positions: Vec<Vector2<f64>>,
    /// The tiles in the middle of the step, if nothing acted on them.
    halfway: Vec<(Mover, Pose)>,
    /// Their acceleration by the table's motion.
    carried: Vector2<f64>,
    /// The same, and by pairs apart.
    steady: Vec<Vector3<f64>>,
    apart: Vec<Apart>,
    /// The near pairs of the step before.
    known: Vec<NearPair>,
    /// The pulls of pairs apart, in their order, and those of the step before.
    lasting: Vec<Lasting>,
    lasted: Vec<Lasting>,
}

/// A pair of tiles that do not touch within the step.
struct Apart {
    two: Two,
    /// The pair's index if it is near.
    near: Option<usize>,
    /// By this distance (m) the pull changes little if the tiles move relative to each other.
    room: f64,
}

/// The pull of two tiles apart for some steps, of the middle of their way in this time.
#[derive(Clone, Copy)]
struct Lasting {
    two: Two,
    /// In the frame of the first tile, in which it also turns with the two.
    within: Within,
    /// The pose of the second in this frame at the first of the steps.
    at: Configuration,
    /// The number of steps that it is for, with this one.
    steps: usize,
}

/// A tile became too fast for the step.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "at {time:.6} s tile {tile} moves at {speed:.3e} m/s, too fast for steps of {step:.3e} s: the motion \
     is unstable; shorten the step"
)]
pub struct BlowUp {
    /// The time (s).
    pub time: f64,
    /// The tile's index.
    pub tile: usize,
    /// Its speed (m/s).
    pub speed: f64,
    /// The step (s).
    pub step: f64,
}

impl<'a> Stepper<'a> {
    /// Starts with the given tiles; `random` are the random number generators of each tile.
    pub fn new(
        crowd: &'a Crowd,
        settings: &'a TableSettings,
        movers: Vec<Mover>,
        random: &dyn Fn(usize) -> ChaCha8Rng,
    ) -> Self {
        let drive = Drive::new(settings);
        let random = (0..movers.len()).map(random).collect();
        let masses = movers.iter().map(|it| crowd.kinds[it.kind].body.masses());
        let masses = masses.collect();
        let movers = movers.into_iter();
        let riders = movers.map(|mover| Rider { mover, debt: 0.0 });
        let nears = crowd.couples().iter().map(|couple| couple.near);
        let mut stepper = Self {
            crowd,
            settings,
            drive,
            riders: riders.collect(),
            masses,
            random,
            time: 0.0,
            account: Account::default(),
            steps: 0,
            since_kick: 0,
            neighbours: Neighbours::default(),
            near: Vec::new(),
            margins: crowd.margins(),
            least_near: nears.fold(f64::INFINITY, f64::min),
            scratch: Scratch::default(),
            solvers: Vec::new(),
        };
        stepper.prepare(0.0, &mut Scratch::default());
        stepper
    }

    fn winds(&self) -> Winds<'a> {
        Winds(&self.settings.fans)
    }

    fn laws(&self) -> Laws<'a> {
        let settings = self.settings;
        Laws {
            friction: settings.friction,
            table_friction: settings.table_friction,
            restitution: settings.restitution,
            walls: settings.walls,
            fans: self.winds(),
            is_shaken: settings.shaking.is_some(),
            step: settings.step,
        }
    }

    /// The tiles.
    pub fn movers(&self) -> Vec<Mover> {
        self.riders.iter().map(|it| it.mover).collect()
    }

    /// Kinetic energy (J).
    pub fn kinetic(&self) -> f64 {
        let each = self.riders.iter().map(|it| it.mover);
        each.map(|it| self.crowd.kinds[it.kind].body.kinetic_energy(&it.velocity))
            .sum()
    }

    /// Magnetic energy of all pairs, and the energy of all tiles in fans without their oscillation (J).
    pub fn potential(&mut self) -> f64 {
        let (crowd, movers) = (self.crowd, self.movers());
        let poses: Vec<_> = movers.iter().map(|it| Pose::of(crowd, it)).collect();
        let positions: Vec<_> = poses.iter().map(|pose| pose.at.position()).collect();
        let pairs = self.neighbours.within(crowd.range(), &positions);
        let energy = |&[i, j]: &[usize; 2]| {
            let two = Two::of([movers[i].kind, movers[j].kind], [i, j]);
            let [first, second] = [two.first, two.second];
            let couple = crowd.couple(movers[first].kind, movers[second].kind).0;
            couple.pull(&poses[first].to(&poses[second].at)).0
        };
        let magnetic: f64 = pairs.iter().map(energy).sum();
        let places = movers.iter().map(|it| it.place.xy());
        let winds = places.map(|place| self.winds().wind(place, self.time).energy);
        magnetic + winds.sum::<f64>()
    }

    /// Pairs of tiles that are near each other, with their poses.
    pub fn near_pairs(&self) -> impl Iterator<Item = Two> + '_ {
        self.near.iter().map(|near| near.two)
    }

    /// Makes one step.
    ///
    /// # Errors
    /// If a tile is too fast for the step, or contact cannot be solved.
    pub fn step(&mut self) -> Result<(), StepError> {
        let h = self.settings.step;
        self.check_speeds()?;
        // Half of the drag before the step and half after it: a free tile goes as far as it should.
        if self.settings.shaking.is_none() {
            self.damp(0.5 * h);
        }
        let mut scratch = std::mem::take(&mut self.scratch);
        self.prepare(h, &mut scratch);
        self.move_all(&scratch)?;
        let tiles = self.riders.iter().zip(&self.masses);
        for ((rider, masses), before) in tiles.zip(&scratch.movers) {
            let way = rider.mover.place - before.place;
            self.account.work += masses.x * scratch.carried.dot(&way.xy());
        }
        self.scratch = scratch;
        self.time += h;
        self.since_kick += 1;
        if self.settings.shaking.is_none() {
            self.damp(0.5 * h);
        } else if self.since_kick >= self.settings.steps_between_kicks() {
            let since = self.since_kick as f64 * h;
            self.since_kick = 0;
            self.damp(since);
        }
        Ok(())
    }

    /// Applies drag over a time (s), and the kicks of shaking.
    fn damp(&mut self, time: f64) {
        let tiles = self.riders.iter_mut().zip(&mut self.random);
        for ((rider, random), masses) in tiles.zip(&self.masses) {
            let velocity = &mut rider.mover.velocity;
            let [work, loss] = self.drive.damp(velocity, random, masses, time);
            self.account.work += work;
            self.account.drag_loss += loss;
        }
    }

    fn check_speeds(&self) -> Result<(), BlowUp> {
        let step = self.settings.step;
        for (tile, rider) in self.riders.iter().enumerate() {
            let mover = &rider.mover;
            let reach = self.crowd.kinds[mover.kind].reach;
            let speed = mover.velocity.xy().norm() + reach * mover.velocity.z.abs();
            let may_go = speed * step <= MOST_OF_NEAR * self.least_near;
            if !(may_go && mover.place.iter().all(|x| x.is_finite())) {
                return Err(BlowUp {
                    time: self.time,
                    tile,
                    speed,
                    step,
                });
            }
        }
        Ok(())
    }

    /// Prepares a step of length h (s): finds the near pairs, ties those that may touch, and
    /// computes the poses and the accelerations by the table's motion and by pairs apart.
    fn prepare(&mut self, h: f64, scratch: &mut Scratch) {
        let crowd = self.crowd;
        let Scratch { movers, poses, .. } = scratch;
        refill(movers, self.riders.iter().map(|it| it.mover));
        refill(poses, movers.iter().map(|it| Pose::of(crowd, it)));
        let halfway = movers.iter().map(|mover| ahead(crowd, mover, 0.5 * h));
        refill(&mut scratch.halfway, halfway);
        scratch.carried = self.drive.carry(self.time + 0.5 * h);
        let steady = scratch.carried.push(0.0);
        refill(&mut scratch.steady, movers.iter().map(|_| steady));
        self.sort_pairs(scratch);
        self.pull_apart(scratch);
    }

    /// Finds the near pairs, and ties those that may touch.
    fn sort_pairs(&mut self, scratch: &mut Scratch) {
        let crowd = self.crowd;
        let Scratch { movers, poses, .. } = scratch;
        let positions = &mut scratch.positions;
        refill(positions, poses.iter().map(|pose| pose.at.position()));
        let speeds = movers.iter().map(|it| fastest(crowd, it, &it.velocity));
        let travel = 2.0 * speeds.fold(0.0, f64::max) * self.settings.step;
        let touching = crowd.couples().iter().map(|it| it.radii() + it.near);
        let range = crowd.range().max(touching.fold(0.0, f64::max) + travel);
        let pairs = self.neighbours.within(range, positions);
        std::mem::swap(&mut self.near, &mut scratch.known);
        let mut known = scratch.known.drain(..).peekable();
        let apart = &mut scratch.apart;
        apart.clear();
        for &[i, j] in pairs {
            let two = Two::of([i, j].map(|k| movers[k].kind), [i, j]);
            let kept = next_of(&two, &mut known, |near| near.two);
            let [first, second] = [two.first, two.second].map(|k| &movers[k]);
            let couple = crowd.couple(first.kind, second.kind).0;
            let distance = (positions[i] - positions[j]).norm();
            let speed =
                fastest(crowd, first, &first.velocity) + fastest(crowd, second, &second.velocity);
            let travel = speed * self.settings.step;
            let near = couple.near + travel.max(2.0 * SHARE_OF_NEAR * couple.near);
            let room = match distance <= couple.radii() + near {
                true => {
                    let q = poses[two.first].to(&poses[two.second].at);
                    couple.contact.clearance_bound(&q)
                }
                false => f64::INFINITY,
            };
            let is_near = room <= near;
            let is_tied = is_near && { room <= travel + SHARE_TIED * couple.near };
            if is_near {
                let mut pair = kept.unwrap_or_else(|| NearPair::new(two));
                pair.is_tied = is_tied;
                self.near.push(pair);
            }
            if !is_tied && (is_near || distance <= couple.cutoff.to + near) {
                let near = is_near.then(|| self.near.len() - 1);
                // Of near tiles the pull changes over the distance of their outlines.
                let room = match is_near {
                    true => room.max(self.margins.feature),
                    false => (distance - couple.radii()).max(LEAST_ROOM * couple.radii()),
                };
                let room = SHARE_OF_ROOM * room;
                apart.push(Apart { two, near, room });
            }
        }
    }

    /// Adds the accelerations by pairs apart, given the tiles in the middle of the step, and ties those
    /// whose forces are too strong for the step.
    fn pull_apart(&mut self, scratch: &mut Scratch) {
        let crowd = self.crowd;
        let h = self.settings.step;
        let Scratch {
            apart,
            halfway,
            movers,
            poses,
            lasting,
            lasted,
            ..
        } = scratch;
        std::mem::swap(lasting, lasted);
        lasting.clear();
        let mut lasted = lasted.iter().peekable();
        let mut new = Vec::new();
        for Apart { two, room, .. } in apart.iter() {
            let known = next_of(two, &mut lasted, |it| it.two);
            let [first, second] = [two.first, two.second].map(|k| &movers[k]);
            let kinds = [first.kind, second.kind];
            let left_out = crowd.couple(kinds[0], kinds[1]).0.cutoff.left_out;
            let strength = known.map_or(f64::INFINITY, |it| {
                let (energy, force, torque) = it.within;
                energy.abs() + force.norm() * (room / SHARE_OF_ROOM) + torque.abs()
            });
            let room = room * (WEAK * left_out / strength).clamp(1.0, MOST_WEAK);
            let at = poses[two.first].to(&poses[two.second].at);
            let moved = |from: &Configuration| {
                let step = from.step_to(&at);
                step.xy().norm() + crowd.contact(kinds).moving().circumradius() * step.z.abs()
            };
            let known = known.filter(|it| it.steps > 1 && moved(&it.at) <= room);
            if let Some(known) = known {
                lasting.push(Lasting {
                    steps: known.steps - 1,
                    ..*known
                });
                continue;
            }
            let speed = relative(
                crowd,
                [first, second],
                [first, second].map(|it| it.velocity),
            );
            let steps = room / (speed * h).max(f64::MIN_POSITIVE);
            new.push(lasting.len());
            lasting.push(Lasting {
                two: *two,
                within: Default::default(),
                at,
                steps: steps.clamp(1.0, MOST_STEPS) as usize,
            });
        }
        let parts: Vec<&[usize]> = new.chunks(APART_TOGETHER).collect();
        let found = parallel::flat_map(&parts, |part| {
            let pull_of = |k: &usize| {
                let Lasting { two, steps, .. } = &lasting[*k];
                let middle = |tile: usize| match steps {
                    1 => halfway[tile],
                    _ => ahead(crowd, &movers[tile], 0.5 * *steps as f64 * h),
                };
                let [(first, a), (second, b)] = [two.first, two.second].map(middle);
                crowd.pull([first.kind, second.kind], &a.to(&b.at))
            };
            part.iter().map(pull_of).collect::<Vec<_>>()
        });
        for (k, within) in new.into_iter().zip(found) {
            lasting[k].within = within;
        }
        for (Apart { two, near, .. }, Lasting { within, .. }) in apart.iter().zip(&*lasting) {
            let [(first, a), (second, b)] = [two.first, two.second].map(|k| &halfway[k]);
            let pulls = on_the_table(*within, [first, second], [a, b]).1;
            let tiles = [two.first, two.second];
            let own = [0, 1].map(|side| pulls[side].component_div(&self.masses[tiles[side]]));
            if let Some(near) = near.map(|k| &mut self.near[k]) {
                let each = [0, 1].map(|side| fastest(crowd, &halfway[tiles[side]].0, &own[side]));
                let longest = longest_step(self.margins.feature, each[0] + each[1]);
                near.is_tied = longest < self.margins.usual_step;
                if near.is_tied {
                    continue;
                }
            }
            for (tile, own) in tiles.into_iter().zip(own) {
                scratch.steady[tile] += own;
            }
        }
    }

    /// Advances every island independently.
    fn move_all(&mut self, scratch: &Scratch) -> Result<(), StepError> {
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

/// The tiles of a pair, in the order in which pairs come.
fn key(two: &Two) -> [usize; 2] {
    [two.first.min(two.second), two.first.max(two.second)]
}

/// What is known of a pair, in a list whose pairs come in the same order.
fn next_of<T>(
    two: &Two,
    known: &mut Peekable<impl Iterator<Item = T>>,
    of: impl Fn(&T) -> Two,
) -> Option<T> {
    while known.next_if(|it| key(&of(it)) < key(two)).is_some() {}
    known.next_if(|it| of(it) == *two)
}

/// A tile after a time (s), if nothing acts on it.
fn ahead(crowd: &Crowd, mover: &Mover, time: f64) -> (Mover, Pose) {
    let place = mover.place + mover.velocity * time;
    let mover = Mover { place, ..*mover };
    (mover, Pose::of(crowd, &mover))
}

/// Replaces the elements of a vector.
fn refill<T>(vector: &mut Vec<T>, with: impl IntoIterator<Item = T>) {
    vector.clear();
    vector.extend(with);
}
