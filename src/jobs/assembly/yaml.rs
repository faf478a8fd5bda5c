//! YAML (and JSON, which is a part of it) as a tree whose nodes know their positions in the file.
//!
//! The parser is `saphyr-parser`: safe Rust without recursion, so that unlimited nesting and
//! self-references are rejected in time linear in the text.

use std::collections::{HashMap, HashSet};
use std::ops::Range;
use std::rc::Rc;

use saphyr_parser::{Event, Parser, ScalarStyle, Span};

use crate::design::{DesignError, FilePlace};

/// Deepest nesting of lists and mappings; a tile set needs five.
const DEEPEST: usize = 16;

/// A node of the tree.
#[derive(Clone, Debug)]
pub(super) struct Node {
    /// Its position, in characters.
    at: Range<usize>,
    /// Depth of nested lists and mappings.
    depth: usize,
    /// Shared by all aliases.
    value: Rc<Value>,
}

#[derive(Debug)]
enum Value {
    Scalar { text: String, is_plain: bool },
    List(Vec<Node>),
    Mapping(Vec<(Node, Node)>),
}

impl Node {
    /// The text of a scalar.
    pub fn text(&self) -> Option<&str> {
        match &*self.value {
            Value::Scalar { text, .. } => Some(text),
            _ => None,
        }
    }

    /// The text of a scalar without quotes.
    fn plain(&self) -> Option<&str> {
        match &*self.value {
            Value::Scalar { text, is_plain } => is_plain.then_some(text),
            _ => None,
        }
    }

    /// Whether it is null.
    pub fn is_null(&self) -> bool {
        matches!(self.plain(), Some("" | "~" | "null" | "Null" | "NULL"))
    }

    /// The items of a list.
    pub fn list(&self) -> Option<&[Self]> {
        match &*self.value {
            Value::List(items) => Some(items),
            _ => None,
        }
    }

    /// A whole number from 0 on.
    pub fn whole(&self) -> Option<usize> {
        let text = self.plain()?;
        let text = text.strip_prefix('+').unwrap_or(text);
        let is_digits = text.bytes().all(|byte| byte.is_ascii_digit());
        is_digits.then(|| text.parse().ok()).flatten()
    }

    /// A finite number.
    pub fn number(&self) -> Option<f64> {
        let number = self.plain()?.parse().ok();
        number.filter(|number: &f64| number.is_finite())
    }
}

/// A text with its file's name, for error messages.
#[derive(Clone, Copy)]
pub(super) struct TextSource<'a> {
    /// The whole text.
    pub text: &'a str,
    /// Its name.
    pub file: &'a str,
}

impl TextSource<'_> {
    /// The tree of the text's only document.
    ///
    /// # Errors
    /// If the text is not YAML, is nested too deeply, or has several documents.
    pub fn tree(&self) -> Result<Node, DesignError> {
        let mut parser = Parser::new_from_str(self.text);
        let mut tree = Tree::default();
        while let Some(event) = parser.next_event() {
            let taken = event
                .map_err(|error| (error.marker().index()..0, error.info().to_owned()))
                .and_then(|(event, span)| tree.take(event, span));
            taken.map_err(|(at, why)| {
                self.fault(at, format!("it is not valid YAML: {why}"), FORM)
            })?;
        }
        let nothing = || self.fault(0..0, "it is empty".to_owned(), FORM);
        tree.root.ok_or_else(nothing)
    }

    /// An error at a node.
    pub fn wrong(&self, node: &Node, message: impl Into<String>, help: &str) -> DesignError {
        self.fault(node.at.clone(), message.into(), help)
    }

    fn fault(&self, at: Range<usize>, message: String, help: &str) -> DesignError {
        let byte = |index| self.text.char_indices().nth(index);
        let byte = |index| byte(index).map_or(self.text.len(), |(at, _)| at);
        let (start, end) = (byte(at.start), byte(at.end.max(at.start + 1)));
        let place = FilePlace::of(self.text, start..end);
        DesignError::new(self.file, Some(place), message, help)
    }

    /// The entries of a mapping, each key with its name and value.
    ///
    /// # Errors
    /// If it is not a mapping, or a key is not a name or occurs twice.
    pub fn entries<'n>(
        &self,
        node: &'n Node,
        what: &str,
    ) -> Result<Vec<(&'n Node, &'n str, &'n Node)>, DesignError> {
        let Value::Mapping(entries) = &*node.value else {
            return Err(self.wrong(node, format!("{what} is written as `key: value`"), FORM));
        };
        let mut seen = HashSet::new();
        let named = |(key, value): &'n (Node, Node)| {
            let name = key.text();
            let name = name.ok_or_else(|| self.wrong(key, "a key is a word", FORM))?;
            match seen.insert(name) {
                true => Ok((key, name, value)),
                false => {
                    let message = format!("the key `{name}` is there twice");
                    Err(self.wrong(key, message, "remove one"))
                }
            }
        };
        entries.iter().map(named).collect()
    }
}

