//! Panels directly above a pole face, as where blocks touch along their faces.

use std::f64::consts::PI;

use super::arch::Arch;
use super::lengths::hypotenuse;
use super::rule::Rule;
use super::{CellMotion, ELLIPSE, Left, Pair, SheetPanel};
use crate::potential::bounds::cuboid::nodes::{Node, Nodes};

/// Panels over a face that are tilted by more than this (rad) are cut like other panels.
const STEEPEST: f64 = 0.1;

impl Pair {
    /// A panel over the first block's pole face, nearly parallel to it and clear of the face's
    /// upright edges, by a Gauss rule. `None` if it is not so.
    pub(super) fn over(&self, panel: &SheetPanel, nodes: &mut Nodes) -> Option<Left> {
        let CellMotion {
            reach, turn, slack, ..
        } = self.motion;
        let tilt = panel.along.x.abs() + turn;
        let [reach_up, reach_aside] = self.extent(panel);
        let (h, v) = (panel.middle.x, panel.middle.y.abs());
        let sheet = self.first[1] / 2.0;
        let clear = sheet - v - reach_aside - slack;
        let is_level = tilt <= STEEPEST && panel.half * tilt <= 0.5 * reach;
        if !is_level || h.abs() + reach_up > clear || !(h > reach_up || self.stays_out(h, reach_up))
        {
            return None;
        }
        let rule = Rule::at(clear / panel.half)?;
        let [_, thin, thick] = self.charge();
        let [high, low] = self.heights();
        let far = sheet + v - reach_aside;
        let edge = |p: f64| self.upright(p);
        let edges = edge(clear) + edge(far);
        let third = edge(clear) / clear + edge(far) / far;

        // Second derivatives along h, all positive: the one that depends on the gap alone is
        // replaced by a constant, the rest, from 0 to `edges`, by half of `edges`.
        let [up, aside] = self.moved(panel);
        let gap =
            |h: f64| 4.0 * libm::log(hypotenuse(h, high) / hypotenuse(h, low).max(0.1 * slack));
        let floor = (h - reach_up).max(0.0);
        let mut arch = Arch::of(floor, up, h + reach_up, |h| [gap(h); 2]);
        let off = arch.off + 0.5 * edges * up;
        arch.bend += 0.5 * edges;
        for (place, share) in rule.nodes() {
            let part = panel.part(place * panel.half, panel.half);
            let node = self.first_order(&part, share * panel.weight());
            nodes.push(&Node {
                bend: node.value,
                arch: 0.5 * node.value * arch.bend,
                ..node
            });
        }
        let arc = 0.5 * (panel.arm.norm() + panel.half) * turn * turn * (1.0 + turn);
        let [fast_up, fast_aside] = self.speeds(panel);
        let [arced, arced_slope] = arch.bent_off(arc, [up, fast_up], turn);
        let bent = off * up + arced;
        let gap_alone = |way: f64| {
            let way = way.max(slack);
            4.0 * way * way * (0.5 * libm::log(hypotenuse(way, high) / hypotenuse(way, low)) + 0.75)
        };
        // Third-order terms.
        let rest =
            third * aside * aside * (aside / 3.0 + 0.75 * up) + edges * arc * (up + 2.0 * aside);
        // Their slopes.
        let gap_slope = |way: f64| {
            let way = way.max(slack);
            4.0 * way * (libm::log(hypotenuse(way, high) / hypotenuse(way, low)) + 1.0)
        };
        let bent_slope = off * fast_up + arced_slope;
        let rest_slope = third
            * (fast_aside * (aside * aside + 1.5 * aside * up + up * up)
                + 0.75 * fast_up * aside * aside)
            + edges * arc * (2.0 * (up + 2.0 * aside) + fast_up + 2.0 * fast_aside);
        // The error of the rule.
        let short = ELLIPSE * clear;
        let long = hypotenuse(panel.half, short);
        let least = clear - short;
        let steepness = (1.0 + (h.abs() + reach_up + long * tilt) * tilt / least) / least;
        let smooth = 2.0 * thin * thick * long * steepness * rule.error(short / panel.half);
        let rule_s = smooth + 2.0 * gap_alone(panel.half * tilt);
        let steepest = (1.0 + (h.abs() + reach_up + long * tilt) / least) / least;
        let smooth_slope =
            2.0 * thin * thick * steepest * (reach + turn * long) * rule.error(short / panel.half);
        let rule_slope = smooth_slope + 2.0 * gap_slope(panel.half * tilt) * fast_up;

        let weight = panel.weight();
        Some(Left {
            spread: weight.abs() * (bent + rest + rule_s + 4.0 * PI * thick * slack),
            slope: weight.abs() * (bent_slope + rest_slope + rule_slope),
            jump: weight.abs() * self.stuck_out(),
        })
    }
}
