//! Figures of the documentation that follow from the public constants of the code and from the
//! tables in `hdl-out/`.

use carrystep_core::build::{MAX_CLOCK_HZ, MAX_CLOCKS, MIN_CLOCKS_PER_TICK};
use carrystep_core::engine::{
    MAX_AXES, MAX_DEBOUNCE_SAMPLES, MAX_ROUND, MAX_ROUNDS, MIN_CLOCKS_PER_PHASE, PUT_BEAT,
    QUEUE_DEPTHS, TIME_SLOT_CLOCKS,
};
use carrystep_core::fixed::{FRACTION_BITS, StartPhase};
use carrystep_core::link::registers::MOST_AXES;
use carrystep_core::link::{
    ANSWER_BYTES, BAUD_PERCENT, CRC_BYTES, END, ESC, ESC_END, ESC_ESC, MAX_BIT_CLOCKS,
    MIN_BIT_CLOCKS, REQUEST_HEAD, SEGMENTS_AXIS_WORDS, SEGMENTS_HEAD_WORDS, SESSION_BYTES, WINDOW,
    image,
};
use carrystep_core::tick::{FIXED_CLOCK_HZ, default_tick};
use carrystep_core::{AXES, Timebase};
use carrystep_tests::pages::{self, grouped, says, word};
use carrystep_tools::resources::{EIGHT_TO_SIX, EngineRow, LINES, LINK_BUDGET, ROWS};

#[test]
fn pages_give_clock_and_tick_of_a_machine_file_without_them() {
    let (tick_ns, chosen) = default_tick(FIXED_CLOCK_HZ, 16, AXES).expect("a default tick");
    assert_eq!(chosen, None, "the default clock has a fixed tick");
    let (mhz, us) = (FIXED_CLOCK_HZ / 1_000_000, tick_ns / 1000);
    // The numbers of axes that need another tick.
    let is_longer = |axes: &usize| default_tick(FIXED_CLOCK_HZ, 16, *axes) != Some((tick_ns, None));
    let longer: Vec<&str> =
        (1..=MAX_AXES).filter(is_longer).map(|axes| word(axes as u64)).collect();
    let longer = longer.join(" or ");
    says(
        "README.md",
        &[
            format!("in every tick ({us} us by default)"),
            format!("runs at {mhz} MHz with ticks of {us} us"),
            format!("one adder that serves {} axes", word(AXES as u64)),
        ],
    );
    says(
        "docs/five-minutes.md",
        &[
            format!("It has one adder for {} axes.", word(AXES as u64)),
            format!("a time slot of {TIME_SLOT_CLOCKS} clocks"),
            format!("at {mhz} MHz a tick takes {us} us"),
        ],
    );
    says(
        "docs/engine.md",
        &[
            format!("file is {mhz} MHz with ticks of {us} us."),
            format!("It serves {} axes, or any number", word(AXES as u64)),
            format!("With {} axes a {us} us tick needs {mhz} MHz", word(AXES as u64)),
        ],
    );
    says(
        "docs/machine-files.md",
        &[
            format!("At the default clock of {mhz} MHz the default tick is {tick_ns} ns"),
            format!("At any other clock than {mhz} MHz the default"),
            format!("the machine has {longer} axes, carrystep chooses"),
        ],
    );
}

