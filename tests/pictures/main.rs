//! The pictures of an analysis, drawn from data put together by hand.

mod paper_tile;

use paper_tile::{BOUND, Pair, clearance};
use tilebind::landscape::map::Pair as Tiles;
use tilebind::report::plots::{NamedPicture, Scene, draw_all};

fn pictures(pair: &Pair) -> Vec<NamedPicture> {
    let clearance = |q: &tilebind::Configuration| clearance(&pair.fixed, &pair.moving, q);
    draw_all(&Scene {
        name: "paper-tile",
        pair: Tiles {
            fixed: &pair.fixed,
            moving: &pair.moving,
            potential: &pair.potential,
            clearance: &clearance,
        },
        space: &pair.space,
        bound: BOUND,
        target: (0, 2),
        states: &pair.states,
        barriers: &pair.barriers,
    })
    .unwrap()
}

#[test]
fn pictures_are_compact_and_complete() {
    let pair = Pair::new();
    let start = std::time::Instant::now();
    let pictures = pictures(&pair);
    eprintln!("{:?}", start.elapsed());
    for NamedPicture { name, picture } in &pictures {
        eprintln!(
            "{name}: svg {} png {}",
            picture.svg.len(),
            picture.png.len()
        );
        let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR"));
        std::fs::write(folder.join(format!("{name}.svg")), &picture.svg).unwrap();
        std::fs::write(folder.join(format!("{name}.png")), &picture.png).unwrap();
    }
}
