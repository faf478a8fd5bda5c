//! The declaration of a request's options, from which the command line, Python's keywords and what
//! is written of both are made.
//!
//! `options!` takes the request with one line more for each field: the comment on a field is its
//! help, and the expression after it says how a text becomes its value.
//!
//! ```ignore
//! options! {
//!     /// The options of a table.
//!     #[derive(Clone, Debug)]
//!     pub struct Request {
//!         /// Duration of each run (s)
//!         pub time: f64 = value("S", request::time),
//!
//!         /// Number of runs, each from its own start
//!         pub runs: usize = value("R", request::runs).or(1),
//!
//!         /// How tiles move.
//!         pub motion: MotionOptions = group(),
//!     }
//! }
//! ```
//!
//! The type of a field says how often its option is given: exactly once or, with a default, at most
//! once (`T`), at most once (`Option<T>`, `bool`), or repeatedly (`Vec<T>`).

use std::any::TypeId;
use std::collections::BTreeMap;
use std::sync::Arc;

use super::Misused;

/// A request that declares its options. `options!` implements it.
pub trait Options: Sized {
    /// Adds the options to a form, and reads the request from what is given there.
    ///
    /// # Errors
    /// If a text is no value of its option, or one is missing.
    fn fill(form: &mut RequestForm) -> Result<Self, Misused>;

    /// The request, with defaults for what is not given.
    ///
    /// # Errors
    /// If a text is no value of its option, or one is missing.
    fn read(given: Given) -> Result<Self, Misused> {
        let form = RequestForm {
            given,
            ..RequestForm::default()
        };
        Self::fill(&mut { form })
    }

    /// The request if nothing is given.
    ///
    /// # Panics
    /// If an option is required.
    fn with_defaults() -> Self {
        Self::read(Given::new()).expect("no option is required")
    }

    /// The options, in the order of the help.
    fn table() -> Vec<Entry> {
        let mut form = RequestForm::default();
        // Nothing is given: what is required is missing.
        let _ = Self::fill(&mut form);
        form.table
    }
}

/// What is given for options, and what is known of those whose fields were read.
#[derive(Default)]
pub struct RequestForm {
    given: Given,
    table: Vec<Entry>,
    /// The name and comment of the next field.
    field: &'static str,
    comment: String,
}

impl RequestForm {
    /// At a field of this name and comment: a paragraph is a line of the help, with empty lines
    /// between them. Attributes are `None`.
    pub fn at(&mut self, field: &'static str, comment: &[Option<&str>]) -> &mut Self {
        let lines: Vec<&str> = comment.iter().flatten().map(|it| it.trim()).collect();
        let paragraphs = lines.split(|line| line.is_empty());
        let paragraphs: Vec<String> = paragraphs.map(|lines| lines.join(" ")).collect();
        (self.field, self.comment) = (field, paragraphs.join("\n\n"));
        self
    }
}

/// The texts that are given for options, by their names: an empty one where an option has no value.
pub type Given = BTreeMap<&'static str, Vec<String>>;

/// All that is known of an option.
#[derive(Clone, Default)]
pub struct Entry {
    /// Its name as a keyword: `certify_work` for `--certify-work`.
    pub name: &'static str,
    /// Another name, which no help lists.
    pub alias: Option<&'static str>,
    /// Its help: a line, and paragraphs below it if there is more to say.
    pub help: String,
    /// What stands for its value in the help; `None` if it has no value.
    pub value: Option<&'static str>,
    /// The type of its value.
    pub kind: Option<TypeId>,
    /// The words that it takes, if it takes nothing else.
    pub words: Vec<&'static str>,
    /// Its text if it is not given.
    pub default: Option<String>,
    /// Its text if it is given without a value, where that is possible; it is empty if no text
    /// says the same.
    pub alone: Option<&'static str>,
    /// It must be given if none of these is.
    pub required_unless: Option<&'static [&'static str]>,
    /// Options that cannot be given with it.
    pub conflicts: &'static [&'static str],
    /// An option without which it has no meaning.
    pub requires: Option<&'static str>,
    /// Whether it may be given repeatedly.
    pub repeats: bool,
    /// Whether one text holds several values, separated by commas.
    pub is_list: bool,
    /// Whether its value can begin with a minus sign.
    pub is_signed: bool,
    /// Whether no help lists it.
    pub is_hidden: bool,
    check: Option<Arc<dyn Reader<Value = ()>>>,
}

