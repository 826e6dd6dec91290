//! The proof of the readout: the words of state, and snapshots.

use super::builds::BuiltEngine;
use super::{Bug, Case, Promises, Proof};

const BUGS: &[Bug] = &[
    Bug {
        breaks: "promise_15_one_page_in_a_tick",
        text: "page = NO_PAGE;",
        becomes: "page = LIVE_PAGE;",
    },
    Bug {
        breaks: "promise_15_one_page_in_a_tick",
        text: "if (strobe) begin",
        becomes: "if (strobe | beat[12]) begin",
    },
    Bug {
        breaks: "promise_15_a_snapshot_is_of_all_axes",
        text: "takes <= asked & !found;",
        becomes: "takes <= asked;",
    },
    Bug {
        breaks: "promise_15_one_page_in_a_tick",
        text: "asked <= asked & found;",
        becomes: "asked <= 1'b0;",
    },
    Bug { breaks: "promise_15_each_word_once", text: "(ticks_left & !met)", becomes: "ticks_left" },
    Bug { breaks: "promise_15_items", text: "(ticks_left & running)", becomes: "ticks_left" },
    Bug {
        breaks: "promise_15_words_as_the_memory_has_them",
        text: "low = word[15:0];",
        becomes: "low = status;",
    },
    Bug { breaks: "promise_15_status", text: "waiting = ~room;", becomes: "waiting = room;" },
    Bug {
        breaks: "promise_15_refreshed",
        text: "beat[12] & is_last & !takes",
        becomes: "beat[12] & is_last",
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
