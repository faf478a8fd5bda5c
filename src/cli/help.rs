//! Help that fits the terminal.

use console::measure_text_width;

/// Columns where the width is unknown.
const USUAL: usize = 80;
/// Longer lines are hard to read, however wide the terminal is.
const WIDEST: usize = 100;
/// Least room for the text beside its indent.
const LEAST: usize = 30;

/// The help with long lines broken between words, below the text that they continue; `columns` is the
/// terminal's width. Commands to copy get a backslash.
pub fn wrapped(help: &str, columns: Option<usize>) -> String {
    let width = columns.unwrap_or(USUAL).min(WIDEST);
    help.split('\n')
        .map(|line| wrap(line, width))
        .collect::<Vec<_>>()
        .join("\n")
}

fn wrap(line: &str, width: usize) -> String {
    if measure_text_width(line) <= width {
        return line.to_owned();
    }
    let is_command = line.trim_start().starts_with("tilebind ") || line.trim_end().ends_with('\\');
    let (indent, width) = match is_command {
        true => (line.len() - line.trim_start().len() + 2, width - 2),
        false => (hanging(line, width), width),
    };
    let mut lines: Vec<String> = Vec::new();
    let mut current = String::new();
    for word in words(line, is_command) {
        let fits = measure_text_width(&current) + measure_text_width(word.trim_end()) <= width;
        if !fits && !current.trim().is_empty() {
            lines.push(std::mem::take(&mut current).trim_end().to_owned());
            current = " ".repeat(indent);
        }
        current += word;
    }
    lines.push(current.trim_end().to_owned());
    lines.join(if is_command { " \\\n" } else { "\n" })
}

/// The words of a line, each with the spaces after it; those in quotes of a command stay together.
fn words(line: &str, is_command: bool) -> Vec<&str> {
    let (mut words, mut from, mut quoted, mut spaced) = (Vec::new(), 0, false, false);
    let start = line.len() - line.trim_start().len();
    for (at, c) in line.char_indices().filter(|(at, _)| *at >= start) {
        quoted ^= is_command && c == '"';
        match c {
            ' ' if !quoted => spaced = true,
            _ if spaced => {
                words.push(&line[from..at]);
                (from, spaced) = (at, false);
            }
            _ => {}
        }
    }
    words.push(&line[from..]);
    words
}

/// Where a line is continued: below the second column of an option's line, or below its first word.
fn hanging(line: &str, width: usize) -> usize {
    let plain = console::strip_ansi_codes(line);
    let start = plain.len() - plain.trim_start().len();
    let gap = plain[start..].find("  ");
    let column = gap.map_or(start, |at| {
        let rest = &plain[start + at..];
        let wide = rest.len() - rest.trim_start().len();
        measure_text_width(&plain[..start + at]) + wide
    });
    match column + LEAST <= width {
        true => column,
        false => start.min(width.saturating_sub(LEAST)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_broken_between_words_below_their_column() {
        let option = "  --kt <E_J>  Effective energy of the shaking, in joules or with a unit of energy behind it";
        let found = wrapped(option, Some(60));
        let lines: Vec<&str> = found.lines().collect();
        assert!(lines.iter().all(|line| line.len() <= 60), "{found}");
        assert!(
            lines[1].starts_with(&" ".repeat(14)) && &lines[1][14..15] != " ",
            "{found}"
        );
        let joined = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        assert_eq!(joined(&found), joined(option));
    }

    #[test]
    fn commands_can_be_copied() {
        let command = "  tilebind barrier shapes/paper-tile.toml --from \"43 cm,0,0\" --to free --text --out target/barrier";
        let found = wrapped(command, Some(60));
        assert!(found.lines().all(|line| line.len() <= 60), "{found}");
        let parts = found.lines().map(|line| line.trim_end_matches('\\').trim());
        assert_eq!(parts.collect::<Vec<_>>().join(" "), command.trim());
        assert!(found.contains("\"43 cm,0,0\""));
    }

    #[test]
    fn short_lines_stay() {
        assert_eq!(wrapped("a\n  b  c\n", None), "a\n  b  c\n");
    }
}
