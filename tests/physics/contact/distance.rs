//! The distance of outlines.

use parry2d_f64::math::{Pose, Vector};
use parry2d_f64::query;
use parry2d_f64::shape::{Compound, SharedShape};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::Design;
use tilebind::contact::Contact;
use tilebind::tile::Outline;
use tilebind::tile::outline::ConvexPart;

fn compound(outline: &Outline) -> Compound {
    let points = |part: &ConvexPart| part.points.iter().map(|p| Vector::new(p.x, p.y)).collect();
    let parts = outline.parts().iter();
    let shapes = parts.filter_map(|part| SharedShape::convex_polyline_unmodified(points(part)));
    Compound::new(shapes.map(|shape| (Pose::identity(), shape)).collect())
}

/// Two ways to one distance: our trees of edges and corners, and parry's convex parts.
#[test]
fn outlines_are_as_far_apart_as_their_convex_parts() {
    let mut rng = ChaCha8Rng::seed_from_u64(6);
    for shape in ["sine-teeth-20mm", "dovetail", "tab-20mm"] {
        let design = Design::load(format!("shapes/{shape}.toml").as_ref()).unwrap();
        let [fixed, moving] = [&design.pair.fixed, &design.pair.moving].map(|tile| &tile.outline);
        let contact = Contact::new(fixed, moving);
        let shapes = [fixed, moving].map(compound);
        let bond = design.pair.bound;
        let mut apart = 0;
        for _ in 0..400 {
            let mut random = |width: f64| rng.random_range(-width..width);
            let step = nalgebra::Vector3::new(0.03 + random(0.03), random(0.1), random(0.3));
            let q = bond.moved(step);
            let clearance = contact.clearance(&q);
            if clearance <= 0.0 {
                continue;
            }
            let pose = Pose::new(Vector::new(q.x, q.y), q.theta);
            let expected = query::distance(&Pose::identity(), &shapes[0], &pose, &shapes[1]);
            let expected = expected.unwrap().distance;
            assert!((clearance - expected).abs() < 1e-8, "{shape} {q:?}");
            apart += 1;
            let found = |[least, most]: [f64; 2]| contact.distance(&q, [least, most]);
            assert_eq!(found([0.0, 1.0]), clearance);
            assert_eq!(found([0.0, expected / 2.0]), expected / 2.0);
            let near = found([2.0 * expected, 1.0]);
            assert!((expected - 1e-8..=2.0 * expected).contains(&near));
        }
        assert!(apart > 40, "{shape}: {apart}");
    }
}
