//! Connected components by union-find.

/// The root of an item.
pub fn root(roots: &mut [usize], mut k: usize) -> usize {
    while roots[k] != k {
        roots[k] = roots[roots[k]];
        k = roots[k];
    }
    k
}

/// Joins the sets of two items; the smaller root becomes the root of both.
pub fn join(roots: &mut [usize], a: usize, b: usize) {
    let [a, b] = [a, b].map(|k| root(roots, k));
    roots[a.max(b)] = a.min(b);
}
