//! Tiles of several layers: which are cut through for the magnets, and which are lids.

use super::error::PartError;

/// Share of the tile's thickness by which the sum of its layers may differ.
const CLOSE: f64 = 0.05;

/// The layers of a tile.
#[derive(Clone, Debug, PartialEq)]
pub struct Stack {
    /// Thickness of each layer (m), lowest first, and whether the pockets are cut through it.
    pub layers: Vec<(f64, bool)>,
    /// Thickness of the thickest magnet (m).
    pub magnet: f64,
    /// Height (m) left in the pockets above the magnets' thickness.
    pub play: f64,
    /// How far (m) the middle of the pockets is above the middle of the tile.
    pub raised: f64,
}

impl Stack {
    /// The layers of a tile, both thicknesses in m: the fewest adjacent layers as thick as the
    /// magnets are cut through, as near to the tile's middle as possible.
    ///
    /// # Errors
    /// If the layers do not add up to the tile, or the magnets are thicker than it.
    pub fn new(layers: &[f64], tile: f64, magnet: f64) -> Result<Self, PartError> {
        let total: f64 = layers.iter().sum();
        let mm = |length: f64| (length * 1e5).round() / 100.0;
        if (total - tile).abs() > CLOSE * tile {
            return Err(PartError::Layers(format!(
                "the layers are {} mm thick together, but the tile is {} mm: change --layers, or \
                 `thickness` in the design",
                mm(total),
                mm(tile)
            )));
        }
        let n = layers.len();
        let below = |k: usize| layers[..k].iter().sum::<f64>();
        let runs = (0..n).flat_map(|from| (from + 1..=n).map(move |to| (from, to)));
        let holds = |&(from, to): &(usize, usize)| below(to) - below(from) >= magnet - 1e-6;
        let away = |&(from, to): &(usize, usize)| ((below(from) + below(to) - total) / 2.0).abs();
        let best = runs.filter(holds).min_by(|a, b| {
            let layers = (a.1 - a.0).cmp(&(b.1 - b.0));
            layers.then(away(a).total_cmp(&away(b)))
        });
        let Some((from, to)) = best else {
            return Err(PartError::Layers(format!(
                "the magnets are {} mm thick, {} mm more than the layers together: add a layer and \
                 raise `thickness`, or use thinner magnets",
                mm(magnet),
                mm(magnet - total)
            )));
        };
        Ok(Self {
            layers: (layers.iter().enumerate())
                .map(|(k, &thick)| (thick, (from..to).contains(&k)))
                .collect(),
            magnet,
            play: below(to) - below(from) - magnet,
            raised: (below(from) + below(to) - total) / 2.0,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fewest_layers_in_the_middle_hold_the_magnets() {
        let cut = |layers: &[f64], magnet: f64| {
            let tile = layers.iter().sum();
            let stack = Stack::new(layers, tile, magnet)?;
            Ok::<_, PartError>(stack.layers.iter().map(|it| it.1).collect::<Vec<_>>())
        };
        assert_eq!(cut(&[4.0, 4.0], 5.0).unwrap(), [true, true]);
        assert_eq!(cut(&[3.0, 5.0, 3.0], 5.0).unwrap(), [false, true, false]);
        assert_eq!(
            cut(&[2.0, 3.0, 3.0, 2.0], 5.0).unwrap(),
            [false, true, true, false]
        );
        assert_eq!(cut(&[1.0, 6.0], 5.0).unwrap(), [false, true]);
        assert!(cut(&[4.0, 4.0], 9.0).is_err());
        assert!(Stack::new(&[4.0, 3.0], 8.0, 2.0).is_err());
        let stack = Stack::new(&[1.0, 6.0], 7.0, 5.0).unwrap();
        assert_eq!((stack.play, stack.raised), (1.0, 0.5));
    }
}
