//! The proof of the reset: when it freezes the engine, and how long it lasts.

use super::builds::{BuiltEngine, small_engine};
use super::{Bug, Case, Promises, Proof};
use carrystep_core::engine::{EngineBuild, LimitWiring};

const BUGS: &[Bug] = &[
    Bug { breaks: "promise_5_reset_freezes", text: "asked <= 1'b1;", becomes: "asked <= settled;" },
    Bug {
        breaks: "promise_5_frozen_until_complete",
        text: "strobe & second & !reset",
        becomes: "strobe & first & !reset",
    },
    Bug { breaks: "promise_13_only_at_rest", text: "& !pins_busy", becomes: "" },
    Bug { breaks: "promise_13_stages", text: "first | (second & reset)", becomes: "first" },
    Bug {
        breaks: "promise_13_completes",
        text: "completes = over;",
        becomes: "completes = second;",
    },
    Bug { breaks: "promise_13_round", text: "asked & strobe & !first", becomes: "asked & !first" },
    Bug {
        breaks: "promise_13_complete_is_over",
        text: "asked <= 1'b0;",
        becomes: "asked <= settled;",
    },
    Bug { breaks: "promise_13_inactive", text: "asked = 1'b0;", becomes: "asked = 1'b1;" },
];

pub(super) fn proof(built: &BuiltEngine) -> Proof {
    let case = |(build, verilog): (EngineBuild, _)| Case {
        name: format!("{} axes at {} Hz", build.axes(), build.timebase.clock_hz()),
        dut: "carrystep_resets".into(),
        parameters: Vec::new(),
        verilog,
        numbers: Vec::new(),
    };
    Proof {
        module: "resets",
        promises: Promises {
            text: include_str!("../../../crates/hdl/src/engine/resets/promises.sv"),
        },
        cases: [small_engine(6, 80, 4, LimitWiring::Pair), built.clone()]
            .into_iter()
            .map(case)
            .collect(),
        depth: 1,
        reach: 12,
        bugs: BUGS,
    }
}
