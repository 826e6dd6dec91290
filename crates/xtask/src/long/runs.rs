//! The longer runs: what each of them does, and the command that does it.

/// Programs that come with LinuxCNC, beside our own.
const PROGRAMS_OF_LINUXCNC: &str =
    "square_and_arc:3dtest:arcspiral:cds:comp:hole-circle:polar:spiral:comp-g1:flowsnake:3D_Chips";

/// A longer run.
pub struct Run {
    pub name: &'static str,
    pub what: &'static str,
    /// What it asks for in its environment.
    pub asks: &'static [(&'static str, &'static str)],
    /// What cargo is told.
    pub cargo: &'static [&'static str],
}

/// All runs, in the order in which they are done. To add one: a line here; its command says its
/// `FIGURES`.
pub const RUNS: &[Run] = &[
    Run {
        name: "lockstep",
        what: "random programs with stops on all six axes: the model against the exported engine \
            in Verilator, every output in every clock",
        asks: &[("CARRYSTEP_CLOCKS", "10000000")],
        cargo: &["--test", "rung_5_model_equals_verilog", "engine::random_programs_in_verilator"],
    },
    Run {
        name: "rust-hdl",
        what: "the same against Rust-HDL's own simulation",
        asks: &[("CARRYSTEP_CLOCKS", "1000000")],
        cargo: &["--test", "rung_4_model_equals_rust_hdl", "engine::random_programs_at_16_phases"],
    },
    Run {
        name: "adders",
        what: "engines with [several adders](clock-by-clock.md#several-adders), as *lockstep* and \
            *rust-hdl*: six axes on two and on six, eight on eight; planted bugs; a move at 1.9 \
            million steps/s on six axes",
        asks: &[("CARRYSTEP_CLOCKS", "3000000")],
        cargo: &[
            "--test",
            "rung_4_model_equals_rust_hdl",
            "--test",
            "rung_5_model_equals_verilog",
            "--",
            "adders",
        ],
    },
    Run {
        name: "repeats",
        what: "what tests run in part, in full: the demo, all profiles and all golden vectors in \
            Icarus and Rust-HDL, ten million edges of the fast model, homing from every two \
            starts with each kind of stop, 300 random machines home, all random programs of both \
            cores in Rust-HDL, ten minutes of a slow board",
        asks: &[("CARRYSTEP_REPEATS", "all"), ("CARRYSTEP_HOMING_MACHINES", "300")],
        cargo: &[
            "--test",
            "rung_3_fast_model_equals_model",
            "--test",
            "rung_4_model_equals_rust_hdl",
            "--test",
            "rung_5_model_equals_verilog",
            "--test",
            "virtual_board",
            "--",
            "many_edges",
            "parallel::random_programs",
            "engine::random_programs",
            "difference_of_a_slow_board",
            "the_demo",
            "every_profile",
            "golden_vectors",
            "a_move_of_the_shipped",
            "parameters_of_others",
            "random_machines",
            "homes_from_every_start",
            "verilog_homes_in_each_wiring",
            "home_on_a_board_of_verilog",
            "gantry_of_verilog",
        ],
    },
    Run {
        name: "cases",
        what: "of the random cases of which tests run a part, all: plans and slow moves, engines with \
            several latches, holds, programs that are mutated or entered in their middle, overrides, \
            late hosts, a faulty line, tables, gantries and crossed belts that home, ten minutes of a \
            fast board, a self-test by its script",
        asks: &[("CARRYSTEP_REPEATS", "all")],
        cargo: &[
            "--test",
            "rung_1_plan_stays_with_the_profile",
            "--test",
            "rung_3_fast_model_equals_model",
            "--test",
            "job",
            "--test",
            "program",
            "--test",
            "runner",
            "--test",
            "link",
            "--test",
            "table",
            "--test",
            "virtual_board",
            "--test",
            "command_line",
            "--",
            "plans_of_each_kind",
            "linear_plans",
            "mixed_moves",
            "plans_in_f32",
            "slow_moves_of_every_kind",
            "an_engine_with_several_latches",
            "holds_keep_limits",
            "programs_of_the_tree_end",
            "mutated_programs_are_planned",
            "changes_at_random_times",
            "host_late_by_up_to_half",
            "pulses_of_run_",
            "rust_client_survives",
            "any_table_is_played",
            "letters_of_crossed_belts_home_from",
            "gantry_is_square",
            "difference_of_a_fast_board",
            "self_test_of_the_icestick",
        ],
    },
    Run {
        name: "proofs",
        what: "the [promises](promises.md), their covers and planted bugs",
        asks: &[("CARRYSTEP_REPEATS", "all")],
        cargo: &["--test", "rung_7_promises_are_proved"],
    },
    Run {
        name: "mutants",
        what: "all [mutants](mutants.md), with the proofs that survivors are harmless",
        asks: &[("CARRYSTEP_MUTANTS", "all")],
        cargo: &["--test", "rung_8_mutants_are_caught"],
    },
    Run {
        name: "bad-line",
        what: "moves over a line that flips, drops, doubles, cuts and delays bytes, to a board of \
            models: pulses are those of a clean line, or a stop says why",
        asks: &[("CARRYSTEP_FRAMES", "100000")],
        cargo: &["--test", "virtual_board", "bad_line::pulses_on_a_bad_line"],
    },
    Run {
        name: "garbage",
        what: "an hour of garbage at 921 600 baud, then a move",
        asks: &[("CARRYSTEP_GARBAGE", "3600000")],
        cargo: &["--test", "virtual_board", "bad_line::garbage_hangs_nothing"],
    },
    Run {
        name: "dead-host",
        what: "hosts that die in the middle of a move: the board stops in time, its positions are \
            true, the next host goes on",
        asks: &[("CARRYSTEP_DEATHS", "50")],
        cargo: &["--test", "virtual_board", "dead_host::the_board_stops"],
    },
    Run {
        name: "verilog-board",
        what: "the exported Verilog as a board: a second of garbage, then a move; a second of six \
            axes at 500 segments/s over 3 Mbaud",
        asks: &[("CARRYSTEP_VERILOG_MS", "1000")],
        cargo: &["--test", "virtual_board", "verilog_at"],
    },
    Run {
        name: "resources",
        what: "size and speed on every part, against the budgets",
        asks: &[],
        cargo: &["-p", "carrystep-tools"],
    },
    Run {
        name: "boards",
        what: "the gateware of all [boards](../hdl-out/boards.md): iCE40 and ECP5 to bitstreams \
            on their pins, Spartans to yosys' cells",
        asks: &[],
        cargo: &["-p", "carrystep-tools", "--", "boards"],
    },
    Run {
        name: "equivalence",
        what: "from bytes on the line to pulses on the pins: iCE40 boards as Verilog and as \
            bitstreams read back, ECP5 boards as Verilog and as netlists, Spartans as Verilog and \
            as the EDIF of their cells; planted faults",
        asks: &[("CARRYSTEP_BOARDS", "all")],
        cargo: &["--test", "a_board_is_its_verilog"],
    },
    Run {
        name: "spartans",
        what: "[Spartans without their vendor](spartans.md): the EDIF of all boards read by \
            spydrnet, cells, nets and the names of the constraints against our own reader; the \
            clock modules of all boards on small models of the cells; planted faults",
        asks: &[("CARRYSTEP_BOARDS", "all")],
        cargo: &["--test", "spartans_without_their_vendor"],
    },
    Run {
        name: "timing",
        what: "the iCEstick as placed and routed, simulated with [nextpnr's delays](timing.md): \
            from bytes on the line to pulses of six axes, every pin in every clock, no input of a \
            register within its set-up or hold time; violations above the greatest clock; every \
            single check of a small design",
        asks: &[("CARRYSTEP_BOARDS", "all")],
        cargo: &["--test", "a_board_keeps_its_timing"],
    },
    Run {
        name: "self-test",
        what: "the [self-tests](self-test.md) of all boards from their own pins: every output \
            once, alone, with its name on the UART, every change of an input, as Verilog and as \
            bitstream (iCE40), netlist (ECP5) or EDIF (Spartans); planted faults; every pin of \
            each iCE40 and ECP5 board placed by its build script",
        asks: &[("CARRYSTEP_BOARDS", "all")],
        cargo: &["--test", "a_self_test_shows_every_pin", "--test", "boards"],
    },
    Run {
        name: "gowin",
        what: "Gowin [boards](../hdl-out/boards.md): their gateware to bitstreams, in time with \
            each of five seeds; from bytes on the line to pulses on the pins, as Verilog and as \
            netlists; their [self-tests](self-test.md), as Verilog, as netlists and to \
            bitstreams; planted faults; every pin placed by the build script",
        asks: &[("CARRYSTEP_BOARDS", "all")],
        cargo: &[
            "--test",
            "a_board_is_its_verilog",
            "--test",
            "a_self_test_shows_every_pin",
            "--test",
            "boards",
            "--",
            "gowin",
        ],
    },
    Run {
        name: "holds",
        what: "500 holds and resumptions at random times in LinuxCNC's 3D_Chips, without and with \
            [overrides](running-jobs.md#on-a-board) at random times: exact limits, distance from \
            the planned curve, the end",
        asks: &[("CARRYSTEP_HOLDS", "500")],
        cargo: &["--test", "runner", "overrides::holds_at_random_times"],
    },
    Run {
        name: "kills",
        what: "50 programs whose command is killed with SIGKILL in motion: the axes ramp down, by \
            the watchdog or by a dry queue, where the pulses lead; \
            [`--from-block`](running-jobs.md#going-on-at-a-block) ends the job, and the pulses \
            before and behind the ramp are the whole part",
        asks: &[("CARRYSTEP_KILLS", "50")],
        cargo: &["--test", "command_line", "host_that_is_killed"],
    },
    Run {
        name: "programs",
        what: "all shipped programs to their end on a board of models, through the link: each \
            edge of STEP and DIR, and each change of an output, in the clock in which the fast \
            model of `simulate` has it",
        asks: &[("CARRYSTEP_PROGRAM_SECONDS", "1000")],
        cargo: &["--test", "runner", "pulses_of_simulate::"],
    },
    Run {
        name: "hours",
        what: "eight hours of a program on a board of models, through the link: each pulse in the \
            tick that the plan's own sums give it, drift zero steps",
        asks: &[("CARRYSTEP_HOURS", "28800")],
        cargo: &["--test", "runner", "hours_of_a_program::"],
    },
    Run {
        name: "linuxcnc",
        what: "the real [LinuxCNC](linuxcnc.md) with our component and a virtual board in real \
            time: programs, feed hold, abort, jog, e-stop; homing on a switch and on an index \
            pulse, probing, and LinuxCNC killed in motion; pulses against the motor-pos-cmd of \
            every servo period; a short program replayed on the exported Verilog, every pin in \
            every clock",
        asks: &[("CARRYSTEP_LINUXCNC", PROGRAMS_OF_LINUXCNC)],
        cargo: &["--test", "real_linuxcnc"],
    },
    Run {
        name: "senders",
        what: "real [senders](senders.md) drive virtual boards through `carrystep serve`: CNCjs \
            from npm and the sender of bCNC from PyPI stream programs, pause, override, and are \
            closed and killed in motion; ends and pulses against those of `carrystep run`",
        asks: &[("CARRYSTEP_SENDERS", "all")],
        cargo: &["--test", "command_line", "real_senders"],
    },
    Run {
        name: "container",
        what: "the [container recipe](senders.md) built from a clean clone, without a registry: \
            base images made of Debian's packages and rustup's toolchain; a program streamed to \
            what starts in it, twice",
        asks: &[("CARRYSTEP_CONTAINER", "1")],
        cargo: &["--test", "command_line", "container_serves"],
    },
    Run {
        name: "soak",
        what: "[senders](senders.md): 500 real-time characters at random times, judged by the \
            pulses (the path, speed and acceleration); four hours of motion under a sender that \
            misbehaves at random",
        asks: &[("CARRYSTEP_CHARACTERS", "500"), ("CARRYSTEP_SOAK", "14400")],
        cargo: &[
            "--test",
            "command_line",
            "--",
            "characters_at_random_times_break",
            "sender_that_misbehaves",
        ],
    },
];
