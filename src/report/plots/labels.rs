//! Labels placed so that they do not overlap.

use nalgebra::Vector2;
use ordered_float::OrderedFloat;
use physics::order::Order;
use plotters::style::{Color, WHITE};

use super::canvas::{Box4, Canvas, Pixel, middle};
use super::style::{Anchor, SOFT, Text};

/// Width and height (pixels) of a text with its background.
fn extent(font: Text, text: &str) -> (f64, f64) {
    (font.room(text) + 6.0, 1.25 * font.size + 2.0)
}

/// The point of a rectangle nearest to another point.
fn nearest((x, y): Pixel, [left, top, right, bottom]: Box4) -> Pixel {
    (x.clamp(left, right), y.clamp(top, bottom))
}

/// Connects a label to its anchor by a thin line, unless it is beside it.
fn join(canvas: &mut Canvas, anchor: Pixel, place: Box4) {
    let nearest = nearest(anchor, place);
    if libm::hypot(nearest.0 - anchor.0, nearest.1 - anchor.1) > 14.0 {
        canvas.line(&[anchor, nearest], WHITE.mix(0.7), 2.4);
        canvas.line(&[anchor, nearest], SOFT, 1.0);
    }
}

/// Writes a text on a pale background.
fn write(canvas: &mut Canvas, text: &str, font: Text, place: Box4) {
    canvas.block(place, WHITE.mix(0.85));
    canvas.write(font, text, middle(place), Anchor::Middle);
}

/// Spacing of labels in a column if there is room, relative to their height: connecting lines can
/// then be distinguished.
const AIR: f64 = 1.4;

/// Writes labels in a column along the left side of a frame, each as near as possible to the height
/// of its anchor.
pub fn label_column(
    canvas: &mut Canvas,
    font: Text,
    [left, top, _, bottom]: Box4,
    mut labels: Vec<(Pixel, String)>,
) {
    labels.order_by_key(|(anchor, _)| OrderedFloat(anchor.1));
    let (_, high) = extent(font, "");
    let mut heights: Vec<f64> = labels.iter().map(|(anchor, _)| anchor.1).collect();
    let room = (bottom - top - 2.0 * high) / labels.len().max(1) as f64;
    let step = (AIR * high).min(room).max(high + 1.0);
    spread(&mut heights, step, top + high, bottom - high);
    let place = |text: &str, height: f64| {
        let (width, _) = extent(font, text);
        let edge = left + 6.0;
        [edge, height - high / 2.0, edge + width, height + high / 2.0]
    };
    let placed = labels.iter().zip(heights);
    let placed = placed.map(|((anchor, text), height)| (*anchor, text, place(text, height)));
    let placed: Vec<_> = placed.collect();
    for (anchor, _, place) in &placed {
        join(canvas, *anchor, *place);
    }
    for (_, text, place) in &placed {
        write(canvas, text, font, *place);
    }
}

/// Moves ascending heights apart until they differ by `step` and lie between `low` and `high`, as
/// far as they fit.
fn spread(heights: &mut [f64], step: f64, low: f64, high: f64) {
    let count = heights.len();
    for _ in 0..200 {
        for i in 1..count {
            let overlap = step - (heights[i] - heights[i - 1]);
            if overlap > 0.0 {
                heights[i - 1] -= overlap / 2.0;
                heights[i] += overlap / 2.0;
            }
        }
        for (i, height) in heights.iter_mut().enumerate() {
            let (above, below) = (i as f64 * step, (count - 1 - i) as f64 * step);
            *height = height.min(high - below).max(low + above);
        }
    }
}

/// Places labels beside their anchors so that none covers another label or a marker.
pub struct Labels {
    within: Box4,
    taken: Vec<Box4>,
}

impl Labels {
    pub fn new(within: Box4) -> Self {
        Self {
            within,
            taken: Vec::new(),
        }
    }

