//! Absence of a way out, proved; and a way out, found.

use nalgebra::Vector2;
use tilebind::configuration::Configuration;
use tilebind::landscape::minimax::{CertifyError, End, Ordering};
use tilebind::potential::MagnetModel;
use tilebind::tile::{Magnet, Outline, Tile};

use super::scene::{Scene, effort};

/// A tab in a slot of the same shape with `play` (m) all around, its sides leaning outwards by
/// `undercut` (rad).
fn tab_in_slot(undercut: f64, play: f64) -> Scene {
    let (half, side, depth) = (0.05, 0.2, 0.05);
    let wide = half + depth * undercut.tan();
    let across = play / undercut.cos();
    let base = half - across + play * undercut.tan();
    let tile = |points: &[[f64; 2]], x: f64| Tile {
        outline: Outline::new(points.iter().map(|p| Vector2::new(p[0], p[1])).collect()).unwrap(),
        faces: Vec::new(),
        magnets: [-0.15, 0.15]
            .map(|y| Magnet {
                position: Vector2::new(x, y),
                angle: 0.0,
                moment: 0.28,
                size: [0.01, 0.01, 0.003],
                form: Default::default(),
                face: 0,
            })
            .to_vec(),
        mass: 0.1,
        thickness: 0.01,
    };
    let slot = [
        [-side, -side],
        [side, -side],
        [side, -half],
        [side - depth, -wide],
        [side - depth, wide],
        [side, half],
        [side, side],
        [-side, side],
    ];
    let tab = [
        [-side, -side],
        [side, -side],
        [side, side],
        [-side, side],
        [-side, base],
        [-side - depth + play, wide - across],
        [-side - depth + play, across - wide],
        [-side, -base],
    ];
    Scene::new(
        tile(&slot, 0.19),
        tile(&tab, -0.19),
        [0.8, 0.8],
        MagnetModel::Dipole,
    )
}

const MATED: Configuration = Configuration::new(0.4, 0.0, 0.0);

#[test]
fn a_dovetail_is_a_cage() {
    for play in [0.0005, 0.002, 0.005] {
        let scene = tab_in_slot(0.3, play);
        let bracket = scene.bracket(&MATED, &End::Free, &effort(1e-6, 300_000));
        assert!(bracket.bounds.caged, "{play}: {bracket:?}");
        assert_eq!(bracket.bounds.upper, None);
        assert_eq!(bracket.bounds.least(), f64::INFINITY);
        let open = tab_in_slot(-0.1, play);
        let way = open.bracket(&MATED, &End::Free, &effort(1e-6, 300_000));
        assert!(
            !way.bounds.caged && way.bounds.width() <= 1e-6,
            "{play}: {way:?}"
        );
        assert_eq!(bracket.bounds.compare(&way.bounds), Ordering::Higher);
    }
}

#[test]
fn the_shipped_dovetail_is_a_cage() {
    let (scene, design) = Scene::shipped("dovetail", MagnetModel::Dipole);
    let bracket = scene.bracket(&design.pair.bound, &End::Free, &effort(1e-6, 500_000));
    assert!(bracket.bounds.caged, "{bracket:?}");
}

#[test]
fn a_path_inside_the_cage_is_found_all_the_same() {
    let scene = tab_in_slot(0.3, 0.005);
    let to = Configuration::new(0.403, 0.002, 0.01);
    let bracket = scene.bracket(&MATED, &End::At(to), &effort(1e-6, 100_000));
    assert!(
        !bracket.bounds.caged && bracket.bounds.width() <= 1e-6,
        "{bracket:?}"
    );
}

#[test]
fn ends_that_cannot_be_are_refused() {
    let scene = tab_in_slot(0.3, 0.001);
    let inside = Configuration::new(0.3, 0.0, 0.0);
    let outside = Configuration::new(0.81, 0.0, 0.0);
    let effort = effort(1e-6, 1000);
    let mut certifier = scene.certifier();
    let mut refused =
        |from: &Configuration, to: &End| certifier.bracket(from, to, &[], &effort).unwrap_err();
    assert_eq!(refused(&inside, &End::Free), CertifyError::NotFree(inside));
    assert_eq!(
        refused(&MATED, &End::At(inside)),
        CertifyError::NotFree(inside)
    );
    assert_eq!(
        refused(&outside, &End::Free),
        CertifyError::OffTheTable(outside)
    );
}

#[test]
fn a_known_way_through_teeth_without_play_is_proved() {
    let (scene, _) = Scene::shipped("square-teeth-10mm", MagnetModel::Dipole);
    // Near a corner not all contacts within a millimetre can be kept open at the same time.
    let way = [
        [0.442_172_083_65, -0.099_267_659_5, -0.059_647_714_86],
        [0.442_028_926_19, -0.098_645_085_5, -0.054_911_044_75],
        [0.442_208_163_97, -0.097_307_981_0, -0.049_412_396_56],
    ]
    .map(|[x, y, theta]| Configuration::new(x, y, theta));
    let (to, effort) = (End::At(way[2]), effort(1e-5, 1000));
    let bracket = scene.certifier().bracket(&way[0], &to, &way, &effort);
    assert!(bracket.unwrap().bounds.upper.is_some());
}
