//! The JSON Schemas in `docs/schemas/` are those of the documents. A test makes them and compares
//! them. The command does not contain the code for it, which would make it about 4 % larger.

use super::all;
use crate::document::Document;
use schemars::generate::SchemaSettings;
use schemars::{Schema, json_schema};
use serde_json::json;
use std::collections::BTreeMap;
use std::fs;

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/schemas");

/// With this variable in its environment, the test writes the schemas. `cargo xtask generate` sets it.
const WRITE: &str = "CARRYSTEP_WRITE_SCHEMAS";

#[test]
fn committed_schemas_are_those_of_the_documents() {
    let made: BTreeMap<String, String> = all()
        .into_iter()
        .map(|(name, schema)| {
            (format!("{name}.json"), serde_json::to_string_pretty(&schema).unwrap() + "\n")
        })
        .collect();
    if std::env::var_os(WRITE).is_some() {
        for (name, text) in &made {
            fs::write(format!("{FOLDER}/{name}"), text).unwrap();
        }
    }
    let mut committed = BTreeMap::new();
    for file in fs::read_dir(FOLDER).unwrap() {
        let file = file.unwrap();
        let name = file.file_name().into_string().unwrap();
        committed.insert(name, fs::read_to_string(file.path()).unwrap());
    }
    let names = |files: &BTreeMap<String, String>| files.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(&committed), names(&made), "run `cargo xtask generate`");
    for (name, text) in made {
        assert!(committed[&name] == text, "{name}: run `cargo xtask generate`");
    }
}

/// The schema of a document, with the name and the version that [`crate::document::Named`] adds.
pub(super) fn schema<D: Document>() -> Schema {
    let generator = SchemaSettings::draft2020_12().for_serialize().into_generator();
    let mut schema = generator.into_root_schema_for::<D>();
    let title = format!("carrystep.{}", D::NAME);
    let name = json_schema!({
        "description": "What document this is, and which version of it.",
        "type": "object",
        "properties": {
            "name": { "const": title },
            "version": { "const": D::VERSION },
        },
        "required": ["name", "version"],
    });
    let fields = schema.ensure_object();
    fields.insert("title".to_owned(), title.into());
    let properties = fields.entry("properties").or_insert_with(|| json!({}));
    properties.as_object_mut().unwrap().insert("schema".to_owned(), name.to_value());
    let required = fields.entry("required").or_insert_with(|| json!([]));
    required.as_array_mut().unwrap().insert(0, "schema".into());
    schema
}
