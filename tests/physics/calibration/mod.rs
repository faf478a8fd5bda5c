//! Shields fitted to synthetic measurements with known parameters.

mod distances;
mod rows;

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::Vector2;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::Configuration;
use tilebind::calibration::{Calibration, CalibrationSettings, Measurement, Specimen, calibrate};
use tilebind::potential::shielding::{Shield, ShieldRule, Shields};
use tilebind::potential::{MagnetModel, Potential, ShieldedPotential};
use tilebind::tile::magnet::{Form, Shape, Standing};
use tilebind::tile::{Face, Magnet, Outline, Tile};

const TRUTH: Shield = Shield {
    attenuation: 0.7,
    length: 0.02,
    width: 0.4,
    front_gain: 1.15,
};

/// A square of 0.1 m with one magnet on each face.
fn tile(pole: f64) -> Tile {
    let half = 0.05;
    let corners = [[half, -half], [half, half], [-half, half], [-half, -half]]
        .map(|[x, y]| Vector2::new(x, y));
    let faces: Vec<Face> = (0..4)
        .map(|i| Face {
            name: i.to_string(),
            start: corners[i],
            end: corners[(i + 1) % 4],
        })
        .collect();
    let magnets = faces
        .iter()
        .enumerate()
        .map(|(face, frame)| Magnet {
            position: frame.point(0.0, -0.005),
            angle: face as f64 * FRAC_PI_2 + if pole > 0.0 { 0.0 } else { PI },
            moment: 0.3,
            size: [0.010, 0.010, 0.003],
            form: Default::default(),
            face,
        })
        .collect();
    Tile {
        outline: Outline::new(corners.to_vec()).unwrap(),
        faces,
        magnets,
        mass: 0.1,
        thickness: 0.01,
    }
}

/// Approximate magnitudes of energies (J), forces (N) and torques (N m) at the measured poses.
const SIZES: [f64; 4] = [1e-2, 1.0, 1.0, 1e-2];

/// Measurements computed by the model, 1.05 times as strong, with noise in units of the magnitudes.
fn measurements(noise: f64) -> Vec<Measurement> {
    measurements_with(noise, &[Some(TRUTH); 4])
}

/// The same, with shields on the given faces of the fixed tile.
fn measurements_with(noise: f64, fixed_shields: &[Option<Shield>; 4]) -> Vec<Measurement> {
    measurements_of(
        MagnetModel::Dipole,
        [&tile(1.0), &tile(-1.0)],
        noise,
        fixed_shields,
    )
}

fn measurements_of(
    model: MagnetModel,
    [fixed, moving]: [&Tile; 2],
    noise: f64,
    fixed_shields: &[Option<Shield>; 4],
) -> Vec<Measurement> {
    let bare = ShieldedPotential::new(model, fixed, moving, &Shields::default());
    let iron = bare.with_shields(&Shields {
        rule: ShieldRule::Smooth,
        fixed: fixed_shields.to_vec(),
        moving: vec![Some(TRUTH); 4],
    });
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    (0..150)
        .map(|i| {
            let configuration = Configuration::new(
                rng.random_range(0.115..0.15),
                rng.random_range(-0.06..0.06),
                rng.random_range(-0.3..0.3),
            );
            let mut row = Measurement {
                line: i + 2,
                configuration,
                iron: i % 3 != 0,
                measured: [None; 4],
            };
            let model = if row.iron { &iron } else { &bare };
            let (energy, gradient) = model.energy_and_gradient(&row.configuration);
            let values = [energy, -gradient.x, -gradient.y, -gradient.z];
            let mut noisy =
                |k: usize| Some(1.05 * values[k] + noise * SIZES[k] * rng.random_range(-1.0..1.0));
            row.measured = [noisy(0).filter(|_| i % 2 == 0), noisy(1), noisy(2), None];
            row
        })
        .collect()
}

fn fit(rows: &[Measurement]) -> Result<Calibration, String> {
    fit_with(rows, &Shields::default())
}

fn fit_with(rows: &[Measurement], shields: &Shields) -> Result<Calibration, String> {
    let specimen = Specimen {
        model: MagnetModel::Dipole,
        fixed: &tile(1.0),
        moving: &tile(-1.0),
        shields,
    };
    calibrate(&specimen, rows, &CalibrationSettings::default())
}

