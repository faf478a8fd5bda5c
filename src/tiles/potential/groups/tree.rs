//! A tree of groups of dipoles, halved recursively, with the few dipoles that replace each group
//! from afar.

use std::ops::Range;

use nalgebra::Vector2;

use super::interpolation::{least_distance, lebesgue, lost, nodes, shares};
use crate::potential::dipole::{self, Dipole};

/// The largest error of a pair of groups of dipoles, as a fraction of `mu0 M1 M2 / (4 pi r^3)`, with M
/// the sums of the moments' magnitudes and r the distance of the groups. (Actual errors are a hundred
/// times smaller, and far groups are weak compared with those in contact.)
pub const LOST: f64 = 1e-11;

/// How dipoles are grouped.
#[derive(Clone, Copy, Debug)]
pub struct Grain {
    /// Each group's dipoles are padded to a multiple of this.
    pub fill: usize,
    /// The largest error of a pair of groups, as [`LOST`] is.
    pub lost: f64,
}

impl Grain {
    /// For groups of dipoles.
    pub fn of_dipoles(fill: usize) -> Self {
        Self { fill, lost: LOST }
    }
}

/// The allowed error is divided by this. Either group has an error along and across; the second
/// one's is multiplied by Lebesgue's constants of the first one's grid, at most 3.03 for 24 nodes
/// along and 2.33 for 8 across.
const SHARES: f64 = 2.0 * (1.0 + 3.03 * 2.33);

/// Groups of at most this many dipoles, or twice the padding, are not halved.
const FEW: usize = 8;

/// Boxes that reach farther from the reference point than any dipole by this factor are not used,
/// because motions would count as longer by the same factor.
const WIDER: f64 = 1.05;

/// Numbers of nodes along a group that are tried.
const ORDERS: [usize; 6] = [6, 8, 12, 16, 20, 24];

/// Dipoles of one tile in groups.
#[derive(Clone, Debug, Default)]
pub struct Tree {
    /// The whole tile first.
    pub groups: Vec<DipoleGroup>,
    /// The dipoles of the tile and the replacements of groups, each of them padded with dipoles
    /// without moment.
    pub dipoles: Vec<Dipole>,
    /// The largest distance (m) of a dipole, or of the box of a replaced group, from the tile's
    /// reference point.
    pub lever: f64,
}

/// Consecutive dipoles of a tile, in a box.
#[derive(Clone, Debug)]
pub struct DipoleGroup {
    /// Centre of the box (m).
    pub centre: Vector2<f64>,
    /// Unit vector along the box.
    pub axis: Vector2<f64>,
    /// Half the box's length and width (m).
    pub half: [f64; 2],
    /// The indices of the two halves; `None` for a group that is not divided.
    pub parts: Option<[usize; 2]>,
    /// Sum of the moments' magnitudes (A m^2).
    pub magnitude: f64,
    /// The largest distance of the box's points from the tile's reference point (m).
    pub lever: f64,
    /// Number of its dipoles.
    pub count: usize,
    /// The group's own dipoles, for groups without parts.
    pub own: Range<usize>,
    /// Replacements of the group, the fewest dipoles first.
    pub stands: Vec<Stand>,
}

/// Dipoles that replace a group from afar.
#[derive(Clone, Debug)]
pub struct Stand {
    /// The smallest distance (m) from the box.
    pub from: f64,
    /// Their indices in the tree.
    pub dipoles: Range<usize>,
}

impl Tree {
    /// Groups of dipoles, given in their order along a tile's outline.
    pub fn new(dipoles: &[Dipole], grain: Grain) -> Self {
        Self::of_kinds(dipoles, &vec![0; dipoles.len()], grain)
    }

    /// Groups of dipoles each of which has a kind, those of one kind given one after the other in
    /// their order along a tile's outline. Only dipoles of one kind are replaced together.
    pub fn of_kinds(dipoles: &[Dipole], kinds: &[usize], grain: Grain) -> Self {
        let distances = dipoles.iter().map(|dipole| dipole.position.norm());
        let lever = distances.fold(0.0, f64::max);
        let mut tree = Self {
            lever,
            ..Self::default()
        };
        if !dipoles.is_empty() {
            tree.add(dipoles, kinds, grain, WIDER * lever);
        }
        tree
    }

    /// Adds a group and its parts; returns its number. A group whose box reaches farther than
    /// `farthest` (m) from the reference point is not replaced.
    fn add(&mut self, dipoles: &[Dipole], kinds: &[usize], grain: Grain, farthest: f64) -> usize {
        let number = self.groups.len();
        let mut group = DipoleGroup::around(dipoles);
        self.groups.push(group.clone());
        let is_of_one_kind = kinds.first() == kinds.last();
        if is_of_one_kind && dipoles.len() <= FEW.max(2 * grain.fill) {
            group.own = self.append(dipoles.to_vec(), grain.fill);
        } else {
            let is_replaced = is_of_one_kind && group.lever <= farthest;
            for order in ORDERS.into_iter().filter(|_| is_replaced) {
                if let Some((stand, from)) = group.stand(dipoles, order, grain.lost) {
                    let dipoles = self.append(stand, grain.fill);
                    group.stands.push(Stand { from, dipoles });
                    self.lever = self.lever.max(group.lever);
                }
            }
            let cut = if is_of_one_kind {
                cut(dipoles)
            } else {
                between_kinds(kinds)
            };
            let (first, second) = (0..cut, cut..dipoles.len());
            let parts = [first, second]
                .map(|part| self.add(&dipoles[part.clone()], &kinds[part], grain, farthest));
            group.parts = Some(parts);
        }
        self.groups[number] = group;
        number
    }

