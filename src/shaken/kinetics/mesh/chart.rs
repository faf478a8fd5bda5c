//! Polar coordinates of the configurations, folded by the pair's symmetries.

use std::f64::consts::TAU;

use nalgebra::{Matrix3, Vector3};

use tiles::cell::Cell;
use tiles::configuration::Configuration;
use tiles::problem::{Problem, Symmetry};

/// Largest number of bisections of a first cell.
pub(in crate::kinetics) const DEEPEST: u8 = 12;
/// Smallest units in a first cell.
pub(in crate::kinetics) const UNITS: i64 = 1 << DEEPEST;

/// Rounding tolerance of coordinates, as a share of the distance of the centres and of a radian.
const ROUNDING: f64 = 1e-12;

/// Places in a mesh: (s, phi, theta) in its smallest units.
pub(in crate::kinetics) type MeshPoint = [i64; 3];

/// The configurations with centres at most `radius` apart, in the coordinates (s, phi, theta) with
/// x = r cos phi, y = r sin phi and s = (r - g) / (radius - g) with a constant g, with only one of
/// all configurations equivalent under the symmetries of the pair: phi within one rotation of the
/// fixed tile onto itself and theta within one of the moving tile. One period in phi shifts theta by
/// the same rotation.
#[derive(Clone)]
pub(in crate::kinetics) struct Chart {
    /// The origin of phi and theta (rad), chosen so that the bond, which is held by edge contact,
    /// lies on sides of cells.
    origin: [f64; 3],
    /// Where s begins: g (m).
    inner: f64,
    /// Where it ends (m).
    pub radius: f64,
    /// First cells along s, phi and theta.
    pub cells: [i64; 3],
    /// Their size (1, rad, rad).
    step: [f64; 3],
    /// Shift of theta, in first cells, per period in phi.
    shift: i64,
    /// The number of configurations that the chart identifies.
    pub copies: usize,
}

impl Chart {
    /// The chart of a problem's configurations up to `radius` (m), in first cells of about `size`
    /// (m).
    pub fn new(problem: &Problem, radius: f64, size: f64) -> Self {
        let of_fixed = |s: &&Symmetry| s.moving == 0.0;
        let of_moving = |s: &&Symmetry| s.fixed == 0.0;
        let fixed = problem.symmetries.iter().filter(of_fixed).count();
        let moving = problem.symmetries.iter().filter(of_moving).count();
        let bound = problem.pair.as_ref().map(|pair| pair.bound);
        let bound = bound.unwrap_or(Configuration::new(radius / 2.0, 0.0, 0.0));
        let periods = [fixed, moving].map(|n| TAU / n as f64);
        let lever = libm::hypot(bound.x, bound.y).clamp(0.2 * radius, radius);
        let count = |length: f64| (length / size).round().max(2.0) as i64;
        let outside = (radius - lever).max(radius / 8.0);
        let along_r = outside / count(outside) as f64;
        let along_s = (radius / along_r).floor();
        // A rotation of the fixed tile must be a whole number of cells in theta.
        let whole = (fixed / greatest_common_divisor(fixed, moving)) as i64;
        let along_theta = count(periods[1] * problem.space.rho);
        let along_theta = (along_theta + whole - 1) / whole * whole;
        let along_phi = count(periods[0] * lever);
        let cells = [along_s as i64, along_phi, along_theta];
        Self {
            origin: [0.0, libm::atan2(bound.y, bound.x), bound.theta],
            inner: radius - along_r * along_s,
            radius,
            cells,
            step: [
                1.0 / along_s,
                periods[0] / cells[1] as f64,
                periods[1] / cells[2] as f64,
            ],
            shift: moving as i64 * along_theta / fixed as i64,
            copies: fixed * moving,
        }
    }

    /// The turn (rad) of the fixed tile onto itself that phi goes through.
    pub fn turn(&self) -> f64 {
        self.step[1] * self.cells[1] as f64
    }

    /// Size of a cell of this level (1, rad, rad).
    pub fn size(&self, level: u8) -> [f64; 3] {
        self.step.map(|step| step / f64::from(1u32 << level))
    }

    /// Size of a cell of this level (m) along s.
    pub fn depth(&self, level: u8) -> f64 {
        self.length() * self.size(level)[0]
    }

