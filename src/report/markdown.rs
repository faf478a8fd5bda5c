//! Tables in Markdown.

/// Escapes HTML, which Markdown would pass on unchanged.
pub fn without_html(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;")
}

/// Rows as a Markdown table; the first row is its head.
pub fn markdown_table(rows: &[Vec<String>]) -> String {
    let line = |cells: &[String]| {
        let cells: Vec<String> = cells
            .iter()
            .map(|cell| without_html(cell).replace('|', "\\|"))
            .collect();
        format!("| {} |\n", cells.join(" | "))
    };
    let mut out = String::new();
    if let Some((head, rest)) = rows.split_first() {
        out += &line(head);
        out += &format!("|{}\n", "---|".repeat(head.len()));
        rest.iter().for_each(|row| out += &line(row));
    }
    out
}
