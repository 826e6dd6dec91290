//! Embeds the templates of `templates/board`, so that boards and families name them as data, and
//! collects the doc comments of all ports, which the exported Verilog repeats.

#[path = "build/ports.rs"]
mod ports;

use std::path::Path;
use std::{env, fs};

/// The sources of the modules.
const MODULES: &str = "../hdl/src";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    minijinja_embed::embed_templates!("templates/board");
    for path in [MODULES, "build.rs", "build"] {
        println!("cargo:rerun-if-changed={path}");
    }
    let table = ports::table(Path::new(MODULES))?;
    fs::write(Path::new(&env::var("OUT_DIR")?).join("ports.rs"), table)?;
    Ok(())
}
