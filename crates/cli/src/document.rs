//! A document that `--json` prints. It has a name, a version and a JSON Schema that is derived from
//! its Rust type (`documents/schemas.rs`).

use schemars::JsonSchema;
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
