//! Figures of the documentation that are private constants of the code, of tests and of benches.
//! They are read from the text of the source, so that no constant becomes public for a page.

use carrystep_core::Command;
use carrystep_core::engine::{CAUSES, MAX_ROUNDS, SEGMENT_WORDS};
use carrystep_files::MoveFile;
use carrystep_tests::moves;
use carrystep_tests::pages::{self, grouped, part, says, word};
use carrystep_tests::sources::{behind, constant, power_of_ten, whole};

#[test]
fn accuracy_page_gives_the_constants_of_planner_and_checker() {
    let slow = |name| constant("crates/plan/src/slow.rs", name);
    let (least, early) = (slow("LEAST"), slow("EARLY"));
    // The bisection loses a unit for P, one for V, and one for each halving of V except the first.
    let lost = 16_f64.log2() + 1.0;
    let segments = constant("crates/plan/src/limits.rs", "MOST_SEGMENTS");
    let rounding = constant("crates/check/src/axis_check.rs", "ROUNDING_PS") / 1e3;
    let shift = constant("crates/plan/src/fine.rs", "EDGE_SHIFT") * 1e9;
    let samples = constant("crates/plan/src/corridor.rs", "SAMPLES") + 1.0;
    let longest = power_of_ten(behind("crates/files/src/move_file.rs", "if time <= "));
    says(
        "docs/accuracy.md",
        &[
            format!("With 16 phases the loss is at most {} units", word(whole(lost))),
            format!("by up to {:.1} ns / v", lost * 2_f64.powi(-32) * 1e9),
            format!("under {:.2} steps/s (16 phases)", lost * 2_f64.powi(-32) / early),
            format!("Below {least} Q units of 2^-32 step a tick"),
            format!("at most {lost}/{least} of a phase"),
            format!("the planner lets the axis travel {} units of 2^-32 step", word(whole(lost))),
            format!(
                "The bisection loses none to {lost} units, so each edge comes as if the axis were none to {lost} units behind.",
                lost = word(whole(lost))
            ),
            format!("{:.2} steps/s that cruises at its", lost * 2_f64.powi(-32) / early),
            format!("would need over {segments} segments"),
            format!("is a phase and {rounding} ns, plus"),
            format!("moves no edge by more than {shift:.1} ns"),
            format!("takes {} samples per segment", word(whole(samples))),
            format!("for moves of up to 10^{longest} s"),
        ],
    );
}

#[test]
fn machine_file_page_gives_the_limits_of_the_reader() {
    let files = |file: &str, text| behind(&format!("crates/files/src/{file}"), text);
    let tick = |name| constant("crates/core/src/tick.rs", name);
    // The words of a segment, its commit, and the ticks around the start.
    let rest = f64::from(SEGMENT_WORDS)
        + 1.0
        + behind("crates/plan/src/demand.rs", "SEGMENT_WORDS as u64 + 1 + ");
    let ticks = constant("crates/plan/src/demand.rs", "MOST_TICKS").log2();
    let longest = power_of_ten(files("move_file.rs", "if time <= "));
    let power = files("machine/axis.rs", "BigDecimal::new(1.into(), ");
    let least = 10_f64.powf(-power);
    says(
        "docs/machine-files.md",
        &[
            format!("digits and `_`, {} at most", files("machine/axis.rs", "name.len() > ")),
            format!("1 to {} letters, digits", files("machine/units.rs", "LONGEST_NAME: usize = ")),
            format!("computed to {} places", files("machine/units.rs", "PLACES: i64 = ")),
            format!("{least} steps/s to under half a step per tick"),
            format!("{least} steps/s^2 to under half a step per tick^2"),
            format!("is over {} ns and fewer phases", tick("LONG_NS")),
            format!("proposes `phases = {}`", tick("FEWER_PHASES")),
            format!("over 0, to 10^{longest}"),
            format!("at most 2^{ticks} ticks"),
            format!("takes at least {} ticks", word(whole(rest))),
        ],
    );
}

