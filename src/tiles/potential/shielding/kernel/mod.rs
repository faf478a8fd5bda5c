//! Sums over all pairs of shielded magnets, one moving magnet with several fixed ones at once.

mod cell;
mod curvature;
mod factor;
mod jet;
#[cfg(test)]
mod tests;

use nalgebra::{Rotation2, Vector2, Vector3};

use super::Shield;
use crate::configuration::Configuration;
use crate::potential::far::PairEnergy;
use crate::potential::simd::lanes::{Lanes, Task, WIDTH, fill};
use crate::tile::{self, Tile};
use crate::units::MU0_OVER_4PI;
pub(in crate::potential) use cell::{FactorForm, Factors, Forms, Pairs};
pub(in crate::potential) use curvature::Curvature;
use factor::pair_factor;

/// Magnets closer than this (m) count as coinciding.
const COINCIDING: f64 = 1e-12;

/// A magnet's shield and the normal of its face.
pub(in crate::potential) type Front = (Option<Shield>, Vector2<f64>);

/// A magnet with its shield.
#[derive(Clone, Copy, Debug)]
pub(in crate::potential) struct Magnet {
    pub position: Vector2<f64>,
    pub moment: Vector2<f64>,
    pub front: Front,
    pub face: usize,
}

impl Magnet {
    /// The magnet placed at a configuration with that rotation.
    pub fn moved(&self, q: &Configuration, rotation: &Rotation2<f64>) -> Self {
        Self {
            position: q.position() + rotation * self.position,
            moment: rotation * self.moment,
            front: (self.front.0, rotation * self.front.1),
            ..*self
        }
    }

    /// The kernel's layout: place, moment and normal, then the shield's A, 1 / l, 1 / delta and G,
    /// whose values without a shield give the factor 1.
    fn entries(&self) -> [f64; COLUMNS] {
        let (shield, normal) = self.front;
        let [a, l, delta, gain] = shield.map_or([0.0, 1.0, 1.0, 1.0], |s| {
            [s.attenuation, 1.0 / s.length, 1.0 / s.width, s.front_gain]
        });
        let (p, m, n) = (self.position, self.moment, normal);
        [p.x, p.y, m.x, m.y, n.x, n.y, a, l, delta, gain]
    }
}

/// The magnets of a tile. Faces beyond the end of the list of shields have none.
pub(in crate::potential) fn magnets(tile: &Tile, shields: &[Option<Shield>]) -> Vec<Magnet> {
    let shielded = |magnet: &tile::Magnet| Magnet {
        position: magnet.position,
        moment: magnet.moment_vector(),
        face: magnet.face,
        front: (
            shields.get(magnet.face).copied().flatten(),
            tile.faces[magnet.face].normal(),
        ),
    };
    tile.magnets.iter().map(shielded).collect()
}

const COLUMNS: usize = 10;

/// Magnets as a structure of arrays, padded to whole vectors with distant magnets without moment.
#[derive(Clone, Debug)]
pub(in crate::potential) struct Columns {
    entries: [Vec<f64>; COLUMNS],
    faces: Vec<usize>,
}

impl Columns {
    pub fn new(magnets: &[Magnet]) -> Self {
        let rows: Vec<_> = magnets.iter().map(Magnet::entries).collect();
        let far = [1e6, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 1.0];
        Self {
            entries: std::array::from_fn(|k| {
                let mut column = rows.iter().map(|row| row[k]).collect();
                fill(&mut column, far[k]);
                column
            }),
            faces: magnets.iter().map(|magnet| magnet.face).collect(),
        }
    }

    /// Length of the arrays.
    pub fn len(&self) -> usize {
        self.entries[0].len()
    }
}

/// Vectors of magnets.
#[derive(Clone, Copy)]
struct Vectors<F> {
    place: [F; 2],
    moment: [F; 2],
    normal: [F; 2],
    shield: [F; 4],
}

impl<F: Copy> Vectors<F> {
    #[inline(always)]
    fn load<L: Lanes<F = F>>(l: L, columns: &Columns, from: usize) -> Self {
        let [px, py, mx, my, nx, ny, a, length, width, gain] = &columns.entries;
        Self {
            place: [l.load(&px[from..]), l.load(&py[from..])],
            moment: [l.load(&mx[from..]), l.load(&my[from..])],
            normal: [l.load(&nx[from..]), l.load(&ny[from..])],
            shield: [
                l.load(&a[from..]),
                l.load(&length[from..]),
                l.load(&width[from..]),
                l.load(&gain[from..]),
            ],
        }
    }

