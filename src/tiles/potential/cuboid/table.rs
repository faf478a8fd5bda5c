//! The field of one tile's many blocks, tabulated, so that the cost of a block of the other tile does
//! not depend on their number.
//!
//! A block's energy is that of its two pole faces, `U = s (int phi dt over its north face - the same
//! over its south face)`, with s its charge density (A/m), t along the faces in the plane (m), and phi
//! (J/A) the potential of the fixed blocks integrated over the moving block's thickness, in units of
//! the energy of a charge. In the squares of a table ([`crate::potential::patches`]) phi is split: the
//! few blocks near a square are evaluated individually, and phi of all others is a polynomial, from
//! which the integrals follow by Gauss's rule of [`NODES`] nodes a face.
//!
//! # Errors
//! The energy is the mean over the moving block of its moment times the slope of phi, and the fixed
//! blocks are distributions of dipoles, so the error of the polynomial is that of dipoles'
//! polynomials ([`polynomial`](crate::potential::patches::polynomial)). Their proved bound is far too
//! wide here. With [`ORDER`] terms and dipoles at a distance D of `1 /` [`FARTHEST`] half sides the
//! largest error of a slope, at the rim of the square, is 4e-8 of `m / D^3`; of a mean over a block it
//! is much smaller. On a pole face of half width w/2 with all sources at least 6 times that away, as
//! squares are wide enough to ensure, Gauss's rule converges like `(6 + sqrt 37)^-8` = 2e-9. The
//! energies of whole tiles differ from the sums of their pairs by less than 2e-8 of the strongest
//! pair's `mu0 m1 m2 / (4 pi r^3)`. (All as measured in the tests.)

use std::sync::OnceLock;

use nalgebra::{Complex, Vector2};

use super::block::Block;
use super::quadrature::{FOUR, RULES, SIX};
use super::sheet::potential;
use super::{SizedBlock, member};
use crate::configuration::Configuration;
use crate::potential::far::group::Group;
use crate::potential::far::terms::Sums;
use crate::potential::groups::are_many;
use crate::potential::patches::polynomial::{Charge, Interpolation, Polynomial, Sampled};
use crate::potential::patches::square::{Rule, Source, distance};
use crate::potential::patches::table::FieldTable;
use crate::potential::simd::Level;
use crate::potential::simd::lanes::{Lanes, WIDTH};
use crate::units::MU0_OVER_4PI;

/// Number of terms of the polynomials along either side.
pub const ORDER: usize = 12;

/// Blocks at least this many times as far from a polynomial's square as half its side are part of
/// the polynomial.
pub const FARTHEST: f64 = 1.0 / 4.0;

/// Number of nodes on a pole face.
const NODES: usize = WIDTH / 2;

/// Polynomials reach at least this many times a pole face's width beyond their squares, so that
/// what is not near is at least four times as far away.
const ROOM: f64 = 0.75;

/// Squares are not halved below this fraction of a moving block's radius, however many blocks are
/// near.
const FINEST: f64 = 1.0 / 8.0;

/// The field of the fixed tile's blocks, for each size of a moving block.
#[derive(Clone, Debug)]
pub struct BlockField {
    tables: Vec<FieldOfSize>,
    /// How far the moving blocks' centres are from the moving tile's reference point (m).
    lever: f64,
    level: Level,
}

#[derive(Clone, Debug)]
struct FieldOfSize {
    /// Of the moving blocks (m).
    size: [f64; 3],
    table: FieldTable<Fixed>,
    interpolation: Interpolation<ORDER>,
}

/// A block of the fixed tile.
#[derive(Clone, Debug)]
struct Fixed {
    block: Block,
    /// The number of its group, and its place there.
    group: usize,
    at: usize,
}

/// The potential around a square.
#[derive(Clone, Debug)]
pub struct Patch {
    /// That of the blocks that are not near (J/A).
    far: Polynomial<ORDER>,
    /// The others: the numbers of the fixed tile's groups, and those of their blocks that are near,
    /// whose members are places in the group.
    pub near: Vec<(usize, Group)>,
}

impl Source for Fixed {
    type Kept = OnceLock<Box<Patch>>;

