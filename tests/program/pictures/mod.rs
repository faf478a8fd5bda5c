//! The pictures of an analysis, drawn from data put together by hand.

mod grids;
mod paper_tile;

use std::sync::OnceLock;

use paper_tile::{Pair, pair};
use tilebind::landscape::Inventory;
use tilebind::report::plots::{NamedPicture, Scene, draw_all};

fn draw(pair: &Pair, inventory: &Inventory) -> Vec<NamedPicture> {
    let scene = Scene::new(&pair.design, &pair.problem, inventory);
    draw_all(&scene).unwrap()
}

fn pictures() -> &'static [NamedPicture] {
    static PICTURES: OnceLock<Vec<NamedPicture>> = OnceLock::new();
    PICTURES.get_or_init(|| draw(pair(), &pair().inventory))
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
    let expected: [(&str, &[&str]); 6] = [
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
                "free 0 J",
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
                "energy U",
                "0",
                "free",
                "bond A",
                "\u{2212}65.5 mJ",
                "\u{d7}16",
            ],
        ),
    ];
    let pictures = pictures();
    for ((name, labels), drawn) in expected.iter().zip(pictures) {
        assert_eq!(*name, drawn.name);
        let texts = texts(&drawn.picture.svg);
        for label in *labels {
            assert!(texts.contains(label), "{name}: no {label:?} in {texts:?}");
        }
        // For the eye: target/tmp/NAME.svg and .png.
        let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR"));
        std::fs::write(folder.join(format!("{name}.svg")), &drawn.picture.svg).unwrap();
        std::fs::write(folder.join(format!("{name}.png")), &drawn.picture.png).unwrap();
    }
    assert_eq!(pictures.len(), expected.len());
}

#[test]
fn barriers_are_marked_with_their_height_and_their_bounds() {
    let texts = texts(&pictures()[2].picture.svg);
    let slid = pair().inventory.escape(&pair().problem, 16).unwrap();
    let height = tilebind::units::si(slid.forward(), "J", 4);
    assert!(texts.contains(&format!("barrier {height}").as_str()));
    assert!(texts.iter().any(|text| text.starts_with("certified ")));
}

#[test]
fn pictures_are_compact_and_both_forms_have_the_same_size() {
    for NamedPicture { name, picture } in pictures() {
        assert!(picture.svg.len() < 300_000, "{name}: {}", picture.svg.len());
        assert!(picture.png.len() < 300_000, "{name}: {}", picture.png.len());
        let decoder = png::Decoder::new(std::io::Cursor::new(&picture.png));
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
    for NamedPicture { name, picture } in pictures() {
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

#[test]
fn pictures_do_not_depend_on_the_number_of_threads() {
    let one = rayon::ThreadPoolBuilder::new().num_threads(1);
    let alone = one
        .build()
        .unwrap()
        .install(|| draw(pair(), &pair().inventory));
    let three = rayon::ThreadPoolBuilder::new().num_threads(3);
    let together = three
        .build()
        .unwrap()
        .install(|| draw(pair(), &pair().inventory));
    assert!(alone == together);
}

#[test]
fn an_analysis_without_states_still_has_its_maps() {
    let drawn = draw(pair(), &Inventory::default());
    let names: Vec<_> = drawn.iter().map(|p| p.name).collect();
    assert_eq!(names, ["map", "approach", "models"]);
}
