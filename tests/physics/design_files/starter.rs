//! The design that users start from.

use tilebind::design::{Design, STARTER};

#[test]
fn the_starter_is_a_sound_design() {
    let design = Design::parse(STARTER, "starter.toml").unwrap();
    assert!(design.warnings.is_empty());
    assert_eq!(design.pair.bound.to_array(), [0.43, 0.0, 0.0]);
}

/// The commented-out lines are valid without the `#`.
#[test]
fn the_starter_s_remarks_are_sound_too() {
    let mut taken = 0;
    for line in STARTER.lines() {
        let offered = line.strip_prefix("# ");
        let offered = offered.filter(|rest| rest.split(' ').nth(1) == Some("="));
        // Corners instead of a side make another tile, with other faces.
        let Some(offered) = offered.filter(|rest| !rest.starts_with("vertices")) else {
            continue;
        };
        let text = STARTER.replacen(line, offered, 1);
        Design::parse(&text, "starter.toml").unwrap_or_else(|e| panic!("{offered}: {e}"));
        taken += 1;
    }
    assert_eq!(taken, 5);
}