#[test]
fn machine_file_page_gives_the_ends_of_ranges_in_words() {
    let (home, build) = ("crates/files/src/machine/home.rs", "crates/core/src/engine/build.rs");
    let core = |name| constant("crates/core/src/engine.rs", name);
    // In us, and in ms, with ticks of 1 us.
    let debounce = whole((core("MAX_DEBOUNCE_SAMPLES") - 1.0) * core("MAX_ROUND"));
    let watchdog = (f64::from(MAX_ROUNDS) - 1.0) * core("MAX_ROUND") / 1e3;
    assert!(pages::file("crates/files/src/move_file.rs").contains("at_most(i32::MAX.into(), 0)"));
    let ramp = whole(behind(build, "stop.iter().position(|units| !(1..=1 << "));
    let share = part(1 << (64 - ramp));
    assert_eq!(whole(behind(home, "(high - low).unsigned_abs().div_ceil(")), 100, "a hundredth");
    let times = whole(behind(home, "(high - low).saturating_add("));
    assert_eq!(times, 2, "twice");
    let most = part(whole(behind(home, "i64::from(steps) <= (high - low) / ")));
    says(
        "docs/machine-files.md",
        &[
            format!("({} with ticks of 1000 ns)", watchdog.floor()),
            format!("({} with ticks of 1000 ns)", grouped(debounce)),
            "up to 2^31 - 1 steps from the start".to_owned(),
            format!("2^-64 to 1/{} step per tick^2", 1 << (64 - ramp)),
            format!("a {share} of a step per tick^2 at most"),
            "plus a hundredth of the travel".to_owned(),
            format!("over {most} of the travel"),
            "its length plus twice `move_off`".to_owned(),
        ],
    );
    says(
        "docs/engine.md",
        &[format!(
            "over 2^{ramp} in units of 2^-64 step per tick^2 (a {share} of a step per tick^2)"
        )],
    );
}

#[test]
fn pages_give_what_the_tests_of_link_and_simulators_do() {
    let writes = whole(behind(
        "crates/virtual-board/tests/support/bus.rs",
        "Host<SpiLine<Bus<B>>, Bus<B>, ",
    ));
    says(
        "docs/protocol.md",
        &[
            format!("at most ({writes} over SPI)"),
            format!("of unacknowledged writes: {} segments", word(writes)),
        ],
    );
    for rung in ["rung_4_model_equals_rust_hdl", "rung_5_model_equals_verilog"] {
        let run = behind(&format!("tests/{rung}/parallel.rs"), "repeats::part(job.max_clocks, ");
        assert_eq!(whole(run), 10, "{rung}");
    }
    says("README.md", &["run the first tenth in an ordinary test run".to_owned()]);
    // The least ratio of the measured table.
    let page = pages::file("docs/performance.md");
    let ratios = page.lines().filter_map(|line| line.split("**").nth(1)?.parse::<f64>().ok());
    let least = ratios.fold(f64::INFINITY, f64::min);
    assert!((1000.0..f64::INFINITY).contains(&least), "{least}");
    says(
        "README.md",
        &["The fast model is [a thousand times](docs/performance.md) as fast".to_owned()],
    );
}

#[test]
fn performance_page_gives_the_pulses_of_its_moves() {
    let page = pages::file("docs/performance.md");
    for (name, loads) in [("busy", None), ("typical", Some("of its ")), ("rest", None)] {
        let file =
            MoveFile::load(&moves::root().join("sim/bench").join(name).with_extension("toml"));
        let plan = carrystep_plan::plan::<f64>(&file.expect("a move file")).expect("a plan");
        let axes = plan.moves.iter().flat_map(|planned| &planned.axes);
        let pulses: u64 = axes.map(|axis| axis.steps.unsigned_abs()).sum();
        let row =
            page.lines().find(|line| line.starts_with(&format!("| {name} ("))).expect("a row");
        assert_eq!(row.split(" | ").nth(1), Some(pulses.to_string().as_str()), "{row}");
        if let Some(before) = loads {
            let is_segment = |command: &&Command| matches!(command, Command::Segment { .. });
            let count = plan.program().iter().filter(is_segment).count();
            says("docs/performance.md", &[format!("{before}{count} loads")]);
        }
    }
}

#[test]
fn pages_give_the_default_time_between_power_and_start() {
    let guard = "crates/files/src/machine/guard.rs";
    let enable = behind(guard, "name: \"enable_ms\", unit_ns: 1_000_000, default: ");
    says("docs/drivers.md", &[format!("[`[machine.guard]`](machine-files.md), {enable} ms,")]);
    says("docs/flow-of-a-move.md", &[format!("for `enable_ms`, {enable} ms by default")]);
}

