//! The proof of the readout: the words of state, and snapshots.

use super::builds::BuiltEngine;
use super::{Bug, Case, Promises, Proof};

const BUGS: &[Bug] = &[
    Bug {
        breaks: "promise_15_one_page_in_a_tick",
        text: "page = HIT_PAGE;",
        becomes: "page = LIVE_PAGE;",
    },
    Bug {
        breaks: "promise_15_a_snapshot_is_of_all_axes",
        text: "if (strobe) begin\n            takes",
        becomes: "if (strobe | beat[12]) begin\n            takes",
    },
    Bug {
        breaks: "promise_15_one_page_in_a_tick",
        text: "takes <= asked & !taken;",
        becomes: "takes <= asked;",
    },
    Bug {
        breaks: "promise_15_one_page_in_a_tick",
        text: "asked <= asked & taken;",
        becomes: "asked <= 1'b0;",
    },
    Bug {
        breaks: "promise_15_each_word_once",
        text: "(ticks_left & (!captured | latches))",
        becomes: "ticks_left",
    },
    Bug { breaks: "promise_15_items", text: "(ticks_left & running)", becomes: "ticks_left" },
    Bug {
        breaks: "promise_15_words_as_the_memory_has_them",
        text: "low = word[15:0];",
        becomes: "low = status;",
    },
    Bug {
        breaks: "promise_15_switches",
        text: "levels = STATE_BIT;",
        becomes: "levels = LEVEL_BIT;",
    },
    Bug {
        breaks: "promise_15_a_hit_waits_for_the_latch",
        text: "(met & latches)",
        becomes: "(met & takes)",
    },
    Bug {
        breaks: "promise_15_status",
        text: "waiting = ~room & SLOTS;",
        becomes: "waiting = room & SLOTS;",
    },
    Bug {
        breaks: "promise_15_refreshed",
        text: "beat[12] & is_last & !takes &",
        becomes: "beat[12] & is_last &",
    },
    Bug { breaks: "promise_13_inactive", text: "takes = 1'b0;", becomes: "takes = 1'b1;" },
];

pub(super) fn proof(built: &BuiltEngine) -> Proof {
    let case = Case {
        name: "any".into(),
        dut: "carrystep_readout".into(),
        parameters: Vec::new(),
        verilog: built.1.clone(),
        numbers: Vec::new(),
    };
    Proof {
        module: "readout",
        promises: Promises {
            text: include_str!("../../../crates/hdl/src/engine/readout/promises.sv"),
        },
        cases: vec![case],
        depth: 1,
        reach: 24,
        bugs: BUGS,
    }
}
