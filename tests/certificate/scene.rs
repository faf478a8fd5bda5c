//! What the tests certify: designs shipped and made up.

use nalgebra::Vector2;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use tilebind::configuration::{Configuration, ConfigurationSpace};
use tilebind::contact::Contact;
use tilebind::design::Design;
use tilebind::landscape::certificate::{Bracket, Certifier, Effort, End};
use tilebind::potential::bounds::{CellBounds, CuboidBounds, DipoleBounds};
use tilebind::potential::shielding::Shields;
use tilebind::potential::{MagnetModel, Potential, of_tiles};
use tilebind::tile::{Magnet, Outline, Tile};

use crate::designs;

/// A landscape of two tiles with all that is asked of it.
pub struct Scene {
    pub tiles: [Tile; 2],
    pub space: ConfigurationSpace,
    pub contact: Contact,
    pub potential: Box<dyn Potential + Send>,
    pub bounds: Box<dyn CellBounds>,
}

pub fn effort(tolerance: f64, cells: usize) -> Effort {
    Effort {
        tolerance,
        cells,
        time: None,
    }
}

impl Scene {
    pub fn new(fixed: Tile, moving: Tile, half_size: [f64; 2], model: MagnetModel) -> Self {
        Self {
            space: ConfigurationSpace {
                half_size,
                rho: moving.radius_of_gyration(),
                free_distance: fixed.outline.circumradius() + moving.outline.circumradius(),
            },
            contact: Contact::new(&fixed.outline, &moving.outline),
            potential: of_tiles(model, &fixed, &moving, &Shields::default()),
            bounds: match model {
                MagnetModel::Dipole => Box::new(DipoleBounds::new(&fixed, &moving)),
                MagnetModel::Cuboid => Box::new(CuboidBounds::new(&fixed, &moving)),
            },
            tiles: [fixed, moving],
        }
    }

    pub fn shipped(name: &str, model: MagnetModel) -> (Self, Design) {
        let design = designs::load(&format!("shapes/{name}.toml"));
        let half_size = design.table.map(|size| size / 2.0);
        (
            Self::new(
                design.fixed.clone(),
                design.moving.clone(),
                half_size,
                model,
            ),
            design,
        )
    }

    pub fn certifier(&self) -> Certifier<'_> {
        Certifier::new(self.bounds.as_ref(), Some(&self.contact), &self.space)
    }

    /// A bracket from a certifier of its own.
    pub fn bracket(&self, from: &Configuration, to: &End, effort: &Effort) -> Bracket {
        self.certifier().bracket(from, to, &[], effort).unwrap()
    }

    pub fn random_configuration(&self, rng: &mut ChaCha8Rng) -> Configuration {
        let [x, y] = self.space.half_size;
        Configuration::new(
            rng.random_range(-x..x),
            rng.random_range(-y..y),
            rng.random_range(-3.1..3.1),
        )
    }

    /// Two tiles with a few magnets each, of random shapes, convex or not.
    pub fn random(rng: &mut ChaCha8Rng, model: MagnetModel) -> Self {
        let mut tile = || loop {
            if let Some(tile) = random_tile(rng, model) {
                return tile;
            }
        };
        Self::new(tile(), tile(), [0.4, 0.4], model)
    }
}

fn random_tile(rng: &mut ChaCha8Rng, model: MagnetModel) -> Option<Tile> {
    // How deep magnets sit at least: blocks may all but touch.
    let depth = match model {
        MagnetModel::Dipole => 0.006,
        MagnetModel::Cuboid => 0.003,
    };
    let corners = rng.random_range(3..8);
    let vertices = (0..corners)
        .map(|k| {
            let angle =
                (k as f64 + rng.random_range(0.0..0.7)) * std::f64::consts::TAU / corners as f64;
            Vector2::new(angle.cos(), angle.sin()) * rng.random_range(0.05..0.12)
        })
        .collect();
    let outline = Outline::new(vertices).ok()?;
    let mut magnets = Vec::new();
    for _ in 0..rng.random_range(1..4) {
        let mut random = || rng.random_range(-0.1..0.1);
        let position = Vector2::new(random(), random());
        if outline.signed_distance(position) > -depth {
            continue;
        }
        magnets.push(Magnet {
            position,
            angle: random() * 31.0,
            moment: 0.15 + random(),
            size: [0.004, 0.004, 0.004],
            face: 0,
        });
    }
    (!magnets.is_empty()).then(|| Tile {
        outline,
        faces: Vec::new(),
        magnets,
        mass: 0.1,
        thickness: 0.01,
    })
}
