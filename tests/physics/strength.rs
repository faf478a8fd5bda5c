//! The ways to specify the strength of a magnet.

use std::f64::consts::PI;

use nalgebra::Vector2;
use tilebind::Configuration;
use tilebind::potential::interaction::bare;
use tilebind::potential::{CuboidPotential, MagnetModel, Potential};
use tilebind::tile::Magnet;
use tilebind::tile::grade::{Grade, NEODYMIUM};
use tilebind::tile::magnet::{Form, Shape};
use tilebind::tile::strength::{Strength, pull, pull_spread, surface_field_share};
use tilebind::units::MU0;

/// The field at a point on the axis, summed over both pole faces cut into small charges.
fn summed_field(size: [f64; 3], above: f64) -> f64 {
    let [l, a, b] = size;
    let n = 800;
    let sheet = |z: f64| -> f64 {
        let mut sum = 0.0;
        for i in 0..n {
            for j in 0..n {
                let x = a * ((f64::from(i) + 0.5) / f64::from(n) - 0.5);
                let y = b * ((f64::from(j) + 0.5) / f64::from(n) - 0.5);
                sum += z / (x * x + y * y + z * z).powf(1.5);
            }
        }
        sum * a * b / f64::from(n * n) / (4.0 * PI)
    };
    sheet(above) - sheet(l + above)
}

#[test]
fn the_surface_field_is_the_limit_of_the_field_above_the_face() {
    for size in [
        [0.010, 0.010, 0.003],
        [0.003, 0.010, 0.010],
        [0.02, 0.01, 0.01],
    ] {
        // The field falls off linearly right above the face: extrapolate from two heights.
        let step = 2e-4;
        let (near, far) = (summed_field(size, step), summed_field(size, 2.0 * step));
        let surface = 2.0 * near - far;
        let share = surface_field_share(Shape::Block, size);
        assert!((surface / share - 1.0).abs() < 5e-3, "{surface} {share}");
    }
}

#[test]
fn the_surface_field_has_its_limits() {
    assert!((surface_field_share(Shape::Block, [1.0, 1e-4, 1e-4]) - 0.5).abs() < 1e-8);
    let (l, a, b) = (1e-6, 0.02, 0.01);
    let thin = 2.0 / PI * l * f64::hypot(1.0 / a, 1.0 / b);
    assert!((surface_field_share(Shape::Block, [l, a, b]) / thin - 1.0).abs() < 1e-6);
}

#[test]
fn the_three_ways_to_say_a_strength_agree() {
    let size = [0.010, 0.010, 0.003];
    let moment = Strength::Remanence(1.2).moment(Shape::Block, size);
    assert!((moment - 0.28648).abs() < 1e-5);
    assert_eq!(Strength::Moment(moment).moment(Shape::Block, size), moment);
    let field = 1.2 * surface_field_share(Shape::Block, size);
    let from_field = Strength::SurfaceField(field).moment(Shape::Block, size);
    assert!((from_field / moment - 1.0).abs() < 1e-14);
}

/// The force (N) of two equal blocks pole to pole: a block on its mirror image.
fn between_twins(size: [f64; 3], remanence: f64) -> f64 {
    let block = Magnet {
        form: Default::default(),
        position: Vector2::zeros(),
        angle: 0.0,
        moment: Strength::Remanence(remanence).moment(Shape::Block, size),
        size,
        face: 0,
    };
    let blocks = CuboidPotential::new(std::slice::from_ref(&block), std::slice::from_ref(&block));
    let touching = Configuration::new(size[0] * (1.0 + 1e-9), 0.0, 0.0);
    blocks.energy_and_gradient(&touching).1.x
}

#[test]
fn a_pull_is_the_force_of_a_block_on_its_image() {
    for size in [
        [0.010, 0.010, 0.003],
        [0.002, 0.010, 0.005],
        [0.0127, 0.0127, 0.0127],
        [0.001, 0.02, 0.01],
    ] {
        let expected = between_twins(size, 1.3);
        let found = pull(Shape::Block, size, 1.3);
        assert!((found / expected - 1.0).abs() < 2e-5, "{found} {expected}");
    }
}

