//! Designs drawn in SVG files.

use std::f64::consts::PI;
use std::path::Path;

use tilebind::design::{Design, DesignError};

/// Chords leave curves by this share of the drawn shape's longer side at most.
const CHORD_SHARE: f64 = 1.0 / 2150.0;

/// A design whose fixed tile has the given keys and faces.
pub(crate) fn design(fixed: &str, faces: &str, moving: &str, target: (usize, usize)) -> String {
    format!(
        "[table]\nsize = [3.0, 3.0]\n\
         [fixed]\n{fixed}\nthickness = 0.01\nmass = 0.1\n[fixed.faces]\n{faces}\n\
         [moving]\n{moving}\nthickness = 0.01\nmass = 0.1\n\
         [target]\nfixed = {}\nmoving = {}\n",
        target.0, target.1
    )
}

/// The design, in a folder with a drawing `a.svg` of the given text.
pub(crate) fn parse(drawing: &str, design: &str) -> Result<Design, DesignError> {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a.svg"), drawing).unwrap();
    let file = folder.path().join("design.toml");
    Design::parse(design, file.to_str().unwrap())
}

/// A drawing of 400 mm x 400 mm.
pub(crate) fn drawn(content: &str) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"400mm\" height=\"400mm\" \
         viewBox=\"0 0 400 400\">\n{content}\n</svg>"
    )
}

/// A design of a tile with the outline `a.svg`, without magnets, and of one that its face 0 fits.
pub(crate) fn outlined(drawing: &str, keys: &str) -> Result<Design, DesignError> {
    let tile = format!("outline = {{ file = \"a.svg\"{keys} }}");
    let text = design(&tile, "", &tile, (0, 0));
    let mate = "[moving.faces]\n0 = { mates = \"0\" }\n[target]";
    parse(drawing, &text.replace("[target]", mate))
}

/// The warnings about a design's drawings.
fn doubts(design: &Design) -> Vec<&DesignError> {
    let doubts = design.warnings.iter();
    doubts
        .filter(|doubt| doubt.file.ends_with(".svg"))
        .collect()
}

/// The points of the fixed tile's face 0, drawn as the profile `a.svg` on a straight side 0.4 m long.
pub(crate) fn profiled(drawing: &str, keys: &str) -> Result<Vec<[f64; 2]>, DesignError> {
    let face = format!("0 = {{ profile = {{ shape = \"svg\", file = \"a.svg\"{keys} }} }}");
    let design = parse(drawing, &design("side = 0.4", &face, "side = 0.4", (1, 0)))?;
    // Face 0 looks along +x, s runs along +y.
    let points = design.pair.fixed.outline.vertices().iter();
    let corner = |p: &[f64; 2]| p[0].abs() == 0.2 && p[1] == 0.0;
    Ok(points
        .filter(|p| p.x > -0.199)
        .map(|p| [p.y, p.x - 0.2])
        .filter(|p| !corner(p))
        .collect())
}

fn load(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/designs/drawings");
    std::fs::read_to_string(path.join(name)).unwrap()
}

#[track_caller]
fn assert_points(found: &[[f64; 2]], expected: &[[f64; 2]]) {
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (a, b) in found.iter().zip(expected) {
        let distance = (a[0] - b[0]).hypot(a[1] - b[1]);
        assert!(distance < 1e-12, "{found:?}\n{expected:?}");
    }
}

#[test]
fn a_line_drawn_in_inkscape_is_the_profile() {
    let step = [
        [-0.05, 0.0],
        [-0.01, 0.0],
        [0.0, 0.02],
        [0.03, 0.02],
        [0.03, 0.0],
        [0.05, 0.0],
    ];
    let inkscape = load("inkscape.svg");
    // The flat pieces at either end are part of the face's base line.
    assert_points(
        &profiled(&inkscape, ", id = \"step\"").unwrap(),
        &step[1..5],
    );
    let moved = profiled(&inkscape, ", id = \"step\", offset = -0.03").unwrap();
    let expected = step.map(|[s, h]| [s - 0.03, h]);
    assert_points(&moved, &expected[1..5]);
    // The same line drawn from right to left.
    let reversed = drawn("<path d=\"M300 100h-20v-20h-30l-10 20h-40\"/>");
    assert_points(&profiled(&reversed, "").unwrap(), &step[1..5]);
    // A closed shape stands on the base line with its lowest edge.
    let closed = drawn("<polygon points=\"240,100 250,80 280,80 280,100\"/>");
    let offset = ", offset = 0.01";
    assert_points(&profiled(&closed, offset).unwrap(), &step[1..5]);
}