    fn reach(&self) -> f64 {
        self.block.position.norm()
    }

    fn distance(&self, centre: Vector2<f64>, half: f64) -> f64 {
        (distance(self.block.position, centre, half) - self.block.radius()).max(0.0)
    }
}

impl BlockField {
    /// The field of the fixed blocks of some groups, for moving blocks and their sizes (m); `None` if a
    /// table does not pay.
    pub fn new(
        fixed: (&[SizedBlock], &[Group]),
        moving: (&[SizedBlock], &[[f64; 3]]),
        level: Level,
    ) -> Option<Self> {
        if !are_many(fixed.0.len(), moving.0.len()) {
            return None;
        }
        let sources = (0..).zip(fixed.1).flat_map(|(number, group)| {
            (0..group.count).map(move |at| Fixed {
                block: member(group, fixed.0, at),
                group: number,
                at,
            })
        });
        let sources: Vec<Fixed> = sources.collect();
        let of_size = |size: &[f64; 3]| {
            let radius = Block::new(1.0, *size).radius();
            let rule = Rule {
                more: radius.max(ROOM * size[1]),
                farthest: FARTHEST,
                smallest: FINEST * radius,
            };
            FieldOfSize {
                size: *size,
                table: FieldTable::new(sources.clone(), rule),
                interpolation: Interpolation::new(),
            }
        };
        let levers = moving.0.iter().map(|it| it.block.position.norm());
        Some(Self {
            tables: moving.1.iter().map(of_size).collect(),
            lever: levers.fold(0.0, f64::max),
            level,
        })
    }

    /// Whether all moving blocks are within reach of the tables.
    pub fn holds(&self, q: &Configuration) -> bool {
        let farthest = q.position().norm() + self.lever;
        self.tables.iter().all(|it| farthest <= it.table.reach())
    }

    /// The potential around a moving block of this size, in place (m) of its centre.
    #[inline]
    pub fn at(&self, size: usize, place: Complex<f64>, groups: &[Group]) -> &Patch {
        let of_size = &self.tables[size];
        let (square, kept) = of_size.table.at([place.re, place.im]);
        kept.get_or_init(|| {
            let (far, wide) = (
                square.far(&of_size.table.sources),
                of_size.table.rule.wide(square.half),
            );
            let places = of_size.interpolation.places(square.centre, wide);
            let thickness = of_size.size[2];
            let seen = far.iter().map(|it| {
                let distance = it.distance(square.centre, wide);
                Seen::new(&it.block, thickness, distance)
            });
            let (apart, close): (Vec<Seen>, Vec<Seen>) = seen.partition(|it| it.series.is_some());
            let values = self.level.run(Sampled {
                far: &[close, apart].concat(),
                places: &places,
            });
            let near = square.near.iter();
            let near = near.map(|number| &of_size.table.sources[*number as usize]);
            Box::new(Patch {
                far: of_size
                    .interpolation
                    .polynomial(square.centre, wide, &values),
                near: by_group(near, groups),
            })
        })
    }

    /// The pole faces of moving blocks of this size that point in this direction.
    #[inline(always)]
    pub fn faces<L: Lanes>(&self, l: L, size: usize, axis: Complex<f64>) -> PoleFaces<L::F> {
        let [length, width, thickness] = self.tables[size].size;
        let rule = &RULES[FOUR];
        let (mut x, mut y, mut weight) = ([0.0; WIDTH], [0.0; WIDTH], [0.0; WIDTH]);
        for k in 0..WIDTH {
            let sign = if k < NODES { 0.5 } else { -0.5 };
            let along = Complex::new(sign * length, rule.nodes[k % NODES] * width / 2.0);
            let offset = axis * along;
            (x[k], y[k]) = (offset.re, offset.im);
            // The sum of the weights is 2.
            weight[k] = sign * rule.weights[k % NODES] / (length * thickness);
        }
        PoleFaces {
            offset: [l.load(&x), l.load(&y)],
            weight: l.load(&weight),
        }
    }
}

