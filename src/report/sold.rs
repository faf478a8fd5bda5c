//! Magnets specified by a shop's grade or pull, and the uncertainty of that specification.

use serde_json::{Value, json};

use physics::tile::Magnet;
use physics::tile::demagnetising::MEASURED;
use physics::tile::magnet::Shape;
use physics::tile::strength::{Strength, pull_spread};
use physics::units::to_digits;

/// The meaning and the uncertainty of a shop's grade or pull.
pub fn describe((strength, magnet): &(Strength, Magnet)) -> String {
    let size = magnet.axis_first();
    let block = match magnet.form.shape {
        Shape::Block => format!(
            "magnets {} mm, magnetised through {} mm",
            size.map(|x| four(x * 1e3)).join(" x "),
            four(size[0] * 1e3)
        ),
        Shape::Disc => format!(
            "disc magnets {} mm across and {} mm high, magnetised through their height",
            four(size[1] * 1e3),
            four(size[0] * 1e3)
        ),
    };
    match strength {
        Strength::Grade(grade) => {
            let [least, usual, most] = grade.remanence;
            let [low, high] = grade.energy_range().map(|factor| 100.0 * (factor - 1.0));
            let [weakest, strongest] = MEASURED.map(|share| share * usual);
            format!(
                "{block}, {}: remanence {usual:.2} T ({least:.2} to {most:.2} T by manufacturers' \
                 data: energies {low:+.0} to {high:+.0} %), {:.3} T at the working point of the \
                 magnet by itself; measured magnets reach {weakest:.2} to {strongest:.2} T, so measure \
                 yours: tilebind calibrate --gaps",
                grade.name,
                magnet.remanence(),
            )
        }
        Strength::Pull(force) => {
            let found = magnet.remanence();
            let [low, high] = pulled_range(magnet);
            let spread = pull_spread(magnet.form.shape, size);
            format!(
                "{block}, with a pull of {} on thick steel: remanence {} T for ideal magnet and \
                 plate; sellers' values for {} are {} to {} of ideal, so it may be {} to {} T",
                crate::tiles::force(*force),
                three(found),
                spread.name,
                spread.range[0],
                spread.range[1],
                three(low),
                three(high),
            )
        }
        _ => String::new(),
    }
}

/// The range of a magnet's remanence (T) derived from a shop's pull, which is proportional to its square.
fn pulled_range(magnet: &Magnet) -> [f64; 2] {
    let [least, most] = pull_spread(magnet.form.shape, magnet.axis_first()).range;
    [most, least].map(|share| magnet.remanence() / share.sqrt())
}

/// A number to four significant digits, without trailing zeros.
fn four(value: f64) -> String {
    to_digits(value, 4).to_string()
}

fn three(value: f64) -> String {
    to_digits(value, 3).to_string()
}

/// Magnets specified by a grade or a pull.
pub fn entry((strength, magnet): &(Strength, Magnet)) -> Value {
    let found = magnet.remanence();
    let mut entry = json!({ "size_m": magnet.axis_first(), "remanence_T": found });
    match strength {
        Strength::Grade(grade) => {
            let [least, usual, most] = grade.remanence;
            entry["grade"] = json!(grade.name);
            entry["nominal_remanence_T"] = json!(usual);
            entry["remanence_range_T"] = json!([least, most]);
            entry["measured_range_T"] = json!(MEASURED.map(|share| share * usual));
        }
        Strength::Pull(force) => {
            entry["pull_N"] = json!(force);
            entry["remanence_range_T"] = json!(pulled_range(magnet));
        }
        _ => {}
    }
    entry
}
