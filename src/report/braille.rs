//! Line drawings as text: eight dots in each character.

use nalgebra::Vector2;

/// Dots of a character across and down.
const CELL: [usize; 2] = [2, 4];
/// The first of the characters of dots.
const BLANK: u32 = 0x2800;
/// Bits of the dots, row by row.
const DOTS: [[u32; 2]; 4] = [[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]];

/// A drawing under construction, in metres, y upwards.
#[derive(Debug, Default)]
pub struct Braille {
    polygons: Vec<Vec<Vector2<f64>>>,
    letters: Vec<(Vector2<f64>, char)>,
}

impl Braille {
    /// Draws a closed line.
    pub fn polygon(&mut self, corners: &[Vector2<f64>]) {
        self.polygons.push(corners.to_vec());
    }

    /// Puts a letter over the lines.
    pub fn letter(&mut self, at: Vector2<f64>, letter: char) {
        self.letters.push((at, letter));
    }

    /// The drawing, at most the given number of characters wide and about half as many lines high,
    /// since terminal characters are twice as high as wide.
    pub fn text(&self, columns: usize) -> String {
        let points = || self.polygons.iter().flatten();
        let bound = |axis: usize, fold: fn(f64, f64) -> f64, start: f64| {
            points().map(|p| p[axis]).fold(start, fold)
        };
        let low = [0, 1].map(|axis| bound(axis, f64::min, f64::INFINITY));
        let high = [0, 1].map(|axis| bound(axis, f64::max, f64::NEG_INFINITY));
        let size = [high[0] - low[0], high[1] - low[1]];
        if !(size[0] > 0.0 && size[1] > 0.0) {
            return String::new();
        }
        let dots = [
            (columns * CELL[0] - 1) as f64,
            (columns / 3 * CELL[1] - 1) as f64,
        ];
        let scale = (dots[0] / size[0]).min(dots[1] / size[1]);
        let dot = |p: &Vector2<f64>| {
            let [x, y] = [(p.x - low[0]) * scale, (high[1] - p.y) * scale];
            [x.round().max(0.0) as usize, y.round().max(0.0) as usize]
        };
        let cells = [0, 1].map(|k| (size[k] * scale).round() as usize / CELL[k] + 1);
        let mut bits = vec![vec![0_u32; cells[0]]; cells[1]];
        let mut set = |[x, y]: [usize; 2]| {
            let cell = bits
                .get_mut(y / CELL[1])
                .and_then(|row| row.get_mut(x / CELL[0]));
            if let Some(cell) = cell {
                *cell |= DOTS[y % CELL[1]][x % CELL[0]];
            }
        };
        for polygon in &self.polygons {
            for (a, b) in polygon.iter().zip(polygon.iter().cycle().skip(1)) {
                let steps = ((b - a).norm() * scale * 2.0).ceil().max(1.0);
                for k in 0..=steps as usize {
                    set(dot(&(a + (b - a) * (k as f64 / steps))));
                }
            }
        }
        let character = |bits: &u32| match bits {
            0 => ' ',
            _ => char::from_u32(BLANK + bits).unwrap_or(' '),
        };
        let mut rows: Vec<Vec<char>> = bits
            .iter()
            .map(|row| row.iter().map(character).collect())
            .collect();
        for (at, letter) in &self.letters {
            let [x, y] = dot(at);
            let cell = rows
                .get_mut(y / CELL[1])
                .and_then(|row| row.get_mut(x / CELL[0]));
            if let Some(cell) = cell {
                *cell = *letter;
            }
        }
        let line = |row: &Vec<char>| format!("{}\n", String::from_iter(row).trim_end());
        rows.iter().map(line).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rectangle_has_its_corners_and_its_letter() {
        let mut drawing = Braille::default();
        let corners = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [0.0, 1.0]].map(Vector2::from);
        drawing.polygon(&corners);
        drawing.letter(Vector2::new(1.5, 0.5), 'N');
        let text = drawing.text(20);
        let lines: Vec<&str> = text.lines().collect();
        assert!(
            lines.iter().all(|line| line.chars().count() <= 20),
            "{text}"
        );
        assert!(
            lines[0].starts_with('\u{284f}') && lines[0].ends_with('\u{28b9}'),
            "{text}"
        );
        assert_eq!(text.matches('N').count(), 1);
        assert_eq!(Braille::default().text(20), "");
    }
}
