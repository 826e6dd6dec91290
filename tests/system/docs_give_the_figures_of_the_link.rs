//! Figures of the documentation that describe the host link: frames, addresses, block RAMs, and the
//! times of the clients.

use carrystep_core::engine::{ENGINE_PORTS, QUEUE_DEPTHS};
use carrystep_core::link::registers::{
    AXES_AT, CONTROL_ENABLE, CUT, MOST_AXES, OPEN, POSITION, SEGMENT, SEGMENTS, START, STOP,
    of_axis,
};
use carrystep_core::link::{
    ANSWER, ANSWER_BYTES, ANSWER_DATA, CRC_BYTES, DEFAULT_BAUD, REFUSALS, REQUEST_HEAD,
    SEGMENT_FRAME_WORDS, SEGMENTS_AXIS_WORDS, SEGMENTS_HEAD_WORDS, SESSION_BYTES, Uart, WRITE,
};
use carrystep_core::ports::Width;
use carrystep_tests::pages::{part, says, word};
use carrystep_tests::sources::{behind, constant, whole};

#[test]
fn protocol_page_gives_the_addresses_of_the_register_map() {
    let segment = WRITE | of_axis(SEGMENT, 0);
    let axis_of = |address: u8| address & (MOST_AXES - 1);
    let top = (MOST_AXES - 1).ilog2();
    let crc = ANSWER_BYTES - CRC_BYTES;
    assert_eq!(crc, ANSWER_DATA + 4);
    let several = |axes: usize| {
        let words = SEGMENTS_HEAD_WORDS + SEGMENTS_AXIS_WORDS * axes + 1;
        REQUEST_HEAD + SESSION_BYTES + 4 * words + CRC_BYTES
    };
    says(
        "docs/protocol.md",
        &[
            "- **Read**: any address, and no words.".to_owned(),
            format!("- **Write**: the register's address + `{WRITE:02X}`, and one word."),
            format!(
                "- **Segment**: address `{segment:02X} + axis` and {} words:",
                word(SEGMENT_FRAME_WORDS as u64)
            ),
            format!(
                "Addresses from `{:02X}` on are not for writes, except `{:02X}`.",
                segment + MOST_AXES + 1,
                WRITE | CUT
            ),
            format!("- **Segments of several axes**: address `{:02X}`.", WRITE | SEGMENTS),
            format!(
                "{} + {} k bytes: {} for six axes",
                several(0),
                several(1) - several(0),
                several(6)
            ),
            format!("- **`OPEN`** (`{:02X}`)", WRITE | OPEN),
            format!("- **`STOP`** (`{:02X}`)", WRITE | STOP),
            format!("the axis in bits 0 to {top} of the address"),
            format!(
                "After a write below `{segment:02X}` (`CONTROL`, `START`, `CLEAR`, `SEEK`, `SNAPSHOT`, `OPEN`, `STOP`, `LATCH`)"
            ),
            format!("to segments and to reads from `{AXES_AT:02X}` on can"),
            format!("(the answer to its segment, or to a read from `{AXES_AT:02X}` on)"),
            format!("2. Write `CONTROL` = {CONTROL_ENABLE} to power the drivers."),
            format!("Words and the CRC are {CRC_BYTES} bytes each"),
            format!("| {ANSWER_DATA}..{} | | data |", crc - 1),
            format!("| {crc}..{} | | CRC |", ANSWER_BYTES - 1),
        ],
    );
    says("docs/protocol.md", &REFUSALS.map(|why| format!("{} `{why}`: ", why.number())));
    assert!(axis_of(of_axis(POSITION, 5)) == 5 && (WRITE | START) < segment);
}

#[test]
fn protocol_page_gives_the_numbers_of_writes_and_ticks() {
    let next = ANSWER.iter().find(|field| field.name == "next").expect("a field");
    let data = ENGINE_PORTS.iter().find(|port| port.name == "put_data").expect("a port");
    let Width::Bits(bits) = data.width else { panic!("{:?}", data.width) };
    let most = (1_u64 << bits) - 1;
    says(
        "docs/protocol.md",
        &[
            format!("Writes are numbered modulo {}.", 1 << next.bits),
            format!("A segment has 1 to 2^{bits} - 1 ticks: `ticks - 1` = `{most:X}` is a segment"),
        ],
    );
}

#[test]
fn pages_give_the_rates_that_the_test_of_the_link_tries() {
    let test = "tests/system/the_link_talks_as_its_page_says.rs";
    // Half a period of SCK in tenths of a clock.
    let period = 2.0 * behind(test, "for tenths in [") / 10.0;
    let fifth = part(whole(period));
    let baud = whole(behind(test, "Uart::new(48_000_000, "));
    let uart = Uart::new(48_000_000, baud as u32).expect("a UART");
    says(
        "docs/protocol.md",
        &[
            format!("up to a {fifth} of the gateware's clock frequency"),
            format!("({} MHz at 48 MHz)", 48.0 / period),
            format!("a UART of {} clocks per bit or more", uart.bit_clocks()),
        ],
    );
    says(
        "docs/link.md",
        &[format!("back to back at {} Mbaud, and over SPI at a {fifth} of the", baud / 1_000_000)],
    );
    let stranger = behind("crates/virtual-board/tests/stranger.rs", "assert!(count > ");
    says("docs/protocol.md", &[format!("It streams more than {stranger} segments")]);
    // The host has its turn after each millisecond of the board's time.
    let turns = behind("crates/virtual-board/tests/support/mod.rs", "MS: u64 = CLOCK_HZ / ");
    assert_eq!(turns, 1000.0);
    says("docs/performance.md", &["which runs once per millisecond, as over USB".to_owned()]);
    says("docs/virtual-board.md", &[format!("/dev/pts/3: {DEFAULT_BAUD} baud")]);
}

