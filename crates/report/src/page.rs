//! Writes the page: a template, a style and a script that are embedded at build time, and the
//! numbers.

use crate::drawing::Drawing;
use minijinja::{AutoEscape, Environment, UndefinedBehavior, Value, context};
use serde::Serialize;
use std::io::Write;
use thiserror::Error;

const PAGE: &str = include_str!("../page/page.html");
const STYLE: &str = include_str!("../page/page.css");
const SCRIPTS: [&str; 5] = [
    include_str!("../page/figures.js"),
    include_str!("../page/view.js"),
    include_str!("../page/path.js"),
    include_str!("../page/charts.js"),
    include_str!("../page/bars.js"),
];

/// The page cannot be written.
#[derive(Debug, Error)]
pub enum PageError {
    /// The document or the drawing is no JSON.
    #[error("the report's numbers cannot be written: {0}")]
    Numbers(#[from] serde_json::Error),
    /// The template is wrong, which a test excludes.
    #[error("the report's template: {0}")]
    Template(#[from] minijinja::Error),
    /// The file cannot be written.
    #[error(transparent)]
    Write(#[from] std::io::Error),
}

/// Writes the page of a plan. `document` is what `--json` prints, from which the page takes all its
/// figures; `source` are lines of the program that it names, each with its number.
///
/// # Errors
/// See [`PageError`].
pub fn write_page(
    out: &mut impl Write,
    title: &str,
    document: &impl Serialize,
    drawing: &Drawing,
    source: &[(u64, String)],
) -> Result<(), PageError> {
    let mut environment = Environment::new();
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    environment.set_auto_escape_callback(|_| AutoEscape::Html);
    let numbers =
        [("document", json(document)?), ("drawing", json(drawing)?), ("source", json(&source)?)];
    let numbers = numbers.map(|(name, json)| (name, Value::from_safe_string(json)));
    let page = environment.render_str(
        PAGE,
        context! {
            title,
            style => Value::from_safe_string(STYLE.to_owned()),
            script => Value::from_safe_string(SCRIPTS.concat()),
            numbers,
        },
    )?;
    Ok(out.write_all(page.as_bytes())?)
}

/// JSON that no browser takes for an end of the script that it is in.
fn json(value: &impl Serialize) -> Result<String, serde_json::Error> {
    Ok(serde_json::to_string(value)?.replace('<', "\\u003c"))
}
