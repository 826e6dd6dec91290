//! Writes the committed core: `cargo run -p carrystep-export --example core`, from the root of the tree.

use carrystep_export::write_core;
use carrystep_spec::Machine;
use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let machine = Machine::load(Path::new("sim/six-axis.toml"))?;
    write_core(Path::new("hdl-out/core"), &machine.build(), "sim/six-axis.toml")?;
    Ok(())
}
