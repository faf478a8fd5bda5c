//! The neighbours of each leaf, one list behind the other: floods are limited by memory latency.

/// Lists of neighbours, replaced as leaves are subdivided.
#[derive(Clone, Debug, Default)]
pub(super) struct Adjacency {
    /// Where the list of each leaf starts and ends.
    ranges: Vec<[u32; 2]>,
    /// Lists, among former ones.
    lists: Vec<u32>,
    /// Total length of those not replaced.
    used: usize,
}

impl Adjacency {
    /// The neighbours of a leaf.
    pub fn of(&self, id: u32) -> &[u32] {
        let [start, end] = self.ranges[id as usize];
        &self.lists[start as usize..end as usize]
    }

    /// Adds the list of the next leaf.
    pub fn push(&mut self, neighbours: &[u32]) {
        self.ranges.push([0; 2]);
        self.replace(self.ranges.len() as u32 - 1, neighbours);
    }

    /// Replaces the list of a leaf.
    pub fn replace(&mut self, id: u32, neighbours: &[u32]) {
        self.used -= self.of(id).len();
        self.used += neighbours.len();
        let start = self.lists.len() as u32;
        self.lists.extend_from_slice(neighbours);
        self.ranges[id as usize] = [start, self.lists.len() as u32];
    }

    /// Forgets former lists if they are the larger part.
    pub fn compact(&mut self) {
        if self.lists.len() < 2 * self.used {
            return;
        }
        let mut lists = Vec::with_capacity(self.used);
        for range in &mut self.ranges {
            let start = lists.len() as u32;
            lists.extend_from_slice(&self.lists[range[0] as usize..range[1] as usize]);
            *range = [start, lists.len() as u32];
        }
        self.lists = lists;
    }
}