/// A disc on its image: of a thin one nearly all of its own field is against it, of a long rod none; and the
/// force is the slope of two discs' energy.
#[test]
fn a_pull_of_a_disc_is_the_force_of_a_disc_on_its_image() {
    for [height, diameter] in [[0.003, 0.010], [0.010, 0.010], [0.0005, 0.02]] {
        let size = [height, diameter, diameter];
        let disc = Magnet {
            form: Form {
                shape: Shape::Disc,
                stands: None,
            },
            position: Vector2::zeros(),
            angle: 0.0,
            moment: Strength::Remanence(1.3).moment(Shape::Disc, size),
            size,
            face: 0,
        };
        let discs = bare(
            MagnetModel::Cuboid,
            std::slice::from_ref(&disc),
            std::slice::from_ref(&disc),
        );
        let touching = Configuration::new(height * (1.0 + 1e-9), 0.0, 0.0);
        let expected = discs.energy_and_gradient(&touching).1.x;
        let found = pull(Shape::Disc, size, 1.3);
        assert!((found / expected - 1.0).abs() < 1e-4, "{found} {expected}");
    }
    let rod = pull(Shape::Disc, [10.0, 0.01, 0.01], 1.2);
    let most = 1.2 * 1.2 * PI * 0.005 * 0.005 / (2.0 * MU0);
    assert!((rod / most - 1.0).abs() < 1e-4, "{rod} {most}");
    let share = surface_field_share(Shape::Disc, [1.0, 1e-4, 1e-4]);
    assert!((share - 0.5).abs() < 1e-8);
}

#[test]
fn a_pull_has_its_limits_and_scales() {
    // A long bar is attracted only by the pressure of its own field.
    let [a, b] = [0.01, 0.02];
    let most = 1.2 * 1.2 * a * b / (2.0 * MU0);
    assert!((pull(Shape::Block, [10.0, a, b], 1.2) / most - 1.0).abs() < 1e-4);
    // A thin plate's goes to nothing; sides are alike; areas count.
    assert!(pull(Shape::Block, [1e-6, a, b], 1.2) < 1e-3 * most);
    let [one, other] = [[0.003, a, b], [0.003, b, a]].map(|size| pull(Shape::Block, size, 1.2));
    assert!((one / other - 1.0).abs() < 1e-12);
    let doubled = pull(Shape::Block, [0.006, 2.0 * a, 2.0 * b], 2.4);
    assert!((doubled / one - 16.0).abs() < 1e-10);
}

/// N38 of a shop (dhit.pl): length, width, height (mm), magnetised through the last, and the stated
/// pull (N).
const SOLD: [([f64; 3], f64); 7] = [
    ([12.0, 10.0, 4.0], 33.88),
    ([40.0, 20.0, 10.0], 241.53),
    ([40.0, 10.0, 5.0], 116.27),
    ([42.0, 20.0, 5.0], 108.46),
    ([10.0, 5.0, 1.5], 8.47),
    ([10.0, 4.0, 1.5], 8.65),
    ([20.0, 10.0, 5.0], 60.31),
];

#[test]
fn what_a_shop_states_lies_within_the_spread() {
    let n38 = Grade::named("N38").unwrap();
    for ([a, b, l], stated) in SOLD {
        let size = [l, a, b].map(|x| x * 1e-3);
        let share = stated / pull(Shape::Block, size, n38.remanence[1]);
        let [least, most] = pull_spread(Shape::Block, size).range;
        assert!((least - 0.01..most + 0.01).contains(&share), "{share}");
        // The range of remanence from the pull contains the grade's remanence.
        let told =
            MU0 * Strength::Pull(stated).moment(Shape::Block, size) / size.iter().product::<f64>();
        let known = n38.remanence[1];
        let range = [told / most.sqrt() - 0.01, told / least.sqrt() + 0.01];
        assert!(range[0] < known && known < range[1], "{range:?}");
    }
}

#[test]
fn the_range_of_a_pull_contains_the_remanence_of_other_shapes() {
    const IN: f64 = 0.0254;
    const POUND: f64 = 4.448_222;
    // Quickfield's bar of N35 and its flat disc of N40, D82, a disc of N48 as high as wide.
    for (shape, [l, a, b], remanence, stated) in [
        (
            Shape::Block,
            [0.25 * IN, 1.5 * IN, 0.25 * IN],
            1.26,
            14.3 * POUND,
        ),
        (
            Shape::Disc,
            [IN / 32.0, 3.0 * IN / 16.0, 3.0 * IN / 16.0],
            1.28,
            2.49,
        ),
        (
            Shape::Disc,
            [IN / 8.0, IN / 2.0, IN / 2.0],
            1.32,
            6.44 * POUND,
        ),
        (Shape::Disc, [3e-3, 3e-3, 3e-3], 1.38, 0.7 * POUND),
    ] {
        let size = [l, a, b];
        let told = MU0 * Strength::Pull(stated).moment(shape, size) / shape.volume(size);
        let range = pull_spread(shape, size)
            .range
            .map(|share| told / share.sqrt());
        assert!(
            range[1] < remanence && remanence < range[0],
            "{range:?} {remanence}"
        );
    }
}

