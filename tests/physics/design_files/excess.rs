//! Files that are not regular files, and designs with too many entries: refused at once, each with
//! a message.

use std::path::Path;
use std::sync::mpsc::channel;
use std::time::Duration;

use super::drawings::{design, drawn, outlined, profiled};
use tilebind::design::{Design, DesignError};

/// The answer of `load`, within a few seconds.
fn at_once<T: Send + 'static>(
    load: impl FnOnce() -> Result<T, DesignError> + Send + 'static,
) -> DesignError {
    let (sender, receiver) = channel();
    std::thread::spawn(move || sender.send(load().map(|_| ())));
    let told = receiver.recv_timeout(Duration::from_secs(20));
    told.expect("an answer at once").expect_err("a fault")
}

/// A design in `folder` with the drawing that is called `name`.
fn design_of(folder: &Path, name: &str) -> Result<Design, DesignError> {
    let outline = format!("outline = {{ file = \"{name}\" }}");
    let file = folder.join("design.toml");
    std::fs::write(&file, design(&outline, "", "side = 0.1", (0, 0))).unwrap();
    Design::load(&file)
}

#[cfg(unix)]
#[test]
fn only_regular_files_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path().to_owned();
    let pipe = folder.join("pipe");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(made.unwrap().success());
    std::fs::write(folder.join("large"), vec![b' '; (16 << 20) + 1]).unwrap();
    std::fs::create_dir(folder.join("below")).unwrap();
    for (name, expected) in [
        ("/dev/zero", "not a regular file"),
        ("pipe", "not a regular file"),
        ("below", "a folder"),
        ("large", "larger than 16 MB"),
    ] {
        let (at, file) = (folder.clone(), folder.join(name));
        let error = at_once(move || design_of(&at, name));
        assert!(error.message.contains(expected), "{error}");
        assert!(error.file.ends_with("design.toml"));
        let error = at_once(move || Design::load(&file));
        assert!(error.message.contains(expected), "{error}");
    }
}

#[cfg(unix)]
#[test]
fn lines_of_files_elsewhere_are_not_shown() {
    let outer = tempfile::tempdir().unwrap();
    let folder = outer.path().join("design");
    std::fs::create_dir(&folder).unwrap();
    let other = outer.path().join("secrets");
    std::fs::write(&other, "the password is swordfish\n").unwrap();
    std::os::unix::fs::symlink(&other, folder.join("link.svg")).unwrap();
    for name in ["../secrets", other.to_str().unwrap(), "link.svg"] {
        let error = design_of(&folder, name).unwrap_err();
        let told = error.to_string();
        assert!(told.contains("not well-formed XML"), "{told}");
        assert!(
            told.contains(":1:1: ") && !told.contains("swordfish"),
            "{told}"
        );
    }
    // A drawing that lies with its design is shown, by whatever name.
    std::fs::create_dir(folder.join("drawings")).unwrap();
    let own = folder.join("drawings/a.svg");
    std::fs::write(&own, "the password is swordfish\n").unwrap();
    for name in ["drawings/a.svg", own.to_str().unwrap()] {
        let told = design_of(&folder, name).unwrap_err().to_string();
        assert!(told.contains("1 | the password is swordfish"), "{told}");
    }
}

#[test]
fn deeply_nested_groups_are_refused() {
    let nested = |depth: usize| {
        let (open, close) = ("<g>".repeat(depth), "</g>".repeat(depth));
        drawn(&format!(
            "{open}<rect width=\"100\" height=\"100\"/>{close}"
        ))
    };
    assert!(outlined(&nested(200), "").is_ok());
    for depth in [10_000, 90_000] {
        let error = outlined(&nested(depth), "").unwrap_err();
        assert!(error.message.contains("more than 256 elements"), "{error}");
        assert_eq!(error.place.unwrap().line, 2);
    }
}

