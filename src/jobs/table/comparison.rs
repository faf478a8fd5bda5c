//! The predictions of other commands: of `tilebind bond` and `tilebind yield` for the same number of
//! tiles, of `tilebind assemble` for the same tile set.

use super::{About, Request, TableResult};
use crate::assembly::kinetic::Growth;
use crate::design::Design;
use crate::request::of_keywords;
use crate::yields::{self, YieldError, Yields};
use physics::observer::Observer;

/// Attachments that determine the rate to 20 %: a comparison with a wide interval cannot disagree.
const ENOUGH: usize = 100;

/// The corresponding request of `yield`: the same number of pairs, table area, time, drag,
/// restitution and friction. The scarcer kind of tile determines the number of pairs.
fn question(design: &Design, request: &Request, found: &TableResult) -> Option<yields::Request> {
    let kinds = found.ensemble.kinds();
    let count = |kind: usize| kinds.iter().filter(|it| **it == kind).count();
    let kinds_are_one = found.crowd.kinds.len() == 1;
    let pairs = match found.crowd.kinds.len() {
        1 => count(0) / 2,
        _ => count(0).min(count(1)),
    };
    let pairs = Some(pairs).filter(|pairs| *pairs > 0)?;
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
        // Chains and rings of equal tiles are known from simulations alone.
        (
            "simulations",
            if kinds_are_one { "1000" } else { "0" }.to_owned(),
        ),
        ("attachments", ENOUGH.to_string()),
        ("seed", request.seed.to_string()),
    ];
    let words = words.map(|(key, value)| (key.to_owned(), vec![value]));
    of_keywords(words).ok()
}

/// What another command predicts.
pub enum Prediction {
    /// For a design: the yield by detailed balance, with its request.
    Yield(Box<yields::Request>, Box<Yields>),
    /// For a tile set: growth from a seed, with a constant supply of tiles.
    Growth(Growth),
}

/// The prediction, or why there is none; `None` if it is not requested.
pub fn compared(
    (about, designs): (&About, &[Design]),
    request: &Request,
    found: &TableResult,
    progress: &dyn Observer,
) -> Option<Result<Prediction, YieldError>> {
    if !request.compare {
        return None;
    }
    if let Some(growth) = about.growth {
        return Some(Ok(Prediction::Growth(growth)));
    }
    let [design] = designs else { return None };
    let question = question(design, request, found)?;
    let answer = yields::yields(design, &question, progress);
    Some(answer.map(|yields| Prediction::Yield(Box::new(question), Box::new(yields))))
}
