//! The pictures of an analysis, drawn from hand-made data.

mod grids;
mod layout;
mod paper_tile;

use std::sync::OnceLock;

use paper_tile::{Pair, pair};
use tilebind::landscape::Catalogue;
use tilebind::report::plots::{Figure, Picture, Scene, Sheet, draw_all};

fn draw(pair: &Pair, catalogue: &Catalogue, sheet: &Sheet) -> Vec<Figure> {
    let scene = Scene::new(&pair.design, &pair.problem, catalogue);
    draw_all(&scene, sheet).unwrap()
}

fn figures() -> &'static [Figure] {
    static FIGURES: OnceLock<Vec<Figure>> = OnceLock::new();
    FIGURES.get_or_init(|| draw(pair(), &pair().catalogue, &Sheet::SCREEN))
}

/// All pictures by their names.
fn pictures() -> impl Iterator<Item = &'static (String, Picture)> {
    figures().iter().flat_map(|figure| &figure.pictures)
}

/// The texts of a picture.
fn texts_of(name: &str) -> Vec<&'static str> {
    let (_, picture) = pictures().find(|(known, _)| known == name).unwrap();
    texts(&picture.svg)
}

/// The texts of an SVG document, in order.
fn texts(svg: &str) -> Vec<&str> {
    svg.split("<text")
        .skip(1)
        .map(|rest| {
            let (_, content) = rest.split_once('>').unwrap();
            content.split_once("</text>").unwrap().0.trim()
        })
        .collect()
}

#[test]
fn every_picture_says_what_it_shows() {
    let expected: [(&str, &[&str]); 7] = [
        (
            "map",
            &[
                "paper-tile: lowest energy over θ",
                "x (mm)",
                "y (mm)",
                "along the face (mm)",
                "0",
                "\u{2212}10 mJ",
                "bond",
                "trap",
                "saddle",
                "pathway out",
                "tiles would overlap",
                "A: \u{2212}65.5 mJ",
                "B: \u{2212}16.0 mJ",
            ],
        ),
        (
            "approach",
            &[
                "paper-tile: west face in front of the fixed east face",
                "gap (mm)",
                "slide (mm)",
                "tilt (°)",
                "0",
                "bond",
            ],
        ),
        (
            "profiles",
            &[
                "bond A \u{2192} free",
                "trap B \u{2192} bond A",
                "length of the pathway (mm)",
                "energy U (mJ)",
                "0",
                "trap B \u{2212}16.03 mJ",
                "\u{2193} bond A \u{2212}65.47 mJ",
                "free: U \u{2192} 0",
            ],
        ),
        (
            "docking",
            &[
                "paper-tile: docking",
                "1",
                "8",
                "U = \u{2212}65.47 mJ",
                "touching",
                "north pole",
            ],
        ),
        (
            "models",
            &[
                "paper-tile: magnets as point dipoles and as blocks",
                "gap (mm)",
                "dipoles",
                "blocks",
                "44.8 % in contact",
                "35.5 % at 1.00 mm",
            ],
        ),
        (
            "disconnectivity",
            &[
                "energy U (log beyond \u{b1}6.5 µJ)",
                "0",
                "free",
                "bond A",
                "\u{2212}65.5 mJ",
                "\u{d7}16",
            ],
        ),
        (
            "disconnectivity-linear",
            &["energy U", "0", "bond A", "\u{2212}20 mJ", "\u{2212}40 mJ"],
        ),
    ];
    for ((name, labels), (drawn, picture)) in expected.iter().zip(pictures()) {
        assert_eq!(name, drawn);
        let texts = texts(&picture.svg);
        for label in *labels {
            assert!(texts.contains(label), "{name}: no {label:?} in {texts:?}");
        }
        // For the eye: target/tmp/NAME.svg and .png.
        let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR"));
        std::fs::write(folder.join(format!("{name}.svg")), &picture.svg).unwrap();
        std::fs::write(folder.join(format!("{name}.png")), png_of(picture)).unwrap();
    }
    assert_eq!(pictures().count(), expected.len());
}

#[test]
fn barriers_are_marked_with_their_height_and_their_bounds() {
    let texts = texts_of("profiles");
    let slid = pair().catalogue.escape(&pair().problem, 16).unwrap();
    let height = tilebind::units::si(slid.forward(), "J", 4);
    assert!(texts.contains(&format!("barrier {height}").as_str()));
    assert!(texts.iter().any(|text| text.starts_with("certified ")));
}

fn png_of(picture: &Picture) -> &[u8] {
    picture.png.as_ref().expect("a bitmap is wanted")
}

#[test]
fn pictures_are_compact_and_both_forms_have_the_same_size() {
    for (name, picture) in pictures() {
        assert!(picture.svg.len() < 300_000, "{name}: {}", picture.svg.len());
        let png = png_of(picture);
        assert!(png.len() < 300_000, "{name}: {}", png.len());
        let decoder = png::Decoder::new(std::io::Cursor::new(png));
        let mut reader = decoder.read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut pixels).unwrap();
        let size = format!("width=\"{}\" height=\"{}\"", info.width, info.height);
        assert!(picture.svg.contains(&size), "{name}");
        let dark = pixels.chunks(3).filter(|p| p.iter().all(|&c| c < 60));
        assert!(dark.count() > 1000, "{name} is all but blank");
    }
}

