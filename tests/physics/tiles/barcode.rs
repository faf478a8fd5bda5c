//! Barcodes of magnets.

use tilebind::tile::barcode::{Barcode, Pole};

#[test]
fn the_mate_of_the_paper_s_code_is_the_paper_s() {
    assert_eq!(Barcode::parse("NNNS").unwrap().mate().to_string(), "NSSS");
}

#[test]
fn the_mate_of_a_mate_is_the_code() {
    for code in ["", "N", "NS.", "..SSNN.N"] {
        let code = Barcode::parse(code).unwrap();
        assert_eq!(code.mate().mate(), code);
    }
}

#[test]
fn magnets_are_centred_on_the_face_and_gaps_keep_their_place() {
    let places: Vec<_> = Barcode::parse("N..S").unwrap().places(0.04).collect();
    assert_eq!(places, [(0, -0.06, Pole::North), (3, 0.06, Pole::South)]);
}

#[test]
fn a_wrong_character_is_named_with_its_place() {
    let error = Barcode::parse("NnNS").unwrap_err();
    assert_eq!((error.index, error.character), (1, 'n'));
}
