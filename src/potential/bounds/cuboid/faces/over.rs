//! Panels over a pole face, as they are where blocks touch along their faces.

use std::f64::consts::PI;

use super::rule::Rule;
use super::{ELLIPSE, Left, Motion, Pair, SLACK, SheetPanel};
use crate::potential::bounds::cuboid::nodes::{Node, Nodes};

/// Panels over a face that are turned against it by more than this (rad) are cut as others.
const STEEPEST: f64 = 0.1;

impl Pair {
    /// A panel over the first block's pole face, nearly parallel to it and clear of the face's
    /// upright edges, by a Gauss rule. `None` where it is not so.
    pub(super) fn over(&self, panel: &SheetPanel, nodes: &mut Nodes) -> Option<Left> {
        let Motion { reach, turn, .. } = self.motion;
        let tilt = panel.along.x.abs() + turn;
        let [up, aside] = self.extent(panel);
        let (h, v) = (panel.middle.x, panel.middle.y.abs());
        let sheet = self.first[1] / 2.0;
        let clear = sheet - v - aside - SLACK;
        let is_level = tilt <= STEEPEST && panel.half * tilt <= 0.5 * reach;
        if !is_level || h.abs() + up > clear || !(h > up || self.stays_out(h, up)) {
            return None;
        }
        let rule = Rule::at(clear / panel.half)?;
        let (places, weights) = rule.nodes();
        for (place, share) in places.iter().zip(weights) {
            let part = panel.part(place * panel.half, panel.half);
            let node = self.first_order(&part, share * panel.weight());
            nodes.push(&Node {
                bend: node.value,
                ..node
            });
        }
        let [_, thin, thick] = self.charge();
        let [high, low] = self.heights();
        let far = sheet + v - aside;
        let edge = |p: f64| self.upright(p);
        let edges = edge(clear) + edge(far);
        let third = edge(clear) / clear + edge(far) / far;

        // What bends along h alone, upwards everywhere.
        let moved = self.moved(panel);
        let gap_alone = |way: f64| {
            let way = way.max(SLACK);
            4.0 * way * way * (0.5 * (way.hypot(high) / way.hypot(low)).ln() + 0.75)
        };
        let bent = 0.5 * edges * moved[0] * moved[0] + gap_alone(moved[0]);
        // What is of third order.
        let arc = 0.5 * (panel.arm.norm() + panel.half) * turn * turn * (1.0 + turn);
        let rest = third * moved[1] * moved[1] * (moved[1] / 3.0 + 0.75 * moved[0])
            + edges * arc * (moved[0] + 2.0 * moved[1]);
        // What the rule is wrong by.
        let short = ELLIPSE * clear;
        let long = panel.half.hypot(short);
        let least = clear - short;
        let steepness = (1.0 + (h.abs() + up + long * tilt) * tilt / least) / least;
        let smooth = 2.0 * thin * thick * long * steepness * rule.error(short / panel.half);
        let rule_s = smooth + 2.0 * gap_alone(panel.half * tilt);

        let weight = panel.weight();
        Some(Left {
            middle: weight * 0.5 * bent,
            spread: weight.abs() * (0.5 * bent + rest + rule_s + 4.0 * PI * thick * SLACK),
        })
    }
}
