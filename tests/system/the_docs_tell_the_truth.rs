//! Numbers in the documentation must equal those that the product computes.

use carrystep_core::link::Uart;
use carrystep_files::MoveFile;
use carrystep_plan::{Plan, plan};
use carrystep_simulators::engine::run::EngineJob;
use carrystep_simulators::{Job, Level, run};
use carrystep_tests::pages::{self, grouped};
use carrystep_tests::{effort, moves};
use std::process::Command;

fn page(name: &str) -> String {
    pages::file(&format!("docs/{name}"))
}

#[test]
fn flow_of_a_move_page_has_the_planned_numbers() {
    let text = page("flow-of-a-move.md");
    let plan = moves::demo();
    let x = &plan.moves[0].axes[0];
    for segment in &x.segments {
        let wanted = [segment.ticks.to_string(), segment.v.to_string(), segment.a.to_string()];
        let there = text.lines().any(|line| line.split_whitespace().take(3).eq(wanted.iter()));
        assert!(there, "no line '{}'", wanted.join("  "));
    }
    assert!(text.contains(&format!("60.795 ms, {} ticks", plan.moves[0].ticks)));
    assert!(text.contains(&grouped(x.segments[0].a.unsigned_abs())));
    assert!(text.contains(&grouped(x.segments[0].v.unsigned_abs())));

    // The float profile: N steps in the time T from the start speed, as a triangle.
    let (n, v, time) = (800.0_f64, 1000.0_f64, plan.moves[0].ticks as f64 * 1e-6);
    let top = 2.0 * n / time - v;
    let a = 2.0 * (top - v) / time;
    let due = ((v * v + a).sqrt() - v) / a;
    assert!(text.contains(&format!("v_s = {} steps/s in the middle", grouped(top.round() as u64))));
    assert!(text.contains(&format!("= {} steps/s^2, just under", grouped(a.round() as u64))));
    assert!(text.contains(&format!("= {:.3} us", due * 1e6)));
    assert!(text.contains(&format!("e_1 = {:.1} ns", (427e-6 - due) * 1e9)));

    let program = plan.program();
    let (engine, _) = moves::on_the_engine("demo");
    let (mut first, mut start) = (None, None);
    let job = EngineJob::new(&engine, &program, plan.total_ticks());
    job.run(Level::Model, &mut |cycle, outputs| {
        if outputs.started && start.is_none() {
            start = Some(cycle);
        }
        if outputs.step & 1 == 1 && first.is_none() {
            first = Some(cycle);
        }
    })
    .expect("the engine's model");
    let (first, start) = (first.expect("a pulse on x"), start.expect("a start"));
    let clocks = u64::from(plan.build.timebase.clocks_per_tick());
    assert!(
        text.contains(&format!("= {}\n", grouped(first))),
        "the first edge is in cycle {first}"
    );
    let strobe =
        format!("tick {} after configuration, in cycle {}", (start + 1) / clocks, grouped(start));
    assert!(text.contains(&strobe), "not said: {strobe}");
    let sum = format!("\n    {} + ", grouped(start + 1));
    assert!(text.contains(&sum), "the first tick begins in the cycle after the strobe: {sum}");
    let mut of_parallel = None;
    let job = Job::new(&plan.build, &program, plan.total_ticks());
    run(Level::Model, &job, &mut |cycle, outputs| {
        if outputs.step & 1 == 1 && of_parallel.is_none() {
            of_parallel = Some(cycle);
        }
    })
    .expect("the parallel core's model");
    let of_parallel = of_parallel.expect("a pulse on x");
    assert!(
        text.contains(&format!("= {}.", grouped(of_parallel))),
        "the parallel core's is in cycle {of_parallel}"
    );
    assert!(text.contains(&grouped(plan.build.timebase.clock_to_ps(first))));
    let pulses: u64 = plan.moves.iter().flat_map(|m| &m.axes).map(|a| a.steps.unsigned_abs()).sum();
    assert!(text.contains(&format!("{pulses} edges")));
}

