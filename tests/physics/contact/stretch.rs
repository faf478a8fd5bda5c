//! The intervals of a line in which tiles are free.

use nalgebra::Vector2;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::{Configuration, Design};

/// Tiles are free inside every stretch and not free between them, and even obstacles that the line
/// enters and leaves within a millimetre are found.
#[test]
fn stretches_are_where_tiles_are_free() {
    let mut rng = ChaCha8Rng::seed_from_u64(9);
    let mut narrow = 0;
    for design in ["sine-teeth-20mm", "dovetail", "hexagon", "drawn-wave"] {
        let design = Design::load(format!("shapes/{design}.toml").as_ref()).expect("a design");
        let problem = design.problem();
        let contact = problem.contact.as_ref().expect("tiles have outlines");
        let reach = 1.05 * (contact.fixed().circumradius() + contact.moving().circumradius());
        for _ in 0..1000 {
            let mut random = |most: f64| rng.random_range(-most..most);
            let q = Configuration::new(random(reach), random(reach), random(3.2));
            let towards = random(3.2);
            let direction = Vector2::new(libm::cos(towards), libm::sin(towards));
            let length = 0.5 * reach;
            let at =
                |t: f64| Configuration::new(q.x + t * direction.x, q.y + t * direction.y, q.theta);
            let free = contact.free_stretches(&q, direction, length);
            let ends: Vec<f64> = free.iter().flatten().copied().collect();
            assert!(ends.is_sorted());
            for (k, gap) in [&[0.0], &ends[..], &[length]]
                .concat()
                .windows(2)
                .enumerate()
            {
                narrow += usize::from(gap[1] - gap[0] < 1e-3 && gap[1] > gap[0]);
                for part in [0.01, 0.3, 0.5, 0.9, 0.99] {
                    let t = gap[0] + part * (gap[1] - gap[0]);
                    // Rounding is all that may differ within a hair of an end.
                    let hair = (t - gap[0]).min(gap[1] - t) < 1e-12;
                    let is_free = contact.is_free(&at(t));
                    assert!(
                        hair || is_free == (k % 2 == 1),
                        "{q:?} {towards} {t} {ends:?}"
                    );
                }
            }
        }
    }
    assert!(narrow > 0);
}