#[test]
fn pages_give_the_dimensions_of_the_engine() {
    let (slot, last) = (TIME_SLOT_CLOCKS, TIME_SLOT_CLOCKS - 1);
    let [least, middle, most_queue] = QUEUE_DEPTHS;
    let queue = word(least as u64);
    let [most, in_file] = [MAX_CLOCKS, MAX_CLOCKS - 1].map(|clocks| grouped(clocks.into()));
    let time = Timebase::new(FIXED_CLOCK_HZ, 1000, 16).expect("a timebase");
    let (latency, tick) = (time.latency_clocks(), u64::from(time.clocks_per_tick()));
    says(
        "docs/clock-by-clock.md",
        &[
            format!("serves up to {} axes", word(MAX_AXES as u64)),
            format!("in clocks {slot} i .. {slot} i + {last}."),
            format!("The {slot} clocks of a time slot are its *beats* 0 .. {last}."),
            format!("`{slot} N + 2 <= C`"),
            format!("a phase has at least {MIN_CLOCKS_PER_PHASE} clocks"),
            format!("a queue of up to Q segments (Q = {least}, {middle} or {most_queue},"),
            format!("(beat {PUT_BEAT} of that axis' time slot"),
            format!("With `B` samples to debounce, 1 to {MAX_DEBOUNCE_SAMPLES}"),
            format!("L = {} C + {}", latency / tick, latency % tick),
        ],
    );
    says(
        "docs/engine.md",
        &[
            format!("any number from one to {}", word(MAX_AXES as u64)),
            format!("there are more than {}.", word(MAX_AXES as u64)),
            format!("fewer clocks than {slot} for each axis and two more"),
            format!("not from 1 to {most} clocks (in a machine file, up to {in_file})"),
            format!("a queue of {queue} segments costs no logic"),
        ],
    );
    says("docs/index.md", &[format!("serves all axes, up to {}.", word(MAX_AXES as u64))]);
    says("docs/five-minutes.md", &[format!("a queue of {queue} segments for each axis")]);
    says("docs/flow-of-a-move.md", &[format!("Each axis has a queue of {queue} segments")]);
    says(
        "docs/promises.md",
        &[
            format!("*rounds*, of 2 to {MAX_ROUND} ticks"),
            format!("is the {slot} clocks of a tick"),
            format!("{most} clocks for each of STEP_HIGH"),
        ],
    );
}

#[test]
fn machine_file_page_gives_the_ranges_of_the_gateware() {
    let power = MAX_CLOCK_HZ.ilog10();
    assert_eq!(10_u64.pow(power), MAX_CLOCK_HZ);
    let phases = (1..=64_u32).filter(|&phases| Timebase::new(64_000_000, 1000, phases).is_ok());
    let phases: Vec<String> = phases.map(|phases| phases.to_string()).collect();
    let pins = format!("| up to {} clocks |", MAX_CLOCKS - 1);
    says(
        "docs/machine-files.md",
        &[
            format!("| 1 to 10^{power} | frequency"),
            format!("| {MIN_CLOCKS_PER_TICK} to {MAX_CLOCKS} clocks, a whole number |"),
            format!("needs {TIME_SLOT_CLOCKS} clocks per axis plus two"),
            format!("| {}; must divide the clocks of a tick |", phases.join(", ")),
            format!("| 1 to {MAX_AXES} tables |"),
            format!("accept at most {}", word(AXES as u64)),
            format!("*rounds* of 2 to {MAX_ROUND} ticks"),
            format!("time of up to {} rounds each", MAX_ROUNDS - 1),
            format!("time of up to {} rounds.", MAX_DEBOUNCE_SAMPLES - 1),
            format!("over {MIN_BIT_CLOCKS} to {MAX_BIT_CLOCKS}, within {BAUD_PERCENT} %"),
            format!("cannot make the rate within {BAUD_PERCENT} %, the rate is refused"),
        ],
    );
    assert_eq!(pages::joined("docs/machine-files.md").matches(&pins).count(), 4, "{pins}");
}

