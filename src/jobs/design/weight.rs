//! What a tile's mass means for its material.

use super::quantity::four_digits;
use physics::tile::Tile;
use physics::units::{MU0, si};

/// Lowest densities (kg/m^3) of magnets of ferrite and of rare earths, and the remanence (T) that
/// ferrite does not reach.
const OF_MAGNETS: [f64; 2] = [4.5e3, 7.3e3];
const NO_FERRITE: f64 = 0.5;
/// Densities (kg/m^3) of tiles that occur, without their magnets: from foam to brass. Sheets of foam
/// have 20 or more, and what the paper's 100 g leave for its tile without magnets is 27.
const BODIES: [f64; 2] = [20.0, 9e3];
/// The density of the lightest solid, balsa wood; below it are only foam and hollow tiles.
const SOLID: f64 = 100.0;
/// Plywood and acrylic.
const USUAL: [f64; 2] = [600.0, 1190.0];

/// The mass of a tile, and of its parts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weight {
    mass: f64,
    /// Of the magnets (kg), at least.
    magnets: f64,
    /// Of the body without its pockets (m^3).
    volume: f64,
}

impl Weight {
    /// The weight of a tile.
    pub fn of(tile: &Tile) -> Self {
        let magnets = tile.magnets.iter().map(|magnet| {
            let volume = magnet.form.shape.volume(magnet.size);
            let is_ferrite = MU0 * magnet.moment < NO_FERRITE * volume;
            [OF_MAGNETS[usize::from(!is_ferrite)] * volume, volume]
        });
        let [magnets, taken] = magnets.fold([0.0; 2], |sum, it| [sum[0] + it[0], sum[1] + it[1]]);
        Self {
            mass: tile.mass,
            magnets,
            volume: (tile.outline.area() * tile.thickness - taken).max(0.0),
        }
    }

    /// The density (kg/m^3) of the body.
    fn density(&self) -> f64 {
        (self.mass - self.magnets) / self.volume
    }

    /// The mass (kg) with a body of this density (kg/m^3).
    fn with(&self, density: f64) -> f64 {
        density * self.volume + self.magnets
    }

    /// What no usual tile has, if the mass is so.
    pub(super) fn doubt(&self) -> Option<String> {
        let grams = |mass: f64| four_digits(1e3 * mass);
        let [mass, magnets] = [grams(self.mass), grams(self.magnets)];
        let beside = match self.density() {
            _ if self.mass < self.magnets => {
                return Some(format!(
                    "weighs {mass} g, less than its magnets (about {magnets} g)"
                ));
            }
            density if density < BODIES[0] => "lighter than foam",
            density if density > BODIES[1] => "heavier than brass",
            _ => return None,
        };
        Some(format!(
            "weighs {mass} g, with magnets of about {magnets} g: {} g/cm3 for the rest, {beside}",
            four_digits(self.density() / 1e3)
        ))
    }

    /// What full tiles would weigh.
    pub(super) fn usual(&self) -> String {
        let [plywood, acrylic] = USUAL.map(|density| four_digits(1e3 * self.with(density)));
        format!("a full tile of plywood would weigh {plywood} g, one of acrylic {acrylic} g")
    }

    /// A note on a tile, called so, that is lighter than any solid, but not than foam.
    pub fn note(&self, name: &str) -> Option<String> {
        (BODIES[0]..SOLID).contains(&self.density()).then(|| {
            let [mass, plywood] =
                [self.mass, self.with(USUAL[0])].map(|mass| si(1e3 * mass, "g", 3));
            format!(
                "{name} weighs {mass}, as one of foam or a hollow one; a full one of \
                 plywood would weigh {plywood}, and move accordingly (`mass`)"
            )
        })
    }
}
