//! The list of the documents that `--json` prints. It stands above the commands whose documents it
//! names.
//!
//! To add a document, add one line to [`documents!`] below and derive `JsonSchema` for its types;
//! `cargo xtask generate` rewrites `docs/schemas/`. A new field leaves the version unchanged. A
//! field that is removed or changes its meaning increments it.

use crate::commands::{
    boards, build, check, check_program, doctor, home, linuxcnc, list_blocks, machine, offset,
    plan, plan_program, profile, selftest, sweep, table, verilog,
};
use crate::document::Document;
use crate::{drive, ending, found, job, pause, program_run};

#[cfg(test)]
mod schemas;

macro_rules! documents {
    ($($(#[$only:meta])* $name:literal, $version:literal: $document:ty;)*) => {
        $($(#[$only])* impl Document for $document {
            const NAME: &'static str = $name;
            const VERSION: u32 = $version;
        })*

        /// Name and JSON Schema of every document.
        #[cfg(test)]
        fn all() -> Vec<(&'static str, schemars::Schema)> {
            vec![$($(#[$only])* ($name, schemas::schema::<$document>()),)*]
        }
    };
}

documents! {
    "boards", 1: boards::ShownBoards<'_>;
    "build", 1: build::BuildReport;
    "check", 1: check::Checked<'_>;
    "check-program", 1: check_program::CheckedProgram<'_>;
    "doctor", 1: doctor::Examined;
    "drive", 1: drive::Driven;
    "failure", 1: ending::FailedRun;
    "home", 1: home::HomeReport;
    "linuxcnc", 1: linuxcnc::WrittenForLinuxcnc;
    "machine-new", 1: machine::WrittenMachine<'_>;
    "offset", 1: offset::ShownOffsets;
    "pause", 1: pause::PauseResult;
    "plan", 1: plan::Planned<'_>;
    "plan-block", 1: list_blocks::ListedBlock<'_>;
    "plan-end", 1: plan::PlanEnd;
    "plan-move", 1: plan::PlannedLine<'_>;
    "plan-program", 1: plan_program::PlannedProgram;
    "plan-row", 1: plan_program::PlannedRow<'_>;
    "probe", 1: drive::Probed;
    "profile", 1: profile::Profiles<'_>;
    "selftest", 1: selftest::SelftestReport;
    "simulate", 1: job::RunResult;
    "simulate-program", 1: program_run::ProgramResult;
    "status", 1: found::FoundBoard;
    "sweep", 1: carrystep_sweep::SweepReport;
    "sweep-files", 1: sweep::WrittenForCluster<'_>;
    "table", 1: table::Tabled<'_>;
    "verilog", 1: verilog::WrittenVerilog;
    "verilog-board", 1: verilog::WrittenForBoard<'_>;
    #[cfg(unix)]
    "virtual-board", 1: crate::commands::virtual_board::Served;
}
