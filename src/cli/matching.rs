//! `tilebind match`.

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;
use tilebind::contact::Contact;
use tilebind::contact::matching::matches;
use tilebind::report::json;
use tilebind::units::si;

use super::{Failure, input, print};

/// List how the two outlines, magnets aside, fit together, longest contact first
#[derive(Args)]
#[command(after_help = "\
Exact polygons: every edge of one outline is laid on every edge of the other, corners at corners.
The gap is the area between the tiles within the hull of their contact.

Example:
  tilebind match shapes/tab-20mm.toml")]
pub struct Match {
    /// The design file
    design: PathBuf,

    /// Most motions listed
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = input::count)]
    most: usize,

    /// Print JSON
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Entry {
    pose: [f64; 3],
    contact_m: f64,
    gap_m2: f64,
}

/// Motions that the terminal lists.
const LISTED: usize = 20;

impl Match {
    pub fn run(self) -> Result<(), Failure> {
        let design = input::load(&self.design)?;
        let contact = Contact::new(&design.pair.fixed.outline, &design.pair.moving.outline);
        let found = matches(&contact, self.most);
        if self.json {
            let entries: Vec<Entry> = found
                .iter()
                .map(|one| Entry {
                    pose: one.pose.to_array().map(json::positive_zero),
                    contact_m: one.contact,
                    gap_m2: one.gap,
                })
                .collect();
            return print(&json::text(&entries));
        }
        let Some(longest) = found.first() else {
            return print("no two edges can be laid on each other\n");
        };
        let mut text = format!(
            "Longest contact {}, in {} of {} ways listed.\n\n   contact         gap   x, y (mm), \
             theta (deg)\n",
            si(longest.contact, "m", 4),
            found
                .iter()
                .filter(|it| it.contact > longest.contact - 1e-6)
                .count(),
            found.len()
        );
        for one in found.iter().take(LISTED) {
            let q = one.pose;
            let contact = si(one.contact, "m", 4);
            let gap = format!("{:.1} cm2", 1e4 * one.gap);
            text += &format!(
                "{contact:>10}{gap:>12}   {:.1}, {:.1}, {:.1}\n",
                1e3 * q.x + 0.0,
                1e3 * q.y + 0.0,
                q.theta.to_degrees() + 0.0
            );
        }
        print(&text)
    }
}
