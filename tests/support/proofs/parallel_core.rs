//! The proof of the whole exported parallel core.

use super::builds::{beat_name, shipped, small};
use super::{Bug, Case, Promises, Proof};
use crate::lockstep;
use carrystep_core::{AXES, StartPhase};
use carrystep_verilog::{parallel_name, parallel_verilog};
use std::sync::Arc;

const BUGS: &[Bug] = &[
    Bug {
        breaks: "promise_12_any_fault_stops_all",
        text: "frozen = broken;",
        becomes: "frozen = 1'b0;",
    },
    Bug {
        breaks: "promise_5_stays_frozen",
        text: "if (clear_now) begin",
        becomes: "if (frozen) begin",
    },
    Bug {
        breaks: "promise_6_ready",
        text: "(selected[2] & axis_2_waiting)",
        becomes: "(selected[2] & axis_1_waiting)",
    },
    Bug {
        breaks: "promise_6_taken_by_its_axis",
        text: "(push & selected[2])",
        becomes: "(push & selected[1])",
    },
    Bug { breaks: "promise_6_broken_is_told", text: "(taken & !push) | ", becomes: "" },
    Bug { breaks: "promise_6_start_ready", text: "!(frozen | armed)", becomes: "!frozen" },
    Bug {
        breaks: "promise_6_no_start_is_missed",
        text: "armed & tick_strobe & ",
        becomes: "armed & ",
    },
    Bug { breaks: "promise_8_idle", text: "at_rest = !armed;", becomes: "at_rest = 1'b1;" },
    Bug { breaks: "promise_12_go_is_the_start", text: ".go(go & mask[1])", becomes: ".go(go)" },
    Bug { breaks: "promise_13_inactive", text: "broken = 1'b0;", becomes: "broken = 1'b1;" },
];

pub(super) fn proof() -> Proof {
    let case = |axes: usize, beat: String, verilog: Arc<str>| Case {
        name: format!("{axes} axes, {beat}"),
        dut: parallel_name(axes),
        parameters: Vec::new(),
        verilog,
        numbers: vec![("AXES", axes.to_string())],
    };
    // One axis is not proved: there, yosys makes one wire of a signal of all axes and of a promise
    // about it alone, and `connect` then takes the driver from both.
    let fewer = |axes: usize| {
        let build = lockstep::tight_build(4, StartPhase::Half);
        let verilog = parallel_verilog(&build, axes, "a proof").expect("the core");
        case(axes, beat_name(&build.timebase), verilog.into())
    };
    let all = [small(16), shipped()];
    let all = all.into_iter().map(|(build, text)| case(AXES, beat_name(&build.timebase), text));
    Proof {
        module: "core",
        promises: Promises {
            text: include_str!("../../../crates/hdl/src/parallel/core/promises.sv"),
        },
        // Covers and bugs use the first case. Yosys converts it in half of the time of the others.
        cases: [fewer(3)].into_iter().chain(all).collect(),
        depth: 1,
        reach: 20,
        bugs: BUGS,
    }
}
