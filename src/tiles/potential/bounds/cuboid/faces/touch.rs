//! Panels that may touch a pole face.

use std::f64::consts::PI;

use super::arch::Arch;
use super::lengths::{LN_ERROR, asinh, hypotenuse, ln, stretch};
use super::{Left, Pair, SheetPanel};
use crate::potential::bounds::cuboid::nodes::{Node, Nodes};

/// Largest overlap of blocks that stick out of tiles with disjoint interiors, for both blocks, with
/// room for rounding: as a fraction of the slack, a tenth of which a block may stick out.
const STUCK_OUT: f64 = 0.5;

/// A second-order form that replaces Phi over a panel.
#[derive(Clone, Copy)]
pub(super) struct Bent {
    /// Its second derivative along h (m).
    arch: f64,
    /// The bounds of its remainder (m^2), and of the remainder's slope along a motion by the cell's
    /// half sizes.
    remainder: f64,
    slope: f64,
}

impl Pair {
    /// A panel that may touch the first block's pole face: the form of its midpoint with the given
    /// remainder, or an interval by monotonicity.
    pub(super) fn touch(
        &self,
        panel: &SheetPanel,
        remainder: Option<Bent>,
        nodes: &mut Nodes,
    ) -> Left {
        let Some(bent) = remainder else {
            return self.interval(panel, nodes);
        };
        nodes.push(&Node {
            arch: panel.weight() * bent.arch,
            ..self.first_order(panel, 2.0 * panel.weight())
        });
        let weight = panel.weight().abs();
        Left {
            spread: weight * bent.remainder,
            slope: weight * bent.slope,
            jump: weight * self.stuck_out(),
        }
    }

    /// Bound (m^2) of the change of Phi along a motion due to slopes of the outer side, for blocks
    /// that stick out of their tiles.
    pub(super) fn stuck_out(&self) -> f64 {
        let [_, thin, _] = self.charge();
        4.0 * PI * thin * STUCK_OUT * self.motion.slack
    }

    /// The remainder of Phi about the midpoint of a panel, averaged over it. `None` if it has none
    /// (see the documentation of the module), or if an interval is tighter.
    pub(super) fn touching_remainder(&self, panel: &SheetPanel) -> Option<Bent> {
        let sheet = self.first[1] / 2.0;
        let [up, aside] = self.extent(panel);
        let (h, v) = (panel.middle.x, panel.middle.y.abs());
        let inside = v + aside <= sheet - self.motion.slack;
        let beside = v - aside >= sheet + self.motion.slack;
        if !(beside || (inside && (h > up || self.stays_out(h, up)))) {
            return None;
        }
        let [_, thin, thick] = self.charge();
        let [_, low] = self.heights();
        let least = if inside { h - up } else { h.abs() - up };
        let floor = least.max(0.0);
        let edge = |beside: f64| self.upright(hypotenuse(beside, floor));
        let near = (v - sheet).abs() - aside;
        let far = (v + sheet - aside).max(near);
        let edges = edge(near) + edge(far);
        let (levels, share) = if inside {
            let nearest = (v - aside).max(0.0);
            let range = |h: f64| [nearest, v + aside].map(|v| self.level_edges(v, h));
            (Arch::of(floor, up, h + up, range), 1.0)
        } else {
            let level = |height: f64| asinh(sheet, hypotenuse(height, low));
            let most = 4.0 * (0.5 * level(floor)).min(0.5 * level(up) + 1.75) + 4.0 * LN_ERROR;
            let off = 2.0 * most * up;
            (Arch { bend: 0.0, off }, 0.5)
        };
        let bent = 0.5 * edges * (up * up + aside * aside) + share * levels.off * up;
        let [fast_up, fast_aside] = self.speeds(panel);
        let speed = hypotenuse(fast_up, fast_aside);
        // The form is for the midpoint. It does not include the squared distance of the other
        // points along h, nor the curvature of any point's motion.
        let turn = self.motion.turn;
        let arc = 0.5 * (panel.arm.norm() + panel.half) * turn * turn * (1.0 + turn);
        let [arced, arced_slope] = levels.bent_off(arc, [up, fast_up], turn);
        let tilt = panel.half * (panel.along.x.abs() + turn).min(1.0);
        let tilted = levels.bend * tilt * tilt / 6.0;
        let tilted_slope = levels.bend * tilt * panel.half * turn / 3.0;
        let remainder = bent + arced + tilted + 4.0 * PI * thick * self.motion.slack;
        let bent = Bent {
            arch: levels.bend,
            remainder,
            slope: edges * hypotenuse(up, aside) * speed
                + levels.off * fast_up
                + arced_slope
                + tilted_slope,
        };
        (remainder <= 4.0 * PI * thin * (up + aside)).then_some(bent)
    }

    /// `Phi_xx + Phi_hh` (m) at `v` along the face and `h` out of it: the contribution of the
    /// face's level edges. Over the face it decreases with h and |v|.
    fn level_edges(&self, v: f64, h: f64) -> f64 {
        let sheet = self.first[1] / 2.0;
        let [high, low] = self.heights();
        // The contributions of the two ends of a level edge, as one logarithm.
        let edge = |height: f64| {
            let away = hypotenuse(h, height).max(0.1 * self.motion.slack);
            stretch(sheet + v, away) * stretch(sheet - v, away) / (away * away)
        };
        2.0 * ln(edge(low) / edge(high))
    }

    /// Phi decreases with the distance from the face's line and with the distance from its middle
    /// line, so its extremes over a box are at two of the box's points. It has a slope of at most 2
    /// pi times the smaller thickness along h, and along v of `g(p)`, p the distance from the
    /// nearer of the upright edges: on average over the panel, at most as if it were centred on
    /// both of them, `2 / l int_0^(l/2) g = g(l/2) + 2 (high - ..)` at most, l half its width.
    fn interval(&self, panel: &SheetPanel, nodes: &mut Nodes) -> Left {
        let [up, aside] = self.extent(panel);
        let (h, v) = (panel.middle.x.abs(), panel.middle.y.abs());
        let weight = panel.weight();
        let highest = ((h - up).max(0.0), (v - aside).max(0.0), weight.abs());
        let lowest = (h + up, v + aside, -weight.abs());
        for (h, v, spread) in [highest, lowest] {
            nodes.push(&Node {
                h,
                v,
                value: weight,
                spread,
                ..panel.node()
            });
        }
        let [_, thin, _] = self.charge();
        let [high, low] = self.heights();
        let near = panel.half / 2.0;
        let log = |z: f64| {
            let root = hypotenuse(z, near);
            z * ln((z + root) / near) - root
        };
        let g = 2.0 * (log(high) - log(low) + 2.0 * LN_ERROR * high);
        let [fast_up, fast_aside] = self.speeds(panel);
        let slope = 2.0 * PI * thin * fast_up + (g + 2.0 * high) * fast_aside;
        Left {
            slope: weight.abs() * slope,
            ..Left::default()
        }
    }
}
