//! `carrystep schemas`: writes the JSON Schemas of all documents, as they are in `docs/schemas/`.

use crate::arguments::Schemas;
use crate::failure::Failure;
use crate::output::{self, write_file};
use schemars::Schema;
use std::fmt::Write as _;

/// Writes one file per document, from the name and schema of each.
pub fn run(arguments: &Schemas, documents: &[(&str, Schema)]) -> Result<(), Failure> {
    let mut wrote = String::new();
    for (name, schema) in documents {
        let text = serde_json::to_string_pretty(schema)
            .map_err(|error| Failure::Run(error.to_string()))?;
        let file = arguments.out.join(format!("{name}.json"));
        write_file(&file, &format!("{text}\n"))?;
        // Writing to a string cannot fail.
        let _ = writeln!(wrote, "wrote {}", file.display());
    }
    output::print(&wrote)
}
