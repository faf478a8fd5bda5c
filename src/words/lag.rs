//! The energy of two magnets of flush faces as a function of the number of places between them.
//!
//! In flush faces every magnet faces along the normal, at the distance D from its counterpart (the
//! length of a bar and both insets). With `J(d)` the energy of two north poles d places apart along
//! the faces, the energy of two words u and v, slid by s places, is a sum over correlations,
//!
//! ```text
//! U(s) = sum_d J(d) c(s + d),    c(l) = sum_k u[k] v'[k + l],    v'[k] = v[places - 1 - k]   (J)
//! ```
//!
//! For upright magnets, a north pole is one that is up.
//!
//! For dipoles `J(d) = K / r^3 (3 D^2 / r^2 - 1)` with `r^2 = D^2 + (d pitch)^2` and
//! `K = mu0 m^2 / 4 pi`; for blocks it is the exact energy.

use nalgebra::Vector2;

use super::word::MOST_PLACES;
use tiles::configuration::Configuration;
use tiles::order::Order;
use tiles::potential::{Interaction, MagnetModel, interaction};
use tiles::tile::magnet::{Form, Shape, Standing};
use tiles::tile::strength::Strength;
use tiles::tile::{Magnet, Tile};

/// The magnets of a face and their spacing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bar {
    /// Along the face's normal, along the face, through the tile (m).
    pub size: [f64; 3],
    /// Magnetic moment (A m^2).
    pub moment: f64,
    /// Its shape, and whether it is upright.
    pub form: Form,
    /// Distance from the face to the magnet (m).
    pub inset: f64,
    /// Distance between places (m).
    pub pitch: f64,
    /// Dipoles or blocks.
    pub model: MagnetModel,
}

/// Length (m) of a face of the paper's tile.
pub const PAPER_FACE: f64 = 0.43;

impl Bar {
    /// The paper's magnets: 10 x 10 x 3 mm, 1.2 T, 40 mm apart.
    pub fn paper() -> Self {
        let size = [0.010, 0.010, 0.003];
        Self {
            size,
            moment: Strength::Remanence(1.2).moment(Shape::Block, size),
            form: Form::default(),
            inset: 0.0,
            pitch: 0.040,
            model: MagnetModel::Dipole,
        }
    }

    /// A magnet at the origin with its north pole, or its outward direction, in the direction
    /// `angle` (rad).
    fn magnet(&self, angle: f64) -> Magnet {
        Magnet {
            position: Vector2::zeros(),
            angle,
            moment: self.moment,
            size: self.size,
            form: self.form,
            face: 0,
        }
    }
}

/// J(d) (J) of two north poles, for d = 0, 1, 2 ... places.
#[derive(Clone, Debug, PartialEq)]
pub struct Lags {
    /// J(|d|) from the lowest d on.
    either_way: Vec<f64>,
    /// The sum of the k largest magnitudes without J(0) (J), with each side counted separately.
    beside: Vec<f64>,
}

impl Lags {
    /// For real magnets and words with this many places.
    pub fn new(bar: &Bar, places: usize) -> Self {
        let (first, second) = ([bar.magnet(0.0)], [bar.magnet(std::f64::consts::PI)]);
        let potential = interaction::bare(bar.model, &first, &second);
        let apart = bar.size[0] + 2.0 * bar.inset;
        let energy = |d| potential.energy(&Configuration::new(apart, d as f64 * bar.pitch, 0.0));
        Self::of((0..2 * places - 1).map(energy).collect())
    }

    /// Lags that count facing magnets as 1 and all others as 0.
    pub fn contacts(places: usize) -> Self {
        let mut energies = vec![0.0; 2 * places - 1];
        energies[0] = 1.0;
        Self::of(energies)
    }

    fn of(energies: Vec<f64>) -> Self {
        let either_side = energies[1..].iter().flat_map(|energy| [energy.abs(); 2]);
        let mut magnitudes: Vec<f64> = either_side.collect();
        magnitudes.order_by(|a, b| b.total_cmp(a));
        let mut sum = 0.0;
        let largest = magnitudes.into_iter().map(|magnitude| {
            sum += magnitude;
            sum
        });
        let either_way = energies[1..].iter().rev().chain(&energies);
        Self {
            beside: std::iter::once(0.0).chain(largest).collect(),
            either_way: either_way.copied().collect(),
        }
    }

    /// J(0) (J).
    pub fn contact(&self) -> f64 {
        self.apart(0)
    }

    /// Bound (J) of the contribution of all pairs except the facing ones to the energy of two words
    /// with `magnets` and `others` magnets.
    pub fn rest(&self, magnets: u32, others: u32) -> f64 {
        let beside = self.beside.get(others as usize).or(self.beside.last());
        f64::from(magnets) * beside.copied().unwrap_or_default()
    }

    /// J(d) (J) of magnets d places apart, in either direction.
    #[inline]
    pub(super) fn apart(&self, d: i32) -> f64 {
        let at = (self.either_way.len() / 2) as i32 + d;
        self.either_way.get(at as usize).copied().unwrap_or(0.0)
    }

