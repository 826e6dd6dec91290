//! Tests of what a board file may say: each kind of mistake is refused at its place.

#![allow(clippy::unwrap_used)] // a test may panic

use carrystep_boards::Board;
use carrystep_files::{InputError, SourceText};

const ICESTICK: &str = include_str!("../data/boards/icestick.toml");
const MOJO: &str = include_str!("../data/boards/mojo-v3.toml");
const PAPILIO_PRO: &str = include_str!("../data/boards/papilio-pro.toml");

fn read(text: &str) -> Result<Board, InputError> {
    Board::from_source(&SourceText { path: "board.toml".into(), text: text.into() })
}

/// If carrystep has no table of a package, the board's own file can contain one.
#[test]
fn board_file_may_contain_the_table_of_its_package() {
    let own = ICESTICK.replace("package = \"tq144\"", "package = \"own\"");
    assert!(
        read(&own)
            .unwrap_err()
            .message
            .contains("the configuration pins of hx1k in own are not known")
    );
    let table = "\n[[package]]\nname = \"own\"\nparts = [\"hx1k\"]\nsources = [\"data sheet\"]\n[package.spi]\n71 = \"SS\"\n";
    let with_table = read(&(own.clone() + table)).unwrap();
    assert_eq!(with_table.configuration_sources, ["data sheet"]);
    let refused = read(&(own + &table.replace("71", "8"))).unwrap_err();
    assert!(
        refused.message.contains("uart_tx is on 8, which is SS in configuration (SPI)"),
        "{refused}"
    );
}

