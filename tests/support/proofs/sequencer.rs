//! The proof of the sequencer.

use super::builds::shipped;
use super::{Bug, Case, Promises, Proof};

const BUGS: &[Bug] = &[
    Bug {
        breaks: "promise_6_ready_is_empty",
        text: "if (clear) begin\n            wait_full <= 1'b0;",
        becomes: "if (clear) begin",
    },
    Bug {
        breaks: "promise_6_loaded_as_pushed",
        text: "wait_v <= seg_v;",
        becomes: "wait_v <= seg_a;",
    },
    Bug {
        breaks: "promise_6_runs_its_ticks",
        text: "left <= wait_ticks;",
        becomes: "left <= wait_ticks + ONE;",
    },
    Bug {
        breaks: "promise_6_joins_without_a_gap",
        text: "((ending & !last) | (startable & go))",
        becomes: "(startable & go)",
    },
    Bug {
        breaks: "promise_6_starts_when_told",
        text: "(startable & go))",
        becomes: "(startable & go & !active))",
    },
    Bug { breaks: "promise_6_never_in_between", text: "(startable & go))", becomes: "go)" },
    Bug { breaks: "promise_6_startable", text: "(ending & last))", becomes: "ending)" },
    Bug { breaks: "promise_6_dry_is_told", text: "dry | (ending & !last)", becomes: "dry" },
    Bug { breaks: "promise_6_dry_is_dry", text: "dry | (ending & !last)", becomes: "dry | ending" },
];

pub(super) fn proof() -> Proof {
    let case = Case {
        name: "any".into(),
        dut: "carrystep_sequencer".into(),
        parameters: Vec::new(),
        verilog: shipped().1,
        numbers: Vec::new(),
    };
    Proof {
        module: "sequencer",
        promises: Promises {
            text: include_str!("../../../crates/hdl/src/parallel/sequencer/promises.sv"),
        },
        cases: vec![case],
        depth: 1,
        reach: 10,
        bugs: BUGS,
    }
}
