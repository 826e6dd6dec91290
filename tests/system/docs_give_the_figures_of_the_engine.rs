//! Figures of the documentation that describe the engine clock by clock and round by round: beats,
//! words, ticks, samples, and what the proofs assume.

use carrystep_core::build::{MIN_CLOCKS_PER_TICK, check_parallel_axes};
use carrystep_core::engine::{
    COMMIT, ENGINE_PORTS, EngineBuild, Guard, InputRow, MAX_AXES, MAX_ROUND, PUT_BEAT,
    SEGMENT_WORDS, SWITCH_ROWS, StateItem, TIME_SLOT_CLOCKS, least_clocks,
};
use carrystep_core::link::SEGMENT_FRAME_WORDS;
use carrystep_core::ports::Width;
use carrystep_core::tick::{FIXED_CLOCK_HZ, Ticks};
use carrystep_core::{AXES, Timebase};
use carrystep_files::{Machine, MoveFile, SourceText};
use carrystep_hdl::engine::layout::{self, index};
use carrystep_tests::moves;
use carrystep_tests::pages::{self, says, word};
use carrystep_tests::proofs::equivalence;
use carrystep_tests::sources::{behind, constant, whole};

/// A constant of the layout of the engine's Verilog.
fn at(name: &str) -> usize {
    index(name).unwrap_or_else(|| panic!("no {name}"))
}

#[test]
fn specification_gives_the_words_of_a_segment() {
    let (last, commit) = (SEGMENT_WORDS - 1, u64::from(COMMIT));
    let per_segment = commit + 1;
    let ticks = word(per_segment);
    assert_eq!(per_segment, u64::from(SEGMENT_WORDS) + 1, "every word takes a tick");
    says(
        "docs/clock-by-clock.md",
        &[
            format!("the words `w0 .. w{last}` of the segment"),
            format!(
                "a word of a segment: {} `left`, {} {} V, {} {} A, {} {} J, low half first; {commit} commits, bit {} is `last`",
                layout::WORD_TICKS,
                layout::WORD_V_LOW,
                layout::WORD_V_HIGH,
                layout::WORD_A_LOW,
                layout::WORD_A_HIGH,
                layout::WORD_J_LOW,
                layout::WORD_J_HIGH,
                at("COMMIT_LAST"),
            ),
            format!("next <= (next + 1) mod {per_segment}."),
            format!("its words 0 to {last} in this order"),
            format!(
                "its segment takes {ticks} ticks, and all axes can take theirs in the same {ticks}."
            ),
            format!("a segment is its {} words in order and a commit", word(last as u64 + 1)),
        ],
    );
    says(
        "docs/flow-of-a-move.md",
        &[
            format!("as {} words and a commit", word(commit)),
            format!("sends these as {} words.", word(SEGMENT_FRAME_WORDS as u64)),
        ],
    );
}

#[test]
fn specification_gives_the_beats_of_the_layout() {
    assert_eq!(at("BEAT_PUT"), PUT_BEAT as usize);
    // The queue's room is shown in the beat in which a word is taken.
    let wiring = pages::file("crates/hdl/src/engine/wiring.rs");
    assert!(wiring.contains("self.room_valid.next = self.listens.val()"));
    assert_eq!(at("BEAT_LAST") as u32, TIME_SLOT_CLOCKS - 1);
    let output = |beat: &str, item: StateItem| format!("| {} | {} |", at(beat), item as u8);
    says(
        "docs/clock-by-clock.md",
        &[
            format!("room_valid in beat {} of its time slot", at("BEAT_PUT")),
            format!("as they are in beat {0} of that time slot. After beat {0}:", at("BEAT_LAST")),
            output("BEAT_STATE_P_LOW", StateItem::PLow) + " P, low half |",
            format!(
                "| {} | {} if the axis runs, else {} |",
                at("BEAT_STATE_LEFT"),
                StateItem::Left as u8,
                StateItem::Discarded as u8
            ),
            output("BEAT_STATE_SWITCH", StateItem::Switch) + " in a tick in which a switch",
            output("BEAT_STATE_POSITION", StateItem::Position) + " `counted`, the position |",
            output("BEAT_STATE_P_HIGH", StateItem::PHigh) + " P, high half |",
            output("BEAT_STATE_TICK", StateItem::Ticks) + " `ticks` |",
            output("BEAT_STATE_STATUS", StateItem::Status) + " the status;",
            format!(
                "`discarded` in beat {} and `counted` in beat {}:",
                at("BEAT_COMPARE_DISCARDED"),
                at("BEAT_LOAD_POSITION")
            ),
        ],
    );
    let bits = moves::demo().build.timebase.phase_bits() as usize;
    let late = at("BEAT_BISECT_1") + bits - 1 - at("BEAT_LAST");
    let ticks = 1
        << (whole(behind("crates/hdl/src/engine/event_wheel.rs", "event_memory: Memory<"))
            as usize
            - at("EVENT_TICK"));
    says(
        "docs/engine.md",
        &[
            format!("The last {} beats of the bisection overlap", word(late as u64)),
            format!("one word for each phase of {} ticks", word(ticks)),
            format!("so {} need", word(AXES as u64)),
        ],
    );
}

