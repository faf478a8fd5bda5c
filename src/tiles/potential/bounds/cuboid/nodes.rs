//! The potentials of one pole face at many nodes of another block's pole face, with SIMD vectors.

use crate::potential::cuboid::sheet::{Expansion, expansion};
use crate::potential::simd::lanes::{Lanes, Task, WIDTH};

/// A node of a quadrature over a pole face of the second block: an upright line of charge, in the
/// field of a pole face of the first one. The first block's frame has u along its axis and v along
/// its pole faces.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Node {
    /// Its position along the first block's pole face and out of it (m).
    pub v: f64,
    pub h: f64,
    /// Offset (m), out of the face, from the node to the intended place.
    pub shift: f64,
    /// The direction of h along u: 1 or -1.
    pub side: f64,
    /// Weights (J/m^2) of the potential, of its slopes, and of its second derivatives, that along h
    /// alone by itself.
    pub value: f64,
    pub slope: f64,
    pub bend: f64,
    pub bend_h: f64,
    /// Second derivative (J/m^2) along h of the form, instead of the potential's own.
    pub arch: f64,
    /// Weight of the potential in the uncertainty, and of the magnitude of its slopes (the same
    /// times m).
    pub spread: f64,
    pub turn: f64,
    /// Vector (m) from the point about which the second block turns, in the first one's frame.
    pub arm: [f64; 2],
}

const COLUMNS: usize = 13;
const SUMS: usize = 12;

/// Nodes in blocks of whole vectors, the last one padded with nodes without weight.
#[derive(Clone, Debug)]
pub(super) struct Nodes {
    count: usize,
    /// The number of nodes pushed since the beginning, those cleared included.
    pub all: u64,
    blocks: Vec<[[f64; WIDTH]; COLUMNS]>,
}

/// Initial capacity in blocks, enough for most pairs.
const ROOM: usize = 32;

impl Nodes {
    pub fn new() -> Self {
        Self {
            count: 0,
            all: 0,
            blocks: Vec::with_capacity(ROOM),
        }
    }

    pub fn clear(&mut self) {
        self.count = 0;
        self.blocks.clear();
    }

    pub fn push(&mut self, node: &Node) {
        let lane = self.count % WIDTH;
        if lane == 0 {
            let mut empty = [[0.0; WIDTH]; COLUMNS];
            // Off the face, for padding.
            empty[1] = [1.0; WIDTH];
            self.blocks.push(empty);
        }
        self.count += 1;
        self.all += 1;
        let [u, v] = node.arm;
        let entries = [
            node.v,
            node.h,
            node.shift,
            node.side,
            node.value,
            node.slope,
            node.bend,
            node.bend_h,
            node.arch,
            node.spread,
            node.turn,
            u,
            v,
        ];
        if let Some(block) = self.blocks.last_mut() {
            for (column, entry) in block.iter_mut().zip(entries) {
                column[lane] = entry;
            }
        }
    }
}

/// Sums over nodes, in the first block's frame.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Totals {
    pub value: f64,
    /// By u, v and the angle.
    pub gradient: [f64; 3],
    /// As (uu, vv, angle angle, uv, u angle, v angle).
    pub hessian: [f64; 6],
    /// The uncertainty (J), and its part due to the slopes.
    pub spread: f64,
    pub turned: f64,
}

/// Sums up all nodes in the field of a pole face of half the width `half` (m); `heights` are half
/// the sum and half the difference of the two blocks' thicknesses.
pub(super) struct NodeSum<'a> {
    pub nodes: &'a Nodes,
    pub half: f64,
    pub heights: [f64; 2],
}

impl Task for NodeSum<'_> {
    type Output = Totals;

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> Totals {
        let mut sums = [l.splat(0.0); SUMS];
        for block in &self.nodes.blocks {
            self.add(l, block, &mut sums);
        }
        let mut totals = [0.0; SUMS];
        for (total, sum) in totals.iter_mut().zip(sums) {
            *total = l.sum(sum);
        }
        let [value, u, v, turn, uu, vv, tt, uv, ut, vt, spread, turned] = totals;
        Totals {
            value,
            gradient: [u, v, turn],
            hessian: [uu, vv, tt, uv, ut, vt],
            spread: spread + turned,
            turned,
        }
    }
}

impl NodeSum<'_> {
    #[inline(always)]
    fn add<L: Lanes>(&self, l: L, block: &[[f64; WIDTH]; COLUMNS], sums: &mut [L::F; SUMS]) {
        let [
            v,
            h,
            shift,
            side,
            value,
            slope,
            bend,
            bend_h,
            arch,
            spread,
            turn,
            arm_u,
            arm_v,
        ] = block;
        let zero = l.splat(0.0);
        let half = l.splat(self.half);
        let (v, side) = (l.load(v), l.load(side));
        let ends = [l.sub(v, half), l.add(v, half)];
        let phi: Expansion<L::F> = expansion(l, ends, l.load(h), self.heights);

        let weight = l.load(slope);
        let shift = l.load(shift);
        let arch = l.load(arch);
        let arched = l.mul(arch, shift);
        let gu = l.mul(side, l.mul_add(weight, phi.h, arched));
        let bend = l.load(bend);
        // Along v at the intended place.
        let gv = l.mul_add(weight, phi.x, l.mul(l.mul(bend, shift), phi.xh));
        let huu = l.mul_add(l.load(bend_h), phi.hh, arch);
        let hvv = l.mul(bend, phi.xx);
        let huv = l.mul(l.mul(bend, side), phi.xh);
        // A turn moves the node along i arm and curves its path along -arm.
        let (arm_u, arm_v) = (l.load(arm_u), l.load(arm_v));
        let (tu, tv) = (l.sub(zero, arm_v), arm_u);
        let hut = l.mul_add(huu, tu, l.mul(huv, tv));
        let hvt = l.mul_add(huv, tu, l.mul(hvv, tv));
        let htt = l.mul_add(hut, tu, l.mul(hvt, tv));
        let htt = l.neg_mul_add(gu, arm_u, l.neg_mul_add(gv, arm_v, htt));

        let steep = l.mul_add(weight, phi.h, l.mul(l.splat(0.5), arched));
        let shifted = l.mul(steep, shift);
        let value = l.mul_add(l.load(value), phi.value, shifted);
        let steepness = l.add(l.abs(phi.x), l.abs(phi.h));
        let turned = l.mul(l.load(turn), steepness);
        let uncertain = l.mul(l.load(spread), phi.value);
        let shares = [
            value,
            gu,
            gv,
            l.mul_add(gu, tu, l.mul(gv, tv)),
            huu,
            hvv,
            htt,
            huv,
            hut,
            hvt,
            uncertain,
            turned,
        ];
        for (sum, share) in sums.iter_mut().zip(shares) {
            *sum = l.add(*sum, share);
        }
    }
}