/// Near blocks by the number of their group.
fn by_group<'a>(near: impl Iterator<Item = &'a Fixed>, groups: &[Group]) -> Vec<(usize, Group)> {
    let mut found: Vec<(usize, Group)> = Vec::new();
    for fixed in near {
        if found
            .last()
            .is_none_or(|(number, _)| *number != fixed.group)
        {
            let group = &groups[fixed.group];
            let axis = Vector2::new(group.axis.re, group.axis.im);
            found.push((fixed.group, Group::new(group.size, axis)));
        }
        if let Some((_, group)) = found.last_mut() {
            group.push(fixed.at, fixed.block.position, fixed.block.moment);
        }
    }
    found.iter_mut().for_each(|(_, group)| group.fill());
    found
}

/// Nodes on the pole faces of a moving block, in lanes.
#[derive(Clone, Copy)]
pub struct PoleFaces<F> {
    /// Relative to its centre (m).
    offset: [F; 2],
    /// For a moment of 1 A m^2 (A).
    weight: F,
}

/// Adds the energy (J) of a block of a moment (A m^2) at a place (m), on an arm (m) from the moving
/// tile's reference point, in the field of blocks that are not near, and its gradient if requested.
#[inline(always)]
pub fn add<L: Lanes, const SLOPE: bool>(
    l: L,
    Patch { far, .. }: &Patch,
    faces: &PoleFaces<L::F>,
    (place, arm, moment): (Complex<f64>, Complex<f64>, f64),
    sums: &mut Sums<L::F>,
) {
    let scale = l.splat(far.scale);
    let [x, y] = faces.offset;
    let u = l.mul(l.add(x, l.splat(place.re - far.centre[0])), scale);
    let v = l.mul(l.add(y, l.splat(place.im - far.centre[1])), scale);
    let zero = l.splat(0.0);
    let (mut value, mut by_u, mut by_v) = (zero, zero, zero);
    for row in far.rows.iter().rev() {
        let (mut sum, mut slope) = (l.splat(row[ORDER - 1]), zero);
        for coefficient in row[..ORDER - 1].iter().rev() {
            if SLOPE {
                slope = l.mul_add(slope, u, sum);
            }
            sum = l.mul_add(sum, u, l.splat(*coefficient));
        }
        if SLOPE {
            by_v = l.mul_add(by_v, v, value);
            by_u = l.mul_add(by_u, v, slope);
        }
        value = l.mul_add(value, v, sum);
    }
    let weight = l.mul(faces.weight, l.splat(moment));
    sums.energy = l.mul_add(weight, value, sums.energy);
    if SLOPE {
        let weight = l.mul(weight, scale);
        let (fx, fy) = (l.mul(weight, by_u), l.mul(weight, by_v));
        let arm = [l.add(x, l.splat(arm.re)), l.add(y, l.splat(arm.im))];
        let [sum_x, sum_y, turn] = sums.gradient;
        let turn = l.neg_mul_add(arm[1], fx, l.mul_add(arm[0], fy, turn));
        sums.gradient = [l.add(sum_x, fx), l.add(sum_y, fy), turn];
    }
}

/// A block whose potential (J/A) is integrated over a thickness (m).
#[derive(Clone)]
struct Seen<'a> {
    block: &'a Block,
    thickness: f64,
    /// The coefficients in the heights, if the block is so far away that charges stand for it;
    /// otherwise its pole faces are integrated in closed form.
    series: Option<[f64; HEIGHTS]>,
}

impl<'a> Seen<'a> {
    /// From at least a distance (m).
    fn new(block: &'a Block, thickness: f64, distance: f64) -> Self {
        let [_, width, own] = block.size;
        let reach = (own + thickness).max(width) / 2.0;
        Self {
            block,
            thickness,
            series: (distance > APART * reach).then(|| heights(own, thickness)),
        }
    }
}

impl Charge for Seen<'_> {
    #[inline(always)]
    fn add<L: Lanes>(&self, l: L, place: [L::F; 2], sum: L::F) -> L::F {
        match &self.series {
            Some(series) => of_charges(l, self, series, place, sum),
            None => of_faces(l, self, place, sum),
        }
    }
}

