//! Tables for a terminal.

use std::fmt::Write;

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

/// Rows whose last cells go on lines of their own, indented below the second cells, where they are
/// too long for a terminal.
pub fn write_rows(text: &mut String, rows: &[[String; 6]], columns: Option<usize>) {
    let mut table = String::new();
    write_table(&mut table, rows);
    let fits = |width: usize| table.lines().all(|line| line.chars().count() <= width);
    if columns.is_none_or(fits) {
        text.push_str(&table);
        return;
    }
    let short: Vec<&[String]> = rows.iter().map(|row| &row[..row.len() - 1]).collect();
    let mut table = String::new();
    write_table(&mut table, &short);
    let names = rows.iter().map(|row| row[0].chars().count());
    let indent = " ".repeat(names.max().unwrap_or(0) + 2);
    for (line, row) in table.lines().zip(rows) {
        let _ = writeln!(text, "{line}\n{indent}{}", row[row.len() - 1]);
    }
}

/// A table in as many parts below each other as a terminal's width asks for, each with the first
/// column.
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
