//! A document of `--json` beside the committed schema that it names.

use jsonschema::Validator;
use serde_json::Value;
use std::collections::BTreeMap;
use std::sync::{LazyLock, Mutex};

/// The folder of the committed schemas.
const SCHEMAS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/schemas");

/// The committed schemas that have been compiled so far, by their names.
static VALIDATORS: LazyLock<Mutex<BTreeMap<String, Validator>>> = LazyLock::new(Mutex::default);

/// Parses a text that must be one document and checks it against its own schema.
#[track_caller]
pub fn check(text: &str) -> Value {
    let document: Value =
        serde_json::from_str(text).unwrap_or_else(|error| panic!("no document: {error}\n{text}"));
    let name = document["schema"]["name"].as_str().and_then(|name| name.strip_prefix("carrystep."));
    let name = name.unwrap_or_else(|| panic!("no schema is named: {text}")).to_owned();
    let mut validators = VALIDATORS.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let validator = validators.entry(name.clone()).or_insert_with(|| {
        let schema =
            std::fs::read_to_string(format!("{SCHEMAS}/{name}.json")).expect("a committed schema");
        jsonschema::validator_for(&serde_json::from_str(&schema).unwrap()).expect("a schema")
    });
    let wrong: Vec<String> = validator
        .iter_errors(&document)
        .map(|error| format!("{}: {error}", error.instance_path()))
        .collect();
    assert!(wrong.is_empty(), "{name}: {wrong:#?}\n{text}");
    document
}