#[test]
fn drawings_that_reach_too_far_are_refused_before_they_are_drawn() {
    let far = "m from the drawing's origin, more than 1000";
    let cases = [
        ("<rect width=\"1e100\" height=\"9\"/>", far),
        ("<path d=\"M0 0C1e100 0 1e100 9 0 9z\"/>", far),
        ("<path d=\"M0 0Q1e7 0 0 9z\"/>", far),
        ("<path d=\"M0 0h1e9v1e9z\"/>", far),
        (
            "<path transform=\"scale(1e100)\" d=\"M0 0C1 0 1 1 0 1z\"/>",
            far,
        ),
        // Far across, though not far along.
        (
            "<path transform=\"scale(1e-3 1e100)\" d=\"M0 0c9 0 9 9 0 9z\"/>",
            far,
        ),
        (
            "<g transform=\"scale(1e200)\"><path transform=\"scale(1e200)\" d=\"M0 0c9 0 9 9 0 9z\"/></g>",
            "not finite",
        ),
        (
            "<path transform=\"scale(1e200)\" d=\"M0 0a1 1 0 0 0 9 9z\"/>",
            "m from the drawing's origin",
        ),
        (
            "<path d=\"M0 0A1e100 1e100 0 0 0 9 9z\"/>",
            "almost straight",
        ),
        ("<circle r=\"1e100\"/>", far),
        ("<ellipse rx=\"1e300\" ry=\"1\"/>", far),
    ];
    for (content, expected) in cases {
        let drawing = drawn(content);
        let error = at_once(move || outlined(&drawing, ""));
        assert!(error.message.contains(expected), "{content}: {error}");
        // A hundred zeros are not accepted as a number.
        assert!(error.message.len() < 90, "{error}");
        assert_eq!(error.place.unwrap().line, 2, "{content}");
    }
    for head in [
        "width=\"1e300mm\" height=\"1e300mm\" viewBox=\"0 0 1 1\"",
        "width=\"1mm\" height=\"1mm\" viewBox=\"0 0 1e-300 1e-300\"",
    ] {
        let drawing = format!("<svg {head}><circle r=\"1e100\"/></svg>");
        let error = at_once(move || outlined(&drawing, ""));
        assert!(error.message.contains("the shape"), "{error}");
    }
    // Not one curve, but thousands of them.
    let petals = "c900 0 900 900 0 0".repeat(60_000);
    let petals = drawn(&format!("<path d=\"M0 0{petals}z\"/>"));
    let error = at_once(move || outlined(&petals, ""));
    assert!(
        error.message.contains("more than 1000000 points"),
        "{error}"
    );
    // An arc that is almost straight is none of these.
    let straight = drawn("<path d=\"M0 100A1e6 1e6 0 0 1 100 100\"/>");
    assert!(profiled(&straight, "").is_ok());
}

/// A wavy outline about (200, 200), traced in `n` steps.
fn traced(n: usize) -> String {
    let points: Vec<String> = (0..n)
        .map(|k| std::f64::consts::TAU * k as f64 / n as f64)
        .map(|angle| (angle, 100.0 + 5.0 * (5.0 * angle).sin()))
        .map(|(angle, r)| {
            format!(
                "{:.5},{:.5}",
                200.0 + r * angle.cos(),
                200.0 - r * angle.sin()
            )
        })
        .collect();
    drawn(&format!("<polygon points=\"{}\"/>", points.join(" ")))
}

#[test]
fn traced_lines_are_simplified_within_the_chord_error() {
    let corners = ", corners = [[0.1, 0.0], [0.0, 0.105], [-0.1, 0.0], [0.0, -0.095]]";
    // Few enough to be taken as they are.
    let coarse = outlined(&traced(240), corners).unwrap();
    assert_eq!(coarse.pair.fixed.outline.vertices().len(), 240);
    assert!(
        coarse
            .warnings
            .iter()
            .all(|doubt| !doubt.message.contains("left out"))
    );
    let begun = std::time::Instant::now();
    for n in [800, 20_000] {
        let design = outlined(&traced(n), corners).unwrap();
        let outline = &design.pair.fixed.outline;
        let left = outline.vertices().len();
        assert!((60..=200).contains(&left), "{left}");
        let told = format!("of its {n} points are left out");
        let doubts = design
            .warnings
            .iter()
            .filter(|doubt| doubt.message.contains(&told));
        assert_eq!(doubts.count(), 1, "{:?}", design.warnings);
        // The drawn line is within the chord error of the simplified one, which keeps its corners.
        for k in 0..n {
            let angle = std::f64::consts::TAU * k as f64 / n as f64;
            let r = 0.1 + 0.005 * (5.0 * angle).sin();
            let p = nalgebra::Vector2::new(r * angle.cos(), r * angle.sin());
            assert!(outline.signed_distance(p).abs() <= 0.21 / 2150.0, "{p}");
        }
        assert!((design.pair.fixed.faces[0].start.x - 0.1).abs() < 1e-5);
        assert!((design.pair.fixed.faces[1].start.y - 0.105).abs() < 1e-3);
    }
    assert!(
        begun.elapsed() < Duration::from_secs(60),
        "{:?}",
        begun.elapsed()
    );
}

