//! The options of requests on the command line.

use std::ops::Deref;

use clap::builder::{OsStr, PossibleValue, Resettable, StyledStr, TypedValueParser};
use clap::error::ErrorKind;
use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, Args, Command, Error, FromArgMatches, Id};
use tilebind::request::{Entry, Given, Options, Reader};

/// A request whose options are those of a command.
pub struct Asked<R>(pub R);

impl<R> Deref for Asked<R> {
    type Target = R;

    fn deref(&self) -> &R {
        &self.0
    }
}

impl<R: Options> Args for Asked<R> {
    fn augment_args(command: Command) -> Command {
        command.args(R::table().into_iter().map(argument))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl<R: Options> FromArgMatches for Asked<R> {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, Error> {
        let read = R::read(given(R::table(), matches));
        read.map(Self)
            .map_err(|error| Error::raw(ErrorKind::ValueValidation, error))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

/// The texts on the command line.
fn given(table: Vec<Entry>, matches: &ArgMatches) -> Given {
    let is_given = |it: &Entry| matches.value_source(it.name) == Some(ValueSource::CommandLine);
    let texts = |it: &Entry| {
        let texts = it.value.and_then(|_| matches.get_many::<String>(it.name));
        match texts.filter(|texts| texts.len() > 0) {
            Some(texts) => texts.cloned().collect(),
            None => vec![String::new()],
        }
    };
    let all = table.into_iter().filter(is_given);
    all.map(|it| (it.name, texts(&it))).collect()
}

/// An option as clap wants it.
fn argument(option: Entry) -> Arg {
    let long = |name: &str| name.replace('_', "-");
    let (short, more) = match option.help.split_once("\n\n") {
        Some((short, _)) => (short.to_owned(), Some(option.help.clone().into())),
        None => (option.help.clone(), None),
    };
    let required_unless = option.required_unless.unwrap_or_default();
    let argument = Arg::new(option.name)
        .long(long(option.name))
        .alias(Resettable::from(option.alias.map(|it| long(it).into())))
        .help(short)
        .long_help(Resettable::<StyledStr>::from(more))
        .hide(option.is_hidden)
        .conflicts_with_all(option.conflicts)
        .requires(Resettable::from(option.requires.map(Id::from)))
        .required(option.required_unless.is_some() && required_unless.is_empty())
        .required_unless_present_any(required_unless);
    let Some(value) = option.value else {
        return argument.action(ArgAction::SetTrue);
    };
    let argument = match option.alone {
        None => argument,
        // The help says what is usual then.
        Some(text) => argument
            .num_args(0..=1)
            .require_equals(true)
            .hide_default_value(true)
            .default_missing_values(Some(text).filter(|text| !text.is_empty())),
    };
    argument
        .action(if option.repeats {
            ArgAction::Append
        } else {
            ArgAction::Set
        })
        .default_value(Resettable::from(option.default.clone().map(OsStr::from)))
        .value_delimiter(option.is_list.then_some(','))
        .value_name(value)
        .hide_possible_values(true)
        .allow_hyphen_values(option.is_signed)
        .value_parser(By(option))
}

/// A value that is read by this.
#[derive(Clone)]
pub struct By<R>(pub R);

impl<R: Reader + Clone> TypedValueParser for By<R>
where
    R::Value: Clone + Send + Sync + 'static,
{
    type Value = R::Value;

    fn parse_ref(
        &self,
        command: &Command,
        argument: Option<&Arg>,
        text: &std::ffi::OsStr,
    ) -> Result<R::Value, Error> {
        let reader = self.0.clone();
        (move |text: &str| reader.read(text)).parse_ref(command, argument, text)
    }

    /// For shells to complete.
    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        let words = self.0.words();
        let words = Some(words).filter(|words| !words.is_empty())?;
        Some(Box::new(words.into_iter().map(PossibleValue::new)))
    }
}

#[cfg(test)]
mod tests {
    use clap::error::ErrorKind::{
        ArgumentConflict, InvalidValue, MissingRequiredArgument, UnknownArgument, ValueValidation,
    };
    use clap::{CommandFactory, Parser};
    use tilebind::{table, yields};

    use super::*;
    use crate::cli::Arguments;

    /// The request of a command line without quotes.
    fn asked<R: Options>(text: &str) -> R {
        let command = Asked::<R>::augment_args(Command::new("tilebind"));
        let matches = command.try_get_matches_from(text.split(' ')).unwrap();
        Asked::from_arg_matches(&matches).unwrap().0
    }

    #[test]
    fn every_command_names_options_that_exist() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn which_options_go_together() {
        for (text, kind) in [
            ("words --length 8 --gap 0.5 --count 3", ArgumentConflict),
            ("words --length 8 --count 3 --gap 0.5", ArgumentConflict),
            ("words --length 8 --face 0.4", MissingRequiredArgument),
            ("words", MissingRequiredArgument),
            ("bond a.toml --coverage 0.3", MissingRequiredArgument),
            ("yield a.toml --tiles 4 --time 3", MissingRequiredArgument),
            ("bond a.toml --kt 1 --kt 2 --coverage 0.3", ArgumentConflict),
            ("bond a.toml --kt", InvalidValue),
            ("bond a.toml --kt x --coverage 0.3", ValueValidation),
            ("analyse a.toml --out x --dynamics 5", UnknownArgument),
        ] {
            let words = std::iter::once("tilebind").chain(text.split(' '));
            let error = Arguments::try_parse_from(words).err();
            assert_eq!(error.map(|it| it.kind()), Some(kind), "{text}");
        }
        for text in ["words --slots 8", "crosstalk a.toml --cells 5 --certify"] {
            let words = std::iter::once("tilebind").chain(text.split(' '));
            assert!(Arguments::try_parse_from(words).is_ok(), "{text}");
        }
    }

    #[test]
    fn requests_have_the_values_of_the_command_line_or_defaults() {
        let found: yields::Request = asked("tilebind --tiles 4 --time 3 --kt 1e-3,2e-3 --kt 3e-3");
        assert_eq!((found.tiles, &found.kts[..]), (4, &[1e-3, 2e-3, 3e-3][..]));
        assert_eq!((found.simulations, found.method.drag), (1000, None));
        let found: table::Request = asked("tilebind --time 3 --fan -1,0,1e-3,0.2 --compare");
        assert_eq!(found.motion.fan[0].place, [-1.0, 0.0]);
        assert!(found.compare && found.count.is_empty());
        for (text, runs) in [("", 0), (" --dynamics", 1000), (" --dynamics-runs=50", 50)] {
            let found: tilebind::pipeline::Check = asked(&format!("tilebind{text}"));
            assert_eq!(found.dynamics_runs, runs);
        }
        for (text, certify) in [
            ("", None),
            (" --certify", Some(None)),
            (" --certify=1", Some(Some(1.0))),
        ] {
            let found: tilebind::word_sets::CrosstalkRequest = asked(&format!("tilebind{text}"));
            assert_eq!(found.certify, certify);
        }
    }
}