#[test]
fn specification_gives_the_beats_of_the_model() {
    let sample = constant("crates/model/src/engine/motion/switches.rs", "SAMPLE_BEAT");
    says(
        "docs/clock-by-clock.md",
        &[format!("The sample is the level of the pin in beat {sample}.")],
    );
}

#[test]
fn performance_page_gives_the_constants_of_fast_model_and_bench() {
    let crossings = |name| whole(constant("crates/model/src/fast/crossings.rs", name));
    let main = "crates/xtask/benches/levels/main.rs";
    let edge = constant(main, "EDGE_AT_MOST");
    let slower = whole(behind(main, "theirs.megabytes_per_second() / "));
    let causes = whole(behind("tests/rung_3_fast_model_equals_model/engine.rs", "causes >= "));
    let (batch, dense) = (crossings("BATCH"), crossings("DENSE"));
    says(
        "docs/performance.md",
        &[
            format!("The model guesses {} roots together", word(batch)),
            format!("exactly {} steps come before the last guessed tick", batch - 1),
            format!("Where more than one edge in {} ticks is expected", word(dense)),
            format!("costs more than {edge} of the time that Verilator needs for a clock"),
            format!("at less than {} the speed of Verilator's", part(slower)),
            format!("at least {} of the {} causes", word(causes), word(CAUSES.len() as u64)),
        ],
    );
    // A decision gives the times of a tick of six axes, one after the other and side by side.
    let decision = pages::file("docs/decisions/0024-edges-side-by-side-not-axes.md");
    let time = |way: &str| -> f64 {
        let (_, rest) = decision.split_once(&format!("| {way} | ")).expect("a row");
        rest.split(' ').next().and_then(|ns| ns.parse().ok()).expect("ns")
    };
    let longer = time("six axes side by side") / time("one axis after the other");
    assert!((2.0..3.0).contains(&longer), "{longer}");
    says(
        "docs/performance.md",
        &["six axes side by side take more than twice as long as one after the other".to_owned()],
    );
    // The last column of the table is the ratio below which the bench fails.
    let page = pages::file("docs/performance.md");
    for name in ["busy", "typical", "rest"] {
        let row =
            page.lines().find(|line| line.starts_with(&format!("| {name} ("))).expect("a row");
        let shown = row.trim_end_matches(" |").rsplit(' ').next().expect("a last cell");
        let source = pages::file("crates/xtask/benches/levels/moves.rs").replace('_', "");
        let (_, rest) = source.split_once(&format!("name: \"{name}\"")).expect("a density");
        let (_, what) = rest.split_once("what: \"").expect("a description");
        let (what, _) = what.split_once('"').expect("its end");
        let (_, rest) = rest.split_once("wanted: ").expect("a wanted ratio");
        let (wanted, _) = rest.split_once(".0").expect("a whole ratio");
        assert_eq!(shown, wanted, "{row}");
        assert!(row.replace(' ', "").contains(&format!("({})|", what.replace(' ', ""))), "{row}");
        // The ratio of two columns, to three digits.
        let cells: Vec<&str> = row.split(" | ").collect();
        let number = |cell: &str| cell.trim_matches('*').parse::<f64>().expect("a number");
        let [fast, verilator, ratio] = [cells[2], cells[7], cells[8]].map(number);
        assert!((fast / verilator / ratio - 1.0).abs() < 5e-3, "{row}");
    }
}

#[test]
fn pages_give_the_numbers_of_mutants_frames_and_deaths() {
    let mutants = |name| constant("tests/rung_8_mutants_are_caught/mutants.rs", name);
    let (few, all) = (mutants("FEW"), mutants("ALL"));
    let (few_of_full, all_of_full) = (mutants("FEW_OF_FULL"), mutants("ALL_OF_FULL"));
    let bugs = "tests/rung_8_mutants_are_caught/engine_bugs.rs";
    let work = |text| whole(behind("tests/support/mutants/stimuli/work.rs", text));
    says(
        "docs/mutants.md",
        &[
            format!("{all} of them are drawn, of all modules"),
            format!("{all_of_full} mutants are drawn, of the modules"),
            format!("# all {all} and all {all_of_full}, and a table"),
            format!("Every test run takes the first {few} mutants"),
            format!("the first {few_of_full} of the engine with everything"),
            format!("{} bugs of the new modules", behind(bugs, "const NEW: [Bug; ")),
            format!("{} joint moves of all axes", word(work("drawn(&moves(), "))),
            format!("up to {} segments each", word(work("ticks.prop_flat_map(row), 1..="))),
        ],
    );
    let long = |name: &str| {
        whole(behind("crates/xtask/src/long/runs.rs", &format!("(\"CARRYSTEP_{name}\", \"")))
    };
    let bad_line = "crates/virtual-board/tests/bad_line.rs";
    let usual = behind(bad_line, "asked(\"CARRYSTEP_FRAMES\", ");
    says(
        "README.md",
        &[
            format!("({} [mutants](docs/mutants.md))", few + few_of_full),
            format!("does this for all {}.", all + all_of_full),
            format!("Every test run sends {usual} frames"),
            format!("{} frames over the bad line", grouped(long("FRAMES"))),
            format!("{} ends of hosts", long("DEATHS")),
        ],
    );
}