#[test]
fn specification_gives_the_samples_of_a_round() {
    let machine = moves::shipped("demo").0.machine;
    let engine = machine.engine();
    let least = |inputs: [InputRow; 2]| {
        let accepted = |round: &u32| {
            let guard = Guard { round: *round, inputs, ..engine.guard.clone() };
            EngineBuild { guard, ..engine.clone() }.check().is_ok()
        };
        (0..=MAX_ROUND).find(accepted).expect("a round")
    };
    let limits = least([InputRow::default(); 2]);
    let inputs = least([InputRow { exist: 1, low: 0 }; 2]);
    assert!(limits >= 2 && inputs >= SWITCH_ROWS.into(), "each round samples all rows");
    says(
        "docs/clock-by-clock.md",
        &[
            format!("`R` (a power of two, at least {limits})"),
            format!("R is at least {inputs} then"),
        ],
    );
}

#[test]
fn pages_give_the_axes_of_the_parallel_core() {
    let axes: Vec<usize> = (0..=64).filter(|&axes| check_parallel_axes(axes).is_ok()).collect();
    let [first, .., last] = axes[..] else { panic!("{axes:?}") };
    let bits = (MAX_AXES as u64 - 1).ilog2() + 1;
    let port = ENGINE_PORTS.iter().find(|port| port.name == "put_axis").expect("a port");
    assert!(matches!(port.width, Width::Bits(width) if width == bits));
    says(
        "docs/clock-by-clock.md",
        &[
            format!("The core has `N` axes, {first} to {last}, each"),
            format!("the pin timings of {} axes", word(last as u64)),
            format!("`seg_axis` has {} bits", word(bits.into())),
        ],
    );
    says("docs/verilog.md", &[format!("The parallel core of N axes, {first} to {last}.")]);
}

#[test]
fn pages_give_the_latency_in_ticks_and_clocks() {
    let time = Timebase::new(FIXED_CLOCK_HZ, 1000, 16).expect("a timebase");
    let (latency, tick) = (time.latency_clocks(), u64::from(time.clocks_per_tick()));
    assert_eq!(latency % tick, 1, "the pages say: one clock");
    let later = format!("{} ticks and one clock", word(latency / tick));
    says("docs/engine.md", &[format!("come to the pins {later} later")]);
    says("docs/flow-of-a-move.md", &[format!("from a tick to the pins is {later}, L = {latency}")]);
    says(
        "docs/promises.md",
        &[format!("is on the pins {} ticks later, in its phase", word(latency / tick))],
    );
}

/// A speed of the approach, steps/s, that the reader accepts.
const SLOW: f64 = 100.0;

