//! Codes for new designs.

/// The code whose strongest wrong match with its own mate is weakest, where a match slid by k
/// places counts the attracting places minus the repelling ones. Of several such codes the first,
/// `N` before `S`.
pub fn code(magnets: usize) -> String {
    let worst = |bits: u32| {
        let slid = (1..magnets).map(|k| {
            let differ = (bits ^ (bits >> k)) & ((1 << (magnets - k)) - 1);
            (magnets - k) as i32 - 2 * differ.count_ones() as i32
        });
        slid.max().unwrap_or(0)
    };
    let best =
        (0..1_u32 << (magnets - 1)).min_by_key(|&bits| (worst(bits), bits.count_ones(), bits));
    let best = best.unwrap_or(0);
    let letter = |k: usize| match best >> (magnets - 1 - k) & 1 {
        0 => 'N',
        _ => 'S',
    };
    (0..magnets).map(letter).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_those_that_slide_least() {
        assert_eq!((code(1), code(4)), ("N".to_owned(), "NNNS".to_owned()));
        // Barker codes: at no slide the attraction exceeds that of one magnet.
        for magnets in [2, 3, 4, 5, 7, 11, 13] {
            let code: Vec<i32> = code(magnets)
                .bytes()
                .map(|b| if b == b'N' { 1 } else { -1 })
                .collect();
            let slid = |k: usize| code.iter().zip(&code[k..]).map(|(a, b)| a * b).sum::<i32>();
            assert!((1..magnets).all(|k| slid(k) <= 1), "{code:?}");
        }
    }
}
