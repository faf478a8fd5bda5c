//! Bounds for one pair of blocks near each other: quadratures over the second block's pole faces
//! whose errors are bounded over a whole cell.

mod arch;
mod lengths;
mod over;
mod rule;
mod touch;

use std::f64::consts::{PI, SQRT_2};
use std::iter::Sum;
use std::ops::Add;

use nalgebra::Vector2;

use super::nodes::{Node, Nodes};
use crate::potential::bounds::apart::Apart;
use crate::potential::cuboid::block::Block;
use lengths::hypotenuse;
use rule::Rule;

/// The ellipse of analyticity extends to this fraction of the distance to the sheet.
const ELLIPSE: f64 = 0.75;

/// Panels have third-order forms beyond this many times their reach.
const FAR: f64 = 2.0;

/// Panels that may touch the face are cut to this fraction of the reach, those without a
/// first-order form to the second one; none finer than the third, a fraction of the face.
const SHARE: f64 = 0.25;
const SHARE_WITHOUT_FORM: f64 = 0.1;
const FINEST: f64 = 1.0 / 8192.0;

/// The second block as seen from the first, in the first one's frame: u along its axis, v along
/// its pole faces.
pub(super) struct Pair {
    first: [f64; 3],
    second: [f64; 3],
    /// `mu0 / (4 pi)` times the product of the charge densities (J/m^3).
    strength: f64,
    /// Place (m) and axis of the second block.
    place: Vector2<f64>,
    axis: Vector2<f64>,
    motion: CellMotion,
}

/// How a cell moves the second block.
#[derive(Clone, Copy)]
pub(super) struct CellMotion {
    /// Vector (m) to the block from the point about which it turns.
    pub arm: Vector2<f64>,
    /// Largest distance that any of its points moves (m), half the cell's sides (m) and half its
    /// angle (rad).
    pub reach: f64,
    pub sides: Vector2<f64>,
    pub turn: f64,
    /// Whether no point of the second block enters the first one if the tiles are free.
    pub apart: bool,
    /// How much (m) blocks may overlap in configurations that count as free, with a margin.
    pub slack: f64,
}

/// How far (J) the energy may be from the forms, and the slope and the jumps of an
/// [`Enclosure`](super::Enclosure).
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Left {
    pub spread: f64,
    pub slope: f64,
    pub jump: f64,
}

impl Add for Left {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            spread: self.spread + other.spread,
            slope: self.slope + other.slope,
            jump: self.jump + other.jump,
        }
    }
}

impl Sum for Left {
    fn sum<I: Iterator<Item = Self>>(all: I) -> Self {
        all.fold(Self::default(), Self::add)
    }
}

/// A piece of a pole face of the second block before one of the first.
#[derive(Clone, Copy)]
struct SheetPanel {
    /// `h` (out of the first block's face) and `v` (along it) of the midpoint (m), and their change
    /// per metre of the panel.
    middle: Vector2<f64>,
    along: Vector2<f64>,
    /// Half the panel's width (m).
    half: f64,
    /// The direction of h along u.
    side: f64,
    /// The pair's strength with the poles' signs (J/m^3).
    strength: f64,
    /// Vector (m) from the point about which the second block turns to the midpoint, along u and v.
    arm: Vector2<f64>,
}

impl SheetPanel {
    /// A part of it, `offset` (m) from the middle.
    fn part(&self, offset: f64, half: f64) -> Self {
        let way = self.along * offset;
        Self {
            middle: self.middle + way,
            arm: self.arm + Vector2::new(self.side * way.x, way.y),
            half,
            ..*self
        }
    }

    /// A node without weight at the midpoint.
    fn node(&self) -> Node {
        Node {
            h: self.middle.x,
            v: self.middle.y,
            side: self.side,
            arm: self.arm.into(),
            ..Node::default()
        }
    }

