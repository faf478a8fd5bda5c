//! The designs that the tests certify: shipped ones and made-up ones.

use nalgebra::Vector2;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use tilebind::configuration::{Configuration, ConfigurationSpace};
use tilebind::contact::Contact;
use tilebind::design::Design;
use tilebind::landscape::minimax::{Bracket, Certifier, Effort, End};
use tilebind::potential::shielding::{Shield, ShieldRule, Shields};
use tilebind::potential::{Energy, Interaction, LazyBounds, MagnetModel, Potential};
use tilebind::tile::{Face, Magnet, Outline, Tile};

use crate::designs;

/// A landscape of two tiles with everything the tests need.
pub struct Scene {
    pub tiles: [Tile; 2],
    pub space: ConfigurationSpace,
    pub contact: Contact,
    pub potential: Box<dyn Potential + Send>,
    pub bounds: LazyBounds,
}

pub fn effort(tolerance: f64, cells: usize) -> Effort {
    Effort { tolerance, cells }
}

impl Scene {
    /// With magnets that no shield covers.
    pub fn new(fixed: Tile, moving: Tile, half_size: [f64; 2], model: MagnetModel) -> Self {
        let shields = Shields::default();
        Self::of(fixed, moving, half_size, &Interaction { model, shields })
    }

    /// With dipoles behind shields.
    pub fn shielded(fixed: Tile, moving: Tile, half_size: [f64; 2], shields: &Shields) -> Self {
        let interaction = Interaction {
            model: MagnetModel::Dipole,
            shields: shields.clone(),
        };
        Self::of(fixed, moving, half_size, &interaction)
    }

    fn of(fixed: Tile, moving: Tile, half_size: [f64; 2], interaction: &Interaction) -> Self {
        let Energy { potential, bounds } = interaction.between(&fixed, &moving);
        Self {
            space: ConfigurationSpace {
                half_size,
                rho: moving.radius_of_gyration(),
                free_distance: fixed.outline.circumradius() + moving.outline.circumradius(),
            },
            contact: Contact::new(&fixed.outline, &moving.outline),
            potential,
            bounds: bounds.unwrap(),
            tiles: [fixed, moving],
        }
    }

    pub fn shipped(name: &str, model: MagnetModel) -> (Self, Design) {
        let design = designs::load(&format!("shapes/{name}.toml"));
        let half_size = design.table.map(|size| size / 2.0);
        (
            Self::new(
                design.pair.fixed.clone(),
                design.pair.moving.clone(),
                half_size,
                model,
            ),
            design,
        )
    }

    pub fn certifier(&self) -> Certifier<'_> {
        Certifier::new(self.bounds.as_ref(), Some(&self.contact), &self.space)
    }

    /// A bracket from a new certifier.
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
        let [fixed, moving] = random_tiles(rng, model);
        Self::new(fixed, moving, [0.4, 0.4], model)
    }

    /// The same of dipoles behind shields.
    pub fn random_shielded(rng: &mut ChaCha8Rng) -> Self {
        let [fixed, moving] = random_tiles(rng, MagnetModel::Dipole);
        let mut shield = || Shield {
            attenuation: rng.random_range(0.2..0.95),
            length: rng.random_range(0.01..0.06),
            width: rng.random_range(0.1..0.6),
            front_gain: rng.random_range(0.9..1.2),
        };
        let shields = Shields {
            rule: ShieldRule::Smooth,
            fixed: vec![Some(shield())],
            moving: vec![Some(shield())],
        };
        Self::shielded(fixed, moving, [0.4, 0.4], &shields)
    }
}

fn random_tiles(rng: &mut ChaCha8Rng, model: MagnetModel) -> [Tile; 2] {
    std::array::from_fn(|_| {
        loop {
            if let Some(tile) = random_tile(rng, model) {
                return tile;
            }
        }
    })
}

fn random_tile(rng: &mut ChaCha8Rng, model: MagnetModel) -> Option<Tile> {
    // The smallest depth of magnets: blocks may nearly touch.
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
            form: Default::default(),
            face: 0,
        });
    }
    // The face assigned to all magnets.
    let [start, end] = [0, 1].map(|k| outline.vertices()[k]);
    let name = "0".to_owned();
    (!magnets.is_empty()).then(|| Tile {
        outline,
        faces: vec![Face { name, start, end }],
        magnets,
        mass: 0.1,
        thickness: 0.01,
    })
}