/// The expected form of a tile set, for error messages.
pub(super) const FORM: &str = "write tiles: [{name: a, edges: [north, east, south, west]}] as for \
    rgrow, or a .tiles file for xgrow";

/// An unfinished list or mapping, in which keys and values alternate.
struct Open {
    start: usize,
    anchor: usize,
    items: Vec<Node>,
}

/// A tree under construction from events.
#[derive(Default)]
struct Tree {
    open: Vec<Open>,
    anchors: HashMap<usize, Node>,
    root: Option<Node>,
}

/// An error, and its position in characters.
type Wrong = (Range<usize>, String);

impl Tree {
    fn take(&mut self, event: Event, span: Span) -> Result<(), Wrong> {
        let at = span.start.index()..span.end.index();
        match event {
            Event::Scalar(text, style, anchor, _) => {
                let value = Value::Scalar {
                    text: text.into_owned(),
                    is_plain: style == ScalarStyle::Plain,
                };
                self.put(at, value, anchor)
            }
            Event::SequenceStart(anchor, _) | Event::MappingStart(anchor, _) => {
                self.open.push(Open {
                    start: at.start,
                    anchor,
                    items: Vec::new(),
                });
                self.check_depth(at, self.open.len())
            }
            Event::SequenceEnd => self.close(at.end, Value::List),
            Event::MappingEnd => self.close(at.end, |items| {
                let mut items = items.into_iter();
                let pairs = std::iter::from_fn(|| Some((items.next()?, items.next()?)));
                Value::Mapping(pairs.collect())
            }),
            Event::Alias(anchor) => {
                let node = self.anchors.get(&anchor).cloned();
                let node = node.ok_or_else(|| (at.clone(), "it contains itself".to_owned()))?;
                self.check_depth(at.clone(), self.open.len() + node.depth)?;
                self.add(Node { at, ..node });
                Ok(())
            }
            Event::DocumentStart(_) if self.root.is_some() => {
                Err((at, "it has more than one document".to_owned()))
            }
            _ => Ok(()),
        }
    }

    fn check_depth(&self, at: Range<usize>, depth: usize) -> Result<(), Wrong> {
        let message = || format!("more than {DEEPEST} lists and mappings are nested");
        (depth <= DEEPEST)
            .then_some(())
            .ok_or_else(|| (at, message()))
    }

    fn close(&mut self, end: usize, value: impl Fn(Vec<Node>) -> Value) -> Result<(), Wrong> {
        let open = self.open.pop();
        let open = open.ok_or_else(|| (end..end, "an end without a beginning".to_owned()))?;
        self.put(open.start..end, value(open.items), open.anchor)
    }

