//! `carrystep simulate`: plans, simulates and checks a move file, and writes waveform, CSV and
//! plot.

use crate::arguments::Simulate;
use crate::failure::Failure;
use crate::wanted::{Part, Wanted};
use crate::{job, output, program, program_run};
use carrystep_program::is_program;

/// Plans and simulates a move file or a program.
pub fn run(arguments: &Simulate) -> Result<(), Failure> {
    if is_program(&arguments.file) {
        return run_program(arguments);
    }
    arguments.program.refuse_for_moves()?;
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

/// Plans and simulates a program.
fn run_program(arguments: &Simulate) -> Result<(), Failure> {
    let Simulate { fst, save, plot, from, to, axes, fit_ns, .. } = arguments;
    program::refuse(&[
        ("--fit-ns", fit_ns.is_some()),
        ("--fst", fst.is_some()),
        ("--save", save.is_some()),
        ("--plot", plot.is_some()),
        ("--from", from.is_some()),
        ("--to", to.is_some()),
        ("--axes", !axes.is_empty()),
    ])?;
    let file = program::load(&arguments.file, &arguments.program)?;
    let survey = program::survey(&file, |_| Ok(()))?;
    let wanted =
        Wanted { vcd: arguments.vcd.clone(), csv: arguments.csv.clone(), ..Wanted::default() };
    let done = program_run::run(&file, &survey, (arguments.core, arguments.level), &wanted)?;
    if arguments.json {
        output::print_json(&done)?;
    } else {
        output::print(&done.to_string())?;
    }
    done.verdict()
}