#[test]
fn what_is_not_read_of_a_drawing_is_named() {
    let face = "0 = { profile = { shape = \"svg\", file = \"a.svg\", id = \"step\" } }";
    let text = design("side = 0.4", face, "side = 0.4", (1, 0));
    let design = parse(&load("inkscape.svg"), &text).unwrap();
    let [doubt] = doubts(&design)[..] else {
        panic!("{:?}", design.warnings);
    };
    let told = "ignored in the drawing: <text> in line 50, <image> in line 55";
    assert_eq!(doubt.message, told);
    assert_eq!(doubt.place.as_ref().unwrap().line, 50);
    assert!(doubt.file.ends_with("a.svg"));
    assert_eq!(design.drawings.len(), 1);
    assert_eq!(design.drawings[0].file, "a.svg");
    let hidden = drawn(
        "<style>path{display:none}</style><path style=\"display:none\" d=\"M0 0h9v9z\"/>\n\
         <g visibility=\"hidden\"/><use href=\"#a\"/><defs><path id=\"a\"/></defs>\n\
         <line x1=\"0\" x2=\"0\"/><path d=\"M0 0\"/>\
         <path clip-path=\"url(#c)\" d=\"M0 0h100v100h-100z\"/>",
    );
    let design = outlined(&hidden, "").unwrap();
    assert_eq!(
        doubts(&design)[0].message,
        "ignored in the drawing: <style> in line 2, <path> (not displayed) in line 2, \
         <g> (hidden) in line 3, <path> that draws nothing in line 3 and 1 more of it, \
         <line> that draws nothing in line 4, the clip-path of <path> in line 4"
    );
}

#[test]
fn an_outline_from_openscad_has_its_segments_as_faces() {
    let openscad = load("openscad.svg");
    let design = outlined(&openscad, "").unwrap();
    let faces = &design.pair.fixed.faces;
    assert_eq!(faces.len(), 8);
    assert!(doubts(&design).is_empty());
    // Counter-clockwise from where the path begins: up is positive.
    assert!((faces[0].start.y - 0.05).abs() < 1e-12 && (faces[0].end.y - 0.05).abs() < 1e-12);
    assert!((faces[0].length() - 0.12).abs() < 1e-12);
    let area = 0.12 * 0.10 - 0.01 * 0.035;
    assert!((design.pair.fixed.outline.area() - area).abs() < 1e-15);
    assert!(design.pair.fixed.outline.centroid().norm() < 1e-15);
}

#[test]
fn corners_gather_segments_into_faces() {
    let openscad = load("openscad.svg");
    let centre = 0.01 * 0.035 * 0.0551 / (0.12 * 0.10 - 0.01 * 0.035);
    let (left, right) = (-0.06 + centre, 0.06 + centre);
    let corners = format!(
        ", corners = [[{right:.4}, -0.05], [{right:.4}, 0.05], [{left:.4}, 0.05], [{left:.4}, -0.05]]"
    );
    let design = outlined(&openscad, &corners).unwrap();
    let faces = &design.pair.fixed.faces;
    assert_eq!(faces.len(), 4);
    let lengths: Vec<f64> = faces.iter().map(|face| face.length()).collect();
    for (length, expected) in lengths.iter().zip([0.10, 0.12, 0.10, 0.12]) {
        assert!((length - expected).abs() < 1e-12, "{lengths:?}");
    }
    let area = 0.12 * 0.10 - 0.01 * 0.035;
    assert!((design.pair.fixed.outline.area() - area).abs() < 1e-12);
    let told = |corners: &str| outlined(&openscad, corners).unwrap_err().to_string();
    let off = told(", corners = [[0.0616, -0.05], [0.0616, 0.045]]");
    assert!(
        off.contains("the nearest drawn point is [0.06166, 0.05]"),
        "{off}"
    );
    let order = format!(", corners = [[{right:.4}, -0.05], [{left:.4}, 0.05], [{right:.4}, 0.05]]");
    assert!(
        told(&order).contains("counter-clockwise"),
        "{}",
        told(&order)
    );
}