/// A machine with one axis that homes at this speed, in steps/s, and the other keys given.
fn homing_machine(slow_speed: f64, guard: &str) -> Result<Machine, String> {
    let text = format!(
        "[machine]\n[machine.guard]\n{guard}\n[[machine.axis]]\nname = \"x\"\nsteps_per_unit = 1\n\
         speed_limit = 100_000\naccel_limit = 4_000_000\ndriver = \"tmc2209\"\n\
         home = {{ toward = \"min\", seek_speed = 90_000, slow_speed = {slow_speed}, \
         move_off = 20_000, max_travel = 30_000, pull_off = 5_000, position = 0 }}\n"
    );
    let source = SourceText { path: "page.toml".into(), text: text.into() };
    Machine::from_source(&source).map_err(|error| error.message)
}

#[test]
fn pages_give_the_limit_of_the_slow_speed() {
    let machine = homing_machine(SLOW, "").expect("a machine");
    let (round, tick_s) = (machine.engine().guard.round, machine.timebase.tick_seconds());
    // The fastest approach that the reader accepts takes this many ticks for a step.
    let (mut least, mut most) = (SLOW, 90_000.0);
    assert!(homing_machine(most, "").is_err());
    for _ in 0..60 {
        let middle = 0.5 * (least + most);
        if homing_machine(middle, "").is_ok() {
            least = middle;
        } else {
            most = middle;
        }
    }
    let ticks = 1.0 / (least * tick_s);
    assert!((ticks - ticks.round()).abs() < 1e-6, "{ticks}");
    let beside = word(ticks.round() as u64 - u64::from(round));
    says(
        "docs/homing.md",
        &[format!("one step in the time between two samples of the switch plus {beside} ticks")],
    );
    says(
        "docs/machine-files.md",
        &[format!("at most one step in a round of the guard and {beside} ticks")],
    );
}

/// A time of the guard exceeds that of the file by up to so many rounds, and one tick.
#[test]
fn pages_give_the_excess_of_the_times_of_the_guard() {
    let excess = |tenths: u64| {
        let us = tenths as f64 / 10.0;
        let engine = homing_machine(SLOW, &format!("debounce_us = {us}")).expect("a file").engine();
        let most = engine.guard_figures().debounce_us.expect("limits").most;
        assert_eq!(engine.timebase.tick_ns(), 1000, "us are ticks");
        (most - us, f64::from(engine.guard.round))
    };
    let all = (1..2000).map(excess);
    let (longest, round) = all.max_by(|one, other| one.0.total_cmp(&other.0)).expect("one");
    // Tenths of a tick were tried, so the bound is a tenth above.
    let rounds = ((longest + 0.1 - 1.0) / round).round();
    assert!((longest + 0.1 - (rounds * round + 1.0)).abs() < 1e-9, "{longest}");
    let rounds = word(whole(rounds));
    says("docs/homing.md", &[format!("by less than {rounds} rounds and a tick of the")]);
    says("docs/machine-files.md", &[format!("less than {rounds} rounds and a tick longer")]);
}

#[test]
fn homing_page_gives_the_repeatability_that_its_test_requires() {
    let test = "crates/virtual-board/tests/homing.rs";
    let late = whole(behind(test, "(0..=late + "));
    let apart = whole(behind(test, "first.abs_diff(*second) <= "));
    says(
        "docs/homing.md",
        &[
            format!("x this longest value, plus {} step.", word(late)),
            format!("it is the same within {} step.", word(apart)),
        ],
    );
    let pulled = whole(behind("crates/files/src/machine/home.rs", "self.guard)) + "));
    says("docs/machine-files.md", &[format!("at least {} step more than the axis", word(pulled))]);
}

#[test]
fn machine_file_page_gives_the_clocks_of_a_whole_number_of_ns() {
    // One phase, so that only whole clocks and whole ns count.
    let grain = Ticks::of(27_000_000, 1).expect("ticks").grain_ns();
    let clocks = grain * 27 / 1000;
    says(
        "docs/machine-files.md",
        &[format!(
            "At 27 MHz a whole number of clocks is a whole number of ns only every {clocks}"
        )],
    );
}

