//! Parts of a job that can run on different machines.

/// Part `number`, from 1, of `of` parts: every `of`th item.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// The index of the part, from 1.
    pub number: usize,
    /// The number of parts.
    pub of: usize,
}

impl Shard {
    /// The whole as a single part.
    pub const WHOLE: Self = Self { number: 1, of: 1 };

    /// Whether the part contains an item, by its index from 0.
    pub fn contains(&self, index: usize) -> bool {
        index % self.of + 1 == self.number
    }
}

/// Parses a part written as `i/n`.
///
/// # Errors
/// If the text is not a part.
pub fn shard(text: &str) -> Result<Shard, String> {
    let (number, of) = text.split_once('/').ok_or("a part is i/n, such as 1/4")?;
    let parse = |part: &str| part.trim().parse().ok();
    match (parse(number), parse(of)) {
        (Some(number), Some(of)) if (1..=of).contains(&number) => Ok(Shard { number, of }),
        _ => Err("parts of n are 1/n, 2/n, ... n/n".to_owned()),
    }
}
