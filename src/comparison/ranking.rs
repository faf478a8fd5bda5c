//! Designs sorted by a figure, and which order is proved.

use super::{Assessment, Quantity};
use crate::landscape::certificate::{self, Ordering};

/// The designs' places in `assessments` from the best to the worst by a figure, larger being
/// better; those without the figure come last, equal ones in their order.
pub fn ranked(assessments: &[Assessment], by: &Quantity) -> Vec<usize> {
    let value = |index: usize| {
        let estimate = by.of(&assessments[index]);
        estimate.map_or(f64::NEG_INFINITY, |estimate| estimate.value)
    };
    let mut order: Vec<usize> = (0..assessments.len()).collect();
    order.sort_by(|&a, &b| value(b).total_cmp(&value(a)).then(a.cmp(&b)));
    order
}

/// Which of two designs is proved to have the higher figure: undecided where bounds overlap, are
/// not known, or the models of the magnets differ.
///
/// The bounds are those of the saddle; the energy of the state from which the climb is measured is
/// computed in double precision at the minimum that was found.
pub fn order(a: &Assessment, b: &Assessment, quantity: &Quantity) -> Ordering {
    let bounds = |assessment| {
        let estimate = quantity.of(assessment)?;
        Some((estimate.low?, estimate.high))
    };
    match (bounds(a), bounds(b)) {
        (Some(a_bounds), Some(b_bounds)) if a.model == b.model => {
            certificate::order(a_bounds, b_bounds)
        }
        _ => Ordering::Undecided,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::comparison::quantity::QUANTITIES;
    use crate::comparison::{Bond, Way};
    use crate::landscape::SaddleBounds;

    fn design(model: &str, energy: f64, way_out: Way) -> Assessment {
        Assessment {
            name: String::new(),
            sha256: String::new(),
            drawings: Vec::new(),
            model: model.into(),
            seed: 1,
            target_energy: energy,
            bond: Some(Bond {
                pose: [0.0; 3],
                energy,
                way_out,
                capture_range: None,
            }),
            trap_kinds: 0,
            deepest_trap: None,
            far_starts: 0,
            captured: 0,
            uncaptured: 0,
            barriers_checked: None,
            contradictions: Vec::new(),
            overestimates: Vec::new(),
        }
    }

    fn way(lower: f64, upper: f64) -> Way {
        Way {
            saddle: Some(upper),
            bounds: SaddleBounds {
                lower: Some(lower),
                upper: Some(upper),
                caged: false,
            },
        }
    }

    fn unbinding_and_binding() -> [&'static Quantity; 2] {
        let named = |key| QUANTITIES.iter().find(|one| one.key == key).unwrap();
        ["unbinding", "binding"].map(named)
    }

    #[test]
    fn the_climb_is_measured_from_the_state() {
        let [unbinding, binding] = unbinding_and_binding();
        // The same saddle, from depths 3 and 1: climbs of 3 to 3.5 and of 1 to 1.5.
        let deep = design("dipole", -3.0, way(0.0, 0.5));
        let shallow = design("dipole", -1.0, way(0.0, 0.5));
        assert_eq!(order(&deep, &shallow, unbinding), Ordering::Higher);
        assert_eq!(order(&shallow, &deep, unbinding), Ordering::Lower);
        assert_eq!(order(&deep, &shallow, binding), Ordering::Undecided);
        let blocks = design("cuboid", -1.0, way(0.0, 0.5));
        assert_eq!(order(&deep, &blocks, unbinding), Ordering::Undecided);
        let unknown = design("dipole", -1.0, Way::default());
        assert_eq!(order(&deep, &unknown, unbinding), Ordering::Undecided);
        assert_eq!(ranked(&[shallow, unknown, deep], unbinding), [2, 0, 1]);
    }

    #[test]
    fn a_cage_is_higher_than_any_barrier_with_a_way_over_it() {
        let [_, binding] = unbinding_and_binding();
        let mut caged = Way::default();
        caged.bounds.caged = true;
        let cage = design("dipole", -1.0, caged);
        let open = design("dipole", -1.0, way(0.0, 0.5));
        assert_eq!(order(&cage, &open, binding), Ordering::Higher);
        assert_eq!(order(&cage, &cage, binding), Ordering::Undecided);
        assert_eq!(ranked(&[open, cage], binding), [1, 0]);
    }
}
