//! Shapes of faces and their complements.

use std::f64::consts::PI;

use tilebind::tile::profile::{
    CHORD_SHARE, CHORD_SHARE_OF_RADIUS, Polyline, Profile, ProfileError, Waveform, complement,
};

fn tab(width: f64, depth: f64, draft: f64, offset: f64) -> Result<Polyline, ProfileError> {
    let tab = Profile::Tab {
        width,
        depth,
        draft,
        offset,
    };
    tab.polyline()
}

fn teeth(form: Waveform, count: u32, depth: f64, span: f64) -> Polyline {
    let teeth = Profile::Teeth {
        form,
        count,
        depth,
        span,
    };
    teeth.polyline().unwrap()
}

fn arc(width: f64, depth: f64, offset: f64) -> Polyline {
    let arc = Profile::Arc {
        width,
        depth,
        offset,
    };
    arc.polyline().unwrap()
}

fn all() -> Vec<Polyline> {
    vec![
        tab(0.2, 0.02, 0.3, 0.01).unwrap(),
        tab(0.2, -0.02, -0.3, 0.0).unwrap(),
        teeth(Waveform::Sine, 3, 0.01, 0.4),
        teeth(Waveform::Sine, 4, -0.02, 0.4),
        teeth(Waveform::Triangle, 3, 0.01, 0.4),
        teeth(Waveform::Square, 2, 0.01, 0.4),
        arc(0.3, 0.03, 0.0),
        arc(0.1, -0.08, 0.05),
    ]
}

#[test]
fn the_complement_of_the_complement_is_the_profile() {
    for line in all() {
        assert_eq!(complement(&complement(&line)), line);
    }
}

#[test]
fn profiles_begin_and_end_on_the_base_line() {
    for line in all() {
        assert_eq!(line[0][1], 0.0);
        assert_eq!(line[line.len() - 1][1], 0.0);
        assert!(line[0][0] < line[line.len() - 1][0]);
    }
}

#[test]
fn teeth_are_odd_so_that_they_are_their_own_complement() {
    for form in [Waveform::Sine, Waveform::Triangle, Waveform::Square] {
        for count in 1..6 {
            let line = teeth(form, count, 0.013, 0.43);
            for (a, b) in line.iter().zip(complement(&line)) {
                assert!((a[0] - b[0]).abs() < 1e-16 && (a[1] - b[1]).abs() < 1e-16);
            }
        }
    }
}

/// Height of a profile that is a function of s, between its points.
fn height(line: &[[f64; 2]], s: f64) -> f64 {
    let k = line.windows(2).position(|w| s <= w[1][0]).unwrap();
    let ([s0, h0], [s1, h1]) = (line[k], line[k + 1]);
    h0 + (h1 - h0) * (s - s0) / (s1 - s0)
}

#[test]
fn teeth_follow_their_formula() {
    let (depth, span, count) = (0.012, 0.4, 3);
    let phase = |s: f64| 2.0 * PI * f64::from(count) * s / span;
    let wave = |form: Waveform, s: f64| match form {
        Waveform::Sine => phase(s).sin(),
        Waveform::Triangle => 2.0 / PI * phase(s).sin().asin(),
        Waveform::Square => phase(s).sin().signum(),
    };
    for (form, tolerance) in [
        (Waveform::Sine, CHORD_SHARE * depth),
        (Waveform::Triangle, 1e-15),
        (Waveform::Square, 1e-15),
    ] {
        let line = teeth(form, count, depth, span);
        let mut worst: f64 = 0.0;
        for i in 1..1000 {
            let s = span * (i as f64 / 1000.0 - 0.5) + 1e-5;
            worst = worst.max((height(&line, s) - depth / 2.0 * wave(form, s)).abs());
        }
        assert!(worst <= tolerance, "{form:?}: {worst}");
    }
}

#[test]
fn chords_of_an_arc_stay_within_their_error() {
    for (width, depth) in [(0.3, 0.02), (0.1, 0.05), (0.1, 0.08), (0.3, -0.02)] {
        let line = arc(width, depth, 0.0);
        let sagitta = f64::abs(depth);
        let radius = (width * width / 4.0 + sagitta * sagitta) / (2.0 * sagitta);
        let centre = depth - radius * depth.signum();
        let to_centre = |p: [f64; 2]| p[0].hypot(p[1] - centre);
        for pair in line.windows(2) {
            let middle = [
                (pair[0][0] + pair[1][0]) / 2.0,
                (pair[0][1] + pair[1][1]) / 2.0,
            ];
            assert!((to_centre(pair[0]) - radius).abs() < 1e-12);
            let error = radius - to_centre(middle);
            assert!(error > 0.0 && error <= CHORD_SHARE * sagitta, "{error}");
            assert!(error <= CHORD_SHARE_OF_RADIUS * radius, "{error}");
        }
        let top = line.iter().map(|p| p[1].abs()).fold(0.0, f64::max);
        assert!((top - sagitta).abs() < 1e-15);
    }
}

/// A curve keeps its shape at every size: the same number of chords, and no sine becomes a
/// triangle.
#[test]
fn curves_have_the_same_chords_at_every_size() {
    let of = |s: f64| {
        let sine = teeth(Waveform::Sine, 4, 0.010 * s, 0.43 * s);
        [
            arc(0.06 * s, 0.005 * s, 0.0),
            arc(0.1 * s, -0.08 * s, 0.01 * s),
            sine,
        ]
    };
    let whole = of(1.0);
    assert_eq!(whole.each_ref().map(Vec::len), [13, 25, 65]);
    for s in [0.01, 0.1, 10.0] {
        for (line, other) in whole.iter().zip(of(s)) {
            assert_eq!(line.len(), other.len(), "{s}");
            for (a, b) in line.iter().zip(other) {
                assert!(
                    (0..2).all(|k| (a[k] * s - b[k]).abs() < 1e-15 * (1.0 + s)),
                    "{s}"
                );
            }
        }
    }
    let triangle = teeth(Waveform::Triangle, 4, 0.010, 0.43);
    let sine = &whole[2];
    let apart = sine.iter().map(|p| (height(&triangle, p[0]) - p[1]).abs());
    // The most that sin(x) differs from 2 x / pi, at cos(x) = 2 / pi.
    assert!(apart.fold(0.0, f64::max) > 0.2 * 0.005);
}

#[test]
fn a_tab_that_comes_to_a_point_is_refused_with_the_steepest_draft() {
    let spike = |draft| tab(0.02, 0.02, draft, 0.0);
    let Err(ProfileError::SidesMeet { largest_draft }) = spike(0.6) else {
        panic!("a tab with crossed sides was drawn");
    };
    assert!((largest_draft - 0.5_f64.atan()).abs() < 1e-15);
    assert!(spike(largest_draft - 1e-6).is_ok());
}
