//! Parts of a job that can run on different machines.

/// Part `number`, from 1, of `of` parts: every `of`th thing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Which part, from 1.
    pub number: usize,
    /// How many parts there are.
    pub of: usize,
}

impl Shard {
    /// The only part of what is not divided.
    pub const WHOLE: Self = Self { number: 1, of: 1 };

    /// Whether the part holds a thing, by its number from 0.
    pub fn contains(&self, index: usize) -> bool {
        index % self.of + 1 == self.number
    }
}

/// A part as `i/n`.
///
/// # Errors
/// If it is none.
pub fn shard(text: &str) -> Result<Shard, String> {
    let (number, of) = text.split_once('/').ok_or("a part is i/n, such as 1/4")?;
    let parse = |part: &str| part.trim().parse().ok();
    match (parse(number), parse(of)) {
        (Some(number), Some(of)) if (1..=of).contains(&number) => Ok(Shard { number, of }),
        _ => Err("parts of n are 1/n, 2/n, ... n/n".to_owned()),
    }
}
