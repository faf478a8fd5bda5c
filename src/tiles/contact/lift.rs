//! Moves a tile along a straight line until it is clear of the other tile, or touches it.

use nalgebra::Vector2;

use super::Contact;
use crate::configuration::Configuration;
use crate::order::Order;
use crate::tile::outline::cross;

/// Number of touching translations tried before the tile is moved out completely.
const TRIED: usize = 4;

impl Contact {
    /// A translation t >= 0 (m) along the unit vector `direction` that brings `q` into contact and
    /// leaves it free; 0 if it is already free.
    ///
    /// The outlines can touch where a vertex of one meets an edge of the other. The nearest of
    /// these translations are tried, so that pockets are found; if none of them is free, the last
    /// one is taken, beyond which nothing is in the way.
    pub fn lift(&self, q: &Configuration, direction: Vector2<f64>) -> f64 {
        if self.is_free(q) {
            return 0.0;
        }
        let mut touching = self.touching_translations(q, direction);
        touching.retain(|t| *t > 0.0);
        touching.order_by(f64::total_cmp);
        touching.dedup_by(|a, b| *a - *b < self.touch());
        let at = |t: f64| Configuration::new(q.x + direction.x * t, q.y + direction.y * t, q.theta);
        let pocket = touching.iter().take(TRIED).find(|t| self.is_free(&at(**t)));
        pocket.or(touching.last()).copied().unwrap_or(0.0)
    }

    /// The translation t (m) along the unit vector `direction` at which the moving tile, coming
    /// from infinity against it, first touches the other; `None` if it passes by.
    pub fn landing(&self, q: &Configuration, direction: Vector2<f64>) -> Option<f64> {
        let touching = self.touching_translations(q, direction);
        touching.into_iter().max_by(f64::total_cmp)
    }

    /// The intervals of translations t (m) within `range` along the unit vector `direction` that
    /// leave `q` free, ascending. Freedom changes only where a vertex meets an edge, so one test
    /// between two such translations suffices; if the tiles overlap deeply there, translations that
    /// cannot undo the overlap are skipped.
    pub fn free_translations(
        &self,
        q: &Configuration,
        direction: Vector2<f64>,
        range: [f64; 2],
    ) -> Vec<[f64; 2]> {
        let mut ends = self.touching_translations(q, direction);
        ends.retain(|t| range[0] < *t && *t < range[1]);
        ends.extend(range);
        ends.order_by(f64::total_cmp);
        ends.dedup_by(|a, b| *a - *b < self.touch());
        let mut free: Vec<[f64; 2]> = Vec::new();
        let mut blocked_down_to = f64::INFINITY;
        // From far away towards the other tile.
        for pair in ends.windows(2).rev() {
            let [low, high] = [pair[0], pair[1]];
            // An interval blocked at one point is blocked throughout.
            if high > blocked_down_to {
                continue;
            }
            let middle = (low + high) / 2.0;
            let x = q.x + direction.x * middle;
            let y = q.y + direction.y * middle;
            let there = Configuration::new(x, y, q.theta);
            if !self.is_free(&there) {
                blocked_down_to = middle - self.overlap_depth(&there) + 2.0 * self.touch();
                continue;
            }
            match free.last_mut() {
                Some(above) if above[0] <= high => above[0] = low,
                _ => free.push([low, high]),
            }
        }
        free.reverse();
        free
    }

    /// All translations t along a direction at which a vertex meets an edge.
    fn touching_translations(&self, q: &Configuration, direction: Vector2<f64>) -> Vec<f64> {
        let rotation = q.rotation();
        let seen = |p: &Vector2<f64>| [cross(direction, *p), direction.dot(p)];
        let moving: Vec<[f64; 2]> = self
            .moving()
            .vertices()
            .iter()
            .map(|v| seen(&(q.position() + rotation * v)))
            .collect();
        let fixed: Vec<[f64; 2]> = self.fixed().vertices().iter().map(seen).collect();
        let mut found = Vec::new();
        // (lateral position, height) of vertices, and of edges that span the lateral position.
        let sideways = |of: &[[f64; 2]]| {
            let mut sorted = of.to_vec();
            sorted.order_by(|a, b| a[0].total_cmp(&b[0]));
            sorted
        };
        meet(&sideways(&moving), &fixed, |vertex, edge| {
            found.push(edge - vertex);
        });
        meet(&sideways(&fixed), &moving, |vertex, edge| {
            found.push(vertex - edge);
        });
        found
    }
}

/// Calls `found(height of vertex, height of edge)` for each vertex and each edge of another polygon
/// at the same lateral position. The vertices come in the order of their lateral positions.
fn meet(vertices: &[[f64; 2]], polygon: &[[f64; 2]], mut found: impl FnMut(f64, f64)) {
    for (i, a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        let (low, high) = (a[0].min(b[0]), a[0].max(b[0]));
        let first = vertices.partition_point(|vertex| vertex[0] < low);
        let beside = vertices[first..].iter().take_while(|v| v[0] <= high);
        for [lateral, height] in beside {
            if high > low {
                let share = (lateral - a[0]) / (b[0] - a[0]);
                found(*height, a[1] + (b[1] - a[1]) * share);
            } else {
                found(*height, a[1]);
                found(*height, b[1]);
            }
        }
    }
}
