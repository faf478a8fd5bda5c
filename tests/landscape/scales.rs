//! Tiles of any size: with all lengths times s and the same remanence, energies are times s^3 and nothing
//! else changes.

use tilebind::Analysis;
use tilebind::design::Design;
use tilebind::dynamics::docking::Starts;
use tilebind::landscape::Place;
use tilebind::observer::Silent;
use tilebind::pipeline::{self, Certify, Request};
use tilebind::potential::MagnetModel;

/// A design of `shapes` with all its lengths times `s`, and masses times s^3: the numbers behind the
/// keys of lengths are multiplied, line by line.
fn scaled(name: &str, s: f64) -> Design {
    const LENGTHS: [&str; 8] = [
        "size",
        "pitch",
        "inset",
        "side",
        "thickness",
        "width",
        "depth",
        "fit",
    ];
    let path = format!("{}/shapes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).unwrap();
    let mut out = String::new();
    // The text before the number: its key.
    let (mut key, mut word) = (String::new(), String::new());
    let mut comment = false;
    let mut quoted = false;
    for c in text.chars().chain(['\n']) {
        comment = (comment || (c == '#' && !quoted)) && c != '\n';
        if c == '"' {
            quoted = !quoted;
        }
        if !comment && !quoted && (c.is_alphanumeric() || "._-".contains(c)) {
            word.push(c);
            continue;
        }
        let factor = match key.as_str() {
            "mass" => s.powi(3),
            key if LENGTHS.contains(&key) => s,
            _ => 1.0,
        };
        match word.parse::<f64>() {
            Ok(number) if factor != 1.0 => out.push_str(&format!("{:?}", number * factor)),
            Ok(_) => out.push_str(&word),
            Err(_) => {
                if !word.is_empty() {
                    key = word.clone();
                }
                out.push_str(&word);
            }
        }
        word.clear();
        out.push(c);
    }
    Design::parse(&out, name).unwrap_or_else(|error| panic!("{error}\n{out}"))
}

fn analysed(name: &str, s: f64, model: MagnetModel) -> Analysis {
    let mut design = scaled(name, s);
    design.interaction.model = model;
    let settings = Request {
        certify: Certify::of(2.0),
        ..Request::default().surveyed(1000, 40)
    };
    pipeline::analyse(&design, &settings, &Silent)
}

/// Allowed differences: energies of states are stationary and agree to rounding; barriers agree as
/// far as the survey settles them (half a per cent per round, over a few rounds), because rounding
/// decides which of two paths is found.
const ENERGY: f64 = 1e-6;
const BARRIER: f64 = 2e-2;

fn assert_scaled(name: &str, s: f64, one: &Analysis, other: &Analysis) {
    let at = format!("{name} times {s}");
    let close = |a: f64, b: f64, off: f64| (a * s.powi(3) - b).abs() <= off * b.abs();
    assert!(close(one.bound.1, other.bound.1, 1e-9), "{at}");
    let [states, same] = [one, other].map(|it| &it.catalogue.states);
    assert_eq!(states.len(), same.len(), "{at}");
    for (a, b) in states.iter().zip(same) {
        let at = format!("{at}: state {}", a.id);
        assert_eq!((a.kind, a.class), (b.kind, b.class), "{at}");
        assert!(
            close(a.energy, b.energy, ENERGY),
            "{at}: {} {}",
            a.energy,
            b.energy
        );
        let caught = [a, b].map(|state| state.capture.map(|it| it.count));
        assert_eq!(caught[0], caught[1], "{at}");
        let [up, too] = [(one, a), (other, b)].map(|(of, state)| of.escape(state.id).unwrap());
        assert!(
            close(up.forward(), too.forward(), BARRIER),
            "{at}: {} {}",
            up.forward(),
            too.forward()
        );
        assert_eq!(up.to == Place::Free, too.to == Place::Free, "{at}");
    }
    let [cells, alike] = [one, other].map(|it| it.counts.cells as f64);
    assert!((cells / alike - 1.0).abs() <= 0.1, "{at}: {cells} {alike}");
    let complete =
        [one, other].map(|it| it.completeness.as_ref().is_ok_and(|it| it.ended.is_none()));
    assert_eq!(complete[0], complete[1], "{at}");
}

#[test]
fn designs_of_any_size_have_the_same_answers() {
    for (name, model, scales) in [
        ("paper-tile", MagnetModel::Dipole, &[0.01, 10.0][..]),
        ("arc-20mm", MagnetModel::Dipole, &[0.01]),
        ("tab-20mm", MagnetModel::Cuboid, &[0.01]),
        ("triangle-teeth-20mm", MagnetModel::Dipole, &[10.0]),
        ("one-face", MagnetModel::Dipole, &[0.01]),
    ] {
        let one = analysed(name, 1.0, model);
        for s in scales {
            assert_scaled(name, *s, &one, &analysed(name, *s, model));
        }
    }
}

/// Powers of two change no digit: if a number differs, the code contains an absolute length.
#[test]
fn powers_of_two_change_no_digit() {
    let [one, other] = [1.0, 1.0 / 128.0].map(|s| analysed("tab-20mm", s, MagnetModel::Dipole));
    let cube = 128_f64.powi(-3);
    assert_eq!(one.counts.cells, other.counts.cells);
    assert_eq!(one.counts.edges, other.counts.edges);
    assert_eq!(one.bound.1 * cube, other.bound.1);
    for (a, b) in one.catalogue.states.iter().zip(&other.catalogue.states) {
        assert_eq!(a.energy * cube, b.energy, "{}", a.id);
        assert_eq!(a.configuration.x / 128.0, b.configuration.x, "{}", a.id);
    }
}

#[test]
fn tiles_of_any_size_start_to_dock_as_far_away_in_proportion() {
    for s in [1.0, 1.0 / 128.0, 16.0] {
        let starts = Starts::of(&scaled("paper-tile", s).pair);
        assert_eq!(starts.distance, [0.62 * s, s]);
    }
}
