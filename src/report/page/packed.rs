//! A grid of energies in compact form.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::Serialize;

use super::numbers::fixed;
use crate::packing::deflated;
use crate::plots::scale::EnergyScale;
use physics::landscape::volume::Volume;

/// Steps between the two ends of the energy scale. Half a step is a 0.06 % change of an energy far
/// from zero.
const STEPS: f64 = 8192.0;

/// Energies as positions on the energy scale, in 16 bits each.
///
/// `data` contains, zlib-deflated and in base64, one number per grid point: 0 if the configuration
/// is not free, otherwise 1 plus the position's step. Each is the difference (modulo 2^16) from its
/// prediction, left + below - below left within its plane, and all low bytes come before all high
/// ones: smooth fields then deflate to about a byte a point.
#[derive(Clone, Debug, Serialize)]
pub struct Packed {
    /// Values of the coordinates (m, rad), the slowest first.
    axes: [Vec<f64>; 3],
    steps: f64,
    data: String,
}

impl Packed {
    pub fn new(volume: &Volume, scale: &EnergyScale) -> Self {
        let [_, rows, columns] = [0, 1, 2].map(|k| volume.axes[k].len());
        let steps: Vec<u16> = volume.energies.iter().map(|u| step(*u, scale)).collect();
        let differences = differences(&steps, rows, columns);
        let low = differences.iter().map(|d| d.to_le_bytes()[0]);
        let high = differences.iter().map(|d| d.to_le_bytes()[1]);
        let bytes: Vec<u8> = low.chain(high).collect();
        Self {
            axes: volume
                .axes
                .clone()
                .map(|axis| axis.into_iter().map(fixed).collect()),
            steps: STEPS,
            data: STANDARD.encode(deflated(&bytes)),
        }
    }
}

fn step(energy: Option<f64>, scale: &EnergyScale) -> u16 {
    match energy {
        None => 0,
        Some(energy) => 1 + ((scale.position(energy) + 1.0) / 2.0 * STEPS).round() as u16,
    }
}

fn differences(values: &[u16], rows: usize, columns: usize) -> Vec<u16> {
    (0..values.len())
        .map(|i| {
            let (row, column) = (i / columns % rows, i % columns);
            let before = |back: usize, known: bool| if known { values[i - back] } else { 0 };
            let left = before(1, column > 0);
            let below = before(columns, row > 0);
            let corner = before(columns + 1, column > 0 && row > 0);
            let predicted = left.wrapping_add(below).wrapping_sub(corner);
            values[i].wrapping_sub(predicted)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read;

    #[test]
    fn a_volume_comes_back_as_the_page_reads_it() {
        let axes = [
            vec![0.0, 1.0],
            vec![0.0, 0.5, 1.0],
            vec![0.0, 0.2, 0.4, 0.6],
        ];
        let energies: Vec<Option<f64>> = (0..24)
            .map(|i| (i % 7 != 3).then_some(-0.01 * (i as f64 - 11.0)))
            .collect();
        let scale = EnergyScale::holding([0.13]);
        let volume = Volume { axes, energies };
        let packed = Packed::new(&volume, &scale);
        let mut bytes = Vec::new();
        flate2::read::ZlibDecoder::new(&STANDARD.decode(&packed.data).unwrap()[..])
            .read_to_end(&mut bytes)
            .unwrap();
        let mut values = [0u16; 24];
        for i in 0..24 {
            let known = |back: usize, known: bool| if known { values[i - back] } else { 0 };
            let (row, column) = (i / 4 % 3, i % 4);
            let predicted = known(1, column > 0)
                .wrapping_add(known(4, row > 0))
                .wrapping_sub(known(5, column > 0 && row > 0));
            let difference = u16::from_le_bytes([bytes[i], bytes[24 + i]]);
            values[i] = predicted.wrapping_add(difference);
        }
        for (value, energy) in values.iter().zip(&volume.energies) {
            match energy {
                None => assert_eq!(*value, 0),
                Some(energy) => {
                    let position = f64::from(value - 1) / STEPS * 2.0 - 1.0;
                    assert!((position - scale.position(*energy)).abs() <= 1.0 / STEPS);
                }
            }
        }
    }
}