    /// Keeps labels off a disc.
    pub fn keep_off(&mut self, (x, y): Pixel, radius: f64) {
        self.taken
            .push([x - radius, y - radius, x + radius, y + radius]);
    }

    /// Keeps labels off a line.
    pub fn keep_off_line(&mut self, points: &[Pixel]) {
        for pair in points.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            let steps = (libm::hypot(a.0 - b.0, a.1 - b.1) / 5.0).ceil().max(1.0);
            for k in 0..=steps as usize {
                let t = k as f64 / steps;
                self.keep_off((a.0 + (b.0 - a.0) * t, a.1 + (b.1 - a.1) * t), 2.0);
            }
        }
    }

    /// Writes `text` near `anchor`, connected by a thin line unless it is beside it. Omits it if
    /// there is no room nearby.
    pub fn place(
        &mut self,
        canvas: &mut Canvas,
        text: &str,
        font: Text,
        anchor: Pixel,
        outwards: Vector2<f64>,
    ) {
        let (width, height) = extent(font, text);
        if let Some(place) = self.free_place(anchor, width, height, outwards) {
            self.taken.push(place);
            self.keep_off_line(&[anchor, nearest(anchor, place)]);
            join(canvas, anchor, place);
            write(canvas, text, font, place);
        }
    }

    /// The nearest free position, preferring the direction `outwards`.
    fn free_place(
        &self,
        (x, y): Pixel,
        width: f64,
        height: f64,
        outwards: Vector2<f64>,
    ) -> Option<Box4> {
        let directions = 16;
        let mut candidates = Vec::new();
        for ring in 0..13 {
            for k in 0..directions {
                let angle = k as f64 * std::f64::consts::TAU / directions as f64;
                let (dx, dy) = (libm::cos(angle), libm::sin(angle));
                let away = 1.0 - (dx * outwards.x + dy * outwards.y);
                let reach = 11.0 + 16.0 * ring as f64;
                let place = self.moved_inside([
                    x + dx * (reach + width / 2.0) - width / 2.0,
                    y + dy * (reach + height / 2.0) - height / 2.0,
                    x + dx * (reach + width / 2.0) + width / 2.0,
                    y + dy * (reach + height / 2.0) + height / 2.0,
                ]);
                candidates.push((reach + 24.0 * away, place));
            }
        }
        candidates.order_by_key(|(distance, _)| OrderedFloat(*distance));
        candidates
            .into_iter()
            .map(|(_, place)| place)
            .find(|place| self.is_free(*place))
    }

    /// A rectangle moved into the frame, as far as it fits.
    fn moved_inside(&self, [left, top, right, bottom]: Box4) -> Box4 {
        let [l, t, r, b] = self.within;
        let dx = (l - left).max(0.0) - (right - r).max(0.0);
        let dy = (t - top).max(0.0) - (bottom - b).max(0.0);
        [left + dx, top + dy, right + dx, bottom + dy]
    }

    fn is_free(&self, [left, top, right, bottom]: Box4) -> bool {
        // Moving a rectangle inside the frame causes rounding errors.
        const ROUNDING: f64 = 1e-6;
        let [l, t, r, b] = self.within;
        let over = [l - left, t - top, right - r, bottom - b];
        let apart = |[l, t, r, b]: &Box4| right <= *l || *r <= left || bottom <= *t || *b <= top;
        over.iter().all(|o| *o <= ROUNDING) && self.taken.iter().all(apart)
    }
}

#[cfg(test)]
mod tests {
    use super::spread;

    #[test]
    fn spread_heights_keep_their_order_and_their_distance() {
        let mut heights = vec![10.0, 11.0, 12.0, 50.0, 99.0, 99.5];
        spread(&mut heights, 10.0, 0.0, 100.0);
        assert!(heights.windows(2).all(|w| w[1] - w[0] >= 10.0 - 1e-6));
        assert!(heights[0] >= 0.0 && heights[5] <= 100.0);
        assert!((heights[3] - 50.0).abs() < 1e-9);
    }
}
