//! `carrystep simulate`: plans, simulates and checks a move file, and writes waveform, CSV and
//! plot.

use crate::arguments::Simulate;
use crate::failure::{Failure, refused};
use crate::wanted::{Part, Wanted};
use crate::{job, output};
use carrystep_plan::plan;

/// Plans and simulates a move file.
pub fn run(arguments: &Simulate) -> Result<(), Failure> {
    let file = job::load(&arguments.file, arguments.fit_ns)?;
    let plan = plan::<f64>(&file).map_err(|error| refused(&file, &error))?;
    let wanted = Wanted {
        vcd: arguments.vcd.clone(),
        fst: arguments.fst.clone(),
        save: arguments.save.clone(),
        csv: arguments.csv.clone(),
        plot: arguments.plot.clone(),
        part: Part { from: arguments.from, to: arguments.to, axes: arguments.axes.clone() },
    };
    let done = job::run(&file, &plan, arguments.core, arguments.level, &wanted)?;
    if arguments.json {
        output::print_json(&done)?;
    } else {
        output::print(&done.to_string())?;
    }
    done.verdict()
}
