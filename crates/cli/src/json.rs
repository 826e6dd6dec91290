//! Writes values as JSON, in one line or indented.
//!
//! There is one type of serializer for all values, writers and layouts, because Rust compiles the
//! code that serializes a value once for each type of serializer.

use serde::Serialize;
use serde_json::ser::{CompactFormatter, Formatter, PrettyFormatter, Serializer};
use std::io::{Result, Write};

/// Writes a value.
///
/// # Errors
/// The writer fails, or the value has no form in JSON.
pub fn write(
    out: &mut dyn Write,
    value: &impl Serialize,
    in_a_line: bool,
) -> serde_json::Result<()> {
    let layout = if in_a_line { Layout::Line } else { Layout::Indented(PrettyFormatter::new()) };
    value.serialize(&mut Serializer::with_formatter(out, layout))
}

/// The text of a value in one line.
///
/// # Errors
/// The value has no form in JSON.
pub fn line(value: &impl Serialize) -> serde_json::Result<String> {
    text(value, true)
}

/// The indented text of a value.
///
/// # Errors
/// The value has no form in JSON.
pub fn indented(value: &impl Serialize) -> serde_json::Result<String> {
    text(value, false)
}

fn text(value: &impl Serialize, in_a_line: bool) -> serde_json::Result<String> {
    let mut text = Vec::new();
    write(&mut text, value, in_a_line)?;
    String::from_utf8(text).map_err(|error| serde_json::Error::io(std::io::Error::other(error)))
}

enum Layout {
    Line,
    Indented(PrettyFormatter<'static>),
}

/// Passes what differs between the two layouts to the formatter of the layout.
macro_rules! layout {
    ($($method:ident($($argument:ident: $type:ty)?);)*) => {
        impl Formatter for Layout {
            $(fn $method<W: ?Sized + Write>(
                &mut self,
                out: &mut W
                $(, $argument: $type)?
            ) -> Result<()> {
                match self {
                    Self::Line => CompactFormatter.$method(out $(, $argument)?),
                    Self::Indented(formatter) => formatter.$method(out $(, $argument)?),
                }
            })*
        }
    };
}

layout! {
    begin_array();
    end_array();
    begin_array_value(first: bool);
    end_array_value();
    begin_object();
    end_object();
    begin_object_key(first: bool);
    begin_object_value();
    end_object_value();
}

#[cfg(test)]
mod tests {
    use super::{indented, line};
    use serde_json::{from_str, json, to_string, to_string_pretty};

    #[test]
    fn both_layouts_are_those_of_serde_json() {
        let value = json!({"a": [], "b": {}, "c": [1, -2.5, null, [true, "\u{1} \"\u{e9}"]],
            "d": {"e": {"f": [{}, {"g": 1}]}}});
        let (short, long) = (line(&value).unwrap(), indented(&value).unwrap());
        assert_eq!(short, to_string(&value).unwrap());
        assert_eq!(long, to_string_pretty(&value).unwrap());
        assert_eq!(from_str::<serde_json::Value>(&long).unwrap(), value);
    }
}