/// Adds the potential of a block.
#[inline(always)]
fn of_faces<L: Lanes>(l: L, seen: &Seen, place: [L::F; 2], sum: L::F) -> L::F {
    let Seen {
        block, thickness, ..
    } = seen;
    let [length, width, own] = block.size;
    let heights = [(own + thickness) / 2.0, (own - thickness).abs() / 2.0];
    // Phi is twice what `potential` gives.
    let density = 2.0 * MU0_OVER_4PI * block.moment / (length * width * own);
    let [along, across] = relative(l, block, place);
    let half = l.splat(width / 2.0);
    let s = [l.sub(across, half), l.add(across, half)];
    let (north, _) = potential(l, s, l.sub(along, l.splat(length / 2.0)), heights);
    let (south, _) = potential(l, s, l.add(along, l.splat(length / 2.0)), heights);
    l.mul_add(l.splat(density), l.sub(north, south), sum)
}

/// The place relative to a block: along and across its axis (m).
#[inline(always)]
fn relative<L: Lanes>(l: L, block: &Block, [x, y]: [L::F; 2]) -> [L::F; 2] {
    let x = l.sub(x, l.splat(block.position.x));
    let y = l.sub(y, l.splat(block.position.y));
    let (ax, ay) = (l.splat(block.axis.x), l.splat(block.axis.y));
    [
        l.mul_add(x, ax, l.mul(y, ay)),
        l.neg_mul_add(x, ay, l.mul(y, ax)),
    ]
}

/// Number of charges that stand for a pole face, and of terms of the series in its thickness.
const CHARGES: usize = 6;
const HEIGHTS: usize = 8;

/// Charges stand for a pole face beyond this many times half its width, and half the sum of the two
/// thicknesses: Gauss's rule converges like `(6 + sqrt 37)^-12` = 1e-13, and the series like `6^-16`.
const APART: f64 = 6.0;

/// Adds the potential of a block far away.
///
/// The closed forms lose digits there, like `r^4`. With p the distance in the plane and z the
/// difference of two heights, of which `E(z^2k)` is a mean over both thicknesses,
///
/// ```text
/// mean of 1 / sqrt(p^2 + z^2) = 1/p sum_k binomial(-1/2, k) E(z^2k) / p^2k.
/// ```
#[inline(always)]
fn of_charges<L: Lanes>(
    l: L,
    Seen {
        block, thickness, ..
    }: &Seen,
    series: &[f64; HEIGHTS],
    place: [L::F; 2],
    mut sum: L::F,
) -> L::F {
    let [length, width, _] = block.size;
    let rule = &RULES[SIX];
    let [along, across] = relative(l, block, place);
    let charge = MU0_OVER_4PI * block.moment * thickness / length;
    for (sign, pole) in [(1.0, length / 2.0), (-1.0, -length / 2.0)] {
        let along = l.sub(along, l.splat(pole));
        let square = l.mul(along, along);
        for k in 0..CHARGES {
            let across = l.sub(across, l.splat(rule.nodes[k] * width / 2.0));
            let inverse = l.reciprocal_sqrt(l.mul_add(across, across, square));
            let q = l.mul(inverse, inverse);
            let mut mean = l.splat(series[HEIGHTS - 1]);
            for term in series[..HEIGHTS - 1].iter().rev() {
                mean = l.mul_add(mean, q, l.splat(*term));
            }
            let weight = l.splat(sign * charge * rule.weights[k] / 2.0);
            sum = l.mul_add(l.mul(weight, inverse), mean, sum);
        }
    }
    sum
}

