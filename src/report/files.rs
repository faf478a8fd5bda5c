//! The names of the files that each command writes.

use jobs::output::Command;
pub use jobs::output::{Files, PICTURES};

/// The complete results.
pub const REPORT: &str = "report.json";

/// The page for a browser.
pub const PAGE: &str = "report.html";

/// `tilebind analyse`.
pub const ANALYSE: Command = Command {
    name: "analyse",
    files: &[
        REPORT,
        PAGE,
        "states.csv",
        "barriers.csv",
        "dynamics.csv",
        "pathways/#-#.csv",
        "pathways/#-#-by-*.csv",
        "topsearch/min.data",
        "topsearch/min.coords",
        "topsearch/ts.data",
        "topsearch/ts.coords",
        "topsearch/pairlist",
    ],
    pictures: &[
        "map",
        "approach",
        "profiles",
        "docking",
        "models",
        "disconnectivity",
        "roadmap",
    ],
};

/// `tilebind compare`.
pub const COMPARE: Command = Command {
    name: "compare",
    files: &[REPORT, PAGE, "compare.csv", "compare.md"],
    pictures: &["ranking"],
};

/// `tilebind sweep`; its points are files of their own, see [`jobs::sweep::Store`].
pub const SWEEP: Command = Command {
    name: "sweep",
    files: &[PAGE, REPORT, "plan.json", "sweep.csv", "designs/*.toml"],
    pictures: &["curves", "map"],
};

/// `tilebind dock`.
pub const DOCK: Command = Command {
    name: "dock",
    files: &[REPORT, PAGE, "runs.csv", "map.csv", "trajectory.csv"],
    pictures: &["chances", "trajectories", "bound"],
};

/// `tilebind words`.
pub const WORDS: Command = Command {
    name: "words",
    files: &[
        REPORT,
        PAGE,
        "words.csv",
        "crosstalk.csv",
        "frontier.csv",
        "words.toml",
    ],
    pictures: &["crosstalk", "gaps", "frontier"],
};

/// `tilebind crosstalk`.
pub const CROSSTALK: Command = Command {
    name: "crosstalk",
    files: &[REPORT, PAGE, "crosstalk.csv"],
    pictures: &["crosstalk", "gaps"],
};

/// `tilebind match`.
pub const MATCH: Command = Command {
    name: "match",
    files: &[REPORT, PAGE, "matches.csv"],
    pictures: &["matches"],
};

/// `tilebind assemble`.
pub const ASSEMBLE: Command = Command {
    name: "assemble",
    files: &[
        REPORT,
        PAGE,
        "assembly.yaml",
        "assembly.tiles",
        "tileset.yaml",
        "matrix.csv",
        "pairs.csv",
        "slides.csv",
        "words.toml",
        "sheet.md",
        "designs/*.toml",
    ],
    pictures: &["grown"],
};

/// `tilebind table`.
pub const TABLE: Command = Command {
    name: "table",
    files: &[
        REPORT,
        PAGE,
        "energy.csv",
        "bonds.csv",
        "clusters.csv",
        "course.csv",
        "trajectory.csv",
        "trajectory.gsd",
        "part.json",
        "hoomd_table.py",
        "hoomd_table.json",
    ],
    pictures: &["held", "largest", "energy"],
};

/// `tilebind yield`.
pub const YIELD: Command = Command {
    name: "yield",
    files: &[
        REPORT,
        PAGE,
        "settings.csv",
        "yield.csv",
        "course.csv",
        "rates.csv",
    ],
    pictures: &["course", "yield", "shaking"],
};

/// `tilebind bond`.
pub const BOND: Command = Command {
    name: "bond",
    files: &[REPORT, PAGE, "states.csv", "over-kt.csv"],
    pictures: &["shaking"],
};

/// `tilebind rates`.
pub const RATES: Command = Command {
    name: "rates",
    files: &[
        REPORT,
        PAGE,
        "rates.csv",
        "occupation.csv",
        "over-kt.csv",
        "committor.csv",
        "proved.csv",
        "meshes.csv",
    ],
    pictures: &["committor", "rates", "meshes"],
};

/// `tilebind calibrate`.
pub const CALIBRATE: Command = Command {
    name: "calibrate",
    files: &[REPORT, PAGE],
    pictures: &[],
};

/// `tilebind make`.
pub const MAKE: Command = Command {
    name: "make",
    files: &[
        REPORT,
        PAGE,
        "magnets.csv",
        "order.csv",
        "fixed.dxf",
        "fixed.svg",
        "moving.dxf",
        "moving.svg",
        "sheet.md",
    ],
    pictures: &["tiles"],
};

/// `tilebind show`.
pub const SHOW: Command = Command {
    name: "show",
    files: &[REPORT, PAGE, "models.csv", "faces.csv"],
    pictures: &["tiles", "field"],
};

/// `tilebind energy`.
pub const ENERGY: Command = Command {
    name: "energy",
    files: &[REPORT, PAGE, "poses.csv"],
    pictures: &["poses"],
};

/// `tilebind barrier`.
pub const BARRIER: Command = Command {
    name: "barrier",
    files: &[REPORT, PAGE, "pathway.csv"],
    pictures: &["profile", "poses"],
};