#[test]
fn a_mate_of_a_drawn_face_is_its_complement() {
    let openscad = load("openscad.svg");
    let corners =
        ", corners = [[0.0616, -0.05], [0.0616, 0.05], [-0.0584, 0.05], [-0.0584, -0.05]]";
    let fixed = format!("outline = {{ file = \"a.svg\"{corners} }}");
    let mut text = design(&fixed, "", "side = 0.1", (0, 2));
    text = text.replace(
        "[target]",
        "[moving.faces]\nwest = { mates = \"0\" }\n[target]",
    );
    let design = parse(&openscad, &text).unwrap();
    // The slot's area has become a tab's.
    let slot = 0.01 * 0.035;
    assert!((design.pair.moving.outline.area() - (0.01 + slot)).abs() < 1e-12);
    assert!(
        (design.pair.bound.x - (0.0616 + 0.05)).abs() < 1e-4,
        "{:?}",
        design.pair.bound
    );
}

#[test]
fn circles_are_as_round_as_the_chord_error_says() {
    let (r, perimeter) = (0.05_f64, 0.1 * PI);
    let chord_error = 2.0 * r * CHORD_SHARE;
    for shape in [
        "<circle cx=\"200\" cy=\"200\" r=\"50\"/>",
        "<ellipse cx=\"20\" cy=\"20\" rx=\"50\"/>",
        "<path d=\"M150 200a50 50 0 0 0 50 50a50 50 0 1 0 -50 -50z\"/>",
        "<rect x=\"9\" y=\"9\" width=\"100\" height=\"100\" rx=\"50\"/>",
        "<g transform=\"scale(2 4)\"><circle r=\"12.5\" transform=\"scale(2 1)\"/></g>",
        "<circle r=\"50\" transform=\"rotate(37) skewX(0)\"/>",
    ] {
        let outline = outlined(&drawn(shape), "")
            .unwrap_or_else(|e| panic!("{e}"))
            .pair
            .fixed
            .outline
            .clone();
        // Points on the circle, chords inside it by no more than their error.
        let (mut nearest, mut farthest) = (f64::INFINITY, 0.0_f64);
        let n = outline.vertices().len();
        // Of the circle, not of the polygon's area: through three of its points.
        let corner = |i: usize| outline.vertices()[i * n / 3];
        let (a, b, c) = (corner(0), corner(1), corner(2));
        let (u, v) = (b - a, c - a);
        let twice = 2.0 * (u.x * v.y - u.y * v.x);
        let centre = a + nalgebra::Vector2::new(
            (v.y * u.norm_squared() - u.y * v.norm_squared()) / twice,
            (u.x * v.norm_squared() - v.x * u.norm_squared()) / twice,
        );
        for i in 0..n {
            let (a, b) = outline.edge(i);
            let (a, b) = (a - centre, b - centre);
            nearest = nearest.min(((a + b) / 2.0).norm());
            farthest = farthest.max(a.norm());
            assert!((a.norm() - r).abs() < 1e-5 * r, "{shape}: {a}");
        }
        assert!(r - nearest <= chord_error && farthest <= r + 1e-5 * r);
        let missing = PI * r * r - outline.area();
        assert!(
            missing > 0.0 && missing < perimeter * chord_error,
            "{missing}"
        );
        // Not many more chords than it takes: 2 acos(1 - e/r) each.
        let needed = PI / (1.0 - chord_error / r).acos();
        assert!((n as f64) < 2.0 * needed, "{n} chords, {needed} would do");
    }
}

