//! The starting positions and velocities of docking trajectories.

use nalgebra::{Vector2, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::dynamics::Motion;
use tiles::configuration::Configuration;
use tiles::scale::Scale;
use tiles::tile::Pair;

/// The distribution of starts, uniform in every range.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Starts {
    /// Distance of the moving tile's reference point from the fixed tile's (m).
    #[serde(rename = "distance_m")]
    pub distance: [f64; 2],
    /// Largest angle (rad) between its direction and the fixed target face's.
    #[serde(rename = "direction_rad")]
    pub direction: f64,
    /// Largest difference (rad) of its orientation from the bound one.
    #[serde(rename = "orientation_rad")]
    pub orientation: f64,
    /// Speed of its centre of mass (m/s).
    #[serde(rename = "speed_m_per_s")]
    pub speed: [f64; 2],
    /// Largest angle (rad) between the velocity and the direction to the fixed tile's reference
    /// point.
    #[serde(rename = "aim_rad")]
    pub aim: f64,
    /// Largest angular velocity, either way (rad/s).
    #[serde(rename = "spin_rad_per_s")]
    pub spin: f64,
}

impl Default for Starts {
    /// For the paper's tile: distance 0.62 to 1.0 m within 45 degrees of the face, aimed within 0.3 rad at the fixed
    /// tile, orientation within 1.5 rad of the bound one, 0 to 1.3 m/s, no spin.
    fn default() -> Self {
        Self {
            distance: [0.62, 1.0],
            direction: std::f64::consts::FRAC_PI_4,
            orientation: 1.5,
            speed: [0.0, 1.3],
            aim: 0.3,
            spin: 0.0,
        }
    }
}

/// One start with its random quantities.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Start {
    /// The configuration and velocity of the tile.
    pub motion: Motion,
    /// Orientation relative to the bound one (rad).
    pub orientation: f64,
    /// Speed (m/s).
    pub speed: f64,
}

/// The random numbers of one trajectory, independent of all others.
pub fn stream(seed: u64, index: usize) -> ChaCha8Rng {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream((1 << 41) + index as u64);
    rng
}

impl Starts {
    /// The default starts scaled to tiles of any size.
    pub fn of(pair: &Pair) -> Self {
        let scale = Scale::of([pair.free_distance() / 2.0; 2]);
        let usual = Self::default();
        Self {
            distance: usual.distance.map(|told| scale.length(told)),
            ..usual
        }
    }

    pub(super) fn draw(&self, pair: &Pair, rng: &mut ChaCha8Rng) -> Start {
        let mut uniform = |low: f64, high: f64| low + (high - low) * rng.random::<f64>();
        let distance = uniform(self.distance[0], self.distance[1]);
        let normal = pair.target_face().normal();
        let bearing = libm::atan2(normal.y, normal.x) + uniform(-self.direction, self.direction);
        let place = Vector2::new(libm::cos(bearing), libm::sin(bearing)) * distance;
        let orientation = uniform(-self.orientation, self.orientation);
        let speed = uniform(self.speed[0], self.speed[1]);
        let course = bearing + std::f64::consts::PI + uniform(-self.aim, self.aim);
        let spin = uniform(-self.spin, self.spin);
        let theta = pair.bound.theta + orientation;
        let configuration = Configuration::from([place.x, place.y, theta]);
        Start {
            motion: Motion {
                configuration,
                velocity: Vector3::new(speed * libm::cos(course), speed * libm::sin(course), spin),
            },
            orientation,
            speed,
        }
    }
}
