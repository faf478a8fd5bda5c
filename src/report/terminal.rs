//! Tables for the terminal.

use std::fmt::Write;

/// Names longer than the first share of a terminal's width are shortened to the second one.
const MOST_NAME: [[usize; 2]; 2] = [[3, 4], [1, 4]];

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
    let short_names = with_short_names(rows, columns.unwrap_or(usize::MAX));
    for rows in [rows, &short_names] {
        let mut table = String::new();
        write_table(&mut table, rows);
        if fits(&table) {
            text.push_str(&table);
            return;
        }
    }
    let rows = &short_names;
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

/// The same rows where names in the first column that leave hardly any room for the others (see [`MOST_NAME`])
/// lack their middles; two that differ at either end stay different.
fn with_short_names(rows: &[Vec<String>], columns: usize) -> Vec<Vec<String>> {
    let mut rows = rows.to_vec();
    for name in rows.iter_mut().filter_map(|row| row.first_mut()) {
        let letters: Vec<char> = name.chars().collect();
        let [most, kept] = MOST_NAME.map(|of| columns / of[1] * of[0]);
        if letters.len() > most {
            let (start, end) = (&letters[..kept / 2], &letters[letters.len() - kept / 2..]);
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
        assert_eq!(text, "aaaaa…aaaa1  0.5  1.5\naaaaa…aaaa2  0.5  1.5\n");
    }
}
