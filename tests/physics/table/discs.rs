//! The energies of discs and of blocks where tiles move.

use super::*;
use tilebind::tile::magnet::Shape;

/// Discs and few blocks are interpolated where tiles move, within the error of the energy of their dipoles.
#[test]
fn magnets_in_motion_err_by_no_more_than_they_say() {
    for shape in [Shape::Disc, Shape::Block] {
        err_by_no_more_than_they_say(shape);
    }
}

fn err_by_no_more_than_they_say(shape: Shape) {
    let mut tiles = [square(0.044, "NN", &[0]), square(0.044, "SS", &[2])];
    for magnet in tiles.iter_mut().flat_map(|tile| &mut tile.magnets) {
        magnet.form.shape = shape;
        magnet.size = [3e-3, 6e-3, 6e-3];
        let inwards = Vector2::new(libm::cos(magnet.angle), libm::sin(magnet.angle));
        let out = inwards * inwards.dot(&magnet.position).signum();
        // 0.6 mm behind the surface, 11 mm apart.
        let along = Vector2::new(-out.y, out.x);
        let aside = along.dot(&magnet.position).signum() * 5.5e-3;
        magnet.position = out * (0.022 - 0.6e-3 - 1.5e-3) + along * aside;
        magnet.moment = 0.1;
    }
    let interaction = of(MagnetModel::Cuboid);
    let [first, second] = &tiles;
    let exact = interaction.between(first, second).potential;
    let error = 1e-5;
    let told = interaction.in_motion(error, first, second);
    let contact = Contact::new(&first.outline, &second.outline);
    let mut rng = stream(4);
    let mut even = |half: f64| half * (2.0 * rng.random::<f64>() - 1.0);
    // In the bond's gap of 1.2 mm, and anywhere near.
    let strongest = exact.energy(&Configuration::new(0.044, 0.0, 0.0)).abs();
    let (mut tried, mut worst) = (0, 0.0f64);
    while tried < 300 {
        let q = Configuration::new(0.05 + even(0.01), even(0.03), even(0.6));
        if !contact.is_free(&q) {
            continue;
        }
        tried += 1;
        let ((energy, slopes), (told, told_slopes)) =
            (exact.energy_and_gradient(&q), told.energy_and_gradient(&q));
        assert!(
            (energy - told).abs() < 1e-5 * strongest,
            "{q:?} {energy} {told}"
        );
        worst = worst.max((energy - told).abs());
        let off = (slopes - told_slopes).component_div(&Vector3::new(1.0, 1.0, 0.022));
        assert!(
            off.norm() < 1e-4 * strongest / 1.2e-3,
            "{q:?} {slopes} {told_slopes}"
        );
    }
    // Exact energies agree to 1e-9 or better.
    assert!(worst > 1e-8 * strongest, "{shape:?} is not interpolated");
}
