//! The best schedule of a shaken table, against all schedules tried one by one.

use nalgebra::{DMatrix, RowDVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::kinetics::population::chain::Chain;
use tilebind::kinetics::population::mixture::schedule;

/// A chain with rates over several powers of ten.
fn chain(random: &mut ChaCha8Rng, states: usize) -> Chain {
    let rate = |_, _| libm::exp(random.random_range(-5.0..3.0));
    Chain::new(DMatrix::from_fn(states, states, rate))
}

/// No schedule exceeds the bound, none of one or two phases exceeds the one found, and what is
/// found has the value that its slots have one after the other.
#[test]
fn no_schedule_of_two_phases_is_better() {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let (slots, time) = (5, 3.0);
    for _ in 0..60 {
        let settings: Vec<Chain> = (0..3).map(|_| chain(&mut random, 4)).collect();
        let values: Vec<f64> = (0..4).map(|_| random.random_range(0.0..1.0)).collect();
        let steps = settings
            .iter()
            .map(|it| it.transitions(time / slots as f64));
        let steps: Vec<DMatrix<f64>> = steps.collect();
        let value = |schedule: &[usize]| {
            let mut p = RowDVector::zeros(4);
            p[0] = 1.0;
            let end = schedule.iter().fold(p, |p, k| p * &steps[*k]);
            end.iter()
                .zip(&values)
                .map(|(p, value)| p * value)
                .sum::<f64>()
        };
        let found = schedule(&settings, &values, time, slots);
        assert!((value(&found.schedule) - found.value).abs() < 1e-12);
        for number in 0..3usize.pow(slots as u32) {
            let one: Vec<usize> = (0..slots as u32)
                .map(|k| number / 3usize.pow(k) % 3)
                .collect();
            let reached = value(&one);
            assert!(reached <= found.bound + 1e-12, "{one:?}");
            let turns = one.windows(2).filter(|two| two[0] != two[1]).count();
            if turns <= 1 {
                assert!(reached <= found.value * (1.0 + 1e-9), "{one:?} {found:?}");
            }
        }
    }
}
