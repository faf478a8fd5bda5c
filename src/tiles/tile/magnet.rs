//! A magnet of a tile.

use nalgebra::Vector2;

use super::barcode::Pole;
use super::outline::Outline;
use crate::configuration::wrap_angle;
use crate::units::MU0;

/// The shape of a magnet, and how it is mounted in its tile.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Form {
    /// Its shape.
    pub shape: Shape,
    /// The side of its north pole, if its axis is normal to the tile's plane; `None` if it lies in
    /// it.
    pub stands: Option<Standing>,
}

impl Form {
    /// The same with the other pole up, if it is upright.
    pub fn reversed(self) -> Self {
        Self {
            stands: self.stands.map(Standing::opposite),
            ..self
        }
    }
}

/// The shape of a magnet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shape {
    /// A bar or a block.
    #[default]
    Block,
    /// A disc or a rod, magnetised along its axis.
    Disc,
}

impl Shape {
    /// The volume (m^3) of a magnet of this shape, of sizes (m) as [`Magnet::size`] has them, in any order.
    pub fn volume(self, size: [f64; 3]) -> f64 {
        let of_box: f64 = size.iter().product();
        match self {
            Self::Block => of_box,
            Self::Disc => of_box * std::f64::consts::FRAC_PI_4,
        }
    }
}

/// The upper pole of an upright magnet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Standing {
    /// The north pole.
    Up,
    /// The south pole.
    Down,
}

impl Standing {
    /// 1 with the north pole up, -1 with it down.
    pub fn sign(self) -> f64 {
        match self {
            Self::Up => 1.0,
            Self::Down => -1.0,
        }
    }

    /// The other one.
    pub fn opposite(self) -> Self {
        match self {
            Self::Up => Self::Down,
            Self::Down => Self::Up,
        }
    }
}

/// Number of chords of a round outline: they deviate from the circle by 1/200 of its radius.
const CHORDS: usize = 32;

/// A magnet fixed in a tile, in the tile's frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Magnet {
    /// Its centre (m).
    pub position: Vector2<f64>,
    /// Direction of the magnetic moment (rad, counter-clockwise from the tile's x axis); for an
    /// upright magnet, the direction of the first of its sizes.
    pub angle: f64,
    /// Magnitude of the magnetic moment (A m^2), positive.
    pub moment: f64,
    /// Its size (m): along the angle, across it in the tile's plane, and through the tile's
    /// thickness. For a disc, two of them are its diameter, and the one along its axis is its
    /// height.
    pub size: [f64; 3],
    /// Its shape, and how it is mounted.
    pub form: Form,
    /// The face that carries it.
    pub face: usize,
}

impl Magnet {
    /// The moment as a vector in the tiles' plane (A m^2), zero for an upright magnet.
    pub fn moment_vector(&self) -> Vector2<f64> {
        let lying = if self.form.stands.is_some() {
            0.0
        } else {
            self.moment
        };
        Vector2::new(libm::cos(self.angle), libm::sin(self.angle)) * lying
    }

    /// The outward or upper pole, given the outward normal of the magnet's face.
    pub fn pole(&self, outwards: Vector2<f64>) -> Pole {
        match self.form.stands {
            Some(Standing::Up) => Pole::Up,
            Some(Standing::Down) => Pole::Down,
            None if self.moment_vector().dot(&outwards) >= 0.0 => Pole::North,
            None => Pole::South,
        }
    }

    /// Its sizes as it is sold (m), the one along its axis first.
    pub fn axis_first(&self) -> [f64; 3] {
        let [a, b, c] = self.size;
        match self.form.stands {
            Some(_) => [c, b, a],
            None => self.size,
        }
    }

    /// Whether both are the same product.
    pub fn is_sold_as(&self, other: &Self) -> bool {
        self.form.shape == other.form.shape
            && self.axis_first() == other.axis_first()
            && (self.moment - other.moment).abs() <= 1e-12 * self.moment
    }

    /// A magnet that is larger by this much (m) on every side in the tile's plane: its pocket.
    pub fn grown(&self, extra: f64) -> Self {
        let [a, b, thickness] = self.size;
        Self {
            size: [a + 2.0 * extra, b + 2.0 * extra, thickness],
            ..self.clone()
        }
    }

    /// The thinnest wall (m) between it and a tile's rim, negative if it breaks through.
    pub fn wall(&self, rim: &Outline) -> f64 {
        match self.is_round() {
            true => -rim.signed_distance(self.position) - self.size[0] / 2.0,
            false => {
                let corners = self.corners().map(|p| -rim.signed_distance(p));
                corners.into_iter().fold(f64::INFINITY, f64::min)
            }
        }
    }

    /// Whether it covers a circle of the tiles' plane: an upright disc.
    pub fn is_round(&self) -> bool {
        self.form.shape == Shape::Disc && self.form.stands.is_some()
    }

    /// The area that it covers in the tiles' plane (m), counter-clockwise; for an upright disc a
    /// polygon with its corners on the rim: exact towards the face and along it, where neighbours
    /// are, and in between up to 0.5 % of the radius too small.
    pub fn outline(&self) -> Vec<Vector2<f64>> {
        if !self.is_round() {
            return self.corners().to_vec();
        }
        let turn = |k: usize| self.angle + std::f64::consts::TAU * k as f64 / CHORDS as f64;
        let corner =
            |turn: f64| Vector2::new(libm::cos(turn), libm::sin(turn)) * self.size[0] / 2.0;
        let corners = (0..CHORDS).map(|k| self.position + corner(turn(k)));
        corners.collect()
    }

    /// The same magnet with its poles exchanged.
    pub fn reversed(&self) -> Self {
        let mut other = self.clone();
        match self.form.stands {
            Some(_) => other.form = self.form.reversed(),
            None => other.angle = wrap_angle(self.angle + std::f64::consts::PI),
        }
        other
    }

    /// Remanence (T) of the uniformly magnetised magnet with this moment: `Br = mu0 m / V`.
    pub fn remanence(&self) -> f64 {
        MU0 * self.moment / self.form.shape.volume(self.size)
    }

    /// The four corners of the magnet, or of the square around an upright disc, in the tile's plane
    /// (m), counter-clockwise.
    pub fn corners(&self) -> [Vector2<f64>; 4] {
        let axis =
            Vector2::new(libm::cos(self.angle), libm::sin(self.angle)) * (self.size[0] / 2.0);
        let across =
            Vector2::new(-libm::sin(self.angle), libm::cos(self.angle)) * (self.size[1] / 2.0);
        let c = self.position;
        [
            c + axis - across,
            c + axis + across,
            c - axis + across,
            c - axis - across,
        ]
    }
}