/// Columns of each row: the text in the file, its replacement, words of the error message, and the
/// text at the error's place.
#[test]
fn mistake_in_a_board_file_is_refused_at_its_place() {
    let rows = [
        (ICESTICK, "\"J1_4\",", "\"J1_3\",", "pin 112 is taken: step[0]", "\"J1_3\", \"J1_5\""),
        (
            ICESTICK,
            "uart_rx = \"9\"",
            "uart_rx = \"21\"",
            "pin 21 is taken: the oscillator",
            "\"21\"\nuart",
        ),
        (
            ICESTICK,
            "estop = \"J1_10\"",
            "estop = \"J1_11\"",
            "no connector has a pin labelled 'J1_11'",
            "\"J1_11\"",
        ),
        (ICESTICK, "enable_n = ", "enabled = ", "no port is called 'enabled'", "enabled = "),
        (
            ICESTICK,
            "enable_n = \"J1_9\"",
            "enable_n = [\"J1_9\"]",
            "enable_n is one pin",
            "[\"J1_9\"]",
        ),
        (
            ICESTICK,
            "led = \"95\"",
            "led = 95",
            "expected a pin in quotes, or a list of them",
            "95\n",
        ),
        (
            ICESTICK,
            "clock_hz = 48_000_000",
            "clock_hz = 40_000_000",
            "the nearest that it makes is 39.75 MHz",
            "40_000_000",
        ),
        (
            ICESTICK,
            "tick_ns = 2000",
            "tick_ns = 1000",
            "6 axes need 13 clocks each",
            "[[timebase]]",
        ),
        (ICESTICK, "pll = \"core\"\n", "", "an iCE40 needs `pll`", "\"ice40\""),
        (
            ICESTICK,
            "family = \"ice40\"",
            "family = \"ice50\"",
            "unknown variant `ice50`",
            "\"ice50\"",
        ),
        (ICESTICK, "logic_cells = 1280", "speed = 4", "an iCE40 has none", "[[part]]"),
        (
            ICESTICK,
            "hz = 12_000_000",
            "hz = 12_000_000\nio = \"LVCMOS25\"",
            "LVCMOS25 beside pins of LVCMOS33",
            "\"LVCMOS25\"",
        ),
        (
            ICESTICK,
            "usb = \"0403:6010\"",
            "usb = \"6010\"",
            "vendor and product are expected",
            "\"6010\"",
        ),
        (ICESTICK, "iceprog FILE", "iceprog", "has no FILE in it", "\"iceprog\""),
        (
            ICESTICK,
            "led = \"95\"",
            "led = \"95\"\nestop = \"96\"",
            "estop stands in two tables of pins",
            "estop = \"96\"",
        ),
        (PAPILIO_PRO, "vccaux = \"3.3\"\n", "", "a Spartan-6 needs `vccaux`", "\"spartan6\""),
        (PAPILIO_PRO, "\nspeed = 2", "", "all parts but an iCE40 need a `speed` grade", "[[part]]"),
        (
            PAPILIO_PRO,
            "step = [\"C4\"",
            "step = [\"A7\"",
            "step[0] is on P75, which is AWAKE in configuration (every mode)",
            "\"A7\"",
        ),
        (
            PAPILIO_PRO,
            "\"C5\"",
            "\"B10\"",
            "step[1] is on P62, which is MISO2/D1 in configuration (SPI)",
            "\"B10\"",
        ),
        (
            PAPILIO_PRO,
            "enable_n = \"C10\"",
            "enable_n = \"B8\"",
            "enable_n is on P74, which is DOUT/BUSY",
            "\"B8\"",
        ),
        (
            PAPILIO_PRO,
            "configured = [\"spi\"]",
            "configured = []",
            "the modes in which the board is configured",
            "[]",
        ),
        (
            PAPILIO_PRO,
            "tqg144",
            "csg324",
            "the configuration pins of xc6slx9 in csg324 are not known",
            "[[part]]",
        ),
        (
            MOJO,
            "\"P9\", \"P142\"",
            "\"P144\", \"P142\"",
            "step[0] is on P144, which is HSWAPEN",
            "\"P144\", \"P142\"",
        ),
        (
            MOJO,
            "pins = [\"P55\"]",
            "pins = [\"P55\", \"P8\"]",
            "no port is on the configuration pin P8",
            "\"P8\"]",
        ),
        (
            MOJO,
            "pins = [\"P43\", ",
            "pins = [",
            "spi_sck is on P43, which is D6 in configuration",
            "\"P43\"",
        ),
        (MOJO, "holds = [\"uart_tx\", ", "holds = [", "the gate does not hold uart_tx", "\"P70\""),
        (
            MOJO,
            "\"spi_miso\"]",
            "\"spi_miso\", \"led\"]",
            "a gate can hold uart_tx and spi_miso, not 'led'",
            "\"led\"",
        ),
        (
            MOJO,
            "port = \"cclk\"",
            "port = \"estop\"",
            "the gate needs a port of its own",
            "\"estop\"",
        ),
        (MOJO, "pin = \"P70\"", "pin = \"P59\"", "pin P59 is taken: uart_tx", "\"P59\""),
        (
            PAPILIO_PRO,
            "led = \"P112\"",
            "led = \"P144\"",
            "pin P144 is taken: reserved: tied",
            "\"P144\"",
        ),
    ];
    for (text, old, new, says, place) in rows {
        assert!(text.contains(old), "the text is gone: {old}");
        let text = text.replacen(old, new, 1);
        let error = read(&text).expect_err(says);
        assert!(error.message.contains(says), "{says}: {error}");
        let (_, span) = error.place.as_ref().unwrap();
        assert!(text[span.start..].starts_with(place), "{says}: {error}");
    }
}

#[test]
fn board_needs_whole_axes_a_host_and_an_estop() {
    let rows = [
        ("\"J1_3\", ", "5 pins for `step` and 6 for `dir`"),
        ("uart_rx = \"9\"\n", "a host needs both pins of a UART, or all four of an SPI"),
        ("spi_sck = \"PMOD4\"\n", "a host needs both pins of a UART, or all four of an SPI"),
        ("estop = \"J1_10\"\n", "without a pin for the e-stop"),
    ];
    for (gone, says) in rows {
        let error = read(&ICESTICK.replacen(gone, "", 1)).expect_err(says);
        assert!(error.message.contains(says), "{error}");
    }
}
