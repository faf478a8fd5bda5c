//! Requests from keyword arguments.

use super::{Entry, Given, Misused, Options, Reader};

/// Creates a request from keyword arguments, with hyphens or underscores, each with its values as on a command
/// line: no values if the option is absent, an empty one for an option without a value.
///
/// # Errors
/// See [`Misused`].
pub fn of_keywords<R: Options>(
    keywords: impl IntoIterator<Item = (String, Vec<String>)>,
) -> Result<R, Misused> {
    let table = R::table();
    let mut given = Given::new();
    for (key, texts) in keywords {
        let name = key.replace('-', "_");
        let is_called = |it: &&Entry| it.name == name || it.alias == Some(&name);
        let Some(entry) = table.iter().find(is_called) else {
            let known = table.iter().map(|it| it.name).collect();
            return Err(Misused::Unknown(key, known));
        };
        for text in texts {
            let all = given.entry(entry.name).or_default();
            if !all.is_empty() && !entry.repeats {
                return Err(Misused::Wrong(format!(
                    "{} can be given only once",
                    entry.name
                )));
            }
            all.extend(values(entry, text)?);
        }
    }
    check(&table, &given)?;
    R::read(given)
}

/// The values in a text, which are checked.
fn values(entry: &Entry, text: String) -> Result<Vec<String>, Misused> {
    let name = entry.name;
    if text.is_empty() || entry.value.is_none() {
        return match entry.alone.filter(|_| text.is_empty()) {
            Some(alone) => Ok(vec![alone.to_owned()]),
            None => Err(Misused::Wrong(format!("{name} = {text} is not possible"))),
        };
    }
    let parts: Vec<&str> = match entry.is_list {
        true => text.split(',').collect(),
        false => vec![&text],
    };
    let read = |part: &str| {
        let read = entry.read(part);
        read.map_err(|why| Misused::value(name, part, &why))
    };
    parts.into_iter().map(read).collect()
}

/// Checks which options are given together.
fn check(table: &[Entry], given: &Given) -> Result<(), Misused> {
    let is_given = |name: &&str| given.contains_key(name);
    let all: Vec<&Entry> = table.iter().filter(|it| is_given(&it.name)).collect();
    for (k, one) in all.iter().enumerate() {
        let excludes = |other: &&&Entry| {
            one.conflicts.contains(&other.name) || other.conflicts.contains(&one.name)
        };
        if let Some(other) = all[k + 1..].iter().find(excludes) {
            let wrong = format!("{} cannot be given with {}", one.name, other.name);
            return Err(Misused::Wrong(wrong));
        }
    }
    let none_of = |others: &[&str]| !others.iter().any(is_given);
    let required = |it: &&Entry| it.required_unless.is_some_and(none_of);
    let required = table.iter().filter(required).map(|it| it.name);
    let required = required.chain(all.iter().filter_map(|it| it.requires));
    let missing: Vec<&str> = required.filter(|name| !is_given(name)).collect();
    match &missing[..] {
        [] => Ok(()),
        names => Err(Misused::missing(names)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::request::{count, options, positive};

    options! {
        #[derive(Debug, PartialEq)]
        struct Asked {
            kt: Vec<f64> = value("E_J", positive).list().required(),
            most_runs: usize = value("N", count).or(5),
            whole: bool = flag(),
            part: Option<String> = value("PART", |text: &str| Ok(text.to_owned())).conflicts(&["whole"]),
        }
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
        let hyphened = asked(&[("kt", &["1"]), ("most-runs", &["7"])]).unwrap();
        assert_eq!(hyphened.most_runs, 7);
        let names: Vec<&str> = Asked::table().iter().map(|it| it.name).collect();
        assert_eq!(names, ["kt", "most_runs", "whole", "part"]);
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
        assert_eq!(describe(&[("whole", &["x"])]), "whole = x is not possible");
    }
}
