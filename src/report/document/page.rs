//! Documents as HTML pages, and all files of a document.

use serde_json::{Value, json};

use super::{Document, Entry, Fact, Link, PagePart, Table};
use crate::files::{Files, PAGE, PICTURES, REPORT};
use crate::page::{self, Illustration, Page};
use crate::plots::{Figure, PictureError, Sheet};
use physics::parallel;

impl Document<'_> {
    /// All files: the report, tables, pictures with their numbers, and the page, made by `command`;
    /// and the errors of pictures that could not be drawn, which are omitted.
    pub fn files(&self, sheet: &Sheet, command: &str) -> (Files, Result<(), PictureError>) {
        let mut whole = Ok(());
        let figures: Vec<Vec<Figure>> = (self.drawn(sheet).into_iter())
            .map(|drawn| {
                drawn.unwrap_or_else(|error| {
                    whole = Err(error);
                    Vec::new()
                })
            })
            .collect();
        let page = self.page(sheet, &figures);
        let mut files = self.numbers();
        files.extend(self.beside.clone());
        files.insert(REPORT.to_owned(), self.report().into_bytes());
        let named = figures.into_iter().flatten().flat_map(Figure::files);
        files.extend(named.map(|(name, bytes)| (format!("{PICTURES}/{name}"), bytes)));
        // Pathways are not listed: there are many, and tables and the page name them.
        let linked = files.keys().filter(|name| !name.starts_with("pathways/"));
        let page = page.made_by(command).beside(linked).to_html();
        files.insert(PAGE.to_owned(), page.into_bytes());
        (files, whole)
    }

    /// Only the page, made by `command`.
    ///
    /// # Errors
    /// If a picture cannot be drawn.
    pub fn html(&self, command: &str) -> Result<String, PictureError> {
        let figures = self.figures(&Sheet::SCREEN)?;
        let page = self.page(&Sheet::SCREEN, &figures);
        Ok(page.made_by(command).to_html())
    }

    /// Draws the pictures of each drawing.
    ///
    /// # Errors
    /// If a picture cannot be drawn.
    pub fn figures(&self, sheet: &Sheet) -> Result<Vec<Vec<Figure>>, PictureError> {
        self.drawn(sheet).into_iter().collect()
    }

    fn drawn(&self, sheet: &Sheet) -> Vec<Result<Vec<Figure>, PictureError>> {
        parallel::map(&self.pictures[..], |picture| picture.drawn(sheet))
    }

    fn page(&self, sheet: &Sheet, figures: &[Vec<Figure>]) -> Page {
        let shown = self.pictures.iter().zip(figures);
        let shown: Vec<_> = shown.filter(|(picture, _)| picture.is_shown).collect();
        let pictures = parallel::map(&shown[..], |(picture, figures)| {
            let narrow = picture.drawn(&Sheet::PHONE).unwrap_or_default();
            let of_phone = narrow.iter().map(Some).chain(std::iter::repeat(None));
            let both = figures.iter().zip(of_phone);
            let both = both.flat_map(|(figure, narrow)| {
                let narrow = narrow.unwrap_or(figure).svg();
                let wide = figure.pictures.iter().map(|(_, it)| &it.svg);
                // Of several there is one for narrow screens.
                let narrow = std::iter::once(narrow).chain(std::iter::repeat(""));
                wide.zip(narrow).map(|(wide, narrow)| Illustration {
                    title: picture.title.clone(),
                    is_titled: sheet.is_titled(),
                    svg: wide.clone(),
                    narrow: narrow.to_owned(),
                })
            });
            both.collect::<Vec<_>>()
        });
        let paged = |table: &&Table| table.is_shown() && table.is_paged;
        let tables = self.tables().into_iter().filter(paged);
        let mut page = Page {
            subtitle: self.answer.clone(),
            facts: self.facts().into_iter().map(Fact::shown).collect(),
            tables: tables.map(Table::shown).chain(self.settings()).collect(),
            pictures: pictures.concat(),
            notes: [&self.remarks[..], &self.notes].concat(),
            origin: format!("tilebind {}; {}", env!("CARGO_PKG_VERSION"), self.origin),
            ..Page::titled(self.title.clone())
        };
        match self.part.clone() {
            Some(PagePart::Landscape(landscape)) => page.landscape = Some(*landscape),
            Some(PagePart::Charts(charts)) => page.charts = Some(charts),
            Some(PagePart::Meetings(meetings)) => page.meetings = Some(meetings),
            Some(PagePart::Crowd(crowd)) => page.crowd = Some(crowd),
            None => {}
        }
        page
    }
}

impl Document<'_> {
    /// The settings that reproduce the result.
    fn settings(&self) -> Option<page::SortableTable> {
        let asked = self.entries.0.iter().find_map(|entry| match entry {
            Entry::Data("settings", asked) => Some(asked),
            _ => None,
        });
        let mut rows = Vec::new();
        flatten("", asked?, &mut rows);
        Some(page::SortableTable::of_settings(rows))
    }
}

/// The values of an object and its nested objects, each with its path of keys.
fn flatten(name: &str, value: &Value, rows: &mut Vec<(String, Value)>) {
    match value {
        Value::Object(inner) => {
            for (key, value) in inner {
                flatten(format!("{name} {key}").trim_start(), value, rows);
            }
        }
        Value::Array(parts) => {
            let parts: Vec<String> = parts.iter().map(Value::to_string).collect();
            rows.push((name.to_owned(), json!(parts.join(", "))));
        }
        value => rows.push((name.to_owned(), value.clone())),
    }
}

impl Fact {
    fn shown(&self) -> page::Fact {
        page::Fact {
            name: self.head.name.to_string(),
            value: self.to_text(),
            note: self.note.clone(),
        }
    }
}

impl Table {
    fn shown(&self) -> page::SortableTable {
        let viewed: Vec<usize> = self.viewed().collect();
        let (names, texts): (Vec<_>, Vec<_>) = viewed.iter().map(|k| self.column(*k)).unzip();
        let columns = viewed.iter().zip(names).map(|(k, name)| page::Column {
            name,
            meaning: self.heads[*k].meaning,
        });
        let cell = |row: usize, column: usize| -> Value {
            let key = self.rows[row][viewed[column]].0.key();
            match &texts[column][row][..] {
                "-" => Value::Null,
                text => json!([key, text]),
            }
        };
        let state = |link: &Option<Link>| match link {
            Some(Link::State(id)) => Some(*id),
            _ => None,
        };
        let way = |link: &Option<Link>| match link {
            Some(Link::Way(number)) => Some(*number),
            _ => None,
        };
        let rows = 0..self.rows.len();
        page::SortableTable {
            title: self.title.clone(),
            note: self.note.clone(),
            columns: columns.collect(),
            rows: rows
                .map(|row| (0..viewed.len()).map(|k| cell(row, k)).collect())
                .collect(),
            states: self.links.iter().filter_map(state).collect(),
            paths: self.links.iter().map(way).collect(),
        }
    }
}