/// Reads a text as a value, or says what is wrong with it.
pub trait Reader: Send + Sync + 'static {
    /// What is read.
    type Value;

    /// Reads a text.
    ///
    /// # Errors
    /// What to write instead.
    fn read(&self, text: &str) -> Result<Self::Value, String>;

    /// The texts that it takes, if these are a few words.
    fn words(&self) -> Vec<&'static str> {
        Vec::new()
    }
}

impl<T, F: Fn(&str) -> Result<T, String> + Send + Sync + 'static> Reader for F {
    type Value = T;

    fn read(&self, text: &str) -> Result<T, String> {
        self(text)
    }
}

/// An option checks texts.
impl Reader for Entry {
    type Value = String;

    fn read(&self, text: &str) -> Result<String, String> {
        let wrong = self.check.as_ref().map(|check| check.read(text));
        wrong.unwrap_or(Ok(())).map(|()| text.to_owned())
    }

    fn words(&self) -> Vec<&'static str> {
        self.words.clone()
    }
}

/// A field of a request that holds the values of an option.
pub trait OptionField<T>: Sized {
    /// Whether it holds all values, not only one.
    const HOLDS_ALL: bool = false;

    /// The field; `None` if a value is missing.
    fn of(values: Vec<T>) -> Option<Self>;
}

impl<T> OptionField<T> for T {
    fn of(mut values: Vec<T>) -> Option<T> {
        values.pop()
    }
}

impl<T> OptionField<T> for Option<T> {
    fn of(mut values: Vec<T>) -> Option<Self> {
        Some(values.pop())
    }
}

impl<T> OptionField<T> for Vec<T> {
    const HOLDS_ALL: bool = true;

    fn of(values: Vec<T>) -> Option<Self> {
        Some(values)
    }
}

impl OptionField<()> for bool {
    fn of(values: Vec<()>) -> Option<Self> {
        Some(!values.is_empty())
    }
}

/// An option whose values are read as `T`.
pub struct Value<T> {
    entry: Entry,
    reader: Arc<dyn Reader<Value = T>>,
}

/// An option with a value; `name` stands for it in the help.
pub fn value<R: Reader<Value: 'static>>(name: &'static str, reader: R) -> Value<R::Value> {
    Value::new(Some(name), Arc::new(reader))
}

/// An option without a value.
pub fn flag() -> Value<()> {
    Value::new(None, Arc::new(|_: &str| Ok(()))).alone("")
}

