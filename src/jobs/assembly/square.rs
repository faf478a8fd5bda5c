//! Counted squares: N x N tiles from O(log N) kinds of tiles.
//!
//! After Rothemund and Winfree, *The program-size complexity of self-assembled squares* (STOC
//! 2000): binary counters of n = O(log N) bits along the west and the south edge count until they
//! overflow, and one kind of tile fills the rest. A counter alternates between a line of increments
//! from its lowest bit to its highest, and a line of copies back. The highest bit of a line of
//! increments begins the next line unless it overflows, so from the value c there are 2 (2^n - c)
//! lines, including the first one; if their number is odd, a line of caps is added.

use std::ops::RangeInclusive;

use super::{TileSet, TileType};

/// The smallest side, and the largest that fits a canvas.
pub const SIDES: RangeInclusive<usize> = 8..=512;

/// The number of bits of the two counters.
fn bits(side: usize) -> usize {
    let lines = side.div_ceil(2);
    (usize::BITS - (lines - 1).leading_zeros()).max(2) as usize
}

/// The set for a square of `side` x `side` tiles.
pub fn counted(side: usize) -> TileSet {
    let n = bits(side);
    let mut set = TileSet {
        name: format!("square-{side}"),
        tau: Some(2.0),
        size: Some([side + 4; 2]),
        seed: vec![(side + 1, 2, 0)],
        ..TileSet::default()
    };
    // The west counter's lines are rows; the south one's are columns, its copy in the diagonal.
    let corner = Counter {
        prefix: "w",
        side: "fill-e",
        n,
        lines: side,
        transposed: false,
    };
    let along = Counter {
        prefix: "s",
        side: "fill-n",
        n,
        lines: side - n,
        transposed: true,
    };
    corner.add(&mut set, [None, Some("s-first")]);
    along.add(&mut set, [Some("s-first"), None]);
    let fill = [along.side, corner.side].map(|name| Some(set.glue(name, 1.0)));
    let glues = [fill[0], fill[1], fill[0], fill[1]];
    set.tiles.push(TileType::new("fill", glues));
    set
}

/// A counter, described as if it counted northwards with the highest bit in the west.
struct Counter {
    prefix: &'static str,
    /// The glue of its outer side.
    side: &'static str,
    n: usize,
    lines: usize,
    transposed: bool,
}

impl Counter {
    /// Adds its tiles; its first tile is on the first strong glue, and its first line ends with the
    /// last one.
    fn add(&self, set: &mut TileSet, [first, last]: [Option<&str>; 2]) {
        let (n, p) = (self.n, self.prefix);
        let capped = self.lines % 2 == 1;
        let start = (1_usize << n) - self.lines / 2;
        let strong = |name: String| Some((name, 2.0));
        let weak = |name: String| Some((name, 1.0));
        // The ends of a line have glues of their own, so that no other tile fits there.
        let bit = |b: usize| weak(format!("{p}-{b}"));
        let high = |b: usize| weak(format!("{p}-high-{b}"));
        let least = |b: usize| weak(format!("{p}-least-{b}"));
        let begin = |end: &str, b: usize| strong(format!("{p}-{end}-{b}"));
        let outer = || weak(self.side.to_owned());
        let mut add = |name: String, glues: [Option<(String, f64)>; 4]| {
            let glues = glues.map(|glue| glue.map(|(name, strength)| set.glue(&name, strength)));
            let [n, e, s, w] = glues;
            let turned = if self.transposed { [e, n, w, s] } else { glues };
            set.tiles.push(TileType::new(format!("{p}-{name}"), turned));
        };
        for k in 0..n {
            let b = start >> (n - 1 - k) & 1;
            let link = |k: usize| strong(format!("{p}-line-{k}"));
            let west = (k > 0).then(|| link(k)).flatten();
            let south = first.filter(|_| k == 0);
            let south = south.and_then(|name| strong(name.to_owned()));
            let is_least = k == n - 1;
            let east = match (is_least, last) {
                (false, _) => link(k + 1),
                (true, Some(name)) => strong(name.to_owned()),
                (true, None) => outer(),
            };
            let north = match k {
                0 => high(b),
                _ if is_least => begin("up", b),
                _ => bit(b),
            };
            add(format!("first-{k}"), [north, east, south, west]);
        }
        let carry = |c: usize| weak(format!("{p}-carry-{c}"));
        let copy = || weak(format!("{p}-copy"));
        for b in 0..2 {
            let flip = [least(1 - b), outer(), begin("up", b), carry(b)];
            add(format!("flip-{b}"), flip);
            let copy_high = [high(b), copy(), begin("back", b), None];
            add(format!("copy-high-{b}"), copy_high);
            let copy_least = [begin("up", b), outer(), least(b), copy()];
            add(format!("copy-least-{b}"), copy_least);
            if n > 2 {
                add(format!("copy-{b}"), [bit(b), copy(), bit(b), copy()]);
            }
            for c in 0..2 {
                let (sum, over) = (b ^ c, b & c);
                if n > 2 {
                    let glues = [bit(sum), carry(c), bit(b), carry(over)];
                    add(format!("add-{b}{c}"), glues);
                }
                let north = match over {
                    0 => begin("back", sum),
                    _ => capped.then(|| begin("cap", 0)).flatten(),
                };
                add(format!("high-{b}{c}"), [north, carry(c), high(b), None]);
            }
        }
        if capped {
            let cap = || weak(format!("{p}-cap"));
            add("cap-high".to_owned(), [None, cap(), begin("cap", 0), None]);
            add("cap-least".to_owned(), [None, outer(), least(0), cap()]);
            if n > 2 {
                add("cap-middle".to_owned(), [None, cap(), bit(0), cap()]);
            }
        }
    }
}
