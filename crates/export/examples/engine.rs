//! Writes an engine: `cargo run -p carrystep-export --example engine -- MACHINE.toml FOLDER`.

use carrystep_export::write_engine;
use carrystep_spec::Machine;
use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let (Some(file), Some(folder)) = (arguments.next(), arguments.next()) else {
        return Err("a machine file and a folder are needed".into());
    };
    let machine = Machine::load(Path::new(&file))?;
    write_engine(Path::new(&folder), &machine.engine(), &file)?;
    Ok(())
}
