//! Poses in which the tiles overlap slightly, because they were written with few digits.

use physics::configuration::Configuration;
use physics::landscape::constrained::settle;
use physics::observer::Observer;
use physics::problem::Problem;
use physics::tile::rounded_overlap;

/// The pose itself, or the nearest one in which the tiles touch, if they overlap by less than
/// [`rounded_overlap`] in it. The observer is warned of the change.
pub fn seated(problem: &Problem, q: &Configuration, observer: &dyn Observer) -> Configuration {
    let Some(pair) = &problem.pair else {
        return *q;
    };
    if problem.is_clear(q) {
        return *q;
    }
    let depth = -problem.clearance(q);
    if depth >= rounded_overlap([&pair.fixed, &pair.moving]) {
        return *q;
    }
    // At a corner the way out is longer than the overlap is deep.
    let Some(found) = settle(problem, q, 2.0 * depth) else {
        return *q;
    };
    // As few digits as can be used again: a picometre is less than what counts as touching.
    let [x, y, theta] = found
        .to_array()
        .map(|value| (1e12 * value).round() / 1e12 + 0.0);
    let short = Configuration::new(x, y, theta);
    let found = if problem.is_clear(&short) {
        short
    } else {
        found
    };
    let way = q.step_to(&found);
    observer.warn(&format!(
        "the tiles overlap by {:.3} um at the pose {},{},{}: it is moved out to contact, by {:.3} um and \
         {:.5} deg, to {},{},{}",
        1e6 * depth,
        q.x,
        q.y,
        q.theta,
        1e6 * way.xy().norm(),
        way.z.to_degrees().abs(),
        found.x,
        found.y,
        found.theta
    ));
    found
}
