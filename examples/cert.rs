use nalgebra::Vector2;
use std::f64::consts::PI;
use std::time::{Duration, Instant};
use tilebind::configuration::{Configuration, ConfigurationSpace};
use tilebind::contact::Contact;
use tilebind::landscape::certificate::*;
use tilebind::potential::bounds::DipoleBounds;
use tilebind::tile::{Magnet, Outline, Tile};

fn square_tile(code: [f64; 4]) -> Tile {
    let half = 0.215;
    let corners = [[-half, -half], [half, -half], [half, half], [-half, half]];
    let mut magnets = Vec::new();
    for face in 0..4 {
        let angle = face as f64 * PI / 2.0;
        let normal = Vector2::new(angle.cos(), angle.sin());
        let tangent = Vector2::new(-angle.sin(), angle.cos());
        for (k, sign) in code.iter().enumerate() {
            magnets.push(Magnet {
                position: normal * (half - 0.005) + tangent * ((k as f64 - 1.5) * 0.04),
                angle: if *sign > 0.0 { angle } else { angle + PI },
                moment: 1.2 * 3e-7 / tilebind::units::MU0,
                size: [0.01, 0.01, 0.003],
                face,
            });
        }
    }
    Tile {
        outline: Outline::new(corners.map(|c| Vector2::new(c[0], c[1])).to_vec()).unwrap(),
        faces: Vec::new(),
        magnets,
        mass: 0.1,
        thickness: 0.013,
    }
}

fn main() {
    let args: Vec<f64> = std::env::args()
        .skip(1)
        .map(|a| a.parse().unwrap())
        .collect();
    let (a, b) = (
        square_tile([1.0, 1.0, 1.0, -1.0]),
        square_tile([1.0, -1.0, -1.0, -1.0]),
    );
    let bounds = DipoleBounds::new(&a, &b);
    let contact = Contact::new(&a.outline, &b.outline);
    let space = ConfigurationSpace {
        half_size: [1.0, 1.0],
        rho: b.radius_of_gyration(),
        free_distance: 0.85,
    };
    let depth = 65.47e-3;
    let start = Instant::now();
    let mut certifier = Certifier::new(&bounds, Some(&contact), &space);
    println!("first {:?}", start.elapsed());
    let bound = End::At(Configuration::new(0.43, 0.0, 0.0));
    let limit = args[1];
    let queries = [
        ("slid+ -> bound", Configuration::new(0.43, 0.04, 0.0), bound),
        (
            "slid+ -> free",
            Configuration::new(0.43, 0.04, 0.0),
            End::Free,
        ),
        (
            "slid- -> bound",
            Configuration::new(0.43, -0.04, 0.0),
            bound,
        ),
        (
            "flush+.14 -> free",
            Configuration::new(0.43, 0.14, 0.0),
            End::Free,
        ),
        (
            "flush+.1003 -> bound",
            Configuration::new(0.43, 0.1003, 0.0),
            bound,
        ),
        (
            "bound -> free",
            Configuration::new(0.43, 0.0, 0.0),
            End::Free,
        ),
    ];
    let pick = if args.len() > 2 {
        vec![args[2] as usize]
    } else {
        (0..queries.len()).collect()
    };
    for k in pick {
        let (name, from, to) = queries[k];
        let start = Instant::now();
        let effort = Effort {
            tolerance: args[0] * depth,
            cells: 10_000_000,
            time: Some(Duration::from_secs_f64(limit)),
        };
        match certifier.bracket(&from, &to, &[], &effort) {
            Ok(b) => println!(
                "{name}: [{:.5}, {:.5}] mJ width {:.4}% caged {} cells {} rounds {} points {} saddle {:?} {:.2?}",
                b.lower * 1e3,
                b.upper.unwrap_or(f64::NAN) * 1e3,
                b.width() / depth * 100.0,
                b.caged,
                b.cells,
                b.rounds,
                b.pathway.len(),
                b.saddle,
                start.elapsed()
            ),
            Err(e) => println!("{name}: {e}"),
        }
    }
}