#[test]
fn the_constants_are_found_again() {
    let found = fit(&measurements(0.0)).unwrap();
    assert!(found.settled);
    assert!((found.strength - 1.05).abs() < 1e-12);
    assert!(
        (found.shield.attenuation - TRUTH.attenuation).abs() < 1e-4,
        "{found:?}"
    );
    assert!((found.shield.length - TRUTH.length).abs() < 1e-5);
    assert!((found.shield.width - TRUTH.width).abs() < 1e-4);
    assert!((found.shield.front_gain - TRUTH.front_gain).abs() < 1e-4);
    assert_eq!((found.held_out.rows, found.held_out.with_iron), (30, 20));
    assert!(found.held_out.relative[1].unwrap() < 1e-4);
}

#[test]
fn shields_behind_upright_discs_are_fitted() {
    let model = MagnetModel::Cuboid;
    let [fixed, moving] = [(1.0, Standing::Up), (-1.0, Standing::Down)].map(|(pole, up)| {
        let mut tile = tile(pole);
        for magnet in &mut tile.magnets {
            magnet.size = [0.008, 0.008, 0.004];
            magnet.form = Form {
                shape: Shape::Disc,
                stands: Some(up),
            };
        }
        tile
    });
    let rows = measurements_of(model, [&fixed, &moving], 0.0, &[Some(TRUTH); 4]);
    let specimen = Specimen {
        model,
        fixed: &fixed,
        moving: &moving,
        shields: &Shields::default(),
    };
    let found = calibrate(&specimen, &rows, &CalibrationSettings::default()).unwrap();
    assert!(found.settled && (found.strength - 1.05).abs() < 1e-9);
    assert!((found.shield.attenuation - TRUTH.attenuation).abs() < 1e-3);
    assert!((found.shield.length - TRUTH.length).abs() < 1e-4);
    assert!((found.shield.width - TRUTH.width).abs() < 1e-3);
    assert!((found.shield.front_gain - TRUTH.front_gain).abs() < 1e-3);
}

#[test]
fn only_the_faces_that_had_shields_are_fitted() {
    let present = [Some(TRUTH), None, Some(TRUTH), None];
    let rows = measurements_with(0.0, &present);
    // For any constants, because these are fitted.
    let some = Some(CalibrationSettings::default().start);
    let shields = Shields {
        rule: ShieldRule::Smooth,
        fixed: present.map(|shield| shield.and(some)).to_vec(),
        moving: vec![some; 4],
    };
    let found = fit_with(&rows, &shields).unwrap();
    assert!((found.shield.attenuation - TRUTH.attenuation).abs() < 1e-4);
    let wrong = fit(&rows).unwrap();
    assert!((wrong.shield.attenuation - TRUTH.attenuation).abs() > 1e-3);
}

#[test]
fn a_pose_at_which_the_tiles_overlap_is_refused_with_its_line() {
    let mut rows = measurements(0.0);
    rows[7].configuration = Configuration::new(0.09, 0.0, 0.0);
    let message = fit(&rows).unwrap_err();
    assert!(
        message.starts_with("line 9: the tiles overlap by 10.00 mm"),
        "{message}"
    );
}

#[test]
fn noise_shows_in_the_rows_held_out_and_the_errors_cover_the_truth() {
    let noise = 0.02;
    let found = fit(&measurements(noise)).unwrap();
    for residuals in [found.fitted, found.held_out] {
        for (k, size) in SIZES.iter().enumerate().take(3) {
            // The root mean square of even noise is its bound over sqrt(3).
            let ratio = residuals.rms[k].unwrap() / (noise * size / 3f64.sqrt());
            assert!(ratio > 0.6 && ratio < 1.6, "{ratio}");
        }
    }
    assert_eq!(found.held_out.rms[3], None);
    let shield = found.shield;
    let off = [
        shield.attenuation - TRUTH.attenuation,
        shield.length - TRUTH.length,
        shield.width - TRUTH.width,
        shield.front_gain - TRUTH.front_gain,
    ];
    for (off, error) in off.iter().zip(found.standard_errors) {
        assert!(off.abs() < 4.0 * error, "{off} {error}");
    }
}

#[test]
fn too_few_rows_are_refused() {
    let rows = measurements(0.0);
    assert!(fit(&rows[..2]).unwrap_err().contains("too few to fit"));
}
