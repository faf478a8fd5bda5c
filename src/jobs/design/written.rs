//! Magnets in the notation of design files.

use physics::tile::magnet::{Form, Shape};

/// The lines of `[magnet]` for a magnet of a given form and size (m).
pub fn magnet(form: Form, [a, b, c]: [f64; 3]) -> String {
    let [height, width, depth] = match form.stands {
        Some(_) => [c, b, a],
        None => [a, b, c],
    };
    let size = match form.shape {
        Shape::Block => format!("size = [{height:?}, {width:?}, {depth:?}]\n"),
        Shape::Disc => {
            format!("shape = \"disc\"\ndiameter = {width:?}\nheight = {height:?}\n")
        }
    };
    match form.stands {
        Some(_) => size + "axis = \"up\"\n",
        None => size,
    }
}
