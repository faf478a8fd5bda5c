//! The bounds of energies over cells against the energy in plain interval arithmetic, which shares
//! no code with the bounds: a true energy outside its bounds is a finding.

use physics::Configuration;
use physics::cell::Cell;
use physics::contact::Contact;
use physics::potential::CellBounds;
use physics::potential::bounds::{CuboidBounds, DipoleBounds};
use physics::tile::{Magnet, Outline, Tile};

use super::truth;

/// Half a tile's side (m).
const HALF: f64 = 0.1;

/// Numbers from the fuzzer's bytes; zeros when these are used up.
struct Numbers<'a>(&'a [u8]);

impl Numbers<'_> {
    /// Between -1 and 1.
    fn next(&mut self) -> f64 {
        let (bytes, rest) = self.0.split_at(self.0.len().min(2));
        self.0 = rest;
        let read = |k: usize| bytes.get(k).copied().unwrap_or(0);
        f64::from(i16::from_le_bytes([read(0), read(1)])) / 32768.0
    }

    /// One of the first whole numbers.
    fn below(&mut self, count: usize) -> usize {
        ((self.next() + 1.0) / 2.0 * count as f64) as usize
    }
}

/// A square tile with up to three magnets, most of them behind the side that lies in a direction of
/// the x axis.
fn tile(numbers: &mut Numbers, side: f64) -> Tile {
    let corners = [[-HALF, -HALF], [HALF, -HALF], [HALF, HALF], [-HALF, HALF]];
    let magnets = (0..1 + numbers.below(3)).map(|k| {
        let size = [
            [0.010, 0.010, 0.003],
            [0.006, 0.016, 0.003],
            [0.012, 0.005, 0.006],
        ];
        let size = size[numbers.below(3)];
        let angle = 3.1 * numbers.next();
        let reach = (size[0] * angle.cos().abs() + size[1] * angle.sin().abs()) / 2.0;
        let behind = reach + 1e-6 + 0.01 * numbers.next().max(0.0).powi(2);
        Magnet {
            // Apart from each other: a tile cannot have overlapping blocks.
            position: [
                side * (HALF - behind),
                0.03 * (k as f64 - 1.0) + 0.004 * numbers.next(),
            ]
            .into(),
            angle,
            moment: 0.1 + 0.3 * numbers.next().abs(),
            size,
            form: Default::default(),
            face: 0,
        }
    });
    Tile {
        magnets: magnets.collect(),
        outline: Outline::new(corners.map(Into::into).to_vec()).expect("a square"),
        faces: Vec::new(),
        mass: 0.1,
        thickness: 0.01,
    }
}

fn cell(numbers: &mut Numbers) -> Cell {
    let theta = [0.02, 0.4, 3.1][numbers.below(3)] * numbers.next();
    let contact = HALF * (1.0 + theta.cos().abs() + theta.sin().abs());
    let apart = [0.0, 1e-3, 0.01, 0.1][numbers.below(4)] * (1.0 + numbers.next());
    let size = 10f64.powf(-3.5 + 2.5 * numbers.next());
    let mut half = || size * (0.05 + numbers.next().abs());
    let half = [half(), half(), 5.0 * half()];
    let centre = Configuration::new(contact + apart, 0.08 * numbers.next(), theta);
    Cell { centre, half }
}

/// Checks a cell of two tiles made from any bytes.
///
/// # Panics
/// Where an energy is outside its bounds.
pub fn bounds(bytes: &[u8]) {
    let mut numbers = Numbers(bytes);
    let blocks = numbers.below(2) == 1;
    let [fixed, moving] = [1.0, -1.0].map(|side| tile(&mut numbers, side));
    let cell = cell(&mut numbers);
    let enclosure = if blocks {
        CuboidBounds::new(&fixed, &moving).enclose(&cell)
    } else {
        DipoleBounds::new(&fixed, &moving).enclose(&cell)
    };
    assert!(enclosure.low <= enclosure.high, "{enclosure:?}");
    let contact = Contact::new(&fixed.outline, &moving.outline);
    for _ in 0..4 {
        // Corners, where remainders are largest, and places in between.
        let corner = numbers.below(2) == 1;
        let d = cell.half.map(|half| match numbers.next() {
            x if corner => half.copysign(x),
            x => half * x,
        });
        if !contact.is_free(&cell.centre.moved(d.into())) {
            continue;
        }
        let truth = if blocks {
            truth::of_blocks(&fixed, &moving, &cell.centre, d)
        } else {
            Some(truth::of_dipoles(&fixed, &moving, &cell.centre, d))
        };
        let Some(truth) = truth else { continue };
        let form = enclosure.form.at(d);
        let (low, high) = (form + enclosure.low, form + enclosure.high);
        assert!(
            truth.most() >= low && truth.least() <= high,
            "{blocks} {cell:?} {d:?}: {truth:?} not in [{low}, {high}]"
        );
    }
}