/// A move file with one axis.
fn one_axis(limits: &str, moved: &str) -> MoveFile {
    let text = format!(
        "[machine]\n[[machine.axis]]\nname = \"x\"\nsteps_per_unit = 1\n{limits}\ndriver = \"a4988\"\n[[move]]\n{moved}\n"
    );
    carrystep_tests::random_moves::file(&text)
}

fn planned(file: &MoveFile) -> Plan {
    plan::<f64>(file).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn slow_moves_are_as_accurate_as_the_page_says() {
    const STEPS: i32 = 400;
    const SPEED: u64 = 5000;
    const ACCEL: u64 = 25_000;
    let text = page("accuracy.md");
    let time = planned(&one_axis(
        &format!("speed_limit = {SPEED}\naccel_limit = {ACCEL}"),
        "profile = \"trapezoid\"\nto = { x = 1 }",
    ))
    .build
    .timebase;
    pages::says(
        "docs/accuracy.md",
        &[format!(
            "shows {STEPS} steps with `trapezoid`, at most {SPEED} steps/s and {} steps/s^2, {} phases of a {} us tick",
            grouped(ACCEL),
            time.phases(),
            time.tick_ns() / 1000
        )],
    );
    for seconds in [5000, 10_000, 100_000, 1_000_000] {
        let mut cells = vec![grouped(seconds)];
        for steps in [STEPS, -STEPS] {
            let moved =
                format!("profile = \"trapezoid\"\ntime = {seconds}\nto = {{ x = {steps} }}");
            let limits = format!("speed_limit = {SPEED}\naccel_limit = {ACCEL}");
            let file = one_axis(&limits, &moved);
            let plan = planned(&file);
            let report = moves::check(&file, &plan, &plan.courses(), &plan.program(), &plan.build);
            assert!(report.passed, "{report}");
            let axis = &report.axes[0];
            cells.push(plan.moves[0].axes[0].segments.len().to_string());
            // Adding zero converts minus zero to plus zero.
            cells.extend([axis.error_min_ns, axis.error_max_ns].map(|e| {
                let tenths = e.map(|e| (e * 10.0).round() / 10.0 + 0.0);
                tenths.map_or_else(String::new, |e| format!("{e:.1}"))
            }));
        }
        let row = format!("| {} |", cells.join(" | "));
        assert!(text.contains(&row), "no row {row}");
    }
    // Five units of 2^-32 step, at one step per second and at the speed at which they take 1.2 ns;
    // and 8 Q such units in a tick of 1 us.
    let unit = 2_f64.powi(-32);
    for wanted in [
        format!("take {:.1} ns at a speed of one step a second", 5.0 * unit * 1e9),
        format!("under {:.2} steps/s (16 phases)", 5.0 * unit / 1.2e-9),
        format!("is {:.4} steps/s with 16 phases", 8.0 * 16.0 * unit * 1e6),
        format!("over {} segments", 1 << 17),
    ] {
        assert!(
            text.split_whitespace().collect::<Vec<_>>().join(" ").contains(&wanted),
            "not said: {wanted}"
        );
    }
}

#[test]
fn a_closer_fit_costs_as_many_segments_as_the_page_says() {
    let text = page("accuracy.md").split_whitespace().collect::<Vec<_>>().join(" ");
    let counts = |fit_ns: u32| {
        ["sine", "logistic"].map(|profile| {
            let moved =
                format!("profile = \"{profile}\"\nfit_ns = {fit_ns}\nto = {{ x = 20_000 }}");
            planned(&one_axis("speed_limit = 150_000\naccel_limit = 500_000", &moved)).moves[0].axes
                [0]
            .segments
            .len()
        })
    };
    let [tick, fifty, one] = [1000, 50, 1].map(counts);
    assert!(text.contains(&format!(
        "50 ns cost twice the segments (sine {}, logistic {})",
        fifty[0], fifty[1]
    )));
    assert!(text.contains(&format!(
        "1 ns four to five times as many (sine {}, logistic {})",
        one[0], one[1]
    )));
    for (tick, (fifty, one)) in tick.into_iter().zip(fifty.into_iter().zip(one)) {
        let times = |more: usize| more as f64 / tick as f64;
        assert!(
            (1.5..2.5).contains(&times(fifty)) && (4.0..5.0).contains(&times(one)),
            "{tick} {fifty} {one}"
        );
    }
}

#[test]
fn a_byte_takes_the_clocks_that_the_page_of_the_link_says() {
    // A start bit, eight data bits and a stop bit.
    let bits = 1 + 8 + 1;
    let (mhz, mbaud) = (48, 3);
    let uart = Uart::new(mhz * 1_000_000, mbaud * 1_000_000).expect("a UART");
    let clocks = bits * uart.bit_clocks();
    let said = format!(
        "A byte takes {clocks} clocks on a UART of {mbaud} Mbaud if the clock is {mhz} MHz"
    );
    assert!(page("link.md").contains(&said), "not said: {said}");
}

#[test]
fn protocol_page_computes_ten_steps_in_a_thousand_ticks_correctly() {
    let text = page("protocol.md");
    let (way, ticks) = (10_u128 << 64, 1000);
    let (whole, rest) = (way / ticks, way % ticks);
    assert!(text.contains(&format!("10 x 2^64 / 1000 = {whole}.{:02}", rest / 10)));
    assert!(text.contains(&format!(
        "send two segments: {rest} ticks with\nV = {}, then {} with V = {whole}",
        whole + 1,
        ticks - rest
    )));
    assert_eq!(rest * (whole + 1) + (ticks - rest) * whole, way);
}

#[test]
fn five_minutes_page_shows_table_1_as_addition_gives_it() {
    let text = page("five-minutes.md");
    let row = |name: &str| {
        text.lines().find_map(|line| line.trim().strip_prefix(name)).expect("the table")
    };
    let ticks: Vec<u32> =
        row("tick ").split_whitespace().map(|n| n.parse().expect("a tick")).collect();
    assert_eq!(ticks, (1..=10).collect::<Vec<_>>());
    let mut p = 0_u64;
    let mut wanted = (Vec::new(), Vec::new());
    for _ in ticks {
        // A fifth of a step, rounded up so that five of them carry.
        let (next, carry) = p.overflowing_add(u64::MAX / 5 + 1);
        p = next;
        wanted.0.push(format!("{:.1}", p as f64 / 2_f64.powi(64)));
        wanted.1.push(carry);
    }
    assert_eq!(row("P ").split_whitespace().collect::<Vec<_>>(), wanted.0);
    let stars = row("step ");
    let columns = text.lines().find(|line| line.trim().starts_with("tick ")).expect("the table");
    let indent = columns.find("tick").expect("its head") + "step ".len();
    let starred: Vec<bool> = (1..=10)
        .map(|tick| {
            let column = columns
                .find(&format!(" {tick} "))
                .or_else(|| columns.find(&format!(" {tick}")))
                .expect("a tick");
            (column..column + 4)
                .any(|at| stars.as_bytes().get(at.saturating_sub(indent)) == Some(&b'*'))
        })
        .collect();
    assert_eq!(starred, wanted.1);
    let time = moves::demo().build.timebase;
    let (halves, phases) = (pages::word(time.phase_bits().into()), f64::from(time.phases()));
    let step = format!("a step {halves} times, by additions only,");
    assert!(pages::joined("docs/five-minutes.md").contains(&step), "not said: {step}");
    assert!(text.contains(&format!("sixteenth: {} ns", time.tick_ns() as f64 / phases)));
}

#[test]
fn a_tick_of_the_engine_has_the_clocks_that_the_page_says() {
    use carrystep_core::engine::{TIME_SLOT_CLOCKS, clocks_of_time_slots};
    let text = page("engine.md");
    let [six, eight] = [6, 8].map(clocks_of_time_slots);
    assert!(text.contains(&format!(
        "a time slot of {TIME_SLOT_CLOCKS} clocks, so six need {six} and eight {eight}"
    )));
    // The least whole number of MHz that gives this number of clocks in a tick of 1 us, and of 2
    // us.
    let mhz = |us: u32| six.div_ceil(us);
    assert!(text.contains("a 1 us tick needs 80 MHz, a 2 us tick 40 MHz"), "{} {}", mhz(1), mhz(2));
    assert!(
        [mhz(1), mhz(2)]
            .iter()
            .zip([80, 40])
            .all(|(&needed, said)| needed <= said && said - needed < 2)
    );
}

/// The first line that git prints; `None` if there is no repository that git can read.
fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).current_dir(moves::root()).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