#[test]
fn link_page_gives_the_block_rams_of_each_memory() {
    const RAM: u64 = 256 * 16;
    let rams = |file: &str, name: &str| {
        let source = format!("crates/hdl/src/link/{file}");
        let address = whole(behind(&source, &format!("{name}: Memory<")));
        let bits = whole(behind(&source, &format!("{name}: Memory<{address}, ")));
        ((1_u64 << address) * bits).div_ceil(RAM)
    };
    let small = ["instructions", "data", "ring"].map(|name| rams("processor.rs", name));
    assert_eq!(small, [2, 1, 1]);
    let facts = rams("register_mirror.rs", "known");
    let all = small.iter().sum::<u64>() + facts;
    says(
        "docs/link.md",
        &[
            format!(
                "it has {} block RAMs: two for the program, one each for its data and",
                word(all)
            ),
            format!("that wait, and {} for `facts`.", word(facts)),
        ],
    );
}

#[test]
fn protocol_page_gives_the_time_outs_of_the_rust_client() {
    let host = |text| behind("crates/link/src/host.rs", text);
    let patience =
        |name| behind("crates/link/src/host/time.rs", &format!("\n            {name}: "));
    let session = |text| behind("crates/link/src/session/timing.rs", text);
    let (resend, silence) = (session("Self { resend: "), patience("silence"));
    let period = patience("status_period");
    let watchdog =
        behind("crates/files/src/machine/guard.rs", "unit_ns: 1_000_000,\n    default: ");
    let (tries, share) = (word(whole((silence / resend).floor())), part(whole(watchdog / period)));
    let serial = constant("crates/link/src/line/serial.rs", "AHEAD_MS");
    // Ten bits for each byte that the client holds, and then the bytes that the system may hold.
    let held = host("const OUT: usize = ");
    let wait = |baud: f64| (10.0 * held / baud * 1e3 + serial).round();
    let callers = constant("crates/cli/src/control/control_socket.rs", "CALLERS");
    says(
        "docs/protocol.md",
        &[
            format!("| unacknowledged writes | {} at most", host("const N: usize = ")),
            format!("send again from `next` on | after {resend} ms |"),
            format!("longer than the {resend} ms until a lost frame is sent again"),
            format!("| busy, try again | after {} ms |", session(", pause: ")),
            format!("give up | after {silence} ms, or {} ms once", patience("lost")),
            format!("{tries} tries have failed;"),
            format!("a clear | {} ms at most |", patience("change")),
            format!("nothing to send | every {period} ms | a {share} of"),
            format!("usual watchdog time ({watchdog} ms)"),
            format!("at most {held} bytes and another {serial} ms of the line's time"),
            format!("{} ms at 115 200 baud, {} ms at 921 600", wait(115_200.0), wait(921_600.0)),
            format!("Of more than {callers} idle connections"),
        ],
    );
}

#[test]
fn pages_give_the_margin_of_a_clock_and_the_length_of_an_instruction() {
    let margin = constant("crates/boards/src/reach.rs", "MARGIN_PERCENT");
    says("docs/flashing.md", &[format!("more than {margin} % above the recorded clock")]);
    let clocks = whole(constant("crates/model/src/link/processor.rs", "EXECUTE") + 1.0);
    says("docs/link.md", &[format!("Each instruction takes {} clocks", word(clocks))]);
    let bytes = constant("crates/model/src/link/processor.rs", "SIZE");
    says("docs/link.md", &[format!("the {bytes} received bytes that wait")]);
    says(
        "docs/protocol.md",
        &[format!("up to {} received bytes", bytes - 1.0), format!("all {bytes} are lost")],
    );
}

#[test]
fn architecture_page_gives_the_rate_that_the_test_tries() {
    let rates = "crates/virtual-board/tests/rates.rs";
    let rate = behind(rates, "carries::<ModelBoard>(3_000_000, ");
    says("docs/architecture.md", &[format!("six axes at {rate} segments/s")]);
    let other = behind(rates, "carries::<ModelBoard>(921_600, ");
    let spi = behind(rates, "let per_second = ");
    let waiting = |text: &str| behind(rates, text);
    let (fast, slow) = (
        waiting(&format!("carries::<ModelBoard>(3_000_000, {rate}, 1500, ")),
        waiting(&format!("carries::<ModelBoard>(921_600, {other}, 1500, ")),
    );
    let of_spi = constant(rates, "OVER_SPI");
    let mhz = behind(rates, "Bus::<ModelBoard>::new(") / 1e6;
    let depth = QUEUE_DEPTHS[0];
    let writes = whole(behind(
        "crates/virtual-board/tests/support/bus.rs",
        "Host<SpiLine<Bus<B>>, Bus<B>, ",
    ));
    says(
        "docs/performance.md",
        &[
            format!("| 3 000 000 baud | {rate} | {fast} of {depth} |"),
            format!("| 921 600 baud | {other} | {slow} of {depth} |"),
            format!(
                "| SPI at {mhz} MHz, {} unacknowledged writes | {spi} | {of_spi} of {depth} |",
                word(writes)
            ),
        ],
    );
}
