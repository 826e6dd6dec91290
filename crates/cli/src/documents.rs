//! The documents that `--json` prints. Each has a name, a version and a JSON Schema that is derived
//! from its Rust type.
//!
//! To add a document, add one line to [`documents!`] below and derive `JsonSchema` for its types;
//! `cargo xtask generate` rewrites `docs/schemas/`. A new field leaves the version unchanged. A
//! field that is removed or changes its meaning increments it.

use crate::commands::{boards, build, check, doctor, home, machine, plan, profile, table, verilog};
use crate::{drive, failure, found, job};
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

macro_rules! documents {
    ($($(#[$only:meta])* $name:literal, $version:literal: $document:ty;)*) => {
        $($(#[$only])* impl Document for $document {
            const NAME: &'static str = $name;
            const VERSION: u32 = $version;
        })*

        /// Name and JSON Schema of every document.
        pub fn schemas() -> Vec<(&'static str, Schema)> {
            vec![$($(#[$only])* ($name, schema::<$document>()),)*]
        }
    };
}

documents! {
    "boards", 1: boards::Shown<'_>;
    "build", 1: build::Report;
    "check", 1: check::Checked<'_>;
    "doctor", 1: doctor::Examined;
    "drive", 1: drive::Driven;
    "failure", 1: failure::Document;
    "home", 1: home::Report;
    "machine-new", 1: machine::Written<'_>;
    "plan", 1: plan::Planned<'_>;
    "profile", 1: profile::Profiles<'_>;
    "simulate", 1: job::Done;
    "status", 1: found::Found;
    "sweep", 1: carrystep_sweep::Report;
    "table", 1: table::Tabled<'_>;
    "verilog", 1: verilog::Written;
    "verilog-board", 1: verilog::WrittenForBoard<'_>;
    #[cfg(unix)]
    "virtual-board", 1: crate::commands::virtual_board::Served;
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
        Self { schema: Name { name: format!("carrystep.{}", D::NAME), version: D::VERSION }, document }
    }
}

/// The schema of a [`Named`] document.
fn schema<D: Document>() -> Schema {
    let mut schema = SchemaSettings::draft2020_12().for_serialize().into_generator().into_root_schema_for::<D>();
    let name = json_schema!({
        "description": "What document this is, and which version of it.",
        "type": "object",
        "properties": {
            "name": { "const": format!("carrystep.{}", D::NAME) },
            "version": { "const": D::VERSION },
        },
        "required": ["name", "version"],
    });
    let fields = schema.ensure_object();
    fields.insert("title".to_owned(), format!("carrystep.{}", D::NAME).into());
    if let Some(properties) = fields.entry("properties").or_insert_with(|| serde_json::json!({})).as_object_mut() {
        properties.insert("schema".to_owned(), name.to_value());
    }
    if let Some(required) = fields.entry("required").or_insert_with(|| serde_json::json!([])).as_array_mut() {
        required.insert(0, "schema".into());
    }
    schema
}
