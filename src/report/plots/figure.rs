//! Pictures together with the numbers they show, before and after drawing.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

use super::composition::Composition;
use super::picture::{Picture, PictureError};
use super::sheet::Sheet;
use physics::interruption;

/// Pictures with the numbers that they show.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// The stem of the file of numbers, and of the picture if there is only one.
    pub name: String,
    /// The pictures by the stems of their files: one, or one for each panel.
    pub pictures: Vec<(String, Picture)>,
    /// The numbers, as CSV.
    pub data: String,
}

impl Figure {
    pub(crate) fn new(
        composition: &Composition,
        sheet: &Sheet,
        data: String,
    ) -> Result<Self, PictureError> {
        Ok(Self {
            name: composition.name.clone(),
            pictures: composition.draw(sheet)?,
            data,
        })
    }

    /// The first picture as SVG.
    pub fn svg(&self) -> &str {
        self.pictures
            .first()
            .map_or("", |(_, picture)| &picture.svg)
    }

    /// The files by their names: each picture in every form, and the numbers.
    pub fn files(self) -> impl Iterator<Item = (String, Vec<u8>)> {
        let numbers = (format!("{}.csv", self.name), self.data.into_bytes());
        let pictures = self.pictures.into_iter().flat_map(|(stem, picture)| {
            let forms = [
                ("svg", Some(picture.svg.into_bytes())),
                ("png", picture.png),
                ("pdf", picture.pdf),
            ];
            let named =
                |(ending, bytes): (_, Option<_>)| Some((format!("{stem}.{ending}"), bytes?));
            forms.into_iter().filter_map(named).collect::<Vec<_>>()
        });
        pictures.chain([numbers])
    }
}

/// A function that draws pictures.
type Draw<'a> = dyn Fn(&Sheet) -> Result<Vec<Figure>, PictureError> + Send + Sync + 'a;

/// A picture yet to be drawn.
pub struct Drawing<'a> {
    /// The title.
    pub title: String,
    /// Whether the page shows it; not if an interactive part shows the same.
    pub is_shown: bool,
    draw: Box<Draw<'a>>,
}

impl<'a> Drawing<'a> {
    /// A picture with a title.
    pub fn new(
        title: impl Into<String>,
        draw: impl Fn(&Sheet) -> Result<Figure, PictureError> + Send + Sync + 'a,
    ) -> Self {
        Self::several(title, move |sheet| Ok(vec![draw(sheet)?]))
    }

    /// Pictures that are drawn together.
    pub fn several(
        title: impl Into<String>,
        draw: impl Fn(&Sheet) -> Result<Vec<Figure>, PictureError> + Send + Sync + 'a,
    ) -> Self {
        Self {
            title: title.into(),
            is_shown: true,
            draw: Box::new(draw),
        }
    }

    /// Draws the pictures. A panic while drawing becomes an error, so that the results are not
    /// lost.
    ///
    /// # Errors
    /// If they cannot be drawn.
    pub fn drawn(&self, sheet: &Sheet) -> Result<Vec<Figure>, PictureError> {
        let drawn = catch_unwind(AssertUnwindSafe(|| (self.draw)(sheet)));
        drawn.unwrap_or_else(|fault| match interruption::is_interrupted(fault.as_ref()) {
            true => resume_unwind(fault),
            false => Err(PictureError::Fault(self.title.clone())),
        })
    }

    /// Excludes the picture from the page.
    #[must_use]
    pub fn off_page(self) -> Self {
        Self {
            is_shown: false,
            ..self
        }
    }
}
