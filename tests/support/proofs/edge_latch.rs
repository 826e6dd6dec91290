//! The proof of the latch, with one look, with several, and for a build without it.

use super::builds::{BuiltEngine, engine_with_inputs, small_engine};
use super::{Bug, Case, Promises, Proof};
use carrystep_core::engine::{EngineBuild, LimitWiring};

const BUGS: &[Bug] = &[
    Bug {
        breaks: "promise_15_one_tick_for_one_edge",
        text: "copies <= rises & waits;",
        becomes: "copies <= rises;",
    },
    Bug {
        breaks: "promise_15_told_at_the_strobe",
        text: "comes = rises & waits;",
        becomes: "comes = waits;",
    },
    Bug {
        breaks: "promise_15_edges_are_counted",
        text: "further <= further + ONE;",
        becomes: "further <= further;",
    },
    Bug {
        breaks: "promise_15_armed_until_its_edge",
        text: "waits <= EXISTS != 1'b0;",
        becomes: "waits <= waits;",
    },
    Bug {
        breaks: "promise_13_reset_forgets",
        text: "if (resetting) begin",
        becomes: "if (resetting & !strobe) begin",
    },
    Bug { breaks: "promise_13_inactive", text: "waits = 1'b0;", becomes: "waits = 1'b1;" },
];

pub(super) fn proof(built: &BuiltEngine) -> Proof {
    let builds =
        [engine_with_inputs(6, 80, 4), small_engine(6, 80, 4, LimitWiring::Pair), built.clone()];
    let case = |(build, verilog): (EngineBuild, _)| {
        let latch = build.guard.latches.first();
        let looks = latch.map_or(0, |latch| latch.looks);
        let low = latch.is_some_and(|latch| latch.low);
        Case {
            name: format!("{looks} looks"),
            dut: "carrystep_edge_latch".into(),
            parameters: Vec::new(),
            verilog,
            numbers: vec![("LOOKS", looks.to_string()), ("LOW", u8::from(low).to_string())],
        }
    };
    Proof {
        module: "edge_latch",
        promises: Promises {
            text: include_str!("../../../crates/hdl/src/engine/edge_latch/promises.sv"),
        },
        cases: builds.map(case).into(),
        depth: 1,
        reach: 40,
        bugs: BUGS,
    }
}
