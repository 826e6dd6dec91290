//! The proof of the tick module.

use super::builds::{beat, beat_name, shipped, small};
use super::{Bug, Case, Promises, Proof};
use carrystep_core::Build;

const BUGS: &[Bug] = &[
    Bug {
        breaks: "promise_11_strobe_ends_the_tick",
        text: "sub_over & phase_over",
        becomes: "phase_over",
    },
    Bug {
        breaks: "promise_11_phases_are_equal",
        text: "phases <= FIRST_PHASE;",
        becomes: "phases <= ONE_PHASE;",
    },
    Bug { breaks: "promise_11_phase_start", text: "sub <= ZERO;", becomes: "sub <= ONE;" },
    Bug { breaks: "promise_13_inactive", text: "phases = 4'd0;", becomes: "phases = 4'd1;" },
];

pub(super) fn proof() -> Proof {
    let builds = [small(4), small(16), small(1), shipped()];
    let case = |(build, verilog): (Build, _)| Case {
        name: beat_name(&build.timebase),
        dut: "carrystep_tick".into(),
        parameters: Vec::new(),
        verilog,
        numbers: beat(&build.timebase),
    };
    Proof {
        module: "tick",
        promises: Promises { text: include_str!("../../../crates/hdl/src/parts/tick/promises.sv") },
        cases: builds.into_iter().map(case).collect(),
        depth: 1,
        reach: 40,
        bugs: BUGS,
    }
}
