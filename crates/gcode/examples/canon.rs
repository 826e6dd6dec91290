//! Prints the canonical moves of a program, one a line.

use carrystep_gcode::{Interpreter, Options};
use std::io::Write as _;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args_os().nth(1).map(PathBuf::from).ok_or("canon FILE.ngc")?;
    let mut out = std::io::BufWriter::new(std::io::stdout().lock());
    for step in Interpreter::open(&path, &Options::default())? {
        let step = step?;
        writeln!(out, "{}: {:?}", step.line, step.canon)?;
    }
    Ok(())
}