/// Declares methods that set a field of an option's entry.
macro_rules! saying {
    ($($(#[$about:meta])* $name:ident($($argument:ident: $kind:ty)?), $field:ident = $said:expr;)*) => {
        $($(#[$about])*
        pub fn $name(mut self $(, $argument: $kind)?) -> Self {
            self.entry.$field = $said;
            self
        })*
    };
}

impl<T: 'static> Value<T> {
    /// Apart from [`value`], so that it is compiled once for a type, not for every reader.
    fn new(value: Option<&'static str>, reader: Arc<dyn Reader<Value = T>>) -> Self {
        let checked = Arc::clone(&reader);
        let entry = Entry {
            value,
            kind: Some(TypeId::of::<T>()),
            words: reader.words(),
            check: Some(Arc::new(move |text: &str| checked.read(text).map(drop))),
            ..Entry::default()
        };
        Self { entry, reader }
    }

    saying! {
        /// With a default.
        or(default: impl ToString), default = Some(default.to_string());
        /// With a name other than the field's.
        named(name: &'static str), name = name;
        /// With another name, which no help lists.
        alias(name: &'static str), alias = Some(name);
        /// It can be given without a value, which is then this one.
        alone(text: &'static str), alone = Some(text);
        /// It must be given, though its field could be empty.
        required(), required_unless = Some(&[]);
        /// It must be given if none of these options is.
        required_unless(others: &'static [&'static str]), required_unless = Some(others);
        /// It cannot be given with these options.
        conflicts(others: &'static [&'static str]), conflicts = others;
        /// It has no meaning without this option.
        requires(other: &'static str), requires = Some(other);
        /// A text holds several values, separated by commas.
        list(), is_list = true;
        /// Its value can begin with a minus sign.
        signed(), is_signed = true;
        /// No help lists it.
        hidden(), is_hidden = true;
    }

    /// It can be given without a value.
    pub fn or_alone(self) -> Value<Option<T>> {
        let Self { entry, reader } = self.alone("");
        let reader = Arc::new(move |text: &str| match text {
            "" => Ok(None),
            text => reader.read(text).map(Some),
        });
        Value { entry, reader }
    }

    /// Adds the option to a form as that of the field there, and reads the field.
    ///
    /// # Errors
    /// If a text is no value, or one is missing.
    pub fn field<F: OptionField<T>>(self, form: &mut RequestForm) -> Result<F, Misused> {
        let Self { mut entry, reader } = self;
        if entry.name.is_empty() {
            entry.name = form.field;
        }
        if entry.default.is_none() && F::of(Vec::new()).is_none() {
            entry.required_unless = Some(&[]);
        }
        entry.help = std::mem::take(&mut form.comment);
        entry.repeats = F::HOLDS_ALL;
        let name = entry.name;
        let texts = form.given.remove(name);
        let texts = texts.unwrap_or_else(|| entry.default.iter().cloned().collect());
        form.table.push(entry);
        let read = |text: &String| {
            let read = reader.read(text);
            read.map_err(|why| Misused::value(name, text, &why))
        };
        let values = texts.iter().map(read).collect::<Result<_, _>>()?;
        F::of(values).ok_or_else(|| Misused::missing(&[name]))
    }
}

/// The options of another request.
#[derive(Default)]
pub struct OptionGroup(Option<[&'static str; 2]>);

/// The options of another request.
pub fn group() -> OptionGroup {
    OptionGroup::default()
}

impl OptionGroup {
    /// With other help for one of them.
    pub fn helped(self, name: &'static str, help: &'static str) -> Self {
        Self(Some([name, help]))
    }

    /// Adds the options to a form, and reads the field.
    ///
    /// # Errors
    /// See [`Options::fill`].
    pub fn field<G: Options>(self, form: &mut RequestForm) -> Result<G, Misused> {
        let found = G::fill(form);
        if let Some([name, help]) = self.0 {
            let helped = form.table.iter_mut().filter(|it| it.name == name);
            helped.for_each(|it| help.clone_into(&mut it.help));
        }
        found
    }
}

/// A field that is no option.
pub struct Fixed<F>(pub F);

impl<F> Fixed<F> {
    /// The field.
    ///
    /// # Errors
    /// None.
    pub fn field(self, _: &mut RequestForm) -> Result<F, Misused> {
        Ok(self.0)
    }
}

/// Declares a request with its options, see the module [`option`](self).
macro_rules! options {
    ($(#[$about:meta])* $seen:vis struct $Request:ident {
        $($(#[$($note:tt)*])* $shown:vis $field:ident: $kind:ty = $option:expr),* $(,)?
    }) => {
        $(#[$about])*
        $seen struct $Request {
            $($(#[$($note)*])* $shown $field: $kind,)*
        }

        impl $crate::request::Options for $Request {
            fn fill(
                form: &mut $crate::request::option::RequestForm,
            ) -> Result<Self, $crate::request::Misused> {
                #[allow(unused_imports)]
                use $crate::request::option::{Fixed, comment, flag, group, value};
                // All are added to the form, even if the first cannot be read.
                $(let $field = $option.field(form.at(stringify!($field), &[$(comment!($($note)*)),*]));)*
                Ok(Self { $($field: $field?,)* })
            }
        }
    };
}

/// The text of a line of a comment, which is an attribute; `None` of any other attribute.
macro_rules! comment {
    (doc = $text:literal) => {
        Some($text)
    };
    ($($other:tt)*) => {
        None
    };
}

pub(crate) use {comment, options};
