//! Faces assembled into an outline.

use nalgebra::Vector2;
use tilebind::tile::assembly::{FaceLine, FitTooLarge, Ring, assemble, surface_height};
use tilebind::tile::profile::{Profile, Waveform, complement, complement_arcs};
use tilebind::tile::{Face, Outline};

fn square(side: f64) -> Vec<Face> {
    let h = side / 2.0;
    let corners = [[h, -h], [h, h], [-h, h], [-h, -h]].map(|[x, y]| Vector2::new(x, y));
    (0..4)
        .map(|i| Face {
            name: i.to_string(),
            start: corners[i],
            end: corners[(i + 1) % 4],
        })
        .collect()
}

fn east(profile: Profile, fit: f64) -> Vec<FaceLine> {
    let mut lines = vec![FaceLine::default(); 4];
    lines[0] = FaceLine {
        polyline: profile.polyline().unwrap(),
        fit,
        ..FaceLine::default()
    };
    lines
}

fn area(ring: &Ring) -> f64 {
    Outline::new(ring.points.clone()).unwrap().area()
}

#[test]
fn flat_faces_give_the_square_back() {
    let ring = assemble(&square(2.0), &east(Profile::Flat, 0.0)).unwrap();
    assert_eq!(ring.faces, [0, 1, 2, 3]);
    assert_eq!(area(&ring), 4.0);
}

#[test]
fn square_teeth_up_to_the_corners_leave_no_strip_without_area() {
    let teeth = Profile::Teeth {
        form: Waveform::Square,
        count: 3,
        depth: 0.2,
        span: 2.0,
    };
    let ring = assemble(&square(2.0), &east(teeth, 0.0)).unwrap();
    // As much is added by the teeth as is taken away.
    assert!((area(&ring) - 4.0).abs() < 1e-12);
    // The first tooth cuts in: the south face ends where the cut does.
    assert!(
        ring.points
            .iter()
            .any(|p| (p - Vector2::new(0.9, -1.0)).norm() < 1e-12)
    );
}

#[test]
fn a_flat_face_is_drawn_back_between_its_neighbours() {
    let ring = assemble(&square(2.0), &east(Profile::Flat, 0.1)).unwrap();
    assert!((area(&ring) - 2.0 * 1.9).abs() < 1e-12);
}

#[test]
fn a_slot_drawn_back_grows_on_all_sides() {
    let slot = Profile::Tab {
        width: 1.0,
        depth: -0.5,
        draft: 0.0,
        offset: 0.0,
    };
    let ring = assemble(&square(2.0), &east(slot, 0.1)).unwrap();
    // The face stands 0.1 farther back and the slot reaches 0.1 deeper: as deep as before,
    // and wider by twice 0.1.
    assert!((area(&ring) - (2.0 * 1.9 - 1.2 * 0.5)).abs() < 1e-12);
}

#[test]
fn a_tab_thinner_than_twice_the_fit_cannot_be_drawn_back() {
    let tab = |width| Profile::Tab {
        width,
        depth: 0.5,
        draft: 0.0,
        offset: 0.0,
    };
    assert_eq!(
        assemble(&square(2.0), &east(tab(0.15), 0.1)),
        Err(FitTooLarge(0))
    );
    assert!(assemble(&square(2.0), &east(tab(0.25), 0.1)).is_ok());
}

#[test]
fn the_surface_of_a_step_is_its_lower_side() {
    let edges = [
        [[-1.0, 0.0], [0.0, 0.0]],
        [[0.0, 0.0], [0.0, 0.5]],
        [[0.0, 0.5], [1.0, 1.5]],
    ];
    assert_eq!(surface_height(&edges, 0.0), Some(0.0));
    assert_eq!(surface_height(&edges, 0.5), Some(1.0));
    assert_eq!(surface_height(&edges, 2.0), None);
    assert_eq!(surface_height(&edges, 1.0), Some(1.5));
}

/// Edges that are chords of an arc stay so when the face is drawn back, and no others become so.
#[test]
fn the_chords_of_an_arc_are_known() {
    let arc = Profile::Arc {
        width: 1.0,
        depth: -0.3,
        offset: 0.1,
    };
    let polyline = arc.polyline().unwrap();
    let arcs = arc.arcs(&polyline);
    let chords = polyline.len() - 1;
    assert_eq!(arcs, [[0, chords]]);
    assert_eq!(complement_arcs(&[[1, 3], [3, 6]], 9), [[2, 5], [5, 7]]);
    for (polyline, fit) in [(polyline.clone(), 0.0), (complement(&polyline), 0.05)] {
        let mut lines = vec![FaceLine::default(); 4];
        lines[0] = FaceLine {
            polyline,
            arcs: arcs.clone(),
            fit,
        };
        let ring = assemble(&square(2.0), &lines).unwrap();
        let outline = Outline::new(ring.points.clone()).unwrap();
        let known = outline.with_arcs(&ring.points, &ring.arcs);
        let on_it: Vec<bool> = known.arcs().iter().map(Option::is_some).collect();
        assert_eq!(on_it.iter().filter(|on| **on).count(), chords);
        // One after the other, and the rest are three whole sides and two halves.
        let changes = (0..on_it.len()).filter(|&k| on_it[k] != on_it[(k + 1) % on_it.len()]);
        assert_eq!((changes.count(), on_it.len() - chords), (2, 5));
    }
}