#[test]
fn curves_stay_within_the_chord_error() {
    // A cubic that is a graph, and the same as two quadratics would not be: compare densely.
    let (p, q) = ([100.0, 200.0], [300.0, 200.0]);
    let (c, d) = ([150.0, 60.0], [200.0, 330.0]);
    let path = drawn("<path d=\"M100 200C150 60 200 330 300 200\"/>");
    let line = profiled(&path, "").unwrap();
    let at = |t: f64, k: usize| {
        let u = 1.0 - t;
        u.powi(3) * p[k] + 3.0 * u * u * t * c[k] + 3.0 * u * t * t * d[k] + t.powi(3) * q[k]
    };
    // The control points' box is 200 mm wide and 270 mm high.
    let chord_error = 0.27 * CHORD_SHARE;
    let mut worst = 0.0_f64;
    for i in 0..=4000 {
        let t = f64::from(i) / 4000.0;
        let [s, h] = [(at(t, 0) - 200.0) / 1e3, (200.0 - at(t, 1)) / 1e3];
        let to_segment = |a: [f64; 2], b: [f64; 2]| {
            let (u, v) = ([b[0] - a[0], b[1] - a[1]], [s - a[0], h - a[1]]);
            let share = (u[0] * v[0] + u[1] * v[1]) / (u[0] * u[0] + u[1] * u[1]);
            let share = share.clamp(0.0, 1.0);
            (v[0] - share * u[0]).hypot(v[1] - share * u[1])
        };
        let distances = line.windows(2).map(|w| to_segment(w[0], w[1]));
        worst = worst.max(distances.fold(f64::INFINITY, f64::min));
    }
    assert!(worst <= chord_error && worst > 0.1 * chord_error, "{worst}");
}

#[test]
fn transforms_and_view_boxes_are_composed() {
    let inkscape = load("inkscape.svg");
    // The plate is turned by a quarter: 60 wide, 30 high, corners rounded with 5.
    let plate = outlined(&inkscape, ", id = \"plate\"").unwrap();
    let vertices = plate.pair.fixed.outline.vertices();
    let most = |k: usize| vertices.iter().map(|p| p[k]).fold(0.0, f64::max);
    assert!((most(0) - 0.015).abs() < 1e-12 && (most(1) - 0.030).abs() < 1e-12);
    let area = 0.06 * 0.03 - (4.0 - PI) * 0.005 * 0.005;
    assert!((plate.pair.fixed.outline.area() - area).abs() < 0.01 * PI * 0.06 * CHORD_SHARE);
    // The disc is flattened to half its height.
    let disc = outlined(&inkscape, ", id = \"disc\"").unwrap();
    let area = PI * 0.05 * 0.025;
    assert!((disc.pair.fixed.outline.area() - area).abs() < 0.25 * 0.1 * CHORD_SHARE);

    let square = "<rect width=\"100\" height=\"100\"/>";
    for (head, side) in [
        (
            "width=\"10cm\" height=\"20cm\" viewBox=\"0 0 100 200\"",
            0.1,
        ),
        (
            "width=\"4in\" height=\"4in\" viewBox=\"-7 3 400 400\"",
            0.0254,
        ),
        ("width=\"72pt\" viewBox=\"0 0 50 60\"", 0.0508),
        ("width=\"50mm\" height=\"50mm\"", 100.0 * 0.0254 / 96.0),
    ] {
        let drawing = format!("<svg {head}>{square}</svg>");
        let design = outlined(&drawing, "").unwrap_or_else(|e| panic!("{e}"));
        assert!(
            (design.pair.fixed.outline.area().sqrt() - side).abs() < 1e-12,
            "{head}"
        );
    }
    for (unit, side) in [("mm", 0.1), ("cm", 1.0), ("px", 100.0 * 0.0254 / 96.0)] {
        let drawing = format!("<svg width=\"7\" height=\"9\">{square}</svg>");
        let design = outlined(&drawing, &format!(", unit = \"{unit}\"")).unwrap();
        assert!((design.pair.fixed.outline.area().sqrt() - side).abs() < 1e-12);
    }
}

