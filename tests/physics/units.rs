//! Numbers with SI prefixes.

use tilebind::units::{si, si_range};

#[test]
fn prefixes_and_digits() {
    assert_eq!(si(-0.06547, "J", 4), "-65.47 mJ");
    assert_eq!(si(2.2e-6, "J", 2), "2.2 µJ");
    assert_eq!(si(0.43, "m", 3), "430 mm");
    assert_eq!(si_range(0.014537, 0.0151873, "J", 4), "14.54 to 15.19 mJ");
    assert_eq!(si_range(-2e-7, 0.0151873, "J", 3), "-0.0 to 15.2 mJ");
}

#[test]
fn prefix_and_decimals_are_those_of_the_rounded_number() {
    assert_eq!(si(0.99999, "J", 4), "1.000 J");
    assert_eq!(si(-0.99999, "J", 4), "-1.000 J");
    assert_eq!(si(0.99994, "J", 4), "999.9 mJ");
    assert_eq!(si(9.9999, "J", 3), "10.0 J");
    assert_eq!(si(-99.96, "J", 3), "-100 J");
    // With fewer digits than stand before the point none of these is rounded.
    assert_eq!(si(0.96, "J", 1), "960 mJ");
    assert_eq!(si(0.9996, "J", 1), "1 J");
}

#[test]
fn beyond_the_prefixes_numbers_go_on() {
    assert_eq!(si(999_960.0, "J", 4), "1000 kJ");
    assert_eq!(si(1.23456e9, "J", 4), "1234560 kJ");
    assert_eq!(si(9.99996e-13, "J", 4), "1.000 pJ");
    assert_eq!(si(-1.2346e-15, "J", 4), "-0.001235 pJ");
    assert_eq!(si(f64::MAX, "J", 4).len(), 306 + " kJ".len());
    for zero in [0.0, -0.0] {
        assert_eq!(si(zero, "J", 3), "0 J");
    }
    assert_eq!(si(f64::INFINITY, "J", 3), "inf J");
    assert_eq!(si(f64::NEG_INFINITY, "J", 3), "-inf J");
}

#[test]
fn both_ends_of_a_range_follow_its_larger_one() {
    assert_eq!(si_range(0.5, 0.99999, "J", 4), "0.500 to 1.000 J");
    assert_eq!(si_range(-0.99999, 0.5, "J", 4), "-1.000 to 0.500 J");
    assert_eq!(si_range(-0.99999, 0.99999, "J", 4), "-1.000 to 1.000 J");
    assert_eq!(si_range(9.9996e-4, 9.9999e-3, "J", 3), "1.0 to 10.0 mJ");
    assert_eq!(si_range(0.0, 0.0, "J", 4), "0 to 0 J");
    assert_eq!(si_range(-0.0, f64::INFINITY, "J", 4), "0 to inf J");
    assert_eq!(
        si_range(0.0145374, f64::INFINITY, "J", 4),
        "14.54 to inf mJ"
    );
}

/// Also where a tie falls on one side as joules and on the other as millijoules.
#[test]
fn never_a_thousand_and_never_a_digit_more() {
    for scale in [1e-9, 1e-6, 1e-3, 1.0, 1e3] {
        for digits in 3..9 {
            let below = 1.0 - 0.5 * 10f64.powi(-(digits as i32));
            for ulps in -20..=20 {
                let value = f64::from_bits((scale * below).to_bits().wrapping_add_signed(ulps));
                let text = si(value, "J", digits);
                let number = text.split(' ').next().unwrap();
                assert!(number.parse::<f64>().unwrap() < 1000.0, "{value}: {text}");
                let significant = number.trim_start_matches(['0', '.']);
                let count = significant.bytes().filter(u8::is_ascii_digit).count();
                assert_eq!(count, digits, "{value}: {text}");
            }
        }
    }
}