#[test]
fn profile_page_gives_the_tolerances_and_counts_of_its_tests() {
    let counts = |text: &str| behind("crates/plan/tests/segment_counts.rs", text);
    let [logistic, sine] = ["logistic", "sine"].map(|profile| {
        [1000, 50].map(|fit_ns| counts(&format!("assert_at_most(\"{profile}\", {fit_ns}, ")))
    });
    let tight = constant("crates/profile/tests/golden/mod.rs", "TIGHT");
    let first = behind("crates/profile/tests/near_rest.rs", "close(ramp.crossing(x), u, ");
    says(
        "docs/profiles.md",
        &[
            format!("at most {} segments a ramp for logistic", logistic[0]),
            format!("and {} for sine at 1 us, {} and {} at 50 ns", sine[0], logistic[1], sine[1]),
            format!("hold to a relative {tight:e}"),
            format!("is correct to {first:e}"),
        ],
    );
}

#[test]
fn promises_page_gives_the_width_of_the_counts_of_pulses() {
    // One half counts pulses, the other one discarded steps.
    let bits = behind("crates/hdl/src/engine/pulser.rs", "pub counts: Signal<Out, Word<") / 2.0;
    let counted = whole(bits.exp2());
    let lag = word(counted / 2 - 1);
    says(
        "docs/promises.md",
        &[
            format!("counts pulses modulo {counted}."),
            format!("lags the pins by at most {lag} pulses"),
            format!("may lag by up to {lag} edges"),
        ],
    );
}

#[test]
fn homing_page_gives_the_reserve_of_the_approach() {
    let reserve = behind("crates/link/src/host/homing.rs", "saturating_add(accepted + ");
    says("docs/homing.md", &[format!("accepts the level, plus {} steps", word(whole(reserve)))]);
}

#[test]
fn virtual_board_page_gives_the_times_of_its_pace() {
    let pace = |name| constant("crates/virtual-board/src/pace.rs", name);
    let (late, gone) = (pace("BEHIND"), whole(pace("GONE")));
    let board = |name| constant("crates/cli/src/operated.rs", name);
    let of_watchdog = part(whole(board("PART_OF_WATCHDOG")));
    let ms = 1000.0 / board("PART_OF_SECOND");
    let kept = whole(constant("crates/virtual-board/src/gateware.rs", "KEPT"));
    says(
        "docs/virtual-board.md",
        &[
            format!("It makes up for at most {late} ms of a delay."),
            format!("or is silent for {} seconds of real time", word(gone)),
            format!(
                "idle for no longer than {ms} ms, and no longer than a {of_watchdog} of the watchdog's"
            ),
            format!("at most a {of_watchdog} of the watchdog's time has passed"),
            format!("has more than {} segments waiting", word(kept)),
            format!("than the {} segments that wait there", word(kept)),
            format!("keeps fewer than {} segments waiting", word(kept + 1)),
        ],
    );
    let patience = |name| constant("crates/cli/src/connection.rs", name);
    let seconds = |name| patience(name) / 1000.0;
    let (silence, loss) = (seconds("SILENCE_OF_A_PROGRAM"), seconds("LOSS_OF_A_PROGRAM"));
    says(
        "docs/virtual-board.md",
        &[
            format!("sends a request again after {} ms", patience("RESEND_TO_A_PROGRAM")),
            format!("if nothing has answered for {silence} s"),
            format!("takes the line for dead after {loss} s"),
        ],
    );
    let period = patience("STATUS_PERIOD_OF_A_PROGRAM");
    says("docs/protocol.md", &[format!("the command reads it every {period} ms")]);
}