    /// The weight (J/m^2) of Phi over the whole panel. Nodes give half of Phi.
    fn weight(&self) -> f64 {
        2.0 * self.half * self.strength
    }
}

impl Pair {
    /// `second` as the cell's centre places it.
    pub fn new(first: &Block, second: &Block, strength: f64, motion: &CellMotion) -> Self {
        let into = |w: Vector2<f64>| Vector2::new(first.axis.dot(&w), first.axis.perp(&w));
        Self {
            first: first.size,
            second: second.size,
            strength,
            place: into(second.position - first.position),
            axis: into(second.axis),
            motion: CellMotion {
                arm: into(motion.arm),
                sides: Vector2::new(
                    first.axis.abs().dot(&motion.sides),
                    first.axis.yx().abs().dot(&motion.sides),
                ),
                ..*motion
            },
        }
    }

    /// Appends the nodes of all four pairs of pole faces; returns the remainder, without the nodes'
    /// own spread.
    pub fn append(&self, nodes: &mut Nodes) -> Left {
        self.pole_faces()
            .iter()
            .map(|face| self.cut(face, nodes))
            .sum()
    }

    /// The second block's pole faces relative to both of the first one's.
    fn pole_faces(&self) -> [SheetPanel; 4] {
        let along = Vector2::new(-self.axis.y, self.axis.x);
        [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)].map(|(side, pole)| {
            let offset = self.axis * (pole * self.second[0] / 2.0);
            let middle = self.place + offset;
            SheetPanel {
                middle: Vector2::new(side * middle.x - self.first[0] / 2.0, middle.y),
                along: Vector2::new(side * along.x, along.y),
                half: self.second[1] / 2.0,
                side,
                strength: side * pole * self.strength,
                arm: self.motion.arm + offset,
            }
        })
    }

    /// The same for blocks that stay apart, at the cell's centre: the remainder is the error of the
    /// rules in value, slope and second derivative.
    pub fn append_at_rest(&self, nodes: &mut Nodes) -> Left {
        self.pole_faces()
            .iter()
            .map(|face| self.cut_at_rest(face, nodes))
            .sum()
    }

    /// Whether the remainder of the individual pole faces is smaller than that of whole blocks:
    /// only if all faces are far enough for third-order forms.
    pub fn says_more_than(&self, apart: &Apart) -> bool {
        let mut sum = 0.0;
        for face in self.pole_faces() {
            let distance = self.distance(&face) - self.motion.reach - self.motion.slack;
            if distance < FAR * self.motion.reach {
                return false;
            }
            let [remainder, _] = self.third_order(&face, distance);
            sum += face.weight().abs() * remainder;
        }
        sum < apart.remainder
    }

    /// Cuts a panel until each piece is far enough for a rule.
    fn cut_at_rest(&self, panel: &SheetPanel, nodes: &mut Nodes) -> Left {
        let distance = self.distance(panel) - self.motion.slack;
        let Some(rule) = Rule::at(distance / panel.half) else {
            let half = panel.half / 2.0;
            let parts = [-half, half].map(|offset| panel.part(offset, half));
            return parts.iter().map(|part| self.cut_at_rest(part, nodes)).sum();
        };
        self.add_rule(panel, rule, nodes);
        let error = panel.weight().abs() * self.error(panel, distance, rule);
        // On the ellipse the n-th derivatives are at most sqrt(2) and 7 times the bound of Phi over
        // powers of this distance, and no point of the panel is faster than this.
        let clear = (1.0 - ELLIPSE) * distance;
        let turn = self.motion.turn;
        let speed = (self.motion.reach + turn * ELLIPSE * distance) / clear;
        Left {
            spread: error * (1.0 + SQRT_2 * speed * (1.0 + 0.5 * turn) + 3.5 * speed * speed),
            slope: error * (SQRT_2 * speed * (1.0 + turn) + 7.0 * speed * speed),
            ..Left::default()
        }
    }

    /// Cuts a panel until each piece is far enough for its width, or fine enough.
    fn cut(&self, panel: &SheetPanel, nodes: &mut Nodes) -> Left {
        let distance = self.distance(panel) - self.motion.reach - self.motion.slack;
        if distance >= FAR * self.motion.reach
            && let Some(rule) = Rule::at(distance / panel.half)
        {
            return self.gauss(panel, distance, rule, nodes);
        }
        let fine =
            |share: f64| panel.half <= (share * self.motion.reach).max(FINEST * self.second[1]);
        if fine(SHARE) {
            let remainder = self.touching_remainder(panel);
            if remainder.is_some() || fine(SHARE_WITHOUT_FORM) {
                return self.touch(panel, remainder, nodes);
            }
        } else if let Some(left) = self.over(panel, nodes) {
            return left;
        }
        let half = panel.half / 2.0;
        [-half, half]
            .into_iter()
            .map(|offset| self.cut(&panel.part(offset, half), nodes))
            .sum()
    }

    /// The smallest distance (m) of a panel's points from the first block's pole face, which lies
    /// at h = 0 about v = 0.
    fn distance(&self, panel: &SheetPanel) -> f64 {
        let half = self.first[1] / 2.0;
        let way = panel.along * panel.half;
        let (start, end) = (panel.middle - way, panel.middle + way);
        if start.x * end.x < 0.0 {
            let passage = start.y + (end.y - start.y) * start.x / (start.x - end.x);
            if passage.abs() <= half {
                return 0.0;
            }
        }
        let of_end = |end: Vector2<f64>| {
            let beside = (end.y.abs() - half).max(0.0);
            end.x * end.x + beside * beside
        };
        let of_edge = |edge: f64| {
            let way = Vector2::new(0.0, edge) - panel.middle;
            let along = way.dot(&panel.along).clamp(-panel.half, panel.half);
            (way - panel.along * along).norm_squared()
        };
        of_end(start)
            .min(of_end(end))
            .min(of_edge(-half))
            .min(of_edge(half))
            .sqrt()
    }

    /// A Gauss rule, its error, and the third-order remainder of its nodes' forms.
    fn gauss(&self, panel: &SheetPanel, distance: f64, rule: Rule, nodes: &mut Nodes) -> Left {
        self.add_rule(panel, rule, nodes);
        let error = self.error(panel, distance, rule);
        let [remainder, speed] = self.third_order(panel, distance);
        // The rule's error for a slope: on the ellipse that of Phi is at most sqrt(2) / ((1 -
        // ELLIPSE) d) times the bound of Phi.
        let slope = error * SQRT_2 * speed / ((1.0 - ELLIPSE) * distance) + 3.0 * remainder;
        let weight = panel.weight().abs();
        Left {
            spread: weight * (error + remainder),
            slope: weight * slope,
            ..Left::default()
        }
    }

    /// The third-order remainder (m^2) of Phi at the points of a panel that stay at least the
    /// distance (m) from the face, and the speed (m) of the points of the ellipse about it.
    fn third_order(&self, panel: &SheetPanel, distance: f64) -> [f64; 2] {
        let [width, thin, thick] = self.charge();
        let area = thin * thick;
        let (d, v, w) = (distance, self.motion.reach, self.motion.turn);
        let bend = panel.arm.norm() + panel.half;
        let (d2, d3, d4) = (d * d, d * d * d, d * d * d * d);
        let first = (width * area / d2).min(PI * area / d);
        let second = (2.0 * width * area / d3)
            .min(4.0 * area / d2)
            .min(4.0 * PI * thin / d);
        let third = (6.0 * width * area / d4)
            .min(3.0 * PI * area / d3)
            .min(6.0 * PI * thin / d2);
        let bends = bend * w * w;
        let remainder = (third * v * v * v + 3.0 * second * v * bends + first * bends * w) / 6.0;
        [remainder, v + w * ELLIPSE * d]
    }

    /// The nodes of a rule, with all derivatives.
    fn add_rule(&self, panel: &SheetPanel, rule: Rule, nodes: &mut Nodes) {
        for (place, share) in rule.nodes() {
            let weight = share * panel.weight();
            nodes.push(&Node {
                value: weight,
                slope: weight,
                bend: weight,
                bend_h: weight,
                ..panel.part(place * panel.half, panel.half).node()
            });
        }
    }

    /// The error (m^2) of an average of Phi by a rule at the distance (m) from the face.
    fn error(&self, panel: &SheetPanel, distance: f64, rule: Rule) -> f64 {
        let [width, thin, thick] = self.charge();
        let largest = width * thin * thick / ((1.0 - ELLIPSE) * distance);
        largest * rule.error(ELLIPSE * distance / panel.half)
    }

    /// Largest distances (m) of the points of a panel from its midpoint, along h and along v.
    fn extent(&self, panel: &SheetPanel) -> [f64; 2] {
        let [up, aside] = self.moved(panel);
        let extent = panel.along.abs() * panel.half;
        [extent.x + up, extent.y + aside]
    }

    /// How far (m) the cell moves the points of a panel, along h and along v.
    fn moved(&self, panel: &SheetPanel) -> [f64; 2] {
        self.ways(panel, 0.5).map(|way| way + self.motion.slack)
    }

    /// Their speeds (m) in a motion by the cell's half sizes from anywhere in the cell.
    fn speeds(&self, panel: &SheetPanel) -> [f64; 2] {
        self.ways(panel, 1.0)
    }

    /// A turn moves a point across the arm, and along it by this fraction of the turn's square.
    fn ways(&self, panel: &SheetPanel, bent: f64) -> [f64; 2] {
        let CellMotion {
            reach, sides, turn, ..
        } = self.motion;
        let arm = panel.arm.abs() + panel.along.abs() * panel.half;
        let way = |across: f64, along: f64| turn * (across + bent * turn * along);
        let far = [sides.x + way(arm.y, arm.x), sides.y + way(arm.x, arm.y)];
        far.map(|way| way.min(reach))
    }

    /// The midpoint of a panel with its first-order form.
    fn first_order(&self, panel: &SheetPanel, weight: f64) -> Node {
        let h = panel.middle.x;
        // Above the pole face, at least on the side where the second block stays.
        let over = panel.middle.y.abs() <= self.first[1] / 2.0;
        let base = if over && h <= 0.0 { 0.0 } else { h };
        let w = self.motion.turn;
        Node {
            h: base,
            shift: h - base,
            value: weight,
            slope: weight,
            turn: weight.abs() * panel.arm.norm() * w * w * w / 6.0,
            ..panel.node()
        }
    }

    /// Whether a panel that might reach below the first block's face, within the face's width,
    /// cannot do so if the tiles are free, because it would be inside the block.
    fn stays_out(&self, h: f64, up: f64) -> bool {
        self.motion.apart && h > -up && 2.0 * up <= self.first[0] - self.motion.slack
    }

    /// Width of the first block's pole face and the smaller and the greater thickness (m).
    fn charge(&self) -> [f64; 3] {
        let (a, b) = (self.first[2], self.second[2]);
        [self.first[1], a.min(b), a.max(b)]
    }

    /// Half the sum and half the difference of the two thicknesses (m).
    fn heights(&self) -> [f64; 2] {
        let [_, thin, thick] = self.charge();
        [(thick + thin) / 2.0, (thick - thin) / 2.0]
    }

    /// Bound (m) of the contribution of one of the face's upright edges to the second derivatives
    /// of Phi at a distance (m) from it.
    fn upright(&self, p: f64) -> f64 {
        let [high, low] = self.heights();
        2.0 * (hypotenuse(p, high) - hypotenuse(p, low)) / p
    }
}
