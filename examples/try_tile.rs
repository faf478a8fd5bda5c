use nalgebra::Vector2;
use tilebind::potential::*;
use tilebind::tile::*;
use tilebind::*;
fn tile(code: &str) -> Tile {
    let h = 0.215;
    let v = |x: f64, y: f64| Vector2::new(x, y);
    let o = Outline::new(vec![v(h, -h), v(h, h), v(-h, h), v(-h, -h)]).unwrap();
    let vs = o.vertices().to_vec();
    let mut faces = vec![];
    let mut magnets = vec![];
    for i in 0..4 {
        let f = Face {
            name: format!("{i}"),
            start: vs[i],
            end: vs[(i + 1) % 4],
        };
        for (k, c) in code.chars().enumerate() {
            let n = f.normal();
            let a = n.y.atan2(n.x) + if c == 'N' { 0.0 } else { std::f64::consts::PI };
            magnets.push(Magnet {
                position: f.point((k as f64 - 1.5) * 0.04, -0.005),
                angle: a,
                moment: 1.2 * 3e-7 / tilebind::units::MU0,
                size: [0.01, 0.01, 0.003],
                face: i,
            });
        }
        faces.push(f);
    }
    Tile {
        outline: o,
        faces,
        magnets,
        mass: 0.1,
        thickness: 0.013,
    }
}
pub fn paper() -> Problem {
    let a = tile("NNNS");
    let b = tile("NSSS");
    let space = ConfigurationSpace {
        half_size: [1.0, 1.0],
        rho: b.radius_of_gyration(),
        free_distance: a.outline.circumradius() + b.outline.circumradius(),
    };
    let p = Problem::of_tiles(
        space,
        &a,
        &b,
        Box::new(DipolePotential::new(&a.magnets, &b.magnets)),
    );

    p
}
