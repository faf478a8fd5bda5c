//! Docking runs as CSV.

use super::csv;
use physics::dynamics::docking::{Docking, DockingMap, End, Start};
use physics::dynamics::{Motion, Snapshot};

/// `map.csv`: one cell of the map a line.
pub fn map_csv(map: &DockingMap) -> String {
    let head = "orientation_low_rad,orientation_high_rad,speed_low_m_per_s,speed_high_m_per_s,\
                matched,runs,share,share_low,share_high";
    let rows = map.cells.iter().map(|cell| {
        let ([a, b], [c, d], p) = (cell.orientation, cell.speed, cell.matched);
        let mut row = [a, b, c, d].map(|end| format!("{end:.4}")).to_vec();
        row.extend([p.count, p.of].map(|count| count.to_string()));
        row.extend([p.share(), p.low, p.high].map(|share| format!("{share:.6}")));
        row
    });
    csv::table(head.split(','), rows)
}

/// `runs.csv`: one trajectory a line.
pub fn runs_csv(docking: &Docking) -> String {
    let head = "run,x_m,y_m,theta_rad,vx_m_per_s,vy_m_per_s,spin_rad_per_s,orientation_rad,\
                speed_m_per_s,end,trap,time_to_bind_s,end_x_m,end_y_m,end_theta_rad";
    let rows = docking.runs.iter().map(|run| {
        let Start {
            motion,
            orientation,
            speed,
        } = run.start;
        let (end, trap, since) = match run.end {
            End::Bound { since } => ("bound", None, Some(since)),
            End::Trapped { trap } => ("misbound", trap, None),
            End::Free => ("free", None, None),
        };
        let mut row = vec![run.index.to_string()];
        row.extend(motion_cells(&motion));
        row.extend([orientation, speed].map(decimals));
        row.extend([
            end.to_owned(),
            trap.map(|k| k.to_string()).unwrap_or_default(),
            since.map(|since| format!("{since:.6}")).unwrap_or_default(),
        ]);
        row.extend(run.last.motion.configuration.to_array().map(decimals));
        row
    });
    csv::table(head.split(','), rows)
}

/// One trajectory, a snapshot a line.
pub fn trajectory_csv(snapshots: &[Snapshot]) -> String {
    let head =
        "time_s,x_m,y_m,theta_rad,vx_m_per_s,vy_m_per_s,spin_rad_per_s,potential_J,kinetic_J";
    let rows = snapshots.iter().map(|snapshot| {
        let mut row = vec![format!("{:.6}", snapshot.time)];
        row.extend(motion_cells(&snapshot.motion));
        row.extend([snapshot.potential, snapshot.kinetic].map(|energy| format!("{energy:.9e}")));
        row
    });
    csv::table(head.split(','), rows)
}

fn motion_cells(motion: &Motion) -> [String; 6] {
    let (q, v) = (motion.configuration, motion.velocity);
    [q.x, q.y, q.theta, v.x, v.y, v.z].map(decimals)
}

fn decimals(value: f64) -> String {
    format!("{value:.9}")
}
