//! Tables for the terminal.

use std::fmt::Write;

/// Names of this many letters are never shortened.
const LEAST_NAME: usize = 12;

/// Rows of equal length with their columns aligned.
pub fn write_table<R: AsRef<[String]>>(text: &mut String, rows: &[R]) {
    let columns = rows.iter().map(|row| row.as_ref().len()).max().unwrap_or(0);
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.as_ref().get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..columns).map(width).collect();
    for row in rows {
        let cells = row.as_ref().iter().zip(&widths);
        let line: Vec<String> = cells
            .map(|(cell, &width)| format!("{cell:<width$}"))
            .collect();
        let _ = writeln!(text, "{}", line.join("  ").trim_end());
    }
}

/// A table fitted to a terminal's width: if it is too wide, its last cells go on separate lines,
/// indented below the second cells; if that is not enough, see [`write_folded`].
pub fn write_fitted(text: &mut String, rows: &[Vec<String>], columns: Option<usize>) {
    let fits = |table: &str| {
        let width = columns.unwrap_or(usize::MAX);
        table.lines().all(|line| line.chars().count() <= width)
    };
    let mut table = String::new();
    write_table(&mut table, rows);
    if fits(&table) {
        text.push_str(&table);
        return;
    }
    let rows = &with_short_names(rows, columns.unwrap_or(usize::MAX) / 3);
    let count = rows.first().map_or(0, Vec::len);
    let short: Vec<&[String]> = rows.iter().map(|row| &row[..count - 1]).collect();
    let mut table = String::new();
    write_table(&mut table, &short);
    let names = rows.iter().map(|row| row[0].chars().count());
    let indent = " ".repeat(names.max().unwrap_or(0) + 2);
    let last = rows.iter().map(|row| format!("{indent}{}", row[count - 1]));
    let lines = table.lines().map(str::to_owned).zip(last);
    let table: String = lines.map(|(a, b)| format!("{a}\n{b}\n")).collect();
    match count > 2 && fits(&table) {
        true => text.push_str(&table),
        false => write_folded(text, rows, columns),
    }
}

/// The same rows with the middle of long names in the first column left out, so that the other columns
/// have room; two names that differ at either end stay different.
fn with_short_names(rows: &[Vec<String>], most: usize) -> Vec<Vec<String>> {
    let mut rows = rows.to_vec();
    for name in rows.iter_mut().filter_map(|row| row.first_mut()) {
        let letters: Vec<char> = name.chars().collect();
        if letters.len() > most.max(LEAST_NAME) {
            let kept = most.max(LEAST_NAME) - 1;
            let (start, end) = letters.split_at(kept.div_ceil(2));
            let end = &end[end.len() - kept / 2..];
            *name = start.iter().chain(&['…']).chain(end).collect();
        }
    }
    rows
}

/// A table split into parts below each other to fit a terminal's width, each with the first column.
pub fn write_folded(text: &mut String, rows: &[Vec<String>], columns: Option<usize>) {
    let count = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let room = columns.unwrap_or(usize::MAX);
    let mut start = 1;
    while start < count.max(2) {
        let (mut end, mut used) = (start, width(0));
        while end < count && (end == start || used + 2 + width(end) <= room) {
            used += 2 + width(end);
            end += 1;
        }
        let part = |row: &Vec<String>| -> Vec<String> {
            let cells = row.iter().enumerate();
            let kept = cells.filter(|(k, _)| *k == 0 || (start..end).contains(k));
            kept.map(|(_, cell)| cell.clone()).collect()
        };
        let part: Vec<Vec<String>> = rows.iter().map(part).collect();
        write_table(text, &part);
        start = end.max(start + 1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_names_leave_room_for_what_is_said_of_them() {
        let name = |last: &str| format!("{}{last}", "a".repeat(300));
        let row = |last: &str| vec![name(last), "0.5".to_owned(), "1.5".to_owned()];
        let mut text = String::new();
        write_fitted(&mut text, &[row("1"), row("2")], Some(40));
        assert_eq!(text, "aaaaaa…aaaaa1  0.5  1.5\naaaaaa…aaaaa2  0.5  1.5\n");
    }
}
