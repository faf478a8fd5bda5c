//! The glue-up of tiles of several layers, seen from the side.

use std::fmt::Write;

use super::plain;
use jobs::workshop::Stack;

/// The drawing is this many times as large as the tile.
const SCALE: f64 = 4.0;
/// Width of a tile in the drawing, its left side, and the distance of two (mm).
const WIDE: f64 = 90.0;
const LEFT: f64 = 10.0;
const APART: f64 = 18.0;

/// The kinds of tiles with their names as SVG: their layers and a magnet.
pub(super) fn draw(stacks: &[(&str, &Stack)]) -> String {
    let mm = |length: f64| 1e3 * SCALE * length;
    let total = |stack: &Stack| mm(stack.layers.iter().map(|layer| layer.0).sum());
    let high = stacks.iter().map(|it| total(it.1) + APART).sum::<f64>() + 5.0;
    let wide = 2.0 * LEFT + WIDE + 60.0;
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{wide}mm\" height=\"{high:.3}mm\" \
         viewBox=\"0 0 {wide} {high:.3}\" font-family=\"sans-serif\" font-size=\"4\" \
         stroke-width=\"0.3\">\n"
    );
    let mut top = APART;
    for (name, stack) in stacks {
        let magnet = stack.magnet;
        let _ = writeln!(
            text,
            "<text x=\"{LEFT}\" y=\"{:.3}\">{name} from the side, {SCALE} : 1</text>",
            top - 4.0
        );
        let bottom = top + total(stack);
        let mut low = bottom;
        let mut cut: Option<[f64; 2]> = None;
        for (k, &(thick, is_cut)) in (1..).zip(&stack.layers) {
            let high = low - mm(thick);
            let (fill, what) = match is_cut {
                true => ("#F0DDBB", "pockets cut through"),
                false => ("#D9B777", "lid"),
            };
            let _ = writeln!(
                text,
                "<rect x=\"{LEFT}\" y=\"{high:.3}\" width=\"{WIDE}\" height=\"{:.3}\" \
                 fill=\"{fill}\" stroke=\"#000000\"/>\n<text x=\"{}\" y=\"{:.3}\" \
                 dominant-baseline=\"central\">layer {k}, {} mm: {what}</text>",
                low - high,
                LEFT + WIDE + 3.0,
                (low + high) / 2.0,
                plain(thick)
            );
            if is_cut {
                cut = Some([cut.map_or(low, |known| known[0]), high]);
            }
            low = high;
        }
        if let Some([low, high]) = cut.filter(|_| magnet > 0.0) {
            let middle = (low + high) / 2.0;
            let _ = writeln!(
                text,
                "<rect x=\"{:.3}\" y=\"{:.3}\" width=\"24\" height=\"{:.3}\" fill=\"#56B4E9\" \
                 stroke=\"#000000\"/>\n<text x=\"{:.3}\" y=\"{middle:.3}\" text-anchor=\"middle\" \
                 dominant-baseline=\"central\">magnet</text>",
                LEFT + 20.0,
                middle - mm(magnet) / 2.0,
                mm(magnet),
                LEFT + 32.0
            );
        }
        top = bottom + APART;
    }
    text + "</svg>\n"
}