#[test]
fn every_path_command_draws() {
    // A square of 100 drawn in several ways; rounded ones by arcs and curves without bulges.
    for d in [
        "M0 0H100V100H0Z",
        "m0,0 100,0 0,100 -100,0 z",
        "M 0 0 l 100 0 v 100 h -100 v -100",
        "M0 0C30 0 60 0 100 0S100 60 100 100Q50 100 0 100T0 0Z",
        "M0 0Q50 0 100 0L100 100A0 0 0 0 0 0 100Z",
    ] {
        let area = outlined(&drawn(&format!("<path d=\"{d}\"/>")), "");
        // Smooth quadratic: the mirrored control point lies off the side, so its area differs.
        let smooth = if d.contains('T') { 1e-2 } else { 1e-15 };
        let area = area
            .unwrap_or_else(|e| panic!("{e}"))
            .pair
            .fixed
            .outline
            .area();
        assert!((area - 0.01).abs() < smooth, "{d}: {area}");
    }
}

/// A square of 80 mm as programs write it: by lines, by way of others, in other units.
#[test]
fn an_outline_is_the_same_however_it_is_written() {
    for (file, keys, error) in [
        ("outline-as-four-line-elements.svg", "", 1e-15),
        ("outline-as-four-subpaths.svg", "", 1e-15),
        ("outline-as-symbol.svg", "", 1e-15),
        ("outline-as-use-of-defs.svg", "", 1e-15),
        ("outline-with-20um-gap.svg", "", 1e-15),
        (
            "affinity-300dpi-no-size.svg",
            ", unit = \"0.0846667 mm\"",
            1e-7,
        ),
        ("affinity-300dpi-no-size.svg", ", dpi = 300", 2e-7),
        ("affinity-300dpi-no-size.svg", ", dpi = \"300 dpi\"", 2e-7),
        ("illustrator-80mm-square-in-pt.svg", ", unit = \"pt\"", 1e-6),
    ] {
        let design = outlined(&load(file), keys).unwrap_or_else(|e| panic!("{file}: {e}"));
        let outline = &design.pair.fixed.outline;
        assert_eq!(design.pair.fixed.faces.len(), 4, "{file}");
        for (vertex, expected) in outline.vertices().iter().zip([
            [-0.04, 0.04],
            [-0.04, -0.04],
            [0.04, -0.04],
            [0.04, 0.04],
        ]) {
            let distance = (vertex.x - expected[0]).hypot(vertex.y - expected[1]);
            assert!(distance <= error, "{file}: {:?}", outline.vertices());
        }
        let gaps: Vec<_> = doubts(&design).iter().map(|d| &d.message).collect();
        if file.contains("gap") {
            assert!(
                gaps.len() == 1 && gaps[0].contains("a gap of 0.02 mm"),
                "{gaps:?}"
            );
        } else {
            assert!(gaps.is_empty(), "{gaps:?}");
        }
    }
}

#[test]
fn view_boxes_are_fitted_wherever_they_stand() {
    let square = "<rect width=\"10\" height=\"10\"/>";
    let large = "<rect width=\"50\" height=\"50\"/>";
    let head = "<svg x=\"10\" y=\"10\" width=\"80\" height=\"40\" viewBox=\"0 0 10 10\"";
    for (content, size) in [
        (format!("{head}>{square}</svg>"), [0.04, 0.04]),
        (
            format!("{head} preserveAspectRatio=\"none\">{square}</svg>"),
            [0.08, 0.04],
        ),
        (
            format!("{head} preserveAspectRatio=\"xMinYMax slice\">{square}</svg>"),
            [0.08, 0.08],
        ),
        (
            format!(
                "<symbol id=\"s\" viewBox=\"0 0 10 10\">{square}</symbol><use href=\"#s\" \
                     width=\"80\" height=\"90\" transform=\"scale(.5 1)\"/>"
            ),
            [0.04, 0.08],
        ),
        (
            format!(
                "<symbol id=\"s\" width=\"60\" height=\"70\" viewBox=\"0 0 10 10\">{square}\
                     </symbol><g transform=\"rotate(90)\"><use href=\"#s\"/></g>"
            ),
            [0.06, 0.06],
        ),
        (
            format!("{head}><rect width=\"50%\" height=\"100%\"/></svg>"),
            [0.02, 0.04],
        ),
        (format!("<svg x=\"3\">{large}</svg>"), [0.05, 0.05]),
        (
            format!("<switch><text/><g requiredExtensions=\"e\"/><g/></switch>{large}"),
            [0.05, 0.05],
        ),
    ] {
        let design = outlined(&drawn(&content), "").unwrap_or_else(|e| panic!("{content}: {e}"));
        let vertices = design.pair.fixed.outline.vertices();
        let most = |k: usize| vertices.iter().map(|p| p[k]).fold(0.0, f64::max);
        let found = [0, 1].map(|k| 2.0 * most(k));
        assert!(
            (0..2).all(|k| (found[k] - size[k]).abs() < 1e-12),
            "{content}: {found:?}"
        );
        // Only parts that are cut off are reported.
        let cut = doubts(&design)
            .iter()
            .any(|d| d.message.contains("clips its content"));
        assert_eq!(cut, content.contains("slice"), "{:?}", design.warnings);
    }
}

