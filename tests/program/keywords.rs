//! Python has the options of requests as keywords. Their names, types, defaults and help are written
//! once, where the request is declared: this writes them into the stub, and for the docstrings.
//!
//! Where options changed, run it with `TILEBIND_KEYWORDS=keep` to keep what is new, then
//! `tests/python/api.py`.

use std::any::TypeId;
use std::fmt::Write;
use std::fs;
use std::path::PathBuf;

use tilebind::request::{Entry, Options};
use tilebind::{
    assembly, bond, calibration, comparison, docking, pipeline, query, rates, search, start, sweep,
    table, tolerance, word_sets, workshop, yields,
};

/// A call with the keywords of a request.
struct Call {
    /// Its class, if it has one, and name in the stub.
    class: &'static str,
    name: &'static str,
    keywords: Vec<Keyword>,
}

fn call<R: Options>(name: &'static str, others: &[&str]) -> Call {
    of_table(name, R::table(), others)
}

fn of_table(name: &'static str, table: Vec<Entry>, others: &[&str]) -> Call {
    let shown = table.iter().filter(|it| !it.is_hidden);
    let mut keywords: Vec<_> = shown.map(Keyword::of).collect();
    keywords.retain(|it| !others.contains(&&it.name[..]));
    keywords.sort_by_key(|it| it.default.is_some());
    let (class, name) = name.split_once('.').unwrap_or(("", name));
    Call {
        class,
        name,
        keywords,
    }
}

/// All calls; what they take otherwise, or not at all, is left out.
#[rustfmt::skip]
fn calls() -> Vec<Call> {
    vec![
        call::<pipeline::Request>("Design.analyse", &[]),
        call::<query::Request>("Design.barrier", &["from", "to"]),
        call::<docking::Request>("dock", &[]),
        call::<docking::Request>("Design.dock", &[]),
        call::<rates::Request>("Design.exits", &["start", "traps"]),
        call::<rates::Request>("Analysis.rates", &["start", "check", "restitution", "seed"]),
        call::<bond::Request>("Analysis.bond", &["seed"]),
        call::<yields::Request>("Design.yields", &[]),
        call::<table::Request>("_AirTable.__call__", &[]),
        call::<workshop::Request>("Design.make", &[]),
        call::<calibration::PairsRequest>("Design.calibrate_bonds", &[]),
        call::<start::Request>("Design.start", &[]),
        call::<comparison::Request>("compare", &[]),
        call::<sweep::Request>("sweep", &[]),
        // A search is a sweep with an aim.
        of_table("search", [search::Request::table(), comparison::Request::table()].concat(), &[]),
        call::<tolerance::Request>("tolerance", &[]),
        call::<word_sets::Request>("words", &[]),
        call::<word_sets::CrosstalkRequest>("crosstalk", &[]),
        call::<assembly::Request>("assemble", &[]),
    ]
}

struct Keyword {
    name: String,
    /// Its type in the stub, without `None`.
    kind: String,
    /// `None` if it must be given; Python's `None` if what is usual depends on something else.
    default: Option<String>,
    help: String,
}

impl Keyword {
    fn of(option: &Entry) -> Self {
        // A flag with a number on the command line.
        let name = match option.name {
            "dynamics" => "dynamics_runs",
            name => name,
        };
        let default = match &option.default {
            _ if option.value.is_none() => Some("False".to_owned()),
            _ if option.required_unless.is_some_and(<[_]>::is_empty) => None,
            None => Some("None".to_owned()),
            Some(number) if number.parse::<f64>().is_ok() => Some(number.clone()),
            Some(word) => Some(format!("\"{word}\"")),
        };
        let help = option.help.split("\n\n").next().unwrap_or_default();
        Self {
            name: name.to_owned(),
            kind: kind(option),
            default,
            help: help.to_owned(),
        }
    }

    fn in_stub(&self) -> String {
        match self.default.as_deref() {
            None => format!("{}: {}", self.name, self.kind),
            Some("None") => format!("{}: {} | None = None", self.name, self.kind),
            Some(default) => format!("{}: {} = {default}", self.name, self.kind),
        }
    }

