//! Options that say where docking runs start.

use clap::Args;
use tilebind::dynamics::docking::Starts;
use tilebind::request;

/// Ranges from which starts are drawn.
#[derive(Args)]
pub struct StartOptions {
    /// Distance between the tiles' reference points at the start, LOW,HIGH (m) [default: 0.62,1]
    #[arg(long, value_name = "LOW,HIGH", value_parser = range)]
    distance: Option<[f64; 2]>,

    /// Its direction differs from the target face's by at most this (rad) [default: 0.7854]
    #[arg(long, value_name = "RAD", value_parser = request::not_negative)]
    direction: Option<f64>,

    /// Orientation differs from the bound one by at most this (rad) [default: 1.5]
    #[arg(long, value_name = "RAD", value_parser = request::not_negative)]
    orientation: Option<f64>,

    /// Speed at the start, LOW,HIGH (m/s) [default: 0,1.3]
    #[arg(long, value_name = "LOW,HIGH", value_parser = range)]
    speed: Option<[f64; 2]>,

    /// The velocity's direction differs from that to the fixed tile by at most this (rad)
    /// [default: 0.3]
    #[arg(long, value_name = "RAD", value_parser = request::not_negative)]
    aim: Option<f64>,

    /// Turning rate at the start, either way, at most this (rad/s) [default: 0]
    #[arg(long, value_name = "RATE", value_parser = request::not_negative)]
    spin: Option<f64>,
}

impl StartOptions {
    /// The distribution asked for; what was not is as in `default`.
    pub fn starts(&self, default: Starts) -> Starts {
        Starts {
            distance: self.distance.unwrap_or(default.distance),
            direction: self.direction.unwrap_or(default.direction),
            orientation: self.orientation.unwrap_or(default.orientation),
            speed: self.speed.unwrap_or(default.speed),
            aim: self.aim.unwrap_or(default.aim),
            spin: self.spin.unwrap_or(default.spin),
        }
    }
}

/// A range as `LOW,HIGH`, neither negative.
fn range(text: &str) -> Result<[f64; 2], String> {
    const FORM: &str = "a range is LOW,HIGH with 0 <= LOW <= HIGH, such as 0.4,0.8";
    let ends = text.split_once(',').ok_or(FORM)?;
    let [low, high] = [ends.0, ends.1].map(|end| request::not_negative(end.trim()));
    match (low, high) {
        (Ok(low), Ok(high)) if low <= high => Ok([low, high]),
        _ => Err(FORM.to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges() {
        assert_eq!(range("0, 1.3"), Ok([0.0, 1.3]));
        for wrong in ["", "1", "1,0", "-1,1", "a,b", "0,1,2", "0,inf"] {
            assert!(range(wrong).is_err(), "{wrong}");
        }
    }
}
