//! Maps, roadmap, states and barriers as NPY files, for NumPy and all that reads its format.
//!
//! Grids are plain arrays of doubles in C order, NaN where no configuration is free, with an array
//! for each axis; tables are structured arrays whose fields carry their units. The format is NumPy's
//! version 1.0 (<https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html>): a header
//! of text and the bytes, little-endian. The same analysis gives the same bytes.
//!
//! | file in `arrays/` | shape, fields |
//! |---|---|
//! | `around_energy_J` | (theta, y, x): U around the fixed tile over `around_theta_rad`, `around_y_m`, `around_x_m` |
//! | `front_energy_J` | (gap, tilt, slide): U in front of the target face over `front_gap_m`, `front_tilt_rad`, `front_slide_m` |
//! | `front_landing_m` | (tilt, slide): distance from the bound position at which the tile first touches; the gap is counted from there |
//! | `states` | id, class, bound (0 or 1), pose, energy, block energy, escape saddle, share of far starts captured |
//! | `barriers` | from, to (ids of states, -1 for free), saddle energy with its bounds, saddle pose |
//! | `milestones` | pose and energy; an edge's `from` and `to` are places in this list |
//! | `edges` | from, to, highest energy and where it is on the way (0 to 1), length, work and -ln of the transition probability either way |
//!
//! ```python
//! import matplotlib.pyplot as plt
//! import numpy as np
//!
//! array = lambda name: np.load(f"target/paper-tile/arrays/{name}.npy")
//! lowest = np.fmin.reduce(array("around_energy_J"))  # over theta; NaN where the tiles would overlap
//! states, milestones, edges = array("states"), array("milestones"), array("edges")
//!
//! figure, (left, right) = plt.subplots(1, 2, figsize=(11, 5))
//! mesh = left.pcolormesh(array("around_x_m"), array("around_y_m"), np.cbrt(lowest), cmap="RdBu_r")
//! left.plot(states["x_m"], states["y_m"], "k.")
//! figure.colorbar(mesh, label="cube root of the lowest energy (J)")
//! ends = [np.stack([milestones[k][edges[e]] for e in ("from", "to")]) for k in ("x_m", "y_m")]
//! deep = edges["peak_J"] < -1e-4  # ways that stay below -0.1 mJ
//! right.plot(ends[0][:, deep], ends[1][:, deep], lw=0.3)
//! plt.savefig("paper-tile.png")
//! ```

use std::borrow::Borrow;

use super::columns::{self, Cell, Column, Output, StateRow};
use super::files::Files;
use super::page::landscape::{in_front, whole};
use super::plots::Scene;
use jobs::design::Design;
use jobs::pipeline::Analysis;
use physics::landscape::volume::Volume;
use physics::landscape::{Barrier, Place};
use physics::roadmap::{Edge, EdgeCosts, Milestone, Roadmap};

/// The folder of the arrays.
pub const FOLDER: &str = "arrays";

/// A field of a structured array.
enum Field {
    Whole(String, Vec<i64>),
    Real(String, Vec<f64>),
}

use Field::{Real, Whole};

/// All arrays of an analysis. The roadmap is built anew from the settings, as the analysis has it.
pub fn files(design: &Design, analysis: &Analysis) -> Files {
    let mut files = Files::new();
    let mut add = |name: &str, content: Vec<u8>| {
        files.insert(format!("{FOLDER}/{name}.npy"), content);
    };
    let scene = Scene::new(design, &analysis.problem, &analysis.inventory);
    let (around, front) = rayon::join(|| whole(&scene), || in_front(&scene));
    let names = ["around_theta_rad", "around_y_m", "around_x_m"];
    add_volume(&mut add, "around_energy_J", names, &around);
    let names = ["front_gap_m", "front_tilt_rad", "front_slide_m"];
    add_volume(&mut add, "front_energy_J", names, &front.volume);
    let shape = [1, 2].map(|k| front.volume.axes[k].len());
    add("front_landing_m", grid(&shape, &or_nan(&front.landing)));
    let roadmap = Roadmap::build(&analysis.problem, &analysis.roadmap, &mut |_| {});
    let names = analysis.inventory.names();
    let states = StateRow::all(design, analysis, &names);
    let escapes = states.iter().filter_map(|row| row.escape.as_ref());
    let barriers: Vec<&Barrier> = escapes.chain(&analysis.inventory.barriers).collect();
    add(
        "states",
        table(&fields(&columns::states(Output::Npy), &states)),
    );
    add(
        "barriers",
        table(&fields(&columns::barriers(Output::Npy), &barriers)),
    );
    add("milestones", table(&milestones(&roadmap)));
    add("edges", table(&edges(&roadmap)));
    files
}

fn add_volume(add: &mut impl FnMut(&str, Vec<u8>), name: &str, axes: [&str; 3], volume: &Volume) {
    add(
        name,
        grid(
            &volume.axes.each_ref().map(Vec::len),
            &or_nan(&volume.energies),
        ),
    );
    for (name, axis) in axes.iter().zip(&volume.axes) {
        add(name, grid(&[axis.len()], axis));
    }
}

fn or_nan(values: &[Option<f64>]) -> Vec<f64> {
    values
        .iter()
        .map(|value| value.unwrap_or(f64::NAN))
        .collect()
}