#[test]
fn lines_join_where_their_ends_meet() {
    let square = |gap: f64| {
        format!(
            "<line x1=\"0\" y1=\"0\" x2=\"80\" y2=\"0\"/><line x1=\"80\" y1=\"{gap}\" x2=\"80\" \
             y2=\"80\"/><path d=\"M0 80H80\"/><path d=\"M0 80A80 80 0 0 0 0 0\"/>"
        )
    };
    for gap in [0.0, 0.02, 0.09] {
        let design = outlined(&drawn(&square(gap)), "").unwrap();
        let tile = &design.pair.fixed;
        assert_eq!(tile.faces.len(), 4);
        // Straight sides meet where they cross, so the gap does not move them.
        let half = PI / 6.0;
        let bay = 0.08 * 0.08 * (half - half.sin() * half.cos());
        let error = 0.08 * (0.08 * CHORD_SHARE);
        assert!((tile.outline.area() - 0.0064 + bay).abs() < error, "{gap}");
        assert_eq!(doubts(&design).len(), usize::from(gap > 0.0));
        let arcs = tile.outline.arcs();
        assert!(arcs.iter().filter(|arc| arc.is_some()).count() >= 2);
        assert_eq!(arcs.iter().filter(|arc| arc.is_none()).count(), 3);
    }
    let error = outlined(&drawn(&square(0.2)), "").unwrap_err();
    assert!(
        error.message.contains("its ends are 0.2 mm apart"),
        "{error}"
    );
    // A piece that closes a path across a gap is no face; a drawn one is.
    let closing = |d: &str| outlined(&drawn(&format!("<path d=\"{d}\"/>")), "").unwrap();
    assert_eq!(closing("M0 0H80V80H0V.05Z").pair.fixed.faces.len(), 4);
    assert_eq!(closing("M0 0H80V80H0V.05V0Z").pair.fixed.faces.len(), 5);
    // By the group's id, beside another shape.
    let group = format!(
        "<g id=\"tile\">{}</g><circle id=\"c\" r=\"9\"/>",
        square(0.0)
    );
    let design = outlined(&drawn(&group), ", id = \"tile\"").unwrap();
    assert_eq!(design.pair.fixed.faces.len(), 4);
    assert!(
        outlined(&drawn(&group), "")
            .unwrap_err()
            .message
            .contains("has 5 shapes")
    );
    // What is drawn in pieces has the chords of the whole.
    let quarters = [
        "M150 200A50 50 0 0 0 ",
        "200 250A50 50 0 0 0 ",
        "250 200A50 50 0 0 0 ",
    ];
    let quarters = [
        quarters[0],
        quarters[1],
        quarters[2],
        "200 150A50 50 0 0 0 ",
        "150 200",
    ];
    let whole = format!("<path d=\"{}\"/>", quarters.concat());
    let pieces: String = quarters
        .windows(2)
        .map(|two| {
            let end: Vec<&str> = two[1].split('A').collect();
            let start = two[0].trim_start_matches('M');
            format!("<path d=\"M{start}{}\"/>", end[0])
        })
        .collect();
    let [whole, pieces] = [whole, pieces].map(|content| {
        outlined(&drawn(&content), "")
            .unwrap()
            .pair
            .fixed
            .outline
            .clone()
    });
    assert_eq!(whole.vertices().len(), pieces.vertices().len());
    assert!((whole.area() - pieces.area()).abs() < 1e-12);
    // An open profile of two lines.
    let profile =
        drawn("<path d=\"M200 100L220 90\"/><line x1=\"200\" y1=\"100.05\" x2=\"180\" y2=\"90\"/>");
    let line = profiled(&profile, "").unwrap();
    assert!((line[1][1] + 0.01).abs() < 3e-5, "{line:?}");
}

