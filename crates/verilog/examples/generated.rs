//! Writes the files that are generated from tables of `spec` into the workspace. Run it with `cargo
//! run -p carrystep-verilog --example generated`.

use carrystep_verilog::write_generated_files;
use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    write_generated_files(Path::new("."))?;
    Ok(())
}
