//! The page of a yield.

use super::{Fact, Page, illustrations, yield_charts};
use crate::yields::{headline, phases};
use jobs::design::Design;
use jobs::yields::{Question, Yields};
use physics::units::si;

impl Page {
    /// The page of what a shaken table yields.
    pub fn of_yields(design: &Design, question: &Question, found: &Yields) -> Self {
        let best = found.best();
        let fact = |name: &str, value: String, note: &str| Fact {
            name: name.to_owned(),
            value,
            note: note.to_owned(),
        };
        let percent = |share: f64| format!("{:.1} %", 100.0 * share);
        let [low, high] = best.interval.map(percent);
        let mut facts = vec![
            fact("bound", percent(best.bound), &format!("{low} to {high}")),
            fact("in traps", percent(best.trapped), "taken together"),
            fact("kT", si(best.kt, "J", 3), "best of those asked for"),
        ];
        if let Some(share) = best.equilibrium {
            facts.push(fact("in the end", percent(share), "equilibrium"));
        }
        if let Some([mean, error]) = best.simulated {
            let note = format!("+- {}", percent(2.0 * error));
            facts.push(fact("simulated", percent(mean), &note));
        }
        if let Some((tiles, mixture)) = &found.mixture {
            let bound = mixture.bound.map_or("?".to_owned(), percent);
            let note = format!(
                "{}; {tiles} tiles; no schedule yields more than {bound}",
                phases(question, found, mixture)
            );
            facts.push(fact("kT after kT", percent(mixture.value), &note));
        }
        for (kt, why) in &found.without {
            facts.push(fact(
                &format!("at {}", si(*kt, "J", 3)),
                "no answer".to_owned(),
                &why.to_string(),
            ));
        }
        let pictures = yield_charts::all(question, found);
        Self {
            subtitle: headline(design, question, found),
            facts,
            pictures: illustrations(pictures),
            origin: format!(
                "tilebind {}; {} magnets; {}, detachment by detailed balance; a tile binds one \
                 partner at most",
                env!("CARGO_PKG_VERSION"),
                design.interaction.model.name(),
                question.effort.told(),
            ),
            ..Self::titled(format!("Yield of {}", design.name))
        }
    }
}