    /// As numpydoc has it. That numbers may be texts is said once for all.
    fn in_docstring(&self) -> String {
        let kind = self
            .kind
            .replace("float | str", "float")
            .replace("] | str", "]");
        let kind = kind
            .replace("Sequence[", "sequence of ")
            .replace(" | ", " or ");
        let kind = kind
            .replace("Literal[", "{")
            .replace("\"]", "\"}")
            .replace(']', "");
        let mut text = format!("{} : {kind}", self.name);
        match self.default.as_deref() {
            None => (),
            Some("None" | "False") => text += ", optional",
            Some(default) => write!(text, ", default: {default}").expect("a text"),
        }
        let mut width = 100;
        for word in self.help.split_whitespace() {
            if width + word.len() > 90 {
                text += "\n   ";
                width = 3;
            }
            // Options are keywords here.
            let word = match word.strip_prefix("--") {
                None => word.to_owned(),
                Some(option) => {
                    let is_name = |c: char| c.is_ascii_lowercase() || c == '-';
                    let end = option.find(|c| !is_name(c)).unwrap_or(option.len());
                    format!("`{}`{}", option[..end].replace('-', "_"), &option[end..])
                }
            };
            width += 1 + word.len();
            write!(text, " {word}").expect("a text");
        }
        text
    }
}

/// The type of an option in the stub. Numbers may be given as on the command line, with units.
fn kind(option: &Entry) -> String {
    let Some(form) = option.value else {
        return "bool".to_owned();
    };
    let is = |of: &[TypeId]| option.kind.is_some_and(|it| of.contains(&it));
    let number = [TypeId::of::<f64>()];
    let numbers = [TypeId::of::<[f64; 2]>()];
    let whole = [
        TypeId::of::<usize>(),
        TypeId::of::<u64>(),
        TypeId::of::<u32>(),
        TypeId::of::<u16>(),
    ];
    let wholes = [TypeId::of::<[usize; 2]>(), TypeId::of::<[usize; 3]>()];
    let one = match &option.words[..] {
        [_, ..] => format!("Literal[\"{}\"]", option.words.join("\", \"")),
        [] if is(&number) => "float | str".to_owned(),
        [] if is(&whole) => "int".to_owned(),
        [] if is(&wholes) => "Sequence[int] | str".to_owned(),
        [] if form == "N,M" => "int | Sequence[int] | str".to_owned(),
        [] if is(&numbers) || form.contains(',') => "Sequence[float | str] | str".to_owned(),
        [] => "str".to_owned(),
    };
    match option.alone {
        Some(_) => format!("{one} | bool"),
        None if option.repeats => format!("{one} | Sequence[{one}]"),
        None => one,
    }
}

/// What is no option of a request: objects, and what only Python has.
const OTHERS: [&str; 4] = ["by", "design", "start", "progress"];

/// The stub with the keywords of a call in place of those between its `*` and its end.
fn in_stub(stub: &str, call: &Call) -> String {
    let class = match call.class {
        "" => 0,
        class => stub.find(&format!("class {class}")).expect(class),
    };
    let indent = if call.class.is_empty() { "" } else { "    " };
    let begin = format!("\n{indent}def {}(\n", call.name);
    let begin = class + stub[class..].find(&begin).expect(call.name);
    let end = begin
        + stub[begin..]
            .find(&format!("\n{indent}) -> "))
            .expect("an end");
    let head = &stub[begin..end];
    let Some(star) = head.find("    *,\n") else {
        return stub.to_owned();
    };
    let (places, named) = head.split_at(star + "    *,\n".len());
    let name = |line: &str| line.trim().split(':').next().map(str::to_owned);
    let places: Vec<_> = places.lines().filter_map(name).collect();
    let mut lines: Vec<String> = call
        .keywords
        .iter()
        .filter(|it| !places.contains(&it.name))
        .map(|it| format!("{indent}    {},", it.in_stub()))
        .collect();
    let others = named
        .lines()
        .filter(|line| name(line).is_some_and(|name| OTHERS.contains(&&name[..])));
    lines.extend(others.map(str::to_owned));
    let named = begin + star + "    *,\n".len();
    format!("{}{}{}", &stub[..named], lines.join("\n"), &stub[end..])
}

#[test]
fn python_has_the_options_of_requests_as_keywords() {
    let root = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/src/python"));
    let path = root.join("tilebind/_tilebind.pyi");
    let kept = fs::read_to_string(&path).expect("the stub");
    let stub = calls().iter().fold(kept, |stub, call| in_stub(&stub, call));
    let mut files = vec![(path, stub)];
    for call in calls() {
        let file = call.name.replace("__call__", "table");
        let path = root.join(format!("rust/keywords/{file}.txt"));
        let text = call.keywords.iter().map(Keyword::in_docstring);
        let text = text.collect::<Vec<_>>().join("\n");
        files.push((path, text));
    }
    for (path, text) in files {
        if std::env::var_os("TILEBIND_KEYWORDS").is_some_and(|it| it == "keep") {
            fs::write(&path, &text).expect("it can be written");
        }
        let kept = fs::read_to_string(&path).unwrap_or_default();
        let is_kept = kept == text;
        assert!(
            is_kept,
            "{}: TILEBIND_KEYWORDS=keep writes it anew",
            path.display()
        );
    }
}
