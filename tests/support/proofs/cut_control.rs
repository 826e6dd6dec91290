//! The proof of the cut's stages: all axes execute it, or none.

use super::builds::BuiltEngine;
use super::{Bug, Case, Promises, Proof};

const BUGS: &[Bug] = &[
    Bug {
        breaks: "promise_18_all_or_none",
        text: "denied <= missed;",
        becomes: "denied <= misses;",
    },
    Bug {
        breaks: "promise_18_only_after_a_request",
        text: "checking <= asked;",
        becomes: "checking <= asked | closing;",
    },
    Bug {
        breaks: "promise_18_one_tick",
        text: "cuts = closing & !denied;",
        becomes: "cuts = closing & !denied & !beat[12];",
    },
    Bug {
        breaks: "promise_18_refused_is_told",
        text: "refused = denied |",
        becomes: "refused = missed |",
    },
    Bug {
        breaks: "promise_13_reset_forgets",
        text: "if (resetting) begin",
        becomes: "if (resetting & beat[12]) begin",
    },
    Bug { breaks: "promise_13_inactive", text: "denied = 1'b0;", becomes: "denied = 1'b1;" },
];

pub(super) fn proof(built: &BuiltEngine) -> Proof {
    let case = Case {
        name: "any".into(),
        dut: "carrystep_cut_control".into(),
        parameters: vec![("CUTS", 1)],
        verilog: built.1.clone(),
        numbers: Vec::new(),
    };
    Proof {
        module: "cut_control",
        promises: Promises {
            text: include_str!("../../../crates/hdl/src/engine/cut_control/promises.sv"),
        },
        cases: vec![case],
        depth: 1,
        reach: 30,
        bugs: BUGS,
    }
}
