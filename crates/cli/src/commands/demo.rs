//! `carrystep demo`: the main job on the shipped machine, with all files in one folder.

use crate::arguments::Demo;
use crate::commands::verilog;
use crate::failure::Failure;
use crate::job::{self, RunResult};
use crate::output::{self, write_file};
use crate::shipped::{MACHINE, MACHINE_FILE};
use crate::wanted::{Part, Wanted};
use carrystep_report::Detail;
use carrystep_verilog::Prefix;
use std::path::Path;

/// The move file of the demo.
const MOVES: &str = include_str!("../../../../sim/demo.toml");

/// Plans, exports, simulates and checks the demo, writes its files and prints the report.
pub fn run(arguments: &Demo) -> Result<(), Failure> {
    let out = |name: &str| arguments.out.join(name);
    write_file(&out(MACHINE_FILE), MACHINE)?;
    write_file(&out("demo.toml"), MOVES)?;
    let source = job::load(&out("demo.toml"), None)?;
    let (survey, recorded) = job::recorded(source, Detail::Figures, |_| Ok(()))?;
    let verilog = verilog::write(
        arguments.core,
        &arguments.out,
        survey.machine(),
        &Prefix::default(),
        MACHINE_FILE,
    )?;
    let wanted = Wanted {
        vcd: Some(out("demo.vcd")),
        fst: None,
        save: Some(out("demo.gtkw")),
        csv: Some(out("demo.csv")),
        plot: Some(out("demo.svg")),
        report: None,
        part: Part::default(),
    };
    let mut done = job::run((&survey, &recorded), arguments.core, arguments.level, &wanted)?;
    done.files.splice(0..0, verilog.files);
    print(&done, arguments.json, &arguments.out)?;
    done.verdict()
}

fn print(done: &RunResult, json: bool, out: &Path) -> Result<(), Failure> {
    if json {
        return output::print_json(done);
    }
    output::print(&format!("{done}look: gtkwave {}\n", out.join("demo.gtkw").display()))
}