#[test]
fn pages_give_the_number_formats() {
    let bits = FRACTION_BITS;
    let half = StartPhase::Half.start_value().ilog2();
    assert_eq!((StartPhase::Half.start_value(), StartPhase::Zero.start_value()), (1 << half, 0));
    let ticks = u32::BITS;
    says(
        "README.md",
        &[format!("has {bits} fractional bits, so N steps are the integer N 2^{bits}.")],
    );
    says(
        "docs/five-minutes.md",
        &[
            format!("of these lines, with {bits}-bit integers"),
            format!("P is 2^-{bits} step. N steps are therefore the integer N 2^{bits},"),
        ],
    );
    says(
        "docs/clock-by-clock.md",
        &[
            format!("the running segment: `P V A J` ({bits} bits), `left` ({ticks} bits)"),
            format!("as {bits}-bit unsigned addition"),
            format!("has the start value (2^{half} or 0, a build parameter)"),
        ],
    );
    says(
        "docs/protocol.md",
        &[
            format!("V, A and J are {bits}-bit numbers in two's complement"),
            format!("in units of 2^-{bits} step per tick, per tick^2"),
            format!("is an unsigned {bits}-bit number in 2^-{bits} step."),
            format!("P starts at 2^{half} (half a step)"),
        ],
    );
    says("docs/flow-of-a-move.md", &[format!("P starts at 2^{half}, half a step.")]);
}

/// The cells of the row of `hdl-out/resources.md` that begins with these.
fn measured(first: &[&str]) -> Vec<String> {
    let page = pages::file("hdl-out/resources.md");
    let rows = page.lines().filter_map(|line| line.strip_prefix("| ")?.strip_suffix(" |"));
    let mut rows = rows.map(|row| row.split(" | ").map(str::to_owned).collect::<Vec<_>>());
    let wanted = |row: &Vec<String>| {
        row.len() > first.len() && row.iter().zip(first).all(|(cell, wanted)| cell == wanted)
    };
    rows.find(wanted).unwrap_or_else(|| panic!("no row {first:?}"))
}

/// The number with which a cell begins.
fn number(cell: &str) -> u32 {
    let digits = cell.split(' ').next().unwrap_or_default();
    digits.parse().unwrap_or_else(|_| panic!("{cell}"))
}

/// The first row for this device, with six axes and this tick, ns.
fn row_of(device: &str, tick_ns: u64) -> EngineRow {
    let wanted =
        |row: &EngineRow| row.part.device == device && row.axes == AXES && row.tick_ns == tick_ns;
    ROWS.into_iter().find(wanted).expect("a row")
}

#[test]
fn pages_give_the_sizes_of_the_resources_table() {
    let cells = number(&measured(&["hx8k ct256", "6", "1 us"])[5]);
    let about = format!("It takes about {} logic cells of a small FPGA", (cells + 50) / 100 * 100);
    says("README.md", std::slice::from_ref(&about));
    says("docs/five-minutes.md", &[about]);
    let [two, one] = [2000, 1000].map(|tick_ns| row_of("hx8k", tick_ns).budget.logic_cells);
    let both =
        format!("at most {two} logic cells of an iCE40 HX8K at 2 us ticks and {one} at 1 us");
    says("README.md", &[both]);
    let slow = row_of("up5k", 2000);
    assert!(slow.met && row_of("hx1k", 1000).met);
    says(
        "docs/engine.md",
        &[
            format!("An HX8K runs 1 us ticks in at most {one} logic cells."),
            format!(
                "A UP5K reaches the {} MHz that 2 us ticks need",
                slow.clock_needed_hz() / 1_000_000
            ),
            format!("at most {:.0} % more logic than six", 100.0 * (EIGHT_TO_SIX.2 - 1.0)),
        ],
    );
}

#[test]
fn pages_give_the_size_of_the_link() {
    let [uart, spi] = LINES.map(|line| measured(&[line]));
    let rams = number(&uart[2]);
    assert_eq!(rams, number(&spi[2]), "one sentence gives the block RAMs of both lines");
    let [uart, spi] = [uart, spi].map(|row| number(&row[1]));
    let instructions = (image(false).program.len() + 5) / 10 * 10;
    let budget = LINK_BUDGET.logic_cells;
    says(
        "docs/link.md",
        &[
            format!("take about {instructions} instructions"),
            format!("{uart} logic cells with the UART, {spi} with SPI (the budget is {budget})"),
            format!("With either line it has {} block RAMs", word(rams.into())),
        ],
    );
    says(
        "README.md",
        &[
            format!("about {instructions} instructions]"),
            format!("in {uart} cells with the UART, {spi} with SPI"),
        ],
    );
}