    fn put(&mut self, at: Range<usize>, value: Value, anchor: usize) -> Result<(), Wrong> {
        let deepest = |nodes: &mut dyn Iterator<Item = &Node>| nodes.map(|it| it.depth).max();
        let inner = match &value {
            Value::Scalar { .. } => None,
            Value::List(items) => Some(deepest(&mut items.iter())),
            Value::Mapping(pairs) => Some(deepest(&mut pairs.iter().flat_map(|(k, v)| [k, v]))),
        };
        let node = Node {
            at,
            depth: inner.map_or(0, |inner| 1 + inner.unwrap_or(0)),
            value: Rc::new(value),
        };
        // 0 means no alias.
        if anchor > 0 {
            self.anchors.insert(anchor, node.clone());
        }
        self.add(node);
        Ok(())
    }

    fn add(&mut self, node: Node) {
        match self.open.last_mut() {
            Some(open) => open.items.push(node),
            None => self.root = Some(node),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use super::*;

    fn tree(text: &str) -> Result<Node, DesignError> {
        TextSource { text, file: "a" }.tree()
    }

    #[test]
    fn nodes_are_what_they_are_written_as() {
        let text = "a: &n [1, '2', +3, ~, 1e3, -1]\nb: *n\n\"c\": {\"d\":\"\\u00e4\"}";
        let source = TextSource { text, file: "a" };
        let tree = source.tree().unwrap();
        let all = source.entries(&tree, "it").unwrap();
        assert_eq!(
            all.iter().map(|it| it.1).collect::<Vec<_>>(),
            ["a", "b", "c"]
        );
        for (_, _, list) in &all[..2] {
            let list = list.list().unwrap();
            let wholes: Vec<_> = list.iter().map(Node::whole).collect();
            assert_eq!(wholes, [Some(1), None, Some(3), None, None, None]);
            let numbers: Vec<_> = list.iter().map(Node::number).collect();
            let expected = [Some(1.0), None, Some(3.0), None, Some(1e3), Some(-1.0)];
            assert_eq!(numbers, expected);
            assert!(list[3].is_null() && list[1].text() == Some("2"));
        }
        let inner = source.entries(all[2].2, "it").unwrap();
        assert_eq!(inner[0].2.text(), Some("\u{e4}"));
    }

    #[test]
    fn faults_have_their_places() {
        for (text, place) in [
            ("a: [1", (1, 6)),
            ("\u{e4}: {b: 1}\nc: *x", (2, 4)),
            ("a: &a [*a]", (1, 8)),
            ("--- a\n--- b", (2, 1)),
            ("a: '\u{e4}", (1, 4)),
        ] {
            let error = tree(text).unwrap_err();
            let found = error.place.as_ref().unwrap();
            assert_eq!((found.line, found.column), place, "{text}: {error}");
        }
        let text = "a: 1\nb: 2\na: 3";
        let source = TextSource { text, file: "a" };
        let error = source.entries(&source.tree().unwrap(), "it").unwrap_err();
        assert!(
            error
                .to_string()
                .starts_with("a:3:1: the key `a` is there twice")
        );
        assert!(tree("").unwrap_err().to_string().contains("empty"));
    }

    /// Each of these took some parser minutes, or overflowed its stack.
    #[test]
    fn no_shape_takes_long() {
        let many = 100_000;
        let bombs =
            (1..40).map(|k| format!("a{k}: &a{k} [{}]\n", format!("*a{},", k - 1).repeat(9)));
        let laughs = format!("a0: &a0 [b]\n{}", bombs.collect::<String>());
        let chain = (1..many).map(|k| format!("- &a{k} [*a{}]\n", k - 1));
        let chain = format!("- &a0 b\n{}", chain.collect::<String>());
        let start = Instant::now();
        for deep in ["{a: ", "[", "- ", "? ", "[a: ", "{? "].map(|it| it.repeat(many)) {
            assert!(tree(&deep).is_err());
        }
        assert!(tree(&laughs).is_err() && tree(&chain).is_err());
        let wide = format!("[{}]", "&a {b: c}, *a,".repeat(many));
        assert_eq!(tree(&wide).unwrap().list().unwrap().len(), 2 * many);
        for text in [":".repeat(many), "'".repeat(many), "a\n".repeat(many)] {
            let _ = tree(&text);
        }
        assert!(start.elapsed() < Duration::from_secs(20));
    }
}
