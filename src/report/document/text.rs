//! Documents on a terminal.

use std::fmt::Write;

use super::{Document, Table};
use crate::terminal::write_folded;

impl Document<'_> {
    /// The answer, the tables and what to know of them; tables are folded at the terminal's width.
    pub fn text(&self, columns: Option<usize>) -> String {
        let mut text = format!("{}\n", self.answer);
        for remark in &self.remarks {
            let _ = writeln!(text, "{remark}");
        }
        for table in self.tables().into_iter().filter(|table| table.is_shown()) {
            let title = match &table.title[..] {
                "" => String::new(),
                title => format!("{title}:\n"),
            };
            let _ = write!(text, "\n{title}");
            write_folded(&mut text, &table.texts(), columns);
            if let more @ 1.. = table.rows.len().saturating_sub(table.listed) {
                let _ = writeln!(text, "... and {more} more");
            }
            if !table.note.is_empty() {
                let _ = writeln!(text, "({})", table.note);
            }
        }
        if !self.notes.is_empty() {
            text.push('\n');
        }
        for note in &self.notes {
            let _ = writeln!(text, "{note}");
        }
        text
    }
}

impl Table {
    /// Whether people have anything to see in it.
    pub(super) fn is_shown(&self) -> bool {
        self.is_viewed && !self.rows.is_empty()
    }

    /// What people see, its head first.
    fn texts(&self) -> Vec<Vec<String>> {
        let head = self.viewed().map(|k| self.heads[k].name.to_string());
        let row = |row: usize| self.viewed().map(|k| self.text(row, k)).collect();
        let rows = (0..self.rows.len().min(self.listed)).map(row);
        [head.collect()].into_iter().chain(rows).collect()
    }
}
