//! The proof of the engine's adder. A time slot is proved as a whole, so the induction is as deep
//! as a time slot has clocks.

use super::builds::BuiltEngine;
use super::{Bug, Case, Promises, Proof};

const BUGS: &[Bug] = &[
    Bug {
        breaks: "promise_6_a_plus_j",
        text: "(beat[8] | beat[9] | beat[10])",
        becomes: "(beat[9] | beat[10])",
    },
    Bug {
        breaks: "promise_6_v_plus_a",
        text: "(beat[8] | beat[9] | beat[10])",
        becomes: "(beat[8] | beat[10])",
    },
    Bug {
        breaks: "promise_6_p_plus_v",
        text: "beat[8] | beat[10] | beat[13]) begin\n            a <= word;",
        becomes: "beat[8] | beat[13]) begin\n            a <= word;",
    },
    Bug { breaks: "promise_6_wiped", text: "(beat[5] | beat[11])", becomes: "beat[5]" },
    Bug {
        breaks: "promise_6_carry_is_a_step",
        text: "top <= wide[33];",
        becomes: "top <= wide[33] ^ b[31];",
    },
    Bug { breaks: "promise_6_overspeed", text: "r[31] ^ top ^ sign_of_a", becomes: "r[31] ^ top" },
    Bug {
        breaks: "promise_6_least",
        text: "bound <= low_zero & empty & b[31];",
        becomes: "bound <= empty & b[31];",
    },
    Bug { breaks: "promise_6_ticks_and_discarded", text: "(beat[5] & lost)", becomes: "1'b0" },
    Bug {
        breaks: "promise_6_over_after_the_last_tick",
        text: "if (beat[7]) begin\n            over",
        becomes: "if (beat[8]) begin\n            over",
    },
    Bug { breaks: "promise_7_position", text: "(beat[6] & !up)", becomes: "(beat[6] & down)" },
    Bug {
        breaks: "promise_10_ramp_turns_where_the_sign_does",
        text: "other <= r[31] ^ b[31];",
        becomes: "other <= top;",
    },
    Bug {
        breaks: "promise_11_sign",
        text: "zero <= low_zero & empty & !b[31];",
        becomes: "zero <= empty & !b[31];",
    },
    Bug { breaks: "promise_11_phase_stays", text: "bisects | beat[16]", becomes: "1'b1" },
    Bug { breaks: "promise_13_inactive", text: "bits = 4'd0;", becomes: "bits = 4'd1;" },
    Bug {
        breaks: "promise_15_tick_is_counted",
        text: "adds_tick = beat[15] & !beat[2];",
        becomes: "adds_tick = beat[15] & beat[2];",
    },
    Bug {
        breaks: "promise_15_tick_is_counted",
        text: "carry_due = adds_tick | (",
        becomes: "carry_due = (",
    },
    Bug { breaks: "promise_15_tick_is_counted", text: " | beat[13]) begin", becomes: ") begin" },
    Bug {
        breaks: "promise_6_ticks_and_discarded",
        text: "(forgets & beat[6])",
        becomes: "(forgets & beat[5])",
    },
];

pub(super) fn proof(built: &BuiltEngine) -> Proof {
    let case = Case {
        name: "any".into(),
        dut: "carrystep_adder".into(),
        parameters: Vec::new(),
        verilog: built.1.clone(),
        numbers: Vec::new(),
    };
    Proof {
        module: "adder",
        promises: Promises {
            text: include_str!("../../../crates/hdl/src/engine/adder/promises.sv"),
        },
        cases: vec![case],
        depth: 13,
        reach: 20,
        bugs: BUGS,
    }
}
