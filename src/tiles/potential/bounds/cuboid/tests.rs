use super::*;
use crate::configuration::Configuration;
use crate::potential::cuboid::exact;
use crate::sample;

/// The fixed tile of the paper.
fn paper_tile() -> Tile {
    sample::tile(4, 0.43, "NNNS", &[0, 1, 2, 3])
}

#[test]
fn a_block_on_its_own_copy_bounds_every_pair() {
    for enclosed in enclosed(&paper_tile(), Level::best()) {
        let exact = exact(&enclosed.block, &enclosed.block).energy;
        let bound = enclosed.own * enclosed.own;
        assert!(exact <= bound && bound < 1.03 * exact, "{exact} {bound}");
        assert!(enclosed.inside);
    }
}

#[test]
fn a_block_that_is_cut_or_sticks_out_does_not_count_as_inside() {
    let mut a = paper_tile();
    a.magnets[0].position.x += 1e-4;
    a.magnets[1].size[1] = 0.5;
    let enclosed = enclosed(&a, Level::best());
    assert!(!enclosed[0].inside && !enclosed[1].inside && enclosed[2].inside);
    let block = Block::new(1.0, [0.2, 0.2, 0.1]);
    let notch = [
        [-1.0, -1.0],
        [1.0, -1.0],
        [1.0, 1.0],
        [0.0, 0.05],
        [-1.0, 1.0],
    ];
    let outline = Outline::new(notch.map(|[x, y]| Vector2::new(x, y)).to_vec()).unwrap();
    assert!(is_cut(&block, &outline, 1e-9));
    assert!(!is_cut(&Block::new(1.0, [0.2, 0.05, 0.1]), &outline, 1e-9));
}

#[test]
fn what_is_unknown_of_blocks_in_contact_falls_as_the_square_of_the_cell() {
    let problem = sample::paper_tile();
    let pair = problem.pair.as_ref().unwrap();
    let bounds = CuboidBounds::new(&pair.fixed, &pair.moving);
    let unknown = |slide: f64, half: f64| {
        let found = bounds.enclose(&Cell {
            centre: Configuration::new(0.43 + 0.5 * half, slide, 0.2 * half),
            half: [half, half, half / 0.2],
        });
        found.high - found.low
    };
    // Faces flush, beside each other by a part of their width, and on the next ones.
    for slide in [0.0, -0.0013, -0.04] {
        for half in [5e-5, 2.5e-5] {
            // Over two halvings, because the cuts of panels change from one to the next.
            let ratio = (unknown(slide, half) / unknown(slide, half / 4.0)).sqrt();
            // Less than four for the logarithm.
            assert!(ratio > 3.3 && ratio < 4.0, "{slide} {half} {ratio}");
        }
    }
}

#[test]
fn blocks_that_nearly_touch_count_as_more_work_than_those_far_apart_on_every_kernel() {
    let problem = sample::paper_tile();
    let pair = problem.pair.as_ref().unwrap();
    let work = |level: Level, x: f64| {
        let bounds = CuboidBounds::with_level(&pair.fixed, &pair.moving, level);
        let centre = Configuration::new(x, 0.0, 0.0);
        bounds
            .enclose(&Cell {
                centre,
                half: [1e-3, 1e-3, 5e-3],
            })
            .work
    };
    let [near, far] = [0.43, 0.8].map(|x| work(Level::best(), x));
    assert_eq!(far, A_CELL + A_PAIR * 256);
    assert!(near > 2 * far, "{near} {far}");
    for level in Level::available() {
        assert_eq!(work(level, 0.43), near, "{level:?}");
    }
}
