//! The predictions of `tilebind bond` and `tilebind yield` for the same number of tiles.

use super::{Found, Request};
use crate::design::Design;
use crate::request::of_keywords;
use crate::yields::{Question, YieldError, Yields, yields};
use physics::observer::Observer;

/// The corresponding request of `yield`: the same number of pairs, table area, time, drag,
/// restitution and friction. The scarcer kind of tile determines the number of pairs.
fn question(design: &Design, request: &Request, found: &Found) -> Option<Question> {
    let counts = [0, 1].map(|kind| found.kinds.iter().filter(|it| **it == kind).count());
    let pairs = counts.into_iter().min().filter(|pairs| *pairs > 0)?;
    let area = design.pair.moving.outline.area();
    let table = found.crowd.area();
    let words = [
        ("tiles", (2 * pairs).to_string()),
        ("time", request.time.to_string()),
        ("kt", request.shaking?.to_string()),
        ("coverage", (2.0 * pairs as f64 * area / table).to_string()),
        ("drag", request.motion.drag.to_string()),
        (
            "restitution",
            request.motion.contact.restitution.to_string(),
        ),
        ("friction", request.motion.contact.friction.to_string()),
        ("simulations", "0".to_owned()),
        ("seed", request.seed.to_string()),
    ];
    let words = words.map(|(key, value)| (key.to_owned(), vec![value]));
    of_keywords(words).ok()
}

/// The yield by detailed balance, or why it cannot be computed; `None` if it is not requested.
pub fn compared(
    designs: &[Design],
    request: &Request,
    found: &Found,
    progress: &dyn Observer,
) -> Option<Result<(Question, Yields), YieldError>> {
    let [design] = designs else { return None };
    let question = question(design, request, found).filter(|_| request.compare)?;
    let answer = yields(design, &question, progress);
    Some(answer.map(|yields| (question, yields)))
}
