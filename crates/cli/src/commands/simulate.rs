//! `carrystep simulate`: plans, simulates and checks a move file, and writes waveform, CSV and
//! plot.

use crate::arguments::Simulate;
use crate::failure::Failure;
use crate::wanted::{Part, Wanted};
use crate::{job, output};

/// Plans and simulates a move file.
pub fn run(arguments: &Simulate) -> Result<(), Failure> {
    let survey = job::survey(job::load(&arguments.file, arguments.fit_ns)?, |_| Ok(()))?;
    let wanted = Wanted {
        vcd: arguments.vcd.clone(),
        fst: arguments.fst.clone(),
        save: arguments.save.clone(),
        csv: arguments.csv.clone(),
        plot: arguments.plot.clone(),
        part: Part { from: arguments.from, to: arguments.to, axes: arguments.axes.clone() },
    };
    let done = job::run(&survey, arguments.core, arguments.level, &wanted)?;
    if arguments.json {
        output::print_json(&done)?;
    } else {
        output::print(&done.to_string())?;
    }
    done.verdict()
}
