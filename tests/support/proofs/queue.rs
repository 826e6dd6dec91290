//! The proof of the queue: which segment runs and which segments wait.

use super::builds::BuiltEngine;
use super::{Bug, Case, Promises, Proof};

const BUGS: &[Bug] = &[
    Bug {
        breaks: "promise_5_halted_runs_nothing",
        text: "(word[10] | starts) & !halted",
        becomes: "(word[10] | starts)",
    },
    Bug {
        breaks: "promise_6_in_order",
        text: "next_newest = fresh_now;",
        becomes: "next_newest = newest;",
    },
    Bug {
        breaks: "promise_6_in_order",
        text: "if (empties) begin",
        becomes: "if (empties & starts) begin",
    },
    Bug { breaks: "promise_6_room", text: "(live_now + ~newest)", becomes: "(live_now - newest)" },
    Bug {
        breaks: "promise_6_empty",
        text: "none = newest == live_now",
        becomes: "none = newest == old_live",
    },
    Bug { breaks: "promise_6_full", text: "full = spare == 5'd0", becomes: "full = spare == 5'd7" },
    Bug {
        breaks: "promise_6_words_in_order",
        text: "next_due = due + ONE",
        becomes: "next_due = due",
    },
    Bug {
        breaks: "promise_6_misplaced_is_taken",
        text: "wrong <= takes_word & !fits_in",
        becomes: "wrong <= !fits_in",
    },
    Bug { breaks: "promise_6_runs_as_told", text: "(word[11] | least)", becomes: "word[11]" },
    Bug {
        breaks: "promise_6_the_next_begins",
        text: "steps_on = moves & follows;",
        becomes: "steps_on = follows;",
    },
    Bug { breaks: "promise_6_goes_on", text: "over = ended & last_one;", becomes: "over = ended;" },
    Bug { breaks: "promise_10_dry_is_told", text: "& none & !ramp;", becomes: "& none;" },
    Bug {
        breaks: "promise_10_dry_is_told",
        text: "lasts_write_data = SET;",
        becomes: "lasts_write_data = UNSET;",
    },
    Bug {
        breaks: "promise_10_ramp_as_defined",
        text: "next_known = KNOWN_BIT;",
        becomes: "next_known = NO;",
    },
    Bug {
        breaks: "promise_12_only_its_own_time_slot",
        text: "if (beat[12]) begin",
        becomes: "if (beat[11]) begin",
    },
    Bug {
        breaks: "promise_12_no_word_used_that_was_written",
        text: "if (beat[12]) begin",
        becomes: "if (beat[11]) begin",
    },
    Bug {
        breaks: "promise_18_refused_unless_kept",
        text: "| (is_live & stays & !follows)",
        becomes: "| (is_live & stays)",
    },
    Bug {
        breaks: "promise_18_refused_unless_kept",
        text: "(span & BEYOND) == 6'd0",
        becomes: "1'b1",
    },
    Bug {
        breaks: "promise_18_drops_from_the_end",
        text: "(!keeps | (next_due != 3'd0))",
        becomes: "(next_due != 3'd0)",
    },
    Bug {
        breaks: "promise_18_room_behind_the_named",
        text: "newest = target;",
        becomes: "newest = newest;",
    },
    Bug { breaks: "promise_15_counts_are_kept", text: "<< AT_18)", becomes: "<< AT_14)" },
    Bug {
        breaks: "promise_15_met_in_the_tick_before",
        text: "next_met = MET_BIT;",
        becomes: "next_met = NO;",
    },
];

pub(super) fn proof(built: &BuiltEngine) -> Proof {
    let case = Case {
        name: "any".into(),
        dut: "carrystep_queue".into(),
        parameters: vec![("CUTS", 1)],
        verilog: built.1.clone(),
        numbers: Vec::new(),
    };
    Proof {
        module: "queue",
        promises: Promises {
            text: include_str!("../../../crates/hdl/src/engine/queue/promises.sv"),
        },
        cases: vec![case],
        depth: 1,
        reach: 260,
        bugs: BUGS,
    }
}