    fn append(&mut self, mut dipoles: Vec<Dipole>, fill: usize) -> Range<usize> {
        let first = self.dipoles.len();
        dipole::fill(&mut dipoles, fill);
        self.dipoles.extend(dipoles);
        first..self.dipoles.len()
    }

    /// Whether any group has a replacement.
    pub fn has_stands(&self) -> bool {
        self.groups.iter().any(|group| !group.stands.is_empty())
    }
}

/// Where to halve: at the widest gap of the middle half, with a preference for gaps near the
/// middle.
fn cut(dipoles: &[Dipole]) -> usize {
    let count = dipoles.len();
    let worth = |k: usize| {
        let gap = (dipoles[k].position - dipoles[k - 1].position).norm();
        gap * (1.0 - 0.1 * (k as f64 / count as f64 - 0.5).abs())
    };
    let middle = (count / 4).max(1)..=3 * count / 4;
    let widest = middle.clone().map(worth).fold(0.0, f64::max);
    middle
        .filter(|k| worth(*k) >= widest * (1.0 - 1e-9))
        .min_by_key(|k| k.abs_diff(count / 2))
        .unwrap_or(count / 2)
}

/// Where to divide dipoles of several kinds: between two kinds, near the middle.
fn between_kinds(kinds: &[usize]) -> usize {
    let changes = (1..kinds.len()).filter(|k| kinds[*k] != kinds[k - 1]);
    let nearest = changes.min_by_key(|k| k.abs_diff(kinds.len() / 2));
    nearest.expect("several kinds")
}

impl DipoleGroup {
    fn around(dipoles: &[Dipole]) -> Self {
        let ends = [&dipoles[0], &dipoles[dipoles.len() - 1]].map(|dipole| dipole.position);
        let axis = (ends[1] - ends[0]).try_normalize(0.0);
        let axis = axis.unwrap_or_else(Vector2::x);
        let across = Vector2::new(-axis.y, axis.x);
        let range = |direction: Vector2<f64>| {
            let places = dipoles.iter().map(|dipole| dipole.position.dot(&direction));
            let (low, high) = places.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), s| {
                (a.min(s), b.max(s))
            });
            // A little more, for rounding of the values compared with it.
            let size = low.abs().max(high.abs());
            ((low + high) / 2.0, (high - low) / 2.0 + 1e-15 * size)
        };
        let ((s, length), (h, width)) = (range(axis), range(across));
        let centre = axis * s + across * h;
        let corners = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)]
            .map(|(i, j)| centre + axis * (i * length) + across * (j * width));
        Self {
            centre,
            axis,
            half: [length, width],
            parts: None,
            magnitude: dipoles.iter().map(|dipole| dipole.moment.norm()).sum(),
            lever: corners
                .map(|corner| corner.norm())
                .into_iter()
                .fold(0.0, f64::max),
            count: dipoles.len(),
            own: 0..0,
            stands: Vec::new(),
        }
    }

    /// The replacement of the group with this many nodes along it, with its smallest distance (m);
    /// `None` if it does not have markedly fewer dipoles.
    ///
    /// The error of a grid of n by k nodes is at most that of n nodes along, plus that of k nodes
    /// across times Lebesgue's constant of the n. If both groups of a pair are replaced, it is at
    /// most the error of one plus that of the other times the constants of the first.
    fn stand(&self, dipoles: &[Dipole], order: usize, allowed: f64) -> Option<(Vec<Dipole>, f64)> {
        let [length, width] = self.half;
        let from = least_distance(order, length, allowed / SHARES);
        let across = allowed / (SHARES * lebesgue(order));
        let widths = (1..=8).find(|k| lost(*k, width, from) <= across)?;
        if 4 * order * widths > 3 * dipoles.len() {
            return None;
        }
        let (along, across) = (nodes(order), nodes(widths));
        let normal = Vector2::new(-self.axis.y, self.axis.x);
        let mut stand = Vec::with_capacity(order * widths);
        for s in &along {
            let place = self.centre + self.axis * (self.half[0] * s);
            stand.extend(across.iter().map(|h| Dipole {
                position: place + normal * (self.half[1] * h),
                moment: Vector2::zeros(),
            }));
        }
        for dipole in dipoles {
            let offset = dipole.position - self.centre;
            let at = |direction: &Vector2<f64>, half: f64| {
                let place = if half > 0.0 {
                    offset.dot(direction) / half
                } else {
                    0.0
                };
                place.clamp(-1.0, 1.0)
            };
            let along = shares(&along, at(&self.axis, self.half[0]));
            let across = shares(&across, at(&normal, self.half[1]));
            for (i, share) in along.iter().enumerate() {
                for (j, other) in across.iter().enumerate() {
                    stand[i * widths + j].moment += dipole.moment * (share * other);
                }
            }
        }
        Some((stand, from))
    }

    /// The dipoles to use for the group at a distance (m): the smallest replacement, or its own if
    /// it has no parts; `None` if its parts must be used.
    pub fn at(&self, distance: f64) -> Option<&Range<usize>> {
        let from = |stand: &&Stand| stand.from <= distance;
        let stand = self.stands.iter().find(from);
        match stand {
            Some(stand) => Some(&stand.dipoles),
            None if self.parts.is_none() => Some(&self.own),
            None => None,
        }
    }
}
