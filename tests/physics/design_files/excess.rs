//! Files that are no files, and more of a thing than a design needs: refused at once, each with a
//! message.

use std::path::Path;
use std::sync::mpsc::channel;
use std::time::Duration;

use super::drawings::{design, drawn, outlined, profiled};
use tilebind::design::{Design, DesignError};

/// What `load` says, within a few seconds.
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
            "more than 200 km",
        ),
        ("<circle r=\"1e100\"/>", far),
        ("<ellipse rx=\"1e300\" ry=\"1\"/>", far),
    ];
    for (content, expected) in cases {
        let drawing = drawn(content);
        let error = at_once(move || outlined(&drawing, ""));
        assert!(error.message.contains(expected), "{content}: {error}");
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
    let petals = "c900 0 900 900 0 0".repeat(20_000);
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
