//! What new tiles are made of.

use crate::design::units::density;

/// A material by its density.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Its name; empty for a density.
    pub name: &'static str,
    /// kg/m^3.
    pub density: f64,
}

/// Materials with usual densities (kg/m^3), as makers of sheets and filaments state them.
const MATERIALS: [(&str, f64); 12] = [
    ("plywood", 600.0),
    ("mdf", 750.0),
    ("wood", 500.0),
    ("cardboard", 700.0),
    ("foam", 40.0),
    ("acrylic", 1190.0),
    ("polycarbonate", 1200.0),
    ("pla", 1240.0),
    ("petg", 1270.0),
    ("abs", 1050.0),
    ("polyamide", 1010.0),
    ("aluminium", 2700.0),
];

/// Densities (kg/m^3) from foam to brass.
const POSSIBLE: std::ops::RangeInclusive<f64> = 20.0..=9e3;

impl Material {
    /// The material of new designs unless another one is named.
    pub const USUAL: Self = Self {
        name: MATERIALS[0].0,
        density: MATERIALS[0].1,
    };

    /// Reads a name, or a density (kg/m^3, or with a unit).
    ///
    /// # Errors
    /// If it is neither.
    pub fn parse(text: &str) -> Result<Self, String> {
        let word = text.trim().to_lowercase();
        let known = MATERIALS.iter().find(|(name, _)| *name == word);
        let known = known.map(|&(name, density)| Self { name, density });
        let stated = || {
            let density = density(text).filter(|it| POSSIBLE.contains(it))?;
            Some(Self { name: "", density })
        };
        known.or_else(stated).ok_or_else(|| {
            let names = MATERIALS.map(|(name, _)| name).join(", ");
            format!("a material is one of {names}, or a density such as \"0.6 g/cm3\"")
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn materials_and_densities_are_read() {
        assert_eq!(Material::parse("Acrylic").unwrap().density, 1190.0);
        assert_eq!(Material::parse("0.68 g/cm3").unwrap().density, 680.0);
        assert_eq!(Material::parse("1100").unwrap().density, 1100.0);
        assert!(Material::parse("cheese").is_err() && Material::parse("0.6").is_err());
    }
}