/// The coefficients of the series in the heights (m^2k), for two thicknesses (m): `E(z^2k)` is
/// `2 (a^(2k+2) - b^(2k+2)) / (c1 c2 (2k+1) (2k+2))`, with a half the sum and b half the difference
/// of the thicknesses c1 and c2.
fn heights(first: f64, second: f64) -> [f64; HEIGHTS] {
    let (sum, difference) = ((first + second) / 2.0, (first - second) / 2.0);
    let mut binomial = 1.0;
    std::array::from_fn(|k| {
        let n = 2 * k as i32 + 2;
        if k > 0 {
            binomial *= (0.5 - k as f64) / k as f64;
        }
        let powers = sum.powi(n) - difference.powi(n);
        binomial * 2.0 * powers / (first * second * f64::from(n * (n - 1)))
    })
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;
    use rand::{RngExt, SeedableRng};

    use super::super::CuboidPotential;
    use super::super::many::tests::square;
    use super::*;
    use crate::potential::Potential;
    use crate::potential::patches::polynomial::tests::largest_error;

    /// Energies and gradients in the field are those of all pairs, within the error of the far form,
    /// in contact, nearby and far away, and where tiles overlap.
    #[test]
    fn the_field_acts_like_its_blocks() {
        let (fixed, moving) = (square(32, 1), square(32, 2));
        let potential = CuboidPotential::new(&fixed, &moving);
        let field = potential.field.as_ref().expect("a field");
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(7);
        for k in 0..48 {
            let nearest = [0.401, 0.401, 0.45, 0.1][k % 4];
            let q = Configuration::new(
                nearest + rng.random_range(0.0..[1e-9, 0.05, 0.8, 0.2][k % 4]),
                rng.random_range(-0.3..0.3),
                rng.random_range(-3.1..3.1) * [0.0, 0.01, 1.0, 1.0][k % 4],
            );
            assert!(field.holds(&q));
            let rotation = q.rotation();
            let (mut sum, mut slope, mut strongest) = (0.0, Vector3::zeros(), 0f64);
            for (number, pair) in potential.pairs::<true>(&q).iter().enumerate() {
                let (i, j) = (number % fixed.len(), number / fixed.len());
                let arm = rotation * moving[j].position;
                let r = (q.position() + arm - fixed[i].position).norm();
                let moments = (fixed[i].moment * moving[j].moment).abs();
                strongest = strongest.max(MU0_OVER_4PI * moments / r.powi(3));
                sum += pair.energy;
                let turn = pair.slope + arm.perp(&pair.gradient);
                slope += Vector3::new(pair.gradient.x, pair.gradient.y, turn);
            }
            let (energy, gradient) = potential.energy_and_gradient(&q);
            let off = (energy - sum).abs() / strongest;
            assert!(off < 2e-8, "{q:?}: {off}");
            // The error of a gradient is that of the energy over a few millimetres.
            let off = (gradient - slope).norm() / strongest;
            assert!(off < 2e-8 / 0.002, "{q:?}: {off}");
            let alone = potential.energy(&q);
            assert!((energy - alone).abs() <= 1e-13 * energy.abs().max(strongest));
        }
    }

    #[test]
    fn the_polynomials_lose_as_little_as_is_said() {
        let most = largest_error::<ORDER>(FARTHEST);
        assert!(most < 5e-8 && most > 1e-8, "{most}");
    }

    /// Far away, where closed forms lose digits, charges stand for blocks; where they take over, both
    /// give the same.
    #[test]
    fn charges_act_like_pole_faces() {
        for (size, thickness) in [([0.01, 0.01, 0.003], 0.003), ([0.004, 0.002, 0.02], 0.01)] {
            let block = Block {
                position: Vector2::new(0.02, -0.01),
                axis: Vector2::new(0.6, 0.8),
                ..Block::new(0.3, size)
            };
            let from = |way: f64| {
                let reach = ((size[2] + thickness).max(size[1]) / 2.0) * APART + block.radius();
                let place = |k: usize| {
                    block.position + Vector2::new(1.0, 0.3 * k as f64 - 1.0) * reach * way
                };
                [0, 1].map(|i| (0..WIDTH).map(|k| place(k)[i]).collect::<Vec<_>>())
            };
            let sampled = |way: f64, distance: f64| {
                let far = &[Seen::new(&block, thickness, distance)];
                let places = &from(way);
                Level::best().run(Sampled { far, places })
            };
            // The closed forms lose digits like the fourth power of the distance.
            for (way, lost) in [(1.0, 1e-10), (2.0, 16e-10)] {
                let (faces, charges) = (sampled(way, 0.0), sampled(way, 1.0));
                let largest = faces.iter().fold(0f64, |most, value| most.max(value.abs()));
                for (one, other) in faces.iter().zip(&charges) {
                    assert!((one - other).abs() < lost * largest, "{one} {other}");
                }
            }
        }
    }
}
