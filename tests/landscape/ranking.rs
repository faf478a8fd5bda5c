//! Rankings of designs, with proved and unproved order.

use tilebind::comparison::quantity::QUANTITIES;
use tilebind::comparison::ranking::{order, ranked};
use tilebind::comparison::{Assessment, Bond, Quantity, WayOut};
use tilebind::landscape::SaddleBounds;
use tilebind::landscape::minimax::Ordering;

fn design(model: &str, energy: f64, way_out: WayOut) -> Assessment {
    Assessment {
        name: String::new(),
        sha256: String::new(),
        drawings: Vec::new(),
        model: model.into(),
        magnets: String::new(),
        seed: 1,
        target_energy: energy,
        bond: Some(Bond {
            pose: [0.0; 3],
            energy,
            way_out,
            capture_range: None,
        }),
        trap_kinds: 0,
        robust: None,
        unlisted_above: None,
        deepest_trap: None,
        far_starts: 0,
        captured: 0,
        uncaptured: 0,
        barriers_checked: None,
        contradictions: Vec::new(),
        overestimates: Vec::new(),
    }
}

fn way(lower: f64, upper: f64) -> WayOut {
    WayOut {
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
    let unknown = design("dipole", -1.0, WayOut::default());
    assert_eq!(order(&deep, &unknown, unbinding), Ordering::Undecided);
    assert_eq!(ranked(&[shallow, unknown, deep], unbinding), [2, 0, 1]);
}

#[test]
fn a_cage_is_higher_than_any_barrier_with_a_way_over_it() {
    let [_, binding] = unbinding_and_binding();
    let mut caged = WayOut::default();
    caged.bounds.caged = true;
    let cage = design("dipole", -1.0, caged);
    let open = design("dipole", -1.0, way(0.0, 0.5));
    assert_eq!(order(&cage, &open, binding), Ordering::Higher);
    assert_eq!(order(&cage, &cage, binding), Ordering::Undecided);
    assert_eq!(ranked(&[open, cage], binding), [1, 0]);
}
