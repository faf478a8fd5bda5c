use super::*;
use crate::design::Design;
use crate::potential::cuboid::block;

/// The fixed tile of the paper.
fn paper_tile() -> Tile {
    let design = Design::load("shapes/paper-tile.toml".as_ref()).unwrap();
    design.pair.fixed.clone()
}

#[test]
fn a_block_on_its_own_copy_bounds_every_pair() {
    for enclosed in enclosed(&paper_tile(), Level::best()) {
        let exact = block::exact(&enclosed.block, &enclosed.block).energy;
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
    assert!(is_cut(&block, &outline));
    assert!(!is_cut(&Block::new(1.0, [0.2, 0.05, 0.1]), &outline));
}
