//! What holds of every answer of the readers.

use tilebind::Design;
use tilebind::design::DesignError;

/// Whether an answer can be told in a terminal, and a design that was read is sound.
///
/// # Panics
/// Where it cannot, or is not.
pub fn check(answer: Result<Design, DesignError>) {
    let told = match answer {
        Err(error) => error.to_string(),
        Ok(design) => {
            let pair = &design.pair;
            assert!(design.space().contains(&pair.bound));
            for tile in [&pair.fixed, &pair.moving] {
                assert!(tile.outline.area() > 0.0 && tile.outline.area().is_finite());
                for magnet in &tile.magnets {
                    assert!(magnet.moment.is_finite());
                    assert!(magnet.position.iter().all(|x| x.is_finite()));
                }
            }
            assert!(!design.name.contains(char::is_control));
            let warnings: Vec<String> = design.warnings.iter().map(ToString::to_string).collect();
            warnings.join("\n")
        }
    };
    let escapes = |c: char| c.is_control() && c != '\n';
    assert!(!told.contains(escapes), "{told:?}");
    assert!(told.len() < 100_000, "{} bytes are told", told.len());
}