    #[inline(always)]
    fn splat<L: Lanes<F = F>>(l: L, magnet: &Magnet) -> Self {
        let [px, py, mx, my, nx, ny, a, length, width, gain] = magnet.entries();
        Self {
            place: [l.splat(px), l.splat(py)],
            moment: [l.splat(mx), l.splat(my)],
            normal: [l.splat(nx), l.splat(ny)],
            shield: [l.splat(a), l.splat(length), l.splat(width), l.splat(gain)],
        }
    }
}

/// Energies of pairs; the pair of the fixed magnet i and the moving magnet j has the index `j *
/// stride + i`, with the stride of the fixed magnets' columns.
#[derive(Clone, Debug)]
pub(in crate::potential) struct PairColumns {
    /// Energy (J), its gradient by the second magnet's place (J/m), its derivative by that
    /// magnet's angle (J/rad).
    entries: [Vec<f64>; 4],
}

impl PairColumns {
    /// The columns of pairs in the same order, with `fixed` of them for each moving magnet.
    pub fn new(pairs: &[PairEnergy], fixed: usize, stride: usize) -> Self {
        let moving = pairs.len().checked_div(fixed).unwrap_or(0);
        let mut entries = [(); 4].map(|()| vec![0.0; moving * stride]);
        for (k, pair) in pairs.iter().enumerate() {
            let at = k / fixed * stride + k % fixed;
            let row = [pair.energy, pair.gradient.x, pair.gradient.y, pair.slope];
            for (column, entry) in entries.iter_mut().zip(row) {
                column[at] = entry;
            }
        }
        Self { entries }
    }
}

/// The energy (J) of all pairs, each times its factor, and its gradient if requested (otherwise
/// zero). Not finite if dipoles coincide.
pub(in crate::potential) struct DipoleSum<'a, const SLOPE: bool> {
    pub fixed: &'a Columns,
    pub moving: &'a [Magnet],
    pub q: &'a Configuration,
    /// Energies of pairs of blocks; `None` for point dipoles.
    pub pairs: Option<&'a PairColumns>,
    /// The only faces whose magnets act, with the factor 1; `None` if all act.
    pub faces: Option<(usize, usize)>,
}

impl<const SLOPE: bool> Task for DipoleSum<'_, SLOPE> {
    type Output = (f64, Vector3<f64>);

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> Self::Output {
        let mask: Vec<f64> = (0..self.fixed.len())
            .map(|i| {
                let face = self.fixed.faces.get(i);
                f64::from(self.faces.is_none_or(|(first, _)| face == Some(&first)))
            })
            .collect();
        let rotation = self.q.rotation();
        let mut sums = [l.splat(0.0); 4];
        let mut closest = f64::INFINITY;
        for (j, magnet) in self.moving.iter().enumerate() {
            if self.faces.is_some_and(|(_, second)| magnet.face != second) {
                continue;
            }
            let moved = magnet.moved(self.q, &rotation);
            let second = Vectors::splat(l, &moved);
            let arm = moved.position - self.q.position();
            for from in (0..self.fixed.len()).step_by(WIDTH) {
                if mask[from..from + WIDTH].iter().all(|act| *act == 0.0) {
                    continue;
                }
                let first = Vectors::load(l, self.fixed, from);
                let way = Way::new(l, &first, &second);
                closest = closest.min(l.least(way.square));
                let w = if self.faces.is_some() {
                    [l.splat(1.0), l.splat(0.0), l.splat(0.0), l.splat(0.0)]
                } else {
                    pair_factor::<L, SLOPE>(l, &first, &second, &way)
                };
                let u = match self.pairs {
                    None => dipoles::<L, SLOPE>(l, &first, &second, &way),
                    Some(pairs) => {
                        let [energy, gx, gy, slope] = &pairs.entries;
                        let at = j * self.fixed.len() + from;
                        [
                            l.load(&energy[at..]),
                            l.load(&gx[at..]),
                            l.load(&gy[at..]),
                            l.load(&slope[at..]),
                        ]
                    }
                };
                let mask = l.load(&mask[from..]);
                let (w0, u0) = (l.mul(mask, w[0]), l.mul(mask, u[0]));
                sums[0] = l.mul_add(w0, u[0], sums[0]);
                if SLOPE {
                    let w = [w0, w[1], w[2], w[3]];
                    let [gx, gy, turn] = product_gradient(l, w, u0, &u, arm);
                    sums[1] = l.add(sums[1], gx);
                    sums[2] = l.add(sums[2], gy);
                    sums[3] = l.add(sums[3], turn);
                }
            }
        }
        if self.pairs.is_none() && closest <= COINCIDING * COINCIDING {
            return (f64::INFINITY, Vector3::zeros());
        }
        let gradient = Vector3::new(l.sum(sums[1]), l.sum(sums[2]), l.sum(sums[3]));
        (l.sum(sums[0]), gradient)
    }
}

