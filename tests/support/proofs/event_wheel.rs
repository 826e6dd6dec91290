//! The proof of the event wheel, with the time slots that fill it.

use super::builds::{BuiltEngine, axes, beat, beat_name, small_engine};
use super::{Bug, Case, Promises, Proof};
use carrystep_core::engine::{EngineBuild, LimitWiring};

const BUGS: &[Bug] = &[
    Bug {
        breaks: "promise_6_each_carry_once",
        text: "step_due <= crosses;",
        becomes: "step_due <= crosses & has_sign;",
    },
    Bug {
        breaks: "promise_11_at_its_phase",
        text: "when <= read[6:5] + ONE_TICK;",
        becomes: "when <= read[6:5];",
    },
    Bug {
        breaks: "promise_11_sign_before_its_tick",
        text: "SIGN_KIND | LAST_PHASE;",
        becomes: "SIGN_KIND;",
    },
    Bug { breaks: "promise_11_direction", text: "data = FORWARD;", becomes: "data = ALL;" },
    Bug {
        breaks: "promise_11_one_beat",
        text: "turned <= tick_strobe;",
        becomes: "turned <= tick_phase_start;",
    },
    Bug {
        breaks: "promise_12_of_its_own_axis",
        text: "!sign_due & step_due & step_known",
        becomes: "!sign_due & step_known",
    },
    Bug {
        breaks: "promise_12_no_word_used_that_was_written",
        text: "event_memory_write_address = read;",
        becomes: "event_memory_write_address = place;",
    },
    Bug { breaks: "promise_13_inactive", text: "turned = 1'b0;", becomes: "turned = 1'b1;" },
];

pub(super) fn proof(built: &BuiltEngine) -> Proof {
    let sizes = [(1, 16, 4), (2, 32, 16), (6, 96, 16)];
    let builds =
        sizes.map(|(axes, clocks, phases)| small_engine(axes, clocks, phases, LimitWiring::Pair));
    let case = |(build, verilog): (EngineBuild, _)| Case {
        name: format!("{} axes, {}", build.axes(), beat_name(&build.timebase)),
        dut: "carrystep_event_wheel".into(),
        parameters: Vec::new(),
        verilog,
        numbers: [vec![axes(&build)], beat(&build.timebase)].concat(),
    };
    Proof {
        module: "event_wheel",
        promises: Promises {
            text: include_str!("../../../crates/hdl/src/engine/event_wheel/promises.sv"),
        },
        cases: builds.into_iter().chain([built.clone()]).map(case).collect(),
        depth: 1,
        reach: 56,
        bugs: BUGS,
    }
}
