//! Writes what is made from the register map into the workspace: `cargo run -p carrystep-export --example registers`.

use carrystep_export::write_register_files;
use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    write_register_files(Path::new("."))?;
    Ok(())
}
