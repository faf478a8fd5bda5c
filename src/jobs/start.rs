//! New designs: the request.

use crate::design::{Material, ProfileShape, STARTER, ShopMagnet, Start, StartError, check_name};
use crate::request::{self, Word, options};

options! {
    /// The options of a new design; without any options, it is one that explains every key.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Request {
        /// Sides of both tiles, 3 to 24 [default: 4]
        pub sides: Option<u32> = value("N", sides),

        /// Side length (m), or with a unit: "12 cm" [default: 0.43]
        pub side: Option<f64> = value("M", request::length),

        /// Magnets on each of the two binding faces, 1 to 16 [default: 4]
        pub magnets: Option<usize> = value("K", request::count),

        /// Shape of those faces: flat, tab, arc, sine or triangle [default: tab]
        pub shape: Option<ProfileShape> = value("SHAPE", shape()),

        /// Magnets as sold: "10 x 5 x 2 mm N42", or a disc: "10 x 3 mm N42" [default: sized to fit]
        ///
        /// Length x width x height of a block or diameter x height of a disc, and grade. The magnets are
        /// magnetised along the last dimension. With `up` the axis stands across the tile: "6 x 3 mm N42 up".
        pub magnet: Option<ShopMagnet> = value("MAGNET", ShopMagnet::parse),

        /// Thickness of both tiles (m), or with a unit [default: a fifth of the side, at most 13 mm]
        pub thickness: Option<f64> = value("M", request::length),

        /// What the tiles are made of, for their mass: plywood, acrylic, pla ... or a density [default: plywood]
        ///
        /// A density is in kg/m3 or has a unit: "0.6 g/cm3".
        pub material: Option<Material> = value("MATERIAL", Material::parse),

        /// Both tiles of one kind: each has both binding faces, so that many of them join
        pub one_kind: bool = flag(),
    }
}

fn sides(text: &str) -> Result<u32, String> {
    let found = text.parse();
    found.map_err(|_| "a whole number is needed, such as 6".to_owned())
}

fn shape() -> Word<ProfileShape> {
    let names = ProfileShape::NAMES.map(|(name, _)| name).join(", ");
    Word::new(&ProfileShape::NAMES, format!("a shape is one of {names}"))
}

impl Request {
    /// The text of the design, named after the file with this stem where possible.
    ///
    /// # Errors
    /// If there is no such design.
    pub fn text(&self, stem: &str) -> Result<String, StartError> {
        check_name(stem)?;
        let asked = (self.sides, self.side, self.magnets, self.shape);
        let made = (self.magnet, self.thickness, self.material);
        let is_usual = asked == (None, None, None, None) && made == (None, None, None);
        if is_usual && !self.one_kind {
            return Ok(STARTER.to_owned());
        }
        let usual = Start::default();
        let start = Start {
            sides: self.sides.unwrap_or(usual.sides),
            side: self.side.unwrap_or(usual.side),
            magnets: self.magnets.unwrap_or(usual.magnets),
            shape: self.shape.unwrap_or(usual.shape),
            magnet: self.magnet,
            thickness: self.thickness,
            material: self.material.unwrap_or(usual.material),
            one_kind: self.one_kind,
        };
        // A name without quotes.
        let plain = |c: &char| c.is_alphanumeric() || "-_. ".contains(*c);
        let name: String = stem.chars().filter(plain).collect();
        let name = name.trim_matches(|c| c == '-' || c == ' ');
        start.design(if name.is_empty() { "starter" } else { name })
    }
}