#[test]
fn an_svg_is_well_formed() {
    for (name, picture) in pictures() {
        let mut open = Vec::new();
        for tag in picture.svg.split('<').skip(1) {
            let (tag, _) = tag.split_once('>').unwrap();
            match tag.strip_prefix('/') {
                Some(closed) => assert_eq!(open.pop(), Some(closed), "{name}"),
                None if tag.ends_with('/') => {}
                None => open.push(tag.split_whitespace().next().unwrap()),
            }
        }
        assert!(open.is_empty(), "{name}: {open:?} left open");
    }
}

fn print() -> Sheet {
    Sheet::for_print(85.0, 7.0).unwrap()
}

/// Two columns of a journal are no wider than one figure: text keeps its size, panels move below
/// each other, on to another page where one has no room, and no title repeats the caption.
#[test]
fn pictures_for_print_have_the_width_that_was_asked_for() {
    let figures = draw(pair(), &pair().catalogue, &print());
    assert!(figures.iter().any(|figure| figure.pictures.len() > 1));
    for (name, picture) in figures.iter().flat_map(|figure| &figure.pictures) {
        assert!(!picture.svg.contains("paper-tile:"), "{name} has a title");
        let size = picture.svg.split_once("width=\"").unwrap().1;
        let width: f64 = size.split_once("mm\"").unwrap().0.parse().unwrap();
        assert!((width - 85.0).abs() < 1e-3, "{name}: {width}");
        let height = size.split_once("height=\"").unwrap().1;
        let height: f64 = height.split_once("mm\"").unwrap().0.parse().unwrap();
        assert!(height < 250.0, "{name}: {height} mm high");
        let pdf = picture.pdf.as_ref().unwrap();
        let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR"));
        std::fs::write(folder.join(format!("{name}-85mm.pdf")), pdf).unwrap();
        std::fs::write(folder.join(format!("{name}-85mm.png")), png_of(picture)).unwrap();
        assert!(
            pdf.starts_with(b"%PDF-1.7") && pdf.ends_with(b"%%EOF"),
            "{name}"
        );
        let text = String::from_utf8_lossy(pdf);
        let page = text.split_once("/MediaBox [0 0 ").unwrap().1;
        let points: f64 = page.split_once(' ').unwrap().0.parse().unwrap();
        assert!(
            (points - width * 72.0 / 25.4).abs() < 0.01,
            "{name}: {points} pt"
        );
        assert!(pdf.len() < 400_000, "{name}: {} bytes", pdf.len());
    }
}

#[test]
fn panels_can_be_pictures_of_their_own() {
    let apart = draw(pair(), &pair().catalogue, &print().with_panels_apart());
    let names = |figure: &Figure| -> Vec<String> {
        figure
            .pictures
            .iter()
            .map(|(name, _)| name.clone())
            .collect()
    };
    assert_eq!(names(&apart[0]), ["map-around", "map-target"]);
    assert_eq!(names(&apart[1]), ["approach-gap", "approach-slide"]);
    // What cannot be divided stays one picture.
    assert_eq!(names(&apart[3]), ["docking"]);
    for (_, picture) in &apart[0].pictures {
        assert!(texts(&picture.svg).contains(&"saddle"), "each has its key");
    }
}

#[test]
fn the_numbers_beside_a_picture_are_those_it_shows() {
    let numbers = |name: &str| {
        let figure = figures().iter().find(|figure| figure.name == name).unwrap();
        csv::Reader::from_reader(figure.data.as_bytes())
            .into_deserialize::<std::collections::BTreeMap<String, String>>()
            .map(Result::unwrap)
            .collect::<Vec<_>>()
    };
    let real = |row: &std::collections::BTreeMap<String, String>, key: &str| -> f64 {
        row[key].parse().unwrap()
    };
    let problem = &pair().problem;
    for row in numbers("map").iter().step_by(997) {
        let q = ["x_m", "y_m", "theta_rad"].map(|key| real(row, key));
        let energy = problem.energy(&tilebind::Configuration::from(q));
        let told = real(row, "energy_J");
        // Coordinates are rounded to a micrometre.
        assert!(
            (told - energy).abs() <= 1e-3 * energy.abs() + 1e-9,
            "{row:?} {energy}"
        );
    }
    let graph = numbers("disconnectivity");
    let bond = graph.iter().find(|row| row["states"] == "A").unwrap();
    assert!((real(bond, "energy_J") + 0.06547).abs() < 1e-5 && bond["copies"] == "16");
    assert!(real(bond, "joins_at_J") > real(bond, "energy_J"));
    let start = &numbers("profiles")[0];
    assert!((real(start, "energy_J") + 0.06547).abs() < 1e-5);
    assert_eq!(numbers("docking").len(), 8);
    let contact = &numbers("models")[0];
    let share = 1.0 - real(contact, "dipoles_J") / real(contact, "blocks_J");
    assert!((share - 0.448).abs() < 1e-3);
}

#[test]
fn an_analysis_without_states_still_has_its_maps() {
    let drawn = draw(pair(), &Catalogue::default(), &Sheet::SCREEN);
    let names: Vec<_> = drawn.iter().map(|figure| &figure.name[..]).collect();
    assert_eq!(names, ["map", "approach", "models"]);
}
