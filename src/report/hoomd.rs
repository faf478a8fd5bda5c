//! Tables for HOOMD-blue (<https://hoomd-blue.readthedocs.io>), which simulates more tiles than one
//! machine can: a script, and the tiles it needs beside `trajectory.gsd`.
//!
//! The script's first lines say what is lost. The kinds of tiles are in `hoomd_table.json` as they
//! are here; the script makes discs of outlines and dipoles of magnets, which only it needs.

use serde_json::{Value, json};

use jobs::output::Files;
use jobs::table::{About, TableResult};
use physics::table::Kind;
use physics::tile::{Magnet, magnet::Standing};

/// Both files.
pub fn files(about: &About, found: &TableResult) -> Files {
    let settings = &found.ensemble.settings;
    let cut_off = found.crowd.couples().iter().map(|it| it.cutoff.to);
    let told = json!({
        "model": about.model.name(),
        "seed": found.ensemble.seed,
        "table_m": found.crowd.rim.half_size().map(|half| 2.0 * half),
        "round": found.crowd.rim.radius().is_some(),
        "cut_off_m": cut_off.fold(0.0, f64::max),
        "shaking_J": settings.shaking,
        "drag_per_s": settings.drag,
        "kinds": found.crowd.kinds.iter().map(kind).collect::<Value>(),
    });
    let told = serde_json::to_vec_pretty(&told).expect("tiles have a form in JSON");
    let script = include_bytes!("hoomd_table.py").to_vec();
    Files::from([
        ("hoomd_table.py".to_owned(), script),
        ("hoomd_table.json".to_owned(), told),
    ])
}

fn kind(kind: &Kind) -> Value {
    let outline = kind.tile.outline.vertices().iter();
    json!({
        "name": kind.name,
        "mass": kind.body.mass,
        "inertia": kind.body.inertia,
        "centre": [kind.body.centre.x, kind.body.centre.y],
        "outline": outline.map(|it| [it.x, it.y]).collect::<Vec<_>>(),
        "magnets": kind.tile.magnets.iter().map(magnet).collect::<Value>(),
    })
}

fn magnet(magnet: &Magnet) -> Value {
    let up = match magnet.form.stands {
        Some(Standing::Up) => 1,
        Some(Standing::Down) => -1,
        None => 0,
    };
    json!({
        "position": [magnet.position.x, magnet.position.y],
        "angle": magnet.angle,
        "moment": magnet.moment,
        "size": magnet.size,
        "up": up,
        "face": magnet.face,
    })
}
