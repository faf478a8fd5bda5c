//! The terminal: its width, whether it supports colours, and messages on standard error.

use std::fmt::Display;
use std::io::{IsTerminal, Write};

use tilebind::text::is_invisible;

/// Whether standard output is a terminal.
pub fn is_terminal() -> bool {
    std::io::stdout().is_terminal()
}

/// Columns of the terminal, from COLUMNS or the terminal itself; `None` if standard output is not a
/// terminal.
pub fn columns() -> Option<usize> {
    let named = std::env::var("COLUMNS").ok();
    let named = named.and_then(|text| text.trim().parse().ok());
    let own = || {
        is_terminal()
            .then(|| console::Term::stdout().size_checked())
            .flatten()
    };
    named
        .or_else(|| own().map(|(_, columns)| usize::from(columns)))
        .filter(|columns| *columns >= 20)
}

/// The first word of a message, `error` or `warning`, coloured as by clap if standard error is a
/// terminal and NO_COLOR is not set.
pub fn label(word: &str) -> String {
    let wanted = std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty());
    let dumb = std::env::var_os("TERM").is_some_and(|term| term == "dumb");
    if !wanted || dumb || !std::io::stderr().is_terminal() {
        return format!("{word}:");
    }
    let colour = match word {
        "error" => "31",
        "warning" => "33",
        _ => "36",
    };
    format!("\u{1b}[1;{colour}m{word}:\u{1b}[0m")
}

/// Prints a message on standard error. A failure to print it neither stops the work nor changes the
/// exit status.
pub fn tell(message: impl Display) {
    let harmless = |c: char| match c {
        '\n' | '\t' => c,
        // Removes control characters of file names or unknown keys, which a terminal would obey, and marks by
        // which these would look like others.
        _ if is_invisible(c) => char::REPLACEMENT_CHARACTER,
        _ => c,
    };
    let mut message: String = format!("{message}\n").chars().map(harmless).collect();
    for word in ["error", "warning", "note"] {
        let plain = format!("{word}:");
        if message.starts_with(&plain) {
            message.replace_range(..plain.len(), &label(word));
        }
    }
    let _ = std::io::stderr().write_all(message.as_bytes());
}