#[test]
fn protocol_page_gives_lengths_and_numbers_of_frames() {
    let read = REQUEST_HEAD + CRC_BYTES;
    let owners_read = read + SESSION_BYTES;
    // With an END before it and one after it.
    let on_the_line = |bytes: usize| bytes + 2;
    let [asked, owner_asked, answered] = [read, owners_read, ANSWER_BYTES].map(on_the_line);
    assert_eq!((answered as f64 / asked as f64).round(), 2.0, "twice");
    says(
        "docs/protocol.md",
        &[
            format!("read sequence | address | CRC {read} bytes"),
            format!("owner's read sequence | address | session (2) | CRC {owners_read} bytes"),
            format!("session (2) | words ... | CRC {} bytes or more", owners_read + 4),
            format!("data (4) | CRC {ANSWER_BYTES} bytes"),
            format!("a frame ends with END (`{END:02X}`)"),
            format!("the byte `{END:02X}` is sent as `{ESC:02X} {ESC_END:02X}`"),
            format!("the byte `{ESC:02X}` as `{ESC:02X} {ESC_ESC:02X}`"),
            format!(
                "a frame of {} or {} bytes is a read",
                word(read as u64),
                word(owners_read as u64)
            ),
            format!("The number is one of the {WINDOW} before `next`"),
            format!("up to {WINDOW} unacknowledged writes"),
            format!("over {WINDOW} a number is not unique any more"),
            format!("have at most {} unanswered reads", word(2 * u64::from(MOST_AXES))),
            format!("| unanswered reads | {MOST_AXES} at most |"),
            format!(
                "a read has {asked} to {owner_asked} bytes and its answer {answered}, so reads that are sent back to back arrive twice as fast"
            ),
            "has room, 0 to `QUEUE_DEPTH`".to_owned(),
            format!(
                "(`QUEUE_DEPTH`, {}, {} or {})",
                QUEUE_DEPTHS[0], QUEUE_DEPTHS[1], QUEUE_DEPTHS[2]
            ),
        ],
    );
    // Ten bits a byte on a UART.
    let words = SEGMENTS_HEAD_WORDS + SEGMENTS_AXIS_WORDS * AXES + 1;
    let bytes = owners_read + 4 * words;
    let most = 3_000_000 / 10 / on_the_line(bytes) / 100 * 100;
    says(
        "docs/performance.md",
        &[
            format!("Segments of {} axes with the same ticks", word(AXES as u64)),
            format!("go in one frame of {bytes} bytes"),
            format!("so the bytes of 3 Mbaud carry at most {most} of them a second"),
        ],
    );
}

#[test]
fn verilog_page_gives_the_default_and_the_targets_of_the_files() {
    let template = pages::file("hdl-out/core/carrystep_uart.veo");
    let (_, rest) = template.split_once(".BIT_CLOCKS(").expect("a parameter");
    let (value, _) = rest.split_once(')').expect("its value");
    let core = pages::file("hdl-out/core/carrystep.core");
    let lint = core.lines().filter(|line| line.starts_with("  lint") && line.ends_with(':'));
    let lint: Vec<&str> = lint.map(|line| line.trim().trim_end_matches(':')).collect();
    let received = template.lines().find(|line| line.contains(".received()")).expect("a port");
    let received = received.split_whitespace().collect::<Vec<_>>().join(" ");
    let mut texts = vec![
        received,
        format!("The {} lines that carry the bytes", word(LINES.len() as u64)),
        format!("contains these modules for {} axes.", word(AXES as u64)),
        format!(".BIT_CLOCKS({value})"),
        format!("ran all {} lint targets", word(lint.len() as u64)),
    ];
    texts.extend(lint.iter().map(|target| format!("`{target}`")));
    says("docs/verilog.md", &texts);
}
