//! The JSON Schema of the design file, and a design to start from.
//!
//! The schema is for editors: it describes the keys, their types, units and limits. Mistakes that
//! depend on geometry, such as overlapping tiles, are found only by
//! [`Design::load`](super::Design::load).

/// The JSON Schema (draft 2020-12) of the design file.
pub const SCHEMA: &str = include_str!("schema.json");

/// A commented design to start from.
pub const STARTER: &str = include_str!("starter.toml");

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use serde_json::{Value, json};

    use super::super::face::FACE_KEYS;
    use super::super::magnet::{ListedMagnet, MAGNET_KEYS};
    use super::super::quantity::{self, Quantity};
    use super::super::shield::CONSTANTS;
    use super::super::svg::{OUTLINE_KEYS, UNITS};
    use super::super::tile::TILE_KEYS;
    use super::super::{MagnetModel, ROOT_KEYS, TABLE_KEYS, profile, target};
    use super::*;
    use physics::potential::shielding::ShieldRule;

    fn schema() -> Value {
        serde_json::from_str(SCHEMA).unwrap()
    }

    #[track_caller]
    fn assert_keys(object: &Value, known: &[&str]) {
        let mut said: Vec<&str> = object["properties"]
            .as_object()
            .unwrap()
            .keys()
            .map(String::as_str)
            .collect();
        let mut known = known.to_vec();
        said.sort_unstable();
        known.sort_unstable();
        assert_eq!(said, known);
        assert_eq!(object["additionalProperties"], false);
    }

    #[test]
    fn it_has_every_key_that_is_read_and_no_other() {
        let schema = schema();
        let of = |name: &str| &schema["$defs"][name];
        assert_keys(&schema, &ROOT_KEYS);
        assert_keys(of("table"), &TABLE_KEYS);
        assert_keys(of("magnet"), &MAGNET_KEYS);
        assert_keys(of("listed_magnet"), &ListedMagnet::keys());
        assert_keys(of("tile"), &TILE_KEYS);
        assert_keys(of("face"), &FACE_KEYS);
        assert_keys(of("faces"), &["all", "east", "north", "west", "south"]);
        assert_keys(of("target"), &target::KEYS);
        assert_keys(of("outline"), &OUTLINE_KEYS);
        assert_keys(of("potential"), &["model"]);
        let mut constants = CONSTANTS.map(|(name, _)| name).to_vec();
        assert_keys(of("own_shield"), &constants);
        constants.push("rule");
        assert_keys(of("shield"), &constants);
    }

    #[test]
    fn it_has_every_profile_with_its_keys() {
        let schema = schema();
        let definitions = &schema["$defs"];
        let mut keys_of_all = BTreeSet::new();
        let mut conditions = vec![json!({ "$ref": "#/$defs/profile_keys" })];
        for (shape, keys, _) in profile::SHAPES {
            let of_shape = &definitions[shape];
            assert_keys(of_shape, keys);
            assert_eq!(of_shape["properties"]["shape"]["const"], shape);
            keys_of_all.extend(keys.iter().copied());
            conditions.push(json!({
                "if": { "properties": { "shape": { "const": shape } }, "required": ["shape"] },
                "then": { "$ref": format!("#/$defs/{shape}") },
            }));
        }
        assert_eq!(definitions["profile"]["allOf"], json!(conditions));
        let offered = &definitions["profile_keys"]["properties"];
        let shapes: Vec<_> = profile::SHAPES.iter().map(|shape| shape.0).collect();
        assert_eq!(offered["shape"]["enum"], json!(shapes));
        let offered = offered.as_object().unwrap().keys().map(String::as_str);
        assert_eq!(offered.collect::<BTreeSet<_>>(), keys_of_all);
    }

    #[test]
    fn it_has_every_unit_of_a_drawing() {
        let units = UNITS.map(|(name, _)| name);
        let schema = schema();
        assert_eq!(
            schema["$defs"]["drawing_unit"]["anyOf"][0]["enum"],
            serde_json::json!(units)
        );
    }

    #[test]
    fn it_has_every_model_and_rule() {
        let names = MagnetModel::NAMES.map(|(name, _)| name);
        let schema = schema();
        let model = &schema["$defs"]["potential"]["properties"]["model"];
        assert_eq!(model["enum"], serde_json::json!(names));
        assert_eq!(model["default"], MagnetModel::default().name());
        let rules = ShieldRule::NAMES.map(|(name, _)| name);
        let rule = &schema["$defs"]["shield"]["properties"]["rule"];
        assert_eq!(rule["enum"], serde_json::json!(rules));
        assert_eq!(rule["default"], ShieldRule::default().name());
    }

    /// The reader accepts each limit of the schema, and rejects values just beyond it.
    #[test]
    fn its_limits_are_those_of_the_reader() {
        let schema = schema();
        let quantities: [(&str, Quantity); 25] = [
            ("drawing_unit_length", quantity::DRAWING_UNIT),
            ("drawing_dpi", quantity::DPI),
            ("tile_side", quantity::TILE_SIDE),
            ("tile_corner", quantity::TILE_CORNER),
            ("tile_thickness", quantity::TILE_THICKNESS),
            ("mass", quantity::MASS),
            ("table_size", quantity::TABLE_SIZE),
            ("magnet_size", quantity::MAGNET_SIZE),
            ("remanence", quantity::REMANENCE),
            ("moment", quantity::MOMENT),
            ("surface_field", quantity::SURFACE_FIELD),
            ("pull", quantity::PULL),
            ("pitch", quantity::PITCH),
            ("inset", quantity::INSET),
            ("axis", quantity::AXIS),
            ("fit", quantity::FIT),
            ("along_face", quantity::ALONG_FACE),
            ("profile_width", quantity::PROFILE_WIDTH),
            ("profile_depth", quantity::PROFILE_DEPTH),
            ("draft", quantity::DRAFT),
            ("offset", quantity::ALONG_FACE),
            ("attenuation", quantity::ATTENUATION),
            ("shield_length", quantity::SHIELD_LENGTH),
            ("shield_width", quantity::SHIELD_WIDTH),
            ("front_gain", quantity::FRONT_GAIN),
        ];
        for (name, quantity) in quantities {
            let mut limits = &schema["$defs"][name];
            if let Some(path) = limits["$ref"].as_str() {
                limits = schema.pointer(path.trim_start_matches('#')).unwrap();
            }
            for (bound, outwards) in [("minimum", -1.0), ("maximum", 1.0)] {
                let limit = limits[bound].as_f64().unwrap();
                let beyond = limit + outwards * 1e-9 * limit.abs().max(1e-3);
                assert!(quantity.check(name, limit).is_ok(), "{name} {bound}");
                assert!(quantity.check(name, beyond).is_err(), "{name} {bound}");
            }
            let units: Vec<_> = quantity
                .unit_names()
                .map(|n| n.replace('^', "\\^"))
                .collect();
            let end = format!(" *({}) *$", units.join("|"));
            let pattern = limits["pattern"].as_str().unwrap();
            // A magnet's axis can also be a word.
            let pattern = match name {
                "axis" => pattern.strip_prefix("^up$|").unwrap(),
                _ => pattern,
            };
            assert!(pattern.ends_with(&end), "{name}: {pattern} and {end}");
        }
    }
}
