//! The file names that a command writes.

/// The folder of pictures.
pub const PICTURES: &str = "pictures";
/// File name extensions of a picture: its formats and its numbers.
const FORMS: [&str; 4] = ["svg", "png", "pdf", "csv"];

/// A command that writes files, and all names they can have in its results folder: no other file is
/// ever removed as an old result, whatever a record says.
#[derive(Debug)]
pub struct Command {
    /// Its name.
    pub name: &'static str,
    /// The names. `#` stands for a number or `free`, `*` for any text without a slash.
    pub files: &'static [&'static str],
    /// Names of pictures; `-` and a suffix may follow, for panels and variants.
    pub pictures: &'static [&'static str],
}

impl Command {
    /// A command that only writes single files, named by the user.
    pub const fn of_single_files(name: &'static str) -> Self {
        Self {
            name,
            files: &[],
            pictures: &[],
        }
    }

    /// Whether a file of its results can have this name.
    pub fn writes(&self, name: &str) -> bool {
        let is_picture = || {
            let (stem, form) = name
                .strip_prefix(PICTURES)?
                .strip_prefix('/')?
                .rsplit_once('.')?;
            let mut rests = self
                .pictures
                .iter()
                .filter_map(|own| stem.strip_prefix(own));
            let is_own = rests.any(|rest| rest.is_empty() || rest.starts_with('-'));
            Some(is_own && FORMS.contains(&form) && !stem.contains('/'))
        };
        self.files.iter().any(|pattern| fits(pattern, name)) || is_picture() == Some(true)
    }

    /// The folders of its results, relative to the results folder (the empty name).
    pub(super) fn folders(&self) -> impl Iterator<Item = &'static str> {
        let named = self
            .files
            .iter()
            .filter_map(|name| Some(name.rsplit_once('/')?.0));
        let pictures = (!self.pictures.is_empty()).then_some(PICTURES);
        let mut all: Vec<&str> = named.chain(pictures).chain([""]).collect();
        all.sort_unstable();
        all.dedup();
        all.into_iter()
    }
}

/// Whether a name fits a pattern of [`Command::files`].
fn fits(pattern: &str, name: &str) -> bool {
    let Some(at) = pattern.find(['#', '*']) else {
        return pattern == name;
    };
    let Some(name) = name.strip_prefix(&pattern[..at]) else {
        return false;
    };
    let rest = &pattern[at + 1..];
    let digits = name.len() - name.trim_start_matches(|c: char| c.is_ascii_digit()).len();
    match pattern.as_bytes()[at] {
        b'#' if digits > 0 => fits(rest, &name[digits..]),
        b'#' => name
            .strip_prefix("free")
            .is_some_and(|name| fits(rest, name)),
        _ => {
            let most = name.find('/').unwrap_or(name.len());
            let mut ends = (0..=most).filter(|&end| name.is_char_boundary(end));
            ends.any(|end| fits(rest, &name[end..]))
        }
    }
}