/// The gradient, by x, y and theta, of factors times energies: `w` and `u` are the value, its
/// gradient by the second magnet's place and its derivative by that magnet's angle, `u0` is the
/// energy (masked like `w`'s value), and `arm` leads from the reference point to the second magnet.
#[inline(always)]
fn product_gradient<L: Lanes>(
    l: L,
    w: [L::F; 4],
    u0: L::F,
    u: &[L::F; 4],
    arm: Vector2<f64>,
) -> [L::F; 3] {
    let gx = l.mul_add(w[0], u[1], l.mul(u0, w[1]));
    let gy = l.mul_add(w[0], u[2], l.mul(u0, w[2]));
    let turn = l.mul_add(w[0], u[3], l.mul(u0, w[3]));
    let turn = l.mul_add(l.splat(arm.x), gy, turn);
    [gx, gy, l.neg_mul_add(l.splat(arm.y), gx, turn)]
}

/// The vector from a first magnet to a second one.
#[derive(Clone, Copy)]
struct Way<F> {
    square: F,
    /// One over the distance (1/m), and the distance (m).
    inverse: F,
    distance: F,
    /// Unit vector.
    direction: [F; 2],
}

impl<F: Copy> Way<F> {
    #[inline(always)]
    fn new<L: Lanes<F = F>>(l: L, first: &Vectors<F>, second: &Vectors<F>) -> Self {
        let x = l.sub(second.place[0], first.place[0]);
        let y = l.sub(second.place[1], first.place[1]);
        let square = l.mul_add(x, x, l.mul(y, y));
        let least = l.splat(COINCIDING * COINCIDING);
        let square = l.select(l.sub(square, least), square, least);
        let inverse = l.reciprocal_sqrt(square);
        Self {
            square,
            inverse,
            distance: l.mul(square, inverse),
            direction: [l.mul(x, inverse), l.mul(y, inverse)],
        }
    }
}

#[inline(always)]
fn dot<L: Lanes>(l: L, a: [L::F; 2], b: [L::F; 2]) -> L::F {
    l.mul_add(a[0], b[0], l.mul(a[1], b[1]))
}

/// Energy of two dipoles (J), its gradient by the second one's place and its derivative by the
/// second one's angle: see `dipole::pair`.
#[inline(always)]
fn dipoles<L: Lanes, const SLOPE: bool>(
    l: L,
    first: &Vectors<L::F>,
    second: &Vectors<L::F>,
    way: &Way<L::F>,
) -> [L::F; 4] {
    let (m1, m2, d) = (first.moment, second.moment, way.direction);
    let (along1, along2) = (dot(l, m1, d), dot(l, m2, d));
    let both = l.mul(along1, along2);
    let together = dot(l, m1, m2);
    let cube = l.mul(way.inverse, l.mul(way.inverse, way.inverse));
    let scale = l.mul(l.splat(MU0_OVER_4PI), cube);
    let energy = l.mul(scale, l.neg_mul_add(l.splat(3.0), both, together));
    let zero = l.splat(0.0);
    if !SLOPE {
        return [energy, zero, zero, zero];
    }
    let radial = l.neg_mul_add(l.splat(5.0), both, together);
    let steep = l.mul(l.mul(l.splat(-3.0), scale), way.inverse);
    let x = l.mul_add(along1, m2[0], l.mul_add(along2, m1[0], l.mul(radial, d[0])));
    let y = l.mul_add(along1, m2[1], l.mul_add(along2, m1[1], l.mul(radial, d[1])));
    let turned = [l.sub(zero, m2[1]), m2[0]];
    let slope = l.neg_mul_add(
        l.mul(l.splat(3.0), along1),
        dot(l, turned, d),
        dot(l, m1, turned),
    );
    [
        energy,
        l.mul(steep, x),
        l.mul(steep, y),
        l.mul(scale, slope),
    ]
}