    /// `sum_d J(d) c(s + d)` (J).
    pub fn energy(&self, correlations: &Correlations, s: i32) -> f64 {
        let last = correlations.places as i32 - 1;
        (-last..=last)
            .map(|l| self.apart(l - s) * f64::from(correlations.at(l)))
            .sum()
    }

    /// The same at all slides together, each as the sum of the same terms in the same order.
    pub(super) fn energies(&self, correlations: &Correlations) -> BySlide {
        let count = self.either_way.len() / 2 + 1;
        let mut sums = [0.0; 2 * MOST_PLACES];
        for (l, value) in correlations.values[..count].iter().enumerate() {
            if *value == 0 {
                continue;
            }
            let value = f64::from(*value);
            let energies = &self.either_way[count - 1 - l..2 * count - 1 - l];
            for (sum, energy) in sums[..count].iter_mut().zip(energies) {
                *sum += energy * value;
            }
        }
        BySlide {
            last: correlations.places - 1,
            sums,
        }
    }
}

/// Energies (J) of two words at all slides.
pub(super) struct BySlide {
    last: usize,
    sums: [f64; 2 * MOST_PLACES],
}

impl BySlide {
    pub fn at(&self, s: i32) -> f64 {
        self.sums[(s + self.last as i32) as usize]
    }
}

/// c(l) of two words at all lags.
#[derive(Clone, Debug)]
pub struct Correlations {
    places: usize,
    values: [i32; 2 * MOST_PLACES],
}

impl Correlations {
    /// The correlations of a word and one read as it faces the first.
    pub fn new(word: super::Word, facing: super::Word) -> Self {
        let places = word.places();
        let mut values = [0; 2 * MOST_PLACES];
        if (word.magnets() * facing.magnets()) as usize <= places {
            // Few magnets: pair by pair.
            for (k, pole) in word.poles() {
                for (j, other) in facing.poles() {
                    values[j + places - 1 - k] += pole * other;
                }
            }
        } else {
            let last = places as i32 - 1;
            for (value, lag) in values.iter_mut().zip(-last..=last) {
                *value = word.correlation(facing, lag);
            }
        }
        Self { places, values }
    }

    /// c at a lag smaller than the number of places.
    #[inline]
    pub(super) fn at(&self, lag: i32) -> i32 {
        self.values[(lag + self.places as i32 - 1) as usize]
    }
}

/// Why a face's magnets are not a [`Bar`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum BarError {
    /// There are none.
    #[error("its target face carries no magnets")]
    None,
    /// Words are made of equal magnets.
    #[error("the magnets of its target face differ in size, strength or depth")]
    Differ,
    /// Words are made of magnets along the normal.
    #[error("the magnets of its target face are turned away from the normal")]
    Turned,
    /// Energies behind shields do not depend only on lags.
    #[error("its magnets have shields, which word searches do not support")]
    Shielded,
}

impl Bar {
    /// The magnets of a face of a tile, `pitch` (m) apart.
    ///
    /// # Errors
    /// If words cannot be made of them.
    pub fn of_face(
        tile: &Tile,
        face: usize,
        interaction: &Interaction,
        pitch: f64,
    ) -> Result<Self, BarError> {
        let normal = tile.faces[face].normal();
        let mut magnets = tile.magnets.iter().filter(|magnet| magnet.face == face);
        let bar = |magnet: &Magnet| {
            let direction = Vector2::new(libm::cos(magnet.angle), libm::sin(magnet.angle));
            if direction.dot(&normal).abs() < 1.0 - 1e-9 {
                return Err(BarError::Turned);
            }
            let depth = -(magnet.position - tile.faces[face].middle()).dot(&normal);
            Ok(Self {
                size: magnet.size,
                form: north(magnet.form),
                moment: magnet.moment,
                inset: depth - magnet.size[0] / 2.0,
                pitch,
                model: interaction.model,
            })
        };
        if !interaction.shields.is_none() {
            return Err(BarError::Shielded);
        }
        let first = bar(magnets.next().ok_or(BarError::None)?)?;
        for magnet in magnets {
            let other = bar(magnet)?;
            let same = (other.size, other.form.shape) == (first.size, first.form.shape)
                && other.form.stands.is_some() == first.form.stands.is_some()
                && other.moment == first.moment
                && (other.inset - first.inset).abs() < 1e-9;
            if !same {
                return Err(BarError::Differ);
            }
        }
        // Only a shaped face has magnets that stick out; words lie behind flat faces.
        let inset = if first.inset.abs() < 1e-9 {
            0.0
        } else {
            // Differences of positions have rounding errors: whole picometres.
            (first.inset * 1e12).round() / 1e12
        };
        match inset >= 0.0 {
            true => Ok(Self { inset, ..first }),
            false => Err(BarError::Differ),
        }
    }
}

/// A form with the north pole up, if it is upright.
fn north(form: Form) -> Form {
    Form {
        stands: form.stands.map(|_| Standing::Up),
        ..form
    }
}