#[test]
fn a_traced_profile_is_simplified_too() {
    let line: String = (1..20_000)
        .map(|k| f64::from(k) / 20_000.0)
        .map(|x| {
            format!(
                "L{:.5} {:.5}",
                300.0 * x,
                -8.0 * (std::f64::consts::PI * x).sin()
            )
        })
        .collect();
    let line = drawn(&format!("<path d=\"M0 0{line}L300 0\"/>"));
    let left = profiled(&line, "").unwrap();
    assert!((8..60).contains(&left.len()), "{}", left.len());
    assert!(left.iter().any(|p| (p[1] - 0.008).abs() < 0.01 * 0.008));
}

#[test]
fn lines_that_stay_too_long_are_refused() {
    // Teeth far larger than the chord error.
    let teeth = |n: usize| {
        let tooth = "l.05 -1l.05 1".repeat(n);
        drawn(&format!("<path d=\"M0 0{tooth}\"/>"))
    };
    for (n, expected) in [(1000, "more than 500"), (60_000, "more than 100000")] {
        let drawing = teeth(n);
        let error = at_once(move || profiled(&drawing, ""));
        assert!(error.message.contains(expected), "{error}");
    }
}

/// Points of a line of teeth of 1 mm, from end to end of a face 0.3 m long.
fn many_points(count: usize) -> String {
    let point = |k: usize| {
        let s = 0.3 * (k as f64 / count as f64 - 0.5);
        format!("[{s:.7}, {}]", if k % 2 == 1 { 0.001 } else { 0.0 })
    };
    let points: Vec<String> = (0..=count).map(point).collect();
    format!(
        "profile = {{ shape = \"points\", points = [{}] }}",
        points.join(", ")
    )
}

#[test]
fn lines_of_thousands_of_points_are_split_soon() {
    let text = design(
        "side = 0.4",
        &format!("0 = {{ {} }}", many_points(3990)),
        "side = 0.4",
        (0, 2),
    );
    let mate = "[moving.faces]\n2 = { mates = \"0\" }\n[target]";
    let text = text.replace("[target]", mate);
    let (sender, receiver) = channel();
    std::thread::spawn(move || sender.send(Design::parse(&text, "design.toml").map(|_| ())));
    // A second of a core; without halving the outlines, eighty.
    let read = receiver.recv_timeout(Duration::from_secs(60));
    assert_eq!(read.expect("an answer at once"), Ok(()));
}

#[test]
fn outlines_of_too_many_points_are_refused_before_they_are_split() {
    let text = design(
        "sides = 8\nside = 0.4",
        &format!("all = {{ {} }}", many_points(3000)),
        "side = 0.4",
        (0, 0),
    );
    let error = at_once(move || Design::parse(&text, "design.toml"));
    assert!(error.message.contains("points, more than 10000"), "{error}");
}

#[test]
fn what_is_not_read_is_told_in_one_line() {
    let many = format!(
        "<image/>\n{}<rect width=\"100\" height=\"100\"/>",
        "<text/>\n".repeat(20_000)
    );
    let design = outlined(&drawn(&many), "").unwrap();
    let doubts: Vec<_> = design
        .warnings
        .iter()
        .filter(|doubt| doubt.file.ends_with(".svg"))
        .collect();
    assert_eq!(doubts.len(), 1);
    let message = &doubts[0].message;
    assert!(
        message.ends_with("<image> in line 2, <text> in line 3 and 19999 more of it"),
        "{message}"
    );
}

#[test]
fn codes_and_lists_of_very_many_magnets_are_refused_at_once() {
    for code in [
        format!("code = \"{}\"", "N".repeat(1_000_000)),
        format!(
            "magnets = [{}]",
            "{ at = 0.0, pole = \"N\" },".repeat(100_000)
        ),
    ] {
        let text = design(
            "side = 0.1",
            &format!("east = {{ {code} }}"),
            "side = 0.1",
            (0, 2),
        );
        let error = at_once(move || Design::parse(&text, "design.toml"));
        assert!(
            error.message.contains("more than 1000"),
            "{}",
            error.message
        );
        assert!(error.to_string().len() < 1000);
    }
}
