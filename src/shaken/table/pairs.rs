//! The pairs of tiles in a step of the table: those that are near each other, those that may touch, and the pulls of
//! all that do not.

use std::iter::Peekable;

use super::scratch::{Apart, Lasting, Scratch, ahead, refill};
use super::stepper::Stepper;
use crate::rigid::{NearPair, Two, World, fastest, longest_step, on_the_table, relative};
use tiles::configuration::Configuration;
use tiles::parallel;

/// Usual travel of a tile in a step, as a share of the distance that counts as near; faster tiles are
/// near each other from farther on.
pub const SHARE_OF_NEAR: f64 = 0.25;
/// Pairs apart per task of a thread.
const APART_TOGETHER: usize = 512;
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

impl Stepper<'_> {
    /// Finds the near pairs, and ties those that may touch.
    pub(super) fn sort_pairs(&mut self, scratch: &mut Scratch) {
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
    pub(super) fn pull_apart(&mut self, scratch: &mut Scratch) {
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
