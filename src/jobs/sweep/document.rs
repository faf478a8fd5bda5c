//! A design file as a document whose keys can be set.

use toml::{Table, Value as Toml};

/// Sets the key at a dotted path; missing tables are created.
///
/// # Errors
/// If the path leads through something that is neither a table nor a long enough array.
pub fn set(document: &mut Table, path: &str, value: Toml) -> Result<(), String> {
    let parts: Vec<&str> = path.split('.').map(str::trim).collect();
    let (first, rest) = parts.split_first().ok_or("the path is empty")?;
    if rest.is_empty() {
        document.insert((*first).to_owned(), value);
        return Ok(());
    }
    let mut here = document
        .entry(*first)
        .or_insert_with(|| Toml::Table(Table::new()));
    for (k, part) in rest.iter().enumerate() {
        let last = k + 1 == rest.len();
        let reached = || parts[..=k].join(".");
        let next = match here {
            Toml::Table(table) => table
                .entry(*part)
                .or_insert_with(|| Toml::Table(Table::new())),
            Toml::Array(items) => {
                let count = items.len();
                let item = part.parse().ok().and_then(|i: usize| items.get_mut(i));
                item.ok_or_else(|| {
                    let name = reached();
                    format!(
                        "`{name}` is an array of {count}: give the index of an item, from 0, \
                        not `{part}`"
                    )
                })?
            }
            _ => {
                return Err(format!(
                    "`{}` has no keys, so `{path}` does not exist",
                    reached()
                ));
            }
        };
        if last {
            *next = value;
            return Ok(());
        }
        here = next;
    }
    Ok(())
}

/// The dotted paths of all keys of this name.
pub fn paths(document: &Table, name: &str) -> Vec<String> {
    fn below(here: &Toml, path: &str, name: &str, found: &mut Vec<String>) {
        if let Toml::Table(table) = here {
            within(table, &format!("{path}."), name, found);
        }
    }
    fn within(table: &Table, path: &str, name: &str, found: &mut Vec<String>) {
        for (key, value) in table {
            let own = format!("{path}{key}");
            below(value, &own, name, found);
            if key == name {
                found.push(own);
            }
        }
    }
    let mut found = Vec::new();
    within(document, "", name, &mut found);
    found
}

/// Whether there is a value at a dotted path.
pub fn holds(document: &Table, path: &str) -> bool {
    let mut parts = path.split('.').map(str::trim);
    let first = parts.next().and_then(|part| document.get(part));
    parts
        .try_fold(first, |here, part| match here {
            Some(Toml::Table(table)) => Some(table.get(part)),
            Some(Toml::Array(items)) => Some(part.parse().ok().and_then(|i: usize| items.get(i))),
            _ => None,
        })
        .flatten()
        .is_some()
}

#[cfg(test)]
mod tests {
    use super::super::vary::Value;
    use super::*;

    fn document() -> Table {
        "side = 1.5\nsize = [1.0, 2.0]\n[faces]\nall = { code = \"NN\" }"
            .parse()
            .unwrap()
    }

    #[test]
    fn keys_are_set_wherever_they_are() {
        let mut edited = document();
        for (path, value) in [
            ("side", Value::Whole(2)),
            ("size.1", Value::Number(0.5)),
            ("faces.all.code", Value::Text("NS".into())),
            ("faces.east.profile.depth", Value::Number(0.01)),
        ] {
            assert_eq!(holds(&edited, path), !path.contains("east"), "{path}");
            set(&mut edited, path, value.toml()).unwrap();
            assert!(holds(&edited, path));
        }
        let expected: Table = "side = 2\nsize = [1.0, 0.5]\n[faces]\nall = { code = \"NS\" }\n\
                               east = { profile = { depth = 0.01 } }"
            .parse()
            .unwrap();
        assert_eq!(edited, expected);
    }

    #[test]
    fn paths_that_lead_nowhere_are_refused() {
        for path in ["side.depth", "size.2", "size.x", "size.0.y"] {
            assert!(
                set(&mut document(), path, Toml::Integer(1)).is_err(),
                "{path}"
            );
            assert!(!holds(&document(), path));
        }
    }
}