/// The fields of a table; -1 for `free`, NaN where nothing is known.
fn fields<Row>(columns: &[Column<Row>], rows: &[impl Borrow<Row>]) -> Vec<Field> {
    let field = |column: &Column<Row>| {
        let name = column.key();
        let cells = rows.iter().map(|row| (column.get)(row.borrow()));
        if column.unit.is_empty() {
            Whole(name, cells.map(whole_number).collect())
        } else {
            Real(name, cells.map(real_number).collect())
        }
    };
    columns.iter().map(field).collect()
}

fn whole_number(cell: Cell) -> i64 {
    match cell {
        Cell::Value(value) => value.as_i64().unwrap_or(-1),
        Cell::Place(Place::State(id)) => id as i64,
        Cell::Place(Place::Free) | Cell::Real(_) => -1,
    }
}

fn real_number(cell: Cell) -> f64 {
    match cell {
        Cell::Real(value) => value,
        Cell::Value(_) | Cell::Place(_) => f64::NAN,
    }
}

fn milestones(roadmap: &Roadmap) -> Vec<Field> {
    let real = |name: &str, of: fn(&Milestone) -> f64| {
        Real(name.to_owned(), roadmap.milestones.iter().map(of).collect())
    };
    vec![
        real("x_m", |milestone| milestone.configuration.x),
        real("y_m", |milestone| milestone.configuration.y),
        real("theta_rad", |milestone| milestone.configuration.theta),
        real("energy_J", |milestone| milestone.energy),
    ]
}

fn edges(roadmap: &Roadmap) -> Vec<Field> {
    let edges = &roadmap.edges;
    let whole = |name: &str, of: fn(&Edge) -> u32| {
        Whole(
            name.to_owned(),
            edges.iter().map(|e| of(e).into()).collect(),
        )
    };
    let real = |name: &str, of: fn(&EdgeCosts) -> f64| {
        Real(
            name.to_owned(),
            edges.iter().map(|e| of(&e.costs)).collect(),
        )
    };
    vec![
        whole("from", |edge| edge.from),
        whole("to", |edge| edge.to),
        real("peak_J", |costs| costs.peak),
        real("peak_at", |costs| costs.peak_at),
        real("length_m", |costs| costs.length),
        real("work_forwards_J", |costs| costs.work[0]),
        real("work_backwards_J", |costs| costs.work[1]),
        real("minus_ln_probability_forwards", |c| {
            c.minus_ln_probability[0]
        }),
        real("minus_ln_probability_backwards", |c| {
            c.minus_ln_probability[1]
        }),
    ]
}

/// A plain array of doubles.
fn grid(shape: &[usize], values: &[f64]) -> Vec<u8> {
    let mut file = header("'<f8'", shape);
    file.extend(values.iter().flat_map(|value| value.to_le_bytes()));
    file
}

/// A structured array, row by row.
fn table(fields: &[Field]) -> Vec<u8> {
    let kinds: Vec<String> = fields
        .iter()
        .map(|field| match field {
            Whole(name, _) => format!("('{name}', '<i8')"),
            Real(name, _) => format!("('{name}', '<f8')"),
        })
        .collect();
    let rows = fields.first().map_or(0, |field| match field {
        Whole(_, values) => values.len(),
        Real(_, values) => values.len(),
    });
    let mut file = header(&format!("[{}]", kinds.join(", ")), &[rows]);
    for row in 0..rows {
        for field in fields {
            file.extend(match field {
                Whole(_, values) => values[row].to_le_bytes(),
                Real(_, values) => values[row].to_le_bytes(),
            });
        }
    }
    file
}

/// NumPy's header: the bytes begin at a multiple of 64.
fn header(kind: &str, shape: &[usize]) -> Vec<u8> {
    let sizes: String = shape.iter().map(|size| format!("{size},")).collect();
    let mut text = format!("{{'descr': {kind}, 'fortran_order': False, 'shape': ({sizes}), }}");
    const BEFORE: usize = 10;
    let padding = 63 - (BEFORE + text.len()) % 64;
    text.push_str(&" ".repeat(padding));
    text.push('\n');
    let mut file = b"\x93NUMPY\x01\x00".to_vec();
    // Far below the format's 65 535: a header holds names and sizes.
    file.extend((text.len() as u16).to_le_bytes());
    file.extend(text.into_bytes());
    file
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_what_numpy_writes() {
        // numpy.save of numpy.array([[1.0, 2.0, numpy.nan]]) and of a structured array.
        let file = grid(&[1, 3], &[1.0, 2.0, f64::NAN]);
        assert_eq!(&file[..10], b"\x93NUMPY\x01\x00\x76\x00");
        let text = String::from_utf8(file[10..128].to_vec()).unwrap();
        let start = "{'descr': '<f8', 'fortran_order': False, 'shape': (1,3,), }";
        assert!(text.starts_with(start) && text.ends_with(" \n"));
        assert_eq!(file.len(), 128 + 3 * 8);
        assert_eq!(file[136..144], 2.0_f64.to_le_bytes());

        let file = table(&[
            Whole("a".into(), vec![1, -2]),
            Real("b_J".into(), vec![0.5, 0.25]),
        ]);
        let text = String::from_utf8_lossy(&file[10..]);
        assert!(text.starts_with("{'descr': [('a', '<i8'), ('b_J', '<f8')], "));
        assert!(text.contains("'shape': (2,), }"));
        let rows = &file[file.len() - 32..];
        assert_eq!(rows[16..24], (-2_i64).to_le_bytes());
        assert_eq!(rows[24..], 0.25_f64.to_le_bytes());
        assert_eq!((file.len() - 32) % 64, 0);
    }
}
