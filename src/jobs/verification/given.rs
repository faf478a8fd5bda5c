//! What a results folder of `analyse` states: report.json and the pathways.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Deserialize;

use crate::text;

pub(super) type Pose = [f64; 3];

/// report.json, as far as it is checked.
#[derive(Deserialize)]
pub(super) struct Report {
    pub design: Identity,
    pub settings: Settings,
    pub tiles: Option<Tiles>,
    pub bound: Bound,
    pub states: Vec<State>,
    pub inventory: Inventory,
    pub free: Free,
    pub barriers: Vec<Barrier>,
    pub alternatives: Vec<Alternative>,
    pub uncertified: Option<String>,
}

#[derive(Deserialize)]
pub(super) struct Identity {
    pub name: String,
    pub sha256: String,
}

#[derive(Deserialize)]
pub(super) struct Settings {
    pub model: String,
    pub shields: Option<String>,
    pub complete_below: f64,
    pub complete_escape: f64,
}

#[derive(Deserialize)]
pub(super) struct Tiles {
    pub fixed: Tile,
    pub moving: Tile,
    pub target_pose: Pose,
}

#[derive(Deserialize)]
pub(super) struct Tile {
    pub outline_m: Vec<[f64; 2]>,
    pub magnets: Vec<Magnet>,
    pub faces: Vec<GivenFace>,
}

#[derive(Deserialize)]
pub(super) struct Magnet {
    pub face: usize,
    pub position_m: [f64; 2],
    pub angle: f64,
    #[serde(rename = "moment_Am2")]
    pub moment: f64,
    pub size_m: [f64; 3],
    pub shape: String,
    pub up: Option<f64>,
}

#[derive(Deserialize)]
pub(super) struct GivenFace {
    pub middle_m: [f64; 2],
    pub normal: [f64; 2],
    pub shield: Option<Shield>,
}

#[derive(Clone, Copy, Deserialize)]
pub(super) struct Shield {
    pub attenuation: f64,
    pub length_m: f64,
    pub width: f64,
    pub front_gain: f64,
}

#[derive(Deserialize)]
pub(super) struct Bound {
    pub pose: Pose,
    #[serde(rename = "energy_J")]
    pub energy: f64,
}

#[derive(Deserialize)]
pub(super) struct State {
    pub id: usize,
    pub kind: String,
    pub class: usize,
    pub copies: usize,
    pub pose: Pose,
    #[serde(rename = "energy_J")]
    pub energy: f64,
    pub capture: Option<Share>,
    #[serde(rename = "block_energy_J")]
    pub block_energy: Option<f64>,
    pub escape: Option<Barrier>,
}

#[derive(Deserialize)]
pub(super) struct Share {
    pub share: f64,
    pub low: f64,
    pub high: f64,
    pub count: usize,
    pub of: usize,
}

#[derive(Deserialize)]
pub(super) struct Free {
    pub capture: Share,
    pub at_rest: Share,
    pub gone: Share,
}

#[derive(Deserialize)]
pub(super) struct Inventory {
    #[serde(rename = "below_J")]
    pub below: Option<f64>,
    #[serde(rename = "escape_J")]
    pub escape: Option<f64>,
    pub complete: bool,
    pub open: Vec<serde_json::Value>,
    pub unproved: Option<String>,
}

/// The end of a barrier.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(untagged)]
pub(super) enum BarrierEnd {
    State(usize),
    Free(Free_),
}

/// The word `free`.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
pub(super) enum Free_ {
    #[serde(rename = "free")]
    Free,
}

#[derive(Deserialize)]
pub(super) struct Barrier {
    pub from: BarrierEnd,
    pub to: BarrierEnd,
    #[serde(rename = "saddle_energy_J")]
    pub saddle_energy: Option<f64>,
    pub saddle_pose: Option<Pose>,
    #[serde(rename = "lower_J")]
    pub lower: Option<f64>,
    #[serde(rename = "upper_J")]
    pub upper: Option<f64>,
    #[serde(rename = "forward_J")]
    pub forward: Option<f64>,
    #[serde(rename = "reverse_J")]
    pub reverse: Option<f64>,
    pub pathway: Option<String>,
    pub caged: bool,
    #[serde(rename = "work_J")]
    pub work: Option<f64>,
    #[serde(rename = "reverse_work_J")]
    pub reverse_work: Option<f64>,
    #[serde(rename = "length_m")]
    pub length: Option<f64>,
}

#[derive(Deserialize)]
pub(super) struct Alternative {
    pub from: BarrierEnd,
    pub to: BarrierEnd,
    pub pathway: Option<String>,
}

/// A point of a pathway's file.
#[derive(Clone, Copy, Debug, Deserialize)]
pub(super) struct GivenPoint {
    pub s: f64,
    pub x: f64,
    pub y: f64,
    pub theta: f64,
    #[serde(rename = "energy_J")]
    pub energy: f64,
    #[serde(rename = "clearance_m")]
    pub clearance: f64,
}

impl GivenPoint {
    pub fn pose(&self) -> Pose {
        [self.x, self.y, self.theta]
    }
}

/// A folder's report with its pathways by file, each read or why it cannot be.
pub(super) struct Given {
    pub report: Report,
    pub pathways: BTreeMap<String, Result<Vec<GivenPoint>, String>>,
}

/// Reads a folder.
///
/// # Errors
/// If it holds no report of an analysis.
pub(super) fn read(folder: &Path) -> Result<Given, String> {
    let file = folder.join("report.json");
    let describe = |error: &dyn std::fmt::Display| format!("{}: {error}", file.display());
    let text = text::read(&file).map_err(|error| {
        format!(
            "{}\n  help: give folders that `tilebind analyse --out` wrote",
            describe(&error)
        )
    })?;
    let report: Report = serde_json::from_str(&text).map_err(|error| {
        format!(
            "{}\n  help: only reports of `tilebind analyse` can be verified; analyse the design again if \
             another version wrote this one",
            describe(&error)
        )
    })?;
    let barriers = report.barriers.iter().map(|it| &it.pathway);
    let escapes = report.states.iter().filter_map(|it| it.escape.as_ref());
    let escapes = escapes.map(|it| &it.pathway);
    let others = report.alternatives.iter().map(|it| &it.pathway);
    let names = barriers.chain(escapes).chain(others).flatten();
    let pathways = names.map(|name| (name.clone(), pathway(folder, name)));
    let pathways = pathways.collect();
    Ok(Given { report, pathways })
}

fn pathway(folder: &Path, name: &str) -> Result<Vec<GivenPoint>, String> {
    let is_inside = Path::new(name)
        .components()
        .all(|part| matches!(part, std::path::Component::Normal(_)));
    if !is_inside {
        return Err(format!("{name:?} is not a file of the folder"));
    }
    let text = text::read(&folder.join(name)).map_err(|error| format!("{name}: {error}"))?;
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let points: Result<Vec<GivenPoint>, _> = reader.deserialize().collect();
    let points = points.map_err(|error| format!("{name}: {error}"))?;
    let is_finite = |it: &GivenPoint| {
        let GivenPoint {
            s,
            x,
            y,
            theta,
            energy,
            clearance,
        } = *it;
        [s, x, y, theta, energy, clearance]
            .iter()
            .all(|x| x.is_finite())
    };
    match points.len() > 1 && points.iter().all(is_finite) {
        true => Ok(points),
        false => Err(format!("{name}: not a pathway of finite numbers")),
    }
}