    /// (s, phi, theta) of a place (1, rad, rad).
    pub fn coordinates(&self, place: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|i| self.origin[i] + self.step[i] * place[i] / UNITS as f64)
    }

    /// The length of s (m).
    fn length(&self) -> f64 {
        self.radius - self.inner
    }

    /// The distance of the centres (m) at s.
    pub fn distance(&self, s: f64) -> f64 {
        self.inner + s * self.length()
    }

    /// The configuration at (s, phi, theta).
    pub fn configuration(&self, [s, phi, theta]: [f64; 3]) -> Configuration {
        let r = self.distance(s);
        Configuration::new(r * libm::cos(phi), r * libm::sin(phi), theta)
    }

    /// The volume element by (s, phi, theta) (m^2).
    pub fn volume(&self, s: f64) -> f64 {
        self.distance(s) * self.length()
    }

    /// Gradients by (x, y, theta) of s, phi and theta, as columns.
    pub fn gradients(&self, [s, phi, _]: [f64; 3]) -> Matrix3<f64> {
        let (sin, cos) = libm::sincos(phi);
        let outwards = Vector3::new(cos, sin, 0.0) / self.length();
        let around = Vector3::new(-sin, cos, 0.0) / self.distance(s);
        Matrix3::from_columns(&[outwards, around, Vector3::z()])
    }

    /// The place of a configuration, folded, in smallest units.
    pub fn place(&self, q: &Configuration) -> [f64; 3] {
        let phi = libm::atan2(q.y, q.x);
        let s = ((libm::hypot(q.x, q.y) - self.inner) / self.length()).max(0.0);
        let raw = [s, phi, q.theta];
        let at = |i: usize| (raw[i] - self.origin[i]) / self.step[i] * UNITS as f64;
        let mut place: [f64; 3] = std::array::from_fn(at);
        let period = self.period();
        let turns = (place[1] / period[1]).floor();
        place[1] -= turns * period[1];
        place[2] -= turns * (self.shift * UNITS) as f64;
        place[2] = place[2].rem_euclid(period[2]);
        place
    }

    /// The periods, in smallest units; along s, the length.
    pub(super) fn period(&self) -> [f64; 3] {
        self.cells.map(|n| (n * UNITS) as f64)
    }

    /// Whether a place is at the outer end of s.
    pub fn is_outer(&self, [s, ..]: MeshPoint) -> bool {
        s == self.cells[0] * UNITS
    }

    /// A whole place, folded; `None` beyond the ends of s, including the outer end if `closed` is
    /// false.
    pub fn fold(&self, place: MeshPoint, closed: bool) -> Option<MeshPoint> {
        let [s, phi, theta] = place;
        let period = self.cells.map(|n| n * UNITS);
        let is_inside = (0..period[0]).contains(&s) || (closed && s == period[0]);
        let turns = phi.div_euclid(period[1]);
        let turned = theta - turns * self.shift * UNITS;
        let folded = [s, phi.rem_euclid(period[1]), turned.rem_euclid(period[2])];
        is_inside.then_some(folded)
    }

    /// A box of configurations around the mesh's cell with this lower corner.
    pub fn around(&self, low: MeshPoint, level: u8) -> Cell {
        let mut size = self.size(level);
        let [s, phi, theta] = self.coordinates(low.map(|units| units as f64));
        let r = self.distance(s);
        size[0] *= self.length();
        let middle = [
            r + size[0] / 2.0,
            phi + size[1] / 2.0,
            theta + size[2] / 2.0,
        ];
        let (sin, cos) = libm::sincos(middle[1]);
        let arc = (r + size[0]) * size[1] / 2.0;
        let sagitta = arc * size[1] / 4.0;
        let half = |radial: f64, across: f64| {
            radial.abs() * size[0] / 2.0 + across.abs() * arc + sagitta + ROUNDING * r
        };
        Cell {
            centre: Configuration::new(middle[0] * cos, middle[0] * sin, middle[2]),
            half: [half(cos, sin), half(sin, cos), size[2] / 2.0 + ROUNDING],
        }
    }
}

fn greatest_common_divisor(a: usize, b: usize) -> usize {
    if b == 0 {
        a
    } else {
        greatest_common_divisor(b, a % b)
    }
}
