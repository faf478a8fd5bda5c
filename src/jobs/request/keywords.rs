//! Requests from keyword arguments.

use clap::error::{ContextKind, ContextValue};
use clap::{Args, Command};

/// An error in keyword arguments.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Misused {
    /// There is no such argument.
    #[error("there is no argument {0:?}; known: {known}", known = .1.join(", "))]
    Unknown(String, Vec<String>),
    /// An argument has an invalid value, is missing, or is not allowed.
    #[error("{0}")]
    Wrong(String),
}

/// The options of a request, as keywords.
pub fn options<R: Args>() -> Vec<String> {
    let command = R::augment_args(Command::new(""));
    let named = command.get_arguments().filter_map(|one| one.get_long());
    named.map(keyword).collect()
}

/// The keyword for an option as clap writes it: `--kt <E_J>`.
fn keyword(option: &str) -> String {
    let name = option.trim_start_matches("--");
    let name = name.split([' ', '=', '[']).next().unwrap_or(name);
    name.replace('-', "_")
}

/// Creates a request from keyword arguments, each with its values as on a command line: no values
/// if the option is absent, an empty one for an option without a value.
///
/// # Errors
/// See [`Misused`].
pub fn of_keywords<R: Args>(
    given: impl IntoIterator<Item = (String, Vec<String>)>,
) -> Result<R, Misused> {
    let command = R::augment_args(Command::new("tilebind").no_binary_name(true));
    let known = options::<R>();
    let mut words = Vec::new();
    for (key, values) in given {
        let option = key.replace('_', "-");
        let is_named = |one: &&clap::Arg| {
            let aliases = one.get_all_aliases().unwrap_or_default();
            one.get_long() == Some(&option) || aliases.contains(&&option[..])
        };
        if command.get_arguments().find(is_named).is_none() {
            return Err(Misused::Unknown(key, known));
        }
        words.extend(values.into_iter().map(|value| match value.is_empty() {
            true => format!("--{option}"),
            false => format!("--{option}={value}"),
        }));
    }
    let wrong = |error: clap::Error| Misused::Wrong(describe(&error));
    let matches = command.try_get_matches_from(words).map_err(wrong)?;
    R::from_arg_matches(&matches).map_err(wrong)
}

/// Clap's message about an option, rephrased for a keyword.
fn describe(error: &clap::Error) -> String {
    let text = |kind| match error.get(kind) {
        Some(ContextValue::String(text)) => Some(text.clone()),
        Some(ContextValue::Strings(all)) => Some(all.join(", ")),
        _ => None,
    };
    let why = std::error::Error::source(error).map(ToString::to_string);
    let argument = text(ContextKind::InvalidArg).map(|argument| {
        let names = argument.split(", ").map(keyword);
        names.collect::<Vec<_>>().join(", ")
    });
    match (argument, text(ContextKind::InvalidValue), why) {
        (Some(argument), Some(value), Some(why)) => format!("{argument} = {value}: {why}"),
        (Some(argument), Some(value), None) => format!("{argument} = {value} is not possible"),
        (Some(argument), None, _) => match text(ContextKind::PriorArg) {
            Some(other) => format!("{argument} cannot be given with {}", keyword(&other)),
            None => format!("{argument} is needed"),
        },
        _ => error.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::request::{count, positive};

    #[derive(Args, Debug, PartialEq)]
    struct Asked {
        #[arg(long, value_parser = positive, value_delimiter = ',', required = true)]
        kt: Vec<f64>,
        #[arg(long, default_value_t = 5, value_parser = count)]
        most_runs: usize,
        #[arg(long)]
        whole: bool,
        #[arg(long, conflicts_with = "whole")]
        part: Option<String>,
    }

    fn asked(given: &[(&str, &[&str])]) -> Result<Asked, Misused> {
        let owned = given.iter().map(|(key, values)| {
            let values = values.iter().map(|value| (*value).to_owned());
            ((*key).to_owned(), values.collect())
        });
        of_keywords(owned.collect::<Vec<(String, Vec<String>)>>())
    }

    #[test]
    fn keywords_are_the_options_with_their_defaults() {
        let found = asked(&[("kt", &["1e-3,2e-3"]), ("whole", &[""])]).unwrap();
        let expected = Asked {
            kt: vec![1e-3, 2e-3],
            most_runs: 5,
            whole: true,
            part: None,
        };
        assert_eq!(found, expected);
        assert_eq!(options::<Asked>(), ["kt", "most_runs", "whole", "part"]);
    }

    #[test]
    fn what_is_wrong_is_told_of_the_keyword() {
        let describe = |given| asked(given).unwrap_err().to_string();
        assert_eq!(
            describe(&[("kt", &["-1"])]),
            "kt = -1: a number from 1e-9 to 1e9 is needed"
        );
        assert_eq!(describe(&[]), "kt is needed");
        assert_eq!(
            describe(&[("kt", &["1"]), ("whole", &[""]), ("part", &["a"])]),
            "whole cannot be given with part"
        );
        assert_eq!(
            describe(&[("kT", &["1"])]),
            "there is no argument \"kT\"; known: kt, most_runs, whole, part"
        );
    }
}
