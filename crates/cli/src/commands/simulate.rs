//! `carrystep simulate`: plan, run, check; waveform, CSV and plot on the way.

use crate::arguments::Simulate;
use crate::failure::{Failure, refused};
use crate::job::{self, Wanted};
use crate::output;
use carrystep_plan::plan;
use carrystep_spec::MoveFile;

/// Plans and simulates a move file.
pub fn run(arguments: &Simulate) -> Result<(), Failure> {
    let file = MoveFile::load(&arguments.file)?;
    let plan = plan::<f64>(&file).map_err(|error| refused(&file, &error))?;
    let wanted = Wanted {
        vcd: arguments.vcd.clone(),
        save: arguments.save.clone(),
        csv: arguments.csv.clone(),
        plot: arguments.plot.clone(),
    };
    let done = job::run(&file, &plan, arguments.level, &wanted)?;
    if arguments.json { output::print_json(&done)? } else { output::print(&done.to_string())? }
    done.verdict()
}