#[test]
fn a_pull_gives_the_remanence_that_it_was_made_of() {
    let size = [0.002, 0.010, 0.005];
    for grade in NEODYMIUM {
        let force = pull(Shape::Block, size, grade.remanence[1]);
        let nominal = Strength::Remanence(grade.remanence[1]);
        let [by_pull, nominal, by_grade] = [Strength::Pull(force), nominal, Strength::Grade(grade)]
            .map(|strength| strength.moment(Shape::Block, size));
        assert!((by_pull / nominal - 1.0).abs() < 1e-12);
        // A grade is taken at the working point: between that of a thin plate and of a long bar.
        let working = by_grade / nominal;
        assert!((1.0 / 1.05..1.0).contains(&working), "{working}");
    }
}

/// The demagnetising factor from the energy of both pole faces, cut into small charges: N = (W(0) - W(l))
/// / (2 pi V), W(d) the integral of 1 / R over two faces d apart.
fn summed_factor(shape: Shape, [l, a, b]: [f64; 3]) -> f64 {
    let n = 64;
    let mut charges = Vec::new();
    for i in 0..n {
        for j in 0..n {
            let x = (f64::from(i) + 0.5) / f64::from(n) - 0.5;
            let y = (f64::from(j) + 0.5) / f64::from(n) - 0.5;
            if shape == Shape::Block || x * x + y * y < 0.25 {
                charges.push(Vector2::new(a * x, b * y));
            }
        }
    }
    let area = shape.volume([1.0, a, b]) / charges.len() as f64;
    // The integral of 1 / R over a square of this area and itself.
    let own = 2.973_2 * area.powf(1.5);
    let mut sum = charges.len() as f64 * own;
    for (k, p) in charges.iter().enumerate() {
        for (m, q) in charges.iter().enumerate() {
            let square = (p - q).norm_squared();
            if k != m {
                sum += area * area / square.sqrt();
            }
            sum -= area * area / (square + l * l).sqrt();
        }
    }
    sum / (2.0 * PI * shape.volume([l, a, b]))
}

#[test]
fn demagnetising_factors_are_those_of_charged_faces_and_have_their_limits() {
    use tilebind::tile::demagnetising::{factor, working_point};
    for (shape, size) in [
        (Shape::Block, [0.01, 0.01, 0.01]),
        (Shape::Block, [0.004, 0.012, 0.006]),
        (Shape::Block, [0.02, 0.01, 0.005]),
        (Shape::Disc, [0.01, 0.01, 0.01]),
        (Shape::Disc, [0.003, 0.01, 0.01]),
    ] {
        let (exact, summed) = (factor(shape, size), summed_factor(shape, size));
        assert!(
            (exact - summed).abs() < 0.01,
            "{shape:?} {size:?}: {exact} {summed}"
        );
    }
    // A cube has a third along each axis, and the three of a block add up to 1.
    assert!((factor(Shape::Block, [1.0; 3]) - 1.0 / 3.0).abs() < 1e-9);
    let turned = [[1.0, 2.0, 5.0], [2.0, 5.0, 1.0], [5.0, 1.0, 2.0]];
    let sum: f64 = turned.iter().map(|size| factor(Shape::Block, *size)).sum();
    assert!((sum - 1.0).abs() < 1e-9, "{sum}");
    // Tabulated for a cylinder as high as wide (Chen, Brug and Goldfarb 1991): 0.3116.
    assert!((factor(Shape::Disc, [1.0; 3]) - 0.3116).abs() < 1e-4);
    for shape in [Shape::Block, Shape::Disc] {
        assert!(factor(shape, [1e-3, 1.0, 1.0]) > 0.99);
        assert!(factor(shape, [1e3, 1.0, 1.0]) < 1e-3);
        assert!(working_point(shape, [1e3, 1.0, 1.0]) > 0.9999);
    }
}
