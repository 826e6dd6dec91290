//! Comments that mean something: (MSG,...), (DEBUG,...) and (PRINT,...).

use crate::canon::Canon;
use crate::evaluate::Values;

/// What a comment is: a message for the operator, with the values of its parameters where LinuxCNC
/// shows them, or only a comment.
pub(crate) fn canon(comment: &str, values: &impl Values) -> Canon {
    let (kind, text) = comment.split_once(',').unwrap_or((comment, ""));
    match kind.trim().to_ascii_lowercase().as_str() {
        "msg" if comment.contains(',') => Canon::Message(text.trim().to_owned()),
        "debug" | "print" if comment.contains(',') => {
            Canon::Message(with_values(text.trim(), values))
        }
        _ => Canon::Comment(comment.trim().to_owned()),
    }
}

/// The text with `#1` and `#<name>` replaced by their values, with six decimals. A parameter
/// without a value is shown as `######`.
fn with_values(text: &str, values: &impl Values) -> String {
    let mut shown = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('#') {
        shown.push_str(before);
        let (value, length) = value(after, values);
        match value {
            Some(value) => shown.push_str(&format!("{value:.6}")),
            None => shown.push_str(if length > 0 { "######" } else { "#" }),
        }
        rest = &after[length..];
    }
    shown + rest
}

/// The value of the parameter whose name or number begins a text, and the length of both.
fn value(text: &str, values: &impl Values) -> (Option<f64>, usize) {
    if let Some((name, _)) = text.strip_prefix('<').and_then(|rest| rest.split_once('>')) {
        let length = name.len() + 2;
        let name: String = name.chars().filter(|c| !c.is_whitespace()).collect();
        return (values.named(&name.to_ascii_lowercase()), length);
    }
    let length = text.bytes().take_while(u8::is_ascii_digit).count();
    let number = text[..length].parse().ok().filter(|&number: &usize| number > 0);
    (number.map(|number| values.numbered(number)), length)
}
