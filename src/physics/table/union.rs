//! Which things hang together: a forest of roots.

/// The root of a thing.
pub fn root(roots: &mut [usize], mut k: usize) -> usize {
    while roots[k] != k {
        roots[k] = roots[roots[k]];
        k = roots[k];
    }
    k
}

/// Ties two things together; the lesser root is that of both.
pub fn join(roots: &mut [usize], a: usize, b: usize) {
    let [a, b] = [a, b].map(|k| root(roots, k));
    roots[a.max(b)] = a.min(b);
}
