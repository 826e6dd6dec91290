//! The proof of the bank of several latches, for builds with two, three and four.

use super::builds::engine_with_latches;
use super::{Bug, Case, Promises, Proof};

const BUGS: &[Bug] = &[
    // A record is taken although latch 1 holds it.
    Bug {
        breaks: "promise_15_takes_no_held_record",
        text: "taken = taken | (ONE_RECORD << held_1);",
        becomes: "taken = taken;",
    },
    // The search ends at a record that may be held.
    Bug {
        breaks: "promise_15_takes_no_held_record",
        text: "free = THREE;",
        becomes: "free = TWO;",
    },
    // Latch 2 takes another record than the one to which the words of its tick belong.
    Bug {
        breaks: "promise_15_one_strobe_one_record",
        text: "held_2 <= free;",
        becomes: "held_2 <= TWO;",
    },
    // All latches take the record of one that has accepted its edge, also at other strobes.
    Bug {
        breaks: "promise_15_kept_until_armed",
        text: "if (first_comes) begin",
        becomes: "if (accepts) begin",
    },
    Bug {
        breaks: "promise_15_record_of_its_tick",
        text: "if (accepts) begin",
        becomes: "if (strobe) begin",
    },
    Bug {
        breaks: "promise_13_reset_forgets",
        text: "held_3 <= ZERO;",
        becomes: "held_3 <= THREE;",
    },
    Bug { breaks: "promise_13_inactive", text: "now = 2'd0;", becomes: "now = 2'd1;" },
];

pub(super) fn proof() -> Proof {
    let case = |count: usize| Case {
        name: format!("{count} latches"),
        dut: "carrystep_latch_bank".into(),
        parameters: Vec::new(),
        verilog: engine_with_latches(count).1,
        numbers: vec![("COUNT", count.to_string())],
    };
    Proof {
        module: "latch_bank",
        promises: Promises {
            text: include_str!("../../../crates/hdl/src/engine/latch_bank/promises.sv"),
        },
        cases: [4, 2, 3].map(case).into(),
        depth: 1,
        reach: 40,
        bugs: BUGS,
    }
}