#[test]
fn promises_page_gives_what_the_proofs_assume() {
    let promises = |module: &str| format!("crates/hdl/src/{module}/promises.sv");
    let sum = behind(&promises("parallel/axis"), "reg signed [") + 1.0;
    let ahead = whole(behind(&promises("engine/step_counts"), "given_up - written_off != "));
    let behind_pins = whole(behind(&promises("engine/step_counts"), "behind >= -3 && behind <= "));
    says(
        "docs/promises.md",
        &[
            format!("summed without a carry in {sum} bits"),
            format!("never more than {} ahead of the number", word(ahead)),
            format!("never lags by more than {} pulses", word(behind_pins)),
            format!("at most k + {behind_pins} pulses"),
            format!("so at most {} are left", word(behind_pins)),
        ],
    );
}

/// The page says that the compared moves have the shortest ticks that their axes and phases allow.
#[test]
fn promises_page_compares_moves_in_the_shortest_ticks() {
    let mut compared = Vec::new();
    for pair in equivalence::moves() {
        let number = |wanted: &str| -> u32 {
            let found = pair.engine.numbers.iter().find(|(name, _)| *name == wanted);
            found.expect("a number of the miter").1.parse().expect("a number")
        };
        let (axes, phases) = (number("AXES"), number("PHASES"));
        let least = least_clocks(axes as usize, phases).max(MIN_CLOCKS_PER_TICK);
        assert_eq!(number("CLOCKS"), least.next_multiple_of(phases), "{axes} axes, {phases}");
        compared.push((phases, word(axes.into())));
    }
    compared.sort_unstable();
    let [(few, alone), (many, one), (same, two)] = compared[..] else { panic!("{compared:?}") };
    assert_eq!(many, same);
    says(
        "docs/promises.md",
        &[format!(
            "the shortest ticks of {alone} axis in {few} phases, and of {one} or {two} axes in {many}."
        )],
    );
}

#[test]
fn performance_page_gives_the_machines_of_bench_and_tests() {
    let rung_3 = "tests/rung_3_fast_model_equals_model/engine.rs";
    let source = pages::file(rung_3);
    let calls = source.split("    stops_at_any_clock(").skip(1);
    let mut axes: Vec<u64> = calls
        .map(|call| call.split(',').next().and_then(|axes| axes.parse().ok()).expect("axes"))
        .collect();
    axes.sort_unstable();
    axes.dedup();
    let [few, many] = axes[..] else { panic!("{axes:?}") };
    let bench = constant("crates/xtask/benches/levels/moves.rs", "ENGINE_HZ") / 1e6;
    let file = moves::root().join("sim/bench/busy.toml");
    let machine = MoveFile::load(&file).expect("a move file").machine;
    let (mhz, us) = (machine.timebase.clock_hz() / 1_000_000, machine.timebase.tick_ns() / 1000);
    let bits = u64::from(machine.timebase.phase_bits());
    let file = moves::root().join("sim/bench/steady.toml");
    let plan = carrystep_plan::plan::<f64>(&MoveFile::load(&file).expect("a move file"));
    let steady = &plan.expect("a plan").moves[0];
    let seconds = steady.ticks as f64 * machine.timebase.tick_seconds();
    let speeds = steady.axes.iter().map(|axis| axis.steps.unsigned_abs() as f64 / seconds);
    // To two digits.
    let speeds: Vec<u64> = speeds.map(|speed| (speed / 1e3).round() as u64 * 1000).collect();
    assert!(speeds.iter().all(|speed| *speed == speeds[0]), "{speeds:?}");
    says(
        "docs/performance.md",
        &[
            format!("{} and {} axes, each kind of limit", word(few), word(many)),
            format!("The engine at {bench} MHz, fed word by word"),
            format!("the parallel core at {mhz} MHz with ticks of {us} us)"),
            format!("{} halvings for the phase", word(bits)),
            format!(
                "at {} steps/s (`sim/bench/steady.toml`, {} seconds",
                pages::grouped(speeds[0]),
                word(seconds.round() as u64)
            ),
            format!("the merge of {} streams", word(machine.axes.len() as u64)),
        ],
    );
}
