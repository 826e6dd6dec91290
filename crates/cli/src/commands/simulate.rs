//! `carrystep simulate`: plans, simulates and checks a move file, and writes waveform, CSV and
//! plot.

use crate::arguments::Simulate;
use crate::failure::Failure;
use crate::wanted::{Part, Wanted};
use crate::{job, output, program, program_run, recorded};
use carrystep_program::is_program;

/// Plans and simulates a move file or a program.
pub fn run(arguments: &Simulate) -> Result<(), Failure> {
    if is_program(&arguments.file) {
        return run_program(arguments);
    }
    arguments.program.refuse_for_moves()?;
    let source = job::load(&arguments.file, arguments.fit_ns)?;
    let detail = recorded::detail(arguments.report.is_some());
    let (survey, recorded) = job::recorded(source, detail, |_| Ok(()))?;
    let wanted = Wanted {
        vcd: arguments.vcd.clone(),
        fst: arguments.fst.clone(),
        save: arguments.save.clone(),
        csv: arguments.csv.clone(),
        plot: arguments.plot.clone(),
        report: arguments.report.clone(),
        part: Part { from: arguments.from, to: arguments.to, axes: arguments.axes.clone() },
    };
    let done = job::run((&survey, &recorded), arguments.core, arguments.level, &wanted)?;
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
    let detail = recorded::detail(arguments.report.is_some());
    let wanted = Wanted {
        vcd: arguments.vcd.clone(),
        csv: arguments.csv.clone(),
        report: arguments.report.clone(),
        ..Wanted::default()
    };
    let on = (arguments.core, arguments.level);
    let done = program_run::run(&file, detail, on, &wanted)?;
    if arguments.json {
        output::print_json(&done)?;
    } else {
        output::print(&done.to_string())?;
    }
    done.verdict()
}