/// What the page says of a run that has not been made on this gateware.
const NOT_YET: &str = "not run yet";

#[test]
fn the_long_runs_have_passed_on_this_gateware() {
    let text = page("long-runs.md");
    let (_, rest) = text.split_once("writes from here ... -->").expect("the table");
    let (table, _) = rest.split_once("<!-- ... to here -->").expect("the table's end");
    let rows: Vec<Vec<&str>> = table
        .lines()
        .filter(|line| line.starts_with("| "))
        .skip(1)
        .map(|line| line.trim_matches('|').split('|').map(str::trim).collect())
        .collect();
    let names: Vec<&str> = rows.iter().map(|row| row[0]).collect();
    assert_eq!(
        names,
        [
            "lockstep",
            "rust-hdl",
            "adders",
            "repeats",
            "cases",
            "proofs",
            "mutants",
            "bad-line",
            "garbage",
            "dead-host",
            "verilog-board",
            "resources",
            "boards",
            "equivalence",
            "spartans",
            "timing",
            "self-test",
            "gowin",
            "holds",
            "kills",
            "programs",
            "hours",
            "linuxcnc",
            "senders",
            "container",
            "soak"
        ]
    );
    for row in rows {
        let [name, _, figures, result, took, date, commit, gateware] = row[..] else {
            panic!("a row of {row:?}")
        };
        if [figures, result].contains(&NOT_YET) {
            // Nothing is claimed then: no figure of another gateware, no date, no commit.
            let cells = [figures, result, took, date, commit, gateware];
            assert_eq!(
                cells.concat(),
                NOT_YET,
                "{name}: a run that was not made has come to nothing: {row:?}"
            );
            effort::say(&format!("{name} has not been run yet: `cargo xtask long {name}`"));
            continue;
        }
        assert_eq!(result, "passed", "{name}: {figures}");
        assert!(
            figures.starts_with(|first: char| first.is_ascii_digit()) && took.ends_with(" s"),
            "{name}: {row:?}"
        );
        assert!(
            date.len() == 10 && date.starts_with("20") && date.matches('-').count() == 2,
            "{name}: {date}"
        );
        let [commit, gateware] = [commit, gateware].map(|hash| hash.trim_matches('`'));
        assert!(
            [commit, gateware].iter().all(|hash| hash.len() >= 10),
            "{name}: {commit} {gateware}"
        );
        // Without git nothing more can be checked; in a shallow clone the commit may be missing.
        let Some(now) = git(&["rev-parse", "HEAD:hdl-out/core"]) else { continue };
        assert!(
            now.starts_with(gateware),
            "{name} was run on other gateware: run `cargo xtask long {name}` again"
        );
        if git(&["rev-parse", "--is-shallow-repository"]).as_deref() == Some("false") {
            let ancestor = git(&["merge-base", "--is-ancestor", commit, "HEAD"]);
            assert!(ancestor.is_some(), "{name}: the commit {commit} is not in this history");
        }
    }
}