#[test]
fn what_is_not_painted_is_left_out_beside_what_is() {
    let board = "<rect width=\"400\" height=\"400\" style=\"fill:none;\"/>";
    let tile = "<g style=\"fill:none;stroke:#000\"><rect width=\"80\" height=\"80\"/></g>";
    let design = outlined(&drawn(&format!("{board}{tile}")), "").unwrap();
    assert!((design.pair.fixed.outline.area() - 0.0064).abs() < 1e-12);
    assert!(
        doubts(&design)[0]
            .message
            .contains("<rect> (no fill, no stroke)")
    );
    // Alone it is what is meant; a style sheet may paint it.
    assert!(outlined(&drawn(board), "").is_ok());
    let sheet = "<style>rect{stroke:red}</style>";
    assert!(outlined(&drawn(&format!("{sheet}{board}{tile}")), "").is_err());
}

#[test]
fn a_drawing_without_a_size_is_told_what_units_make_of_it() {
    let drawing = load("illustrator-80mm-square-in-pt.svg");
    let help = outlined(&drawing, "").unwrap_err().help;
    for said in [
        "unit = \"pt\" (the drawing is then 80 x 80 mm)",
        "unit = \"px\" (the drawing is then 60 x 60 mm)",
        "dpi = 300 (the drawing is then 19.2 x 19.2 mm)",
    ] {
        assert!(help.contains(said), "{help}");
    }
    let wrong = |keys: &str| outlined(&drawing, keys).unwrap_err().to_string();
    assert!(wrong(", unit = \"mmm\"").contains("`unit` cannot be \"mmm\""));
    assert!(wrong(", unit = \"3 kg\"").contains("in quotes, such as \"5 cm\": m, cm, mm"));
    assert!(wrong(", unit = \"pt\", dpi = 72").contains("keep one of the two"));
    assert!(wrong(", dpi = 0").contains("above zero"));
}

/// The workshop cuts along arcs drawn as arcs or as the curves that programs convert them to.
#[test]
fn arcs_of_drawings_are_known_as_arcs() {
    let arcs = |drawing: &str| {
        let design = outlined(drawing, "").unwrap();
        let arcs = design.pair.fixed.outline.arcs().to_vec();
        let mut known: Vec<usize> = arcs.into_iter().flatten().collect();
        known.sort_unstable();
        known.dedup();
        known.len()
    };
    assert_eq!(arcs(&load("arc-bump-as-A-command.svg")), 1);
    assert_eq!(arcs(&load("arc-hollow-as-A-command.svg")), 1);
    // Two cubics, within a micrometre of an arc each.
    assert_eq!(arcs(&load("arc-hollow-as-bezier.svg")), 2);
    assert_eq!(
        arcs(&drawn("<rect width=\"80\" height=\"80\" rx=\"9\"/>")),
        4
    );
    let quarter = "C90 72.0914 72.0914 90 50 90C27.9086 90 10 72.0914 10 50";
    let circle = format!(
        "<path d=\"M90 50{quarter}C10 27.9086 27.9086 10 50 10C72.0914 10 90 27.9086 90 50Z\"/>"
    );
    assert_eq!(arcs(&drawn(&circle)), 4);
    assert_eq!(arcs(&drawn("<ellipse rx=\"40\" ry=\"39\"/>")), 0);
    assert_eq!(
        arcs(&drawn("<path d=\"M0 0C30 40 60 -40 90 0V90H0Z\"/>")),
        0
    );
}
