use nalgebra::{Vector2, Vector3};

use super::face::{Face, Shape};
use super::near::integral;
use crate::potential::cuboid::quadrature::gauss_legendre;

const DISC: Shape = Shape::Disc(0.8);
const BOX: Shape = Shape::Rectangle([0.7, 0.4]);

fn points(face: &Face) -> Vec<(Vector3<f64>, f64)> {
    let [x, w] = gauss_legendre::<24>();
    let mut all = Vec::new();
    let mut add = |a: f64, b: f64, weight: f64| {
        all.push((face.centre + face.frame[0] * a + face.frame[1] * b, weight));
    };
    for i in 0..24 {
        match face.shape {
            Shape::Disc(radius) => {
                let r = radius * (x[i] + 1.0) / 2.0;
                for k in 0..64 {
                    let (sin, cos) = libm::sincos(f64::from(k) / 64.0 * std::f64::consts::TAU);
                    add(
                        r * cos,
                        r * sin,
                        w[i] / 2.0 * radius * r * std::f64::consts::TAU / 64.0,
                    );
                }
            }
            Shape::Rectangle([a, b]) => {
                for k in 0..24 {
                    add(a * x[i], b * x[k], a * b * w[i] * w[k]);
                }
            }
        }
    }
    all
}

fn summed(first: &Face, second: &Face) -> f64 {
    let second = points(second);
    points(first)
        .iter()
        .map(|(p, v)| {
            second
                .iter()
                .map(|(q, w)| v * w / (p - q).norm())
                .sum::<f64>()
        })
        .sum()
}

#[test]
fn agrees_with_sums() {
    let other = |upright: bool, shape, [x, y, angle]: [f64; 3], height| {
        let centre = Vector2::new(x, y);
        let (sin, cos) = libm::sincos(angle);
        let along = Vector2::new(cos, sin);
        if upright {
            Face::upright(centre, along, shape)
        } else {
            Face::flat(centre, along, height, shape)
        }
    };
    for (upright, a, b) in [
        (true, Shape::Disc(1.0), DISC),
        (true, Shape::Disc(1.0), BOX),
        (true, BOX, DISC),
        (false, Shape::Disc(1.0), DISC),
        (false, Shape::Disc(1.0), BOX),
        (false, BOX, DISC),
        (false, Shape::Rectangle([1.0, 0.6]), BOX),
    ] {
        let poses: Vec<[f64; 3]> = if upright {
            vec![
                [0.5, 0.2, 0.2],
                [0.9, 0.9, 1.4],
                [0.05, 0.2, 0.02],
                [0.001, 0.1, 0.0],
                [-0.85, 0.5, 1.5],
                [20.0, 2.0, 2.0],
                [0.0, 1.8, 0.0],
                [1e-5, 0.0, 0.0],
            ]
        } else {
            vec![
                [1.9, 0.2, 0.2],
                [1.9, 1.1, 1.4],
                [1.82, 0.0, 0.0],
                [0.0, -1.9, 0.1],
                [20.0, 2.0, 2.0],
                [1.7, 0.0, 0.0],
                [1.7, 1.0, 0.0],
            ]
        };
        for (pose, height) in poses.iter().flat_map(|p| [0.0, 0.3].map(|h| (*p, h))) {
            if upright && height > 0.0 {
                continue;
            }
            let first = other(upright, a, [0.0; 3], 0.0);
            let of = |pose| integral(&first, &other(upright, b, pose, height));
            let i = of(pose);
            let back = integral(&other(upright, b, pose, height), &first).value;
            let brute = summed(&first, &other(upright, b, pose, height));
            let e = 1e-5;
            let mut d = [0.0; 3];
            for k in 0..3 {
                let (mut up, mut down) = (pose, pose);
                up[k] += e;
                down[k] -= e;
                d[k] = (of(up).value - of(down).value) / (2.0 * e);
            }
            let g = [i.gradient.x - d[0], i.gradient.y - d[1], i.slope - d[2]];
            println!(
                "{upright} {a:?} {b:?} {pose:?} {height}: {:.12} swapped {:.1e} summed {:.1e} slopes {:.0e} {:.0e} {:.0e}",
                i.value,
                back / i.value - 1.0,
                brute / i.value - 1.0,
                g[0],
                g[1],
                g[2]
            );
        }
    }
}
