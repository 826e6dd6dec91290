//! The proof of the whole exported engine with several adders.

use super::builds::{axes, beat, beat_name, causes, engine_on_adders, lanes};
use super::{Bug, Case, Promises, Proof};
use crate::repeats;

const BUGS: &[Bug] = &[
    Bug {
        breaks: "promise_5_every_axis_frozen",
        text: ") pulser_1 (\n        .clock(clock),\n        .frozen(stops_frozen),",
        becomes: ") pulser_1 (\n        .clock(clock),\n        .frozen(stops_ramp),",
    },
    Bug {
        breaks: "promise_6_taken_by_one_lane",
        text: ".take(take & is_own_1)",
        becomes: ".take(take)",
    },
    Bug {
        breaks: "promise_6_stored_in_the_memory_of_its_axis",
        text: ".put(taken[1])",
        becomes: ".put(taken[0])",
    },
    Bug {
        breaks: "promise_6_no_such_axis_is_told",
        text: "misplaced = misplaced | queue_1_misplaced;",
        becomes: "misplaced = misplaced;",
    },
    Bug {
        breaks: "promise_6_words_in_order",
        text: ".take(take & is_own_1),\n        .put_word(put_word)",
        becomes: ".take(take & is_own_1),\n        .put_word({1'b0, lane_slots_axis})",
    },
    Bug {
        breaks: "promise_6_something_to_start",
        text: "some_unfed = some_unfed | (masked_1 & queue_1_empty);",
        becomes: "some_unfed = some_unfed;",
    },
    Bug {
        breaks: "promise_7_counts_of_its_own_pulser",
        text: ".pulses(lane_counts_1_counts[2:0])",
        becomes: ".pulses(lane_counts_0_counts[2:0])",
    },
    Bug {
        breaks: "promise_8_idle_is_empty",
        text: "some_active = some_active | queue_1_running | !queue_1_empty;",
        becomes: "some_active = some_active;",
    },
    Bug {
        breaks: "promise_12_events_of_all_wheels",
        text: "events = events | event_wheel_1_events;",
        becomes: "events = events;",
    },
    Bug {
        breaks: "promise_12_starts_who_is_asked_to",
        text: ".starts(going & masked_1),\n        .halted",
        becomes: ".starts(going),\n        .halted",
    },
    Bug {
        breaks: "promise_12_every_lane_tells_its_causes",
        text: "dries = dries | dry_bit_1;",
        becomes: "dries = dries;",
    },
    Bug {
        breaks: "promise_12_lanes_have_their_axes",
        text: "axis_1 = lane_slots_axis + LANE_NUMBER_1",
        becomes: "axis_1 = lane_slots_axis + LANE_NUMBER_0",
    },
    Bug {
        breaks: "promise_12_a_wheel_has_the_axes_of_its_lane",
        text: "(lane_slots_axis_one_hot << TO_WHEEL_1)",
        becomes: "(lane_slots_axis_one_hot << TO_WHEEL_0)",
    },
    Bug {
        breaks: "promise_12_a_limit_of_a_seek_stops_no_other",
        text: "switches_1_found & !lane_seek_forgives[1]",
        becomes: "switches_1_found",
    },
    Bug { breaks: "promise_13_inactive", text: "rest_2 = 1'b1;", becomes: "rest_2 = 1'b0;" },
    Bug {
        breaks: "promise_14_start_only_warm",
        text: "enable & supervisor_warm",
        becomes: "enable",
    },
    Bug {
        breaks: "promise_15_a_snapshot_is_of_all_axes",
        text: "some_meet = some_meet | readout_1_meets;",
        becomes: "some_meet = some_meet;",
    },
    Bug {
        breaks: "promise_15_a_tick_is_live_or_a_snapshot",
        text: ".met(queue_1_met),\n        .sweeps",
        becomes: ".met(queue_1_running),\n        .sweeps",
    },
    Bug {
        breaks: "promise_17_commits_of_the_first_axis",
        text: "(!lane_slots_beat[7] | own_lane[0])",
        becomes: "1'b1",
    },
    Bug {
        breaks: "promise_17_segments_of_the_first_axis",
        text: "follows = queue_0_advances;",
        becomes: "follows = queue_1_advances;",
    },
    Bug {
        breaks: "promise_17_off_at_stops",
        text: "outputs_off = stops_frozen |",
        becomes: "outputs_off =",
    },
    Bug {
        breaks: "promise_18_none_named_while_one_is_examined",
        text: "& names & !cut_control_checks",
        becomes: "& names",
    },
    Bug {
        breaks: "promise_19_a_hit_ramps_its_own_axis",
        text: "stops_ramp | lane_seek_slows[1]",
        becomes: "stops_ramp | lane_seek_slows[0]",
    },
];

pub(super) fn proof() -> Proof {
    // The long run of proofs repeats them for six axes.
    let builds: &[_] =
        if repeats::in_full() { &[(2, 2, 16), (6, 2, 44), (6, 6, 16)] } else { &[(2, 2, 16)] };
    let case = |(axis_count, adders, clocks)| {
        let (build, verilog) = engine_on_adders(axis_count, adders, clocks, 4);
        Case {
            name: format!("{axis_count} axes on {adders}, {}", beat_name(&build.timebase)),
            dut: "carrystep_engine".into(),
            parameters: Vec::new(),
            verilog,
            numbers: [
                vec![axes(&build), lanes(&build), causes()],
                vec![("CUTS", u8::from(build.cuts).to_string())],
                beat(&build.timebase),
            ]
            .concat(),
        }
    };
    Proof {
        module: "wide",
        promises: Promises {
            text: include_str!("../../../crates/hdl/src/engine/wide/promises.sv"),
        },
        cases: builds.iter().copied().map(case).collect(),
        depth: 1,
        reach: 340,
        bugs: BUGS,
    }
}
