//! Documents as terminal text.

use std::fmt::Write;

use super::{Document, Table};
use crate::markdown::{markdown_table, without_html};
use crate::terminal::write_fitted;

/// Default width of lines without a terminal.
const WIDTH: usize = 100;

/// Wraps a text at this width, between words.
fn wrapped(text: &str, width: usize) -> String {
    let mut out = String::new();
    for line in text.lines() {
        let indent = line.len() - line.trim_start().len();
        let mut used = 0;
        for (k, word) in line.trim_start().split(' ').enumerate() {
            let length = word.chars().count();
            if k > 0 && used + 1 + length > width {
                out.push('\n');
                used = 0;
            }
            match used {
                0 => out.extend(std::iter::repeat_n(' ', indent)),
                _ => out.push(' '),
            }
            used += length + if used == 0 { indent } else { 1 };
            out.push_str(word);
        }
        out.push('\n');
    }
    out
}

impl Document<'_> {
    /// The headline, the tables and the notes; tables are folded at the terminal's width.
    pub fn text(&self, columns: Option<usize>) -> String {
        let width = columns.unwrap_or(WIDTH);
        let mut text = wrapped(&self.answer, width);
        for remark in &self.remarks {
            text += &wrapped(remark, width);
        }
        let sketch = self.sketch.as_ref();
        text += &sketch.map_or(String::new(), |it| it.text(width.clamp(20, 72)));
        let printed = |table: &&Table| table.is_shown() && table.is_printed;
        for table in self.tables().into_iter().filter(printed) {
            let title = match &table.title[..] {
                "" => String::new(),
                title => wrapped(&format!("{title}:"), width),
            };
            let _ = write!(text, "\n{title}");
            write_fitted(&mut text, &table.texts(), columns);
            if let more @ 1.. = table.rows.len().saturating_sub(table.listed) {
                let _ = writeln!(text, "... and {more} more");
            }
            if !table.note.is_empty() {
                text += &wrapped(&format!("({})", table.note), width);
            }
        }
        if !self.notes.is_empty() {
            text.push('\n');
        }
        for note in &self.notes {
            text += &wrapped(note, width);
        }
        text
    }

    /// The same as Markdown.
    pub fn markdown(&self) -> String {
        let mut text = format!("# {}\n\n{}\n", self.title, without_html(&self.answer));
        for table in self.tables().into_iter().filter(|table| table.is_shown()) {
            if !table.title.is_empty() {
                let _ = write!(text, "\n## {}\n", without_html(&table.title));
            }
            let _ = write!(text, "\n{}", markdown_table(&table.texts()));
            if !table.note.is_empty() {
                let _ = write!(text, "\n{}\n", without_html(&table.note));
            }
        }
        text.push('\n');
        for note in self.remarks.iter().chain(&self.notes) {
            let _ = writeln!(text, "- {}", without_html(note));
        }
        text
    }
}

impl Table {
    /// Whether the table has anything to show to people.
    pub(super) fn is_shown(&self) -> bool {
        self.is_viewed && !self.rows.is_empty() && self.viewed().next().is_some()
    }

    /// The texts of the table on a terminal, with the head first.
    pub(crate) fn texts(&self) -> Vec<Vec<String>> {
        let printed = self.viewed().filter(|k| self.heads[*k].is_printed);
        let (head, columns): (Vec<_>, Vec<_>) = printed.map(|k| self.column(k)).unzip();
        let row = |row: usize| columns.iter().map(|cells| cells[row].clone()).collect();
        let rows = (0..self.rows.len().min(self.listed)).map(row);
        [head].into_iter().chain(rows).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::wrapped;

    #[test]
    fn lines_break_between_words_and_keep_their_indent() {
        assert_eq!(wrapped("one two three", 8), "one two\nthree\n");
        assert_eq!(wrapped("  one two\nthree", 7), "  one\n  two\nthree\n");
        assert_eq!(wrapped("unbreakable", 4), "unbreakable\n");
    }
}
