//! What each long run depends on, so that a change makes those runs again that it can break.

use crate::shell;

/// A run, and the beginnings of the paths that it depends on.
type Inputs = (&'static str, &'static [&'static str]);

/// What every run depends on.
const ALL: [&str; 3] = ["Cargo.toml", "Cargo.lock", "crates/xtask/src/long"];

/// The engine, its model, and the levels that both run at.
const LOCKSTEP: &[&str] = &[
    "crates/core/",
    "crates/model/",
    "crates/hdl/",
    "crates/verilog/",
    "crates/simulators/",
    "hdl-out/core/",
    "tests/rung_4_model_equals_rust_hdl/",
    "tests/rung_5_model_equals_verilog/",
    "tests/support/engine_builds.rs",
    "tests/support/engine_programs.rs",
    "tests/support/effort.rs",
];

/// A board of models, and what talks with it.
const BOARD: &[&str] =
    &["crates/core/", "crates/model/", "crates/link/", "crates/plan/", "crates/virtual-board/"];

/// The command that runs a program on a board of models.
const RUN: &[&str] = &[
    "crates/cli/",
    "crates/core/",
    "crates/files/",
    "crates/gcode/",
    "crates/grbl/",
    "crates/job/",
    "crates/link/",
    "crates/model/",
    "crates/plan/",
    "crates/program/",
    "crates/runner/",
    "crates/virtual-board/",
];

/// What is synthesised, and by which tools.
const GATEWARE: &[&str] = &[
    "crates/core/",
    "crates/boards/",
    "crates/files/",
    "crates/hdl/",
    "crates/verilog/",
    "crates/tools/",
    "hdl-out/",
    "sim/six-axis.toml",
];

/// The inputs of each run.
pub const INPUTS: &[Inputs] = &[
    ("lockstep", LOCKSTEP),
    ("rust-hdl", LOCKSTEP),
    ("adders", LOCKSTEP),
    (
        "repeats",
        &[
            "crates/core/",
            "crates/model/",
            "crates/hdl/",
            "crates/verilog/",
            "crates/simulators/",
            "hdl-out/core/",
            "tests/golden/",
            "tests/rung_3_fast_model_equals_model/",
            "tests/rung_4_model_equals_rust_hdl/",
            "tests/rung_5_model_equals_verilog/",
            "tests/support/repeats.rs",
            "crates/link/",
            "crates/virtual-board/",
        ],
    ),
    (
        "cases",
        &[
            "crates/cli/",
            "crates/core/",
            "crates/files/",
            "crates/gcode/",
            "crates/job/",
            "crates/link/",
            "crates/model/",
            "crates/plan/",
            "crates/profile/",
            "crates/program/",
            "crates/runner/",
            "crates/table/",
            "crates/virtual-board/",
            "tests/rung_1_plan_stays_with_the_profile/",
            "tests/rung_3_fast_model_equals_model/",
            "tests/support/repeats.rs",
        ],
    ),
    (
        "proofs",
        &[
            "crates/core/",
            "crates/hdl/",
            "crates/verilog/",
            "hdl-out/core/",
            "docs/promises.md",
            "tests/support/proofs",
            "tests/rung_7_promises_are_proved/",
        ],
    ),
    (
        "mutants",
        &[
            "crates/core/",
            "crates/model/",
            "crates/hdl/",
            "crates/verilog/",
            "crates/simulators/",
            "hdl-out/core/",
            "docs/mutants.md",
            "tests/support/engine_builds.rs",
            "tests/support/engine_programs.rs",
            "tests/support/mutants",
            "tests/support/programs.rs",
            "tests/support/proofs",
            "tests/rung_8_mutants_are_caught/",
        ],
    ),
    ("bad-line", BOARD),
    ("garbage", BOARD),
    ("dead-host", BOARD),
    (
        "verilog-board",
        &[
            "crates/core/",
            "crates/hdl/",
            "crates/verilog/",
            "crates/simulators/",
            "crates/link/",
            "crates/plan/",
            "crates/virtual-board/",
        ],
    ),
    ("resources", GATEWARE),
    ("boards", GATEWARE),
    (
        "equivalence",
        &[
            "crates/core/",
            "crates/hdl/",
            "crates/verilog/",
            "crates/tools/",
            "crates/simulators/",
            "hdl-out/",
            "tests/system/a_board_is_its_verilog",
            "tests/support/board_session.rs",
        ],
    ),
    (
        "spartans",
        &[
            "crates/core/",
            "crates/boards/",
            "crates/hdl/",
            "crates/verilog/",
            "crates/tools/",
            "hdl-out/",
            "tests/system/spartans_without_their_vendor/",
        ],
    ),
    (
        "timing",
        &[
            "crates/core/",
            "crates/boards/",
            "crates/model/",
            "crates/hdl/",
            "crates/verilog/",
            "crates/tools/",
            "crates/simulators/",
            "hdl-out/",
            "tests/support/board_session.rs",
            "tests/system/a_board_keeps_its_timing/",
        ],
    ),
    (
        "self-test",
        &[
            "crates/core/",
            "crates/boards/",
            "crates/model/",
            "crates/hdl/",
            "crates/verilog/",
            "crates/tools/",
            "crates/simulators/",
            "docs/self-test.md",
            "tests/support/self_test_bench.rs",
            "tests/support/self_test_board.rs",
            "tests/system/a_self_test_shows_every_pin/",
        ],
    ),
    (
        "gowin",
        &[
            "crates/core/",
            "crates/boards/",
            "crates/model/",
            "crates/hdl/",
            "crates/verilog/",
            "crates/tools/",
            "crates/simulators/",
            "hdl-out/core/",
            "hdl-out/tang-nano-20k/",
            "hdl-out/tang-nano-9k/",
            "tests/support/board_session.rs",
            "tests/support/self_test_bench.rs",
            "tests/support/self_test_board.rs",
            "tests/system/a_board_is_its_verilog/",
            "tests/system/a_self_test_shows_every_pin/",
        ],
    ),
    (
        "holds",
        &[
            "crates/core/",
            "crates/files/",
            "crates/gcode/",
            "crates/job/",
            "crates/plan/",
            "crates/program/",
            "crates/runner/",
            "sim/jobs/",
        ],
    ),
    ("kills", RUN),
    (
        "programs",
        &[
            "crates/core/",
            "crates/files/",
            "crates/gcode/",
            "crates/job/",
            "crates/link/",
            "crates/model/",
            "crates/plan/",
            "crates/program/",
            "crates/runner/",
            "crates/simulators/",
            "crates/virtual-board/",
            "sim/",
        ],
    ),
    (
        "hours",
        &[
            "crates/core/",
            "crates/gcode/",
            "crates/job/",
            "crates/link/",
            "crates/model/",
            "crates/program/",
            "crates/runner/",
            "crates/virtual-board/",
        ],
    ),
    (
        "linuxcnc",
        &[
            "crates/core/",
            "crates/model/",
            "crates/link/",
            "crates/linuxcnc/",
            "crates/simulators/",
            "crates/virtual-board/",
            "hdl-out/core/",
            "sim/jobs/square_and_arc.ngc",
        ],
    ),
    (
        "senders",
        &[
            "crates/cli/src/serve",
            "crates/cli/tests/command_line/real_senders",
            "crates/core/",
            "crates/gcode/",
            "crates/grbl/",
            "crates/job/",
            "crates/link/",
            "crates/model/",
            "crates/program/",
            "crates/runner/",
            "crates/virtual-board/",
            "sim/jobs/",
        ],
    ),
    (
        "container",
        &[
            ".dockerignore",
            "crates/cli/src/serve",
            "crates/cli/tests/command_line/container.rs",
            "sim/container/",
            "sim/jobs/machine.toml",
        ],
    ),
    ("soak", RUN),
];

/// The runs that a change since a commit can break. All, where git does not know the commit: a
/// branch that is new on a server has none before it.
///
/// # Errors
/// git cannot compare.
pub fn touched(base: &str) -> Result<Vec<String>, String> {
    let commit = format!("{base}^{{commit}}");
    if shell::read("git", &["rev-parse", "--quiet", "--verify", &commit]).is_err() {
        shell::say(&format!("no commit {base}: all runs are made"));
        return Ok(INPUTS.iter().map(|(name, _)| (*name).to_owned()).collect());
    }
    let changed = shell::read("git", &["diff", "--name-only", &format!("{base}...HEAD")])?;
    Ok(runs_of(&changed.lines().collect::<Vec<_>>()))
}

fn runs_of(changed: &[&str]) -> Vec<String> {
    let depends = |inputs: &[&str]| {
        let mut all = ALL.iter().chain(inputs);
        all.any(|input| changed.iter().any(|path| path.starts_with(input)))
    };
    INPUTS
        .iter()
        .filter(|(_, inputs)| depends(inputs))
        .map(|(name, _)| (*name).to_owned())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::{ALL, INPUTS, runs_of};
    use crate::shell;

    #[test]
    fn a_change_makes_the_runs_that_it_can_break() {
        assert!(runs_of(&["README.md", "crates/report/src/lib.rs"]).is_empty());
        assert_eq!(
            runs_of(&["crates/link/src/lib.rs"]),
            [
                "repeats",
                "cases",
                "bad-line",
                "garbage",
                "dead-host",
                "verilog-board",
                "kills",
                "programs",
                "hours",
                "linuxcnc",
                "senders",
                "soak"
            ]
        );
        assert_eq!(runs_of(&["README.md", "docs/mutants.md"]), ["mutants"]);
        assert_eq!(runs_of(&["Cargo.lock"]).len(), INPUTS.len());
    }

    /// A path that is renamed would take its runs away in silence.
    #[test]
    fn every_input_is_there() {
        for input in ALL.iter().chain(INPUTS.iter().flat_map(|(_, inputs)| *inputs)) {
            assert!(shell::root().join(input).exists(), "{input}");
        }
    }

    #[test]
    fn every_run_has_inputs() {
        let names: Vec<&str> = INPUTS.iter().map(|(name, _)| *name).collect();
        let runs: Vec<&str> = crate::long::RUNS.iter().map(|run| run.name).collect();
        assert_eq!(names, runs);
    }
}
