//! The layout of JSON: objects indented, arrays of numbers on one line.

use std::io;

use serde::Serialize;
use serde_json::ser::{Formatter, Serializer};

pub use super::values::positive_zero;

/// A value as JSON, objects indented and arrays of numbers on one line, with a final line feed.
/// Numbers that JSON cannot represent (infinity) become null.
///
/// # Panics
/// Never for the entries of this module: their keys are strings.
pub fn text(value: &impl Serialize) -> String {
    let mut bytes = Vec::new();
    let mut serializer = Serializer::with_formatter(&mut bytes, Layout::default());
    value
        .serialize(&mut serializer)
        .expect("plain values with string keys are written");
    bytes.push(b'\n');
    String::from_utf8(bytes).expect("JSON is UTF-8")
}

/// Objects spread over lines, arrays not.
#[derive(Default)]
struct Layout {
    depth: usize,
}

impl Layout {
    fn line<W: ?Sized + io::Write>(&self, writer: &mut W) -> io::Result<()> {
        write!(writer, "\n{:1$}", "", 2 * self.depth)
    }
}

impl Formatter for Layout {
    fn begin_array_value<W: ?Sized + io::Write>(
        &mut self,
        writer: &mut W,
        first: bool,
    ) -> io::Result<()> {
        writer.write_all(if first { b"" } else { b", " })
    }

    fn begin_object<W: ?Sized + io::Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.depth += 1;
        writer.write_all(b"{")
    }

    fn end_object<W: ?Sized + io::Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.depth -= 1;
        self.line(writer)?;
        writer.write_all(b"}")
    }

    fn begin_object_key<W: ?Sized + io::Write>(
        &mut self,
        writer: &mut W,
        first: bool,
    ) -> io::Result<()> {
        writer.write_all(if first { b"" } else { b"," })?;
        self.line(writer)
    }

    fn begin_object_value<W: ?Sized + io::Write>(&mut self, writer: &mut W) -> io::Result<()> {
        writer.write_all(b": ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    #[test]
    fn arrays_stay_on_a_line_and_the_text_is_json() {
        let value = json!({"a": [1.5, {"b": []}], "c": {"d": f64::INFINITY}});
        let text = text(&value);
        let lines =
            "{\n  \"a\": [1.5, {\n    \"b\": []\n  }],\n  \"c\": {\n    \"d\": null\n  }\n}\n";
        assert_eq!(text, lines);
        assert_eq!(serde_json::from_str::<Value>(&text).unwrap(), value);
    }
}
