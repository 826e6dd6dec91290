//! The proof of the whole exported engine.

use super::builds::{BuiltEngine, axes, beat, beat_name, causes, small_engine};
use super::{Bug, Case, Promises, Proof};
use carrystep_core::engine::{EngineBuild, LimitWiring};

const BUGS: &[Bug] = &[
    Bug {
        breaks: "promise_5_every_axis_frozen",
        text: ".clock(clock),\n        .frozen(stops_frozen),",
        becomes: ".clock(clock),\n        .frozen(stops_ramp),",
    },
    Bug {
        breaks: "promise_6_taken_in_its_time_slot",
        text: "listens = time_slot_beat[7]",
        becomes: "listens = time_slot_beat[6]",
    },
    Bug {
        breaks: "promise_6_nothing_taken_in_a_fault",
        text: "put_ready = !stops_fault &",
        becomes: "put_ready =",
    },
    Bug {
        breaks: "promise_6_no_such_axis_is_told",
        text: "((put_valid & nobody) | broken | queue_misplaced | output_control_stray)",
        becomes: "(broken | queue_misplaced | output_control_stray)",
    },
    Bug {
        breaks: "promise_6_something_to_start",
        text: "unfed <= unfed | (masked & queue_empty);",
        becomes: "unfed <= unfed;",
    },
    Bug {
        breaks: "promise_6_a_start_is_kept",
        text: "if (go | (decides & drops) | stops_fault) begin",
        becomes: "if (time_slot_beat[3]) begin",
    },
    Bug {
        breaks: "promise_8_idle",
        text: "rest_2 & !waits & !pins_busy",
        becomes: "rest_2 & !pins_busy",
    },
    Bug {
        breaks: "promise_8_idle_is_empty",
        text: "rest_2 <= !active & rest_1;",
        becomes: "rest_2 <= 1'b1;",
    },
    Bug {
        breaks: "promise_12_own_requests",
        text: ".request(event_wheel_events & event_wheel_phase_start)",
        becomes: ".request(event_wheel_events)",
    },
    Bug {
        breaks: "promise_12_starts_who_is_asked_to",
        text: ".starts(going & masked),\n        .halted",
        becomes: ".starts(going),\n        .halted",
    },
    Bug {
        breaks: "promise_19_a_hit_ramps_its_own_axis",
        text: "stops_ramp | seek_control_slows",
        becomes: "stops_ramp",
    },
    Bug {
        breaks: "promise_12_a_limit_of_a_seek_stops_no_other",
        text: "switches_found & !seek_control_forgives",
        becomes: "switches_found",
    },
    Bug {
        breaks: "promise_18_none_named_while_one_is_examined",
        text: "& names & !cut_control_checks",
        becomes: "& names",
    },
    Bug {
        breaks: "promise_17_off_at_stops",
        text: "outputs_off = stops_frozen |",
        becomes: "outputs_off =",
    },
    Bug {
        breaks: "promise_6_words_in_order",
        text: ".put_word(put_word),\n        .put_slot",
        becomes: ".put_word({1'b0, time_slot_axis}),\n        .put_slot",
    },
    Bug {
        breaks: "promise_13_reset_freezes",
        text: ".ending(resets_ending),\n        .stage_2",
        becomes: ".ending(resets_stage_2),\n        .stage_2",
    },
    Bug {
        breaks: "promise_13_reset_of_an_engine_at_rest",
        text: ".settled(stops_settles),",
        becomes: ".settled(1'b1),",
    },
    Bug { breaks: "promise_13_inactive", text: "rest_2 = 1'b1;", becomes: "rest_2 = 1'b0;" },
    Bug {
        breaks: "promise_15_a_tick_is_live_or_a_snapshot",
        text: ".met(queue_met),\n        .sweeps",
        becomes: ".met(queue_running),\n        .sweeps",
    },
    Bug {
        breaks: "promise_14_start_only_warm",
        text: "enable & supervisor_warm",
        becomes: "enable",
    },
];

pub(super) fn proof(built: &BuiltEngine) -> Proof {
    let sizes = [(1, 16, 4), (6, 96, 16)];
    let builds =
        sizes.map(|(axes, clocks, phases)| small_engine(axes, clocks, phases, LimitWiring::Pair));
    let case = |(build, verilog): (EngineBuild, _)| Case {
        name: format!("{} axes, {}", build.axes(), beat_name(&build.timebase)),
        dut: "carrystep_engine".into(),
        parameters: Vec::new(),
        verilog,
        numbers: [
            vec![axes(&build), causes(), ("CUTS", u8::from(build.cuts).to_string())],
            beat(&build.timebase),
        ]
        .concat(),
    };
    Proof {
        module: "engine",
        promises: Promises { text: include_str!("../../../crates/hdl/src/engine/promises.sv") },
        cases: builds.into_iter().chain([built.clone()]).map(case).collect(),
        depth: 1,
        reach: 340,
        bugs: BUGS,
    }
}
