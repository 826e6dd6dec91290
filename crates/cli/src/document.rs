//! A document that `--json` prints. It has a name, a version and a JSON Schema that is derived from
//! its Rust type.

use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema, json_schema};
use serde::Serialize;

/// A document that `--json` prints.
pub trait Document: Serialize + JsonSchema {
    /// The name after `carrystep.`, which is also the name of the schema file.
    const NAME: &'static str;
    /// The version. It is incremented when a field is removed or changes its meaning.
    const VERSION: u32;
}

/// A document preceded by the name and the version of its schema.
#[derive(Serialize)]
pub struct Named<'a, D: Document> {
    schema: Name,
    #[serde(flatten)]
    document: &'a D,
}

#[derive(Serialize)]
struct Name {
    name: String,
    version: u32,
}

impl<'a, D: Document> Named<'a, D> {
    /// Adds name and version to a document.
    pub fn new(document: &'a D) -> Self {
        Self {
            schema: Name { name: format!("carrystep.{}", D::NAME), version: D::VERSION },
            document,
        }
    }
}

/// The schema of a [`Named`] document.
pub fn schema<D: Document>() -> Schema {
    let generator = SchemaSettings::draft2020_12().for_serialize().into_generator();
    named(generator.into_root_schema_for::<D>(), D::NAME, D::VERSION)
}

/// Adds the name and the version to the schema of a document. It is not part of [`schema`], so that
/// it is compiled once and not for each document.
fn named(mut schema: Schema, name: &str, version: u32) -> Schema {
    let title = format!("carrystep.{name}");
    let name = json_schema!({
        "description": "What document this is, and which version of it.",
        "type": "object",
        "properties": {
            "name": { "const": title },
            "version": { "const": version },
        },
        "required": ["name", "version"],
    });
    let fields = schema.ensure_object();
    fields.insert("title".to_owned(), title.into());
    if let Some(properties) =
        fields.entry("properties").or_insert_with(|| serde_json::json!({})).as_object_mut()
    {
        properties.insert("schema".to_owned(), name.to_value());
    }
    if let Some(required) =
        fields.entry("required").or_insert_with(|| serde_json::json!([])).as_array_mut()
    {
        required.insert(0, "schema".into());
    }
    schema
}
