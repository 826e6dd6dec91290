//! Writes what is made from tables of `core` and `boards` into the workspace: `cargo run -p carrystep-verilog --example generated`.

use carrystep_verilog::write_generated_files;
use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    write_generated_files(Path::new("."))?;
    Ok(())
}
