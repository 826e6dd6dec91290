//! Tests of the boards: all files are valid, and a request that a board cannot satisfy is refused
//! with alternatives.

#![allow(clippy::unwrap_used)] // a test may panic

use carrystep_boards::{
    Board, ConfigurationMode, Measured, OSCILLATOR, PORTS, Placer, board, boards,
};
use carrystep_core::engine::{Latch, LimitWiring, Outputs};
use carrystep_core::{AXES, Build, EngineBuild, PinTiming, StartPhase, Timebase};
use std::path::Path;

/// Names of the axes of a machine.
const NAMES: [&str; 8] = ["x", "y", "z", "a", "b", "c", "u", "v"];

/// Every file of the folder is a board, and has the name of its board.
#[test]
fn every_file_is_listed_once_by_family_and_name() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/boards");
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut files: Vec<String> =
        files.map(|file| file.file_stem().unwrap().to_str().unwrap().to_owned()).collect();
    let mut names: Vec<&str> = boards().iter().map(|board| board.name.as_str()).collect();
    assert!(names.iter().all(|name| board(name).unwrap().name == *name));
    assert!(boards().is_sorted_by_key(|board| (board.family, &board.name)));
    files.sort();
    names.sort();
    assert_eq!(names, files);
    assert!(names.len() >= 14, "a board is gone: {names:?}");
}

#[test]
fn every_board_carries_six_axes_at_each_proposed_clock() {
    for board in boards() {
        board.carries(&NAMES[..6], LimitWiring::Each).unwrap();
        for clock in &board.clocks {
            assert_eq!(board.clock(clock.clock_hz).unwrap(), clock.made_by, "{}", board.name);
        }
        assert_eq!(board.oscillator.io.millivolts(), board.io.millivolts());
    }
}

#[test]
fn no_pin_is_used_twice_and_every_wire_belongs_to_a_port() {
    for board in boards() {
        // With the UART, the pins of the SPI may be those of other ports.
        for uart in [false, true] {
            let wires = board.wires.iter().filter(|wire| {
                if uart { !wire.port.starts_with("spi_") } else { !wire.beside_uart }
            });
            let pins = wires.map(|wire| &wire.pin).chain(board.ties.iter().map(|tie| &tie.pin));
            let mut pins: Vec<&String> = pins.chain([&board.oscillator.pin]).collect();
            let all = pins.len();
            pins.sort();
            pins.dedup();
            assert_eq!(pins.len(), all, "{}", board.name);
        }
        for wire in &board.wires {
            let name = wire.port.split('[').next().unwrap();
            assert!(PORTS.iter().any(|port| port.name == name) && name != OSCILLATOR);
        }
    }
}

/// A port on a pin that a configuration mode of the board uses has a reason. No STEP, DIR or ENABLE
/// is on a pin that has a function in every mode.
#[test]
fn ports_on_configuration_pins_are_listed_with_the_reason() {
    let mut listed = 0;
    for board in boards() {
        for shared in &board.shared {
            listed += 1;
            let now = shared
                .modes
                .iter()
                .any(|mode| *mode == ConfigurationMode::Any || board.configured.contains(mode));
            assert!(!now || shared.why.is_some(), "{}: {shared:?}", board.name);
            let motion =
                ["step", "dir", "enable_n"].iter().any(|name| shared.port.starts_with(name));
            assert!(!(now && motion), "{}: {shared:?}", board.name);
        }
    }
    assert!(listed > 20, "{listed}");
    let on = |name, port| board(name).unwrap().shared.iter().find(|shared| shared.port == port);
    assert_eq!(
        on("mojo-v3", "uart_tx").map(|shared| (shared.function.as_str(), shared.why.is_some())),
        Some(("D10", false))
    );
    assert_eq!(
        on("mojo-v3", "spi_miso").map(|shared| (shared.function.as_str(), shared.why.is_some())),
        Some(("D4", true))
    );
    assert_eq!(on("papilio-one", "step[2]"), None);
    assert_eq!(on("icestick", "uart_tx"), None);
}

#[test]
fn request_that_a_board_cannot_satisfy_is_refused_with_alternatives() {
    let icestick = board("icestick").unwrap();
    let said = |error: &dyn std::error::Error| error.to_string();
    let unknown = said(&board("icestik").unwrap_err());
    let names: Vec<&str> = boards().iter().map(|board| board.name.as_str()).collect();
    assert_eq!(
        unknown,
        format!(
            "no board is called 'icestik' (did you mean 'icestick'?); there are {}",
            names.join(", ")
        )
    );
    let s3board = board("s3board").unwrap();
    assert_eq!(s3board.part(None).unwrap().ordered(), "xc3s400-ft256-4");
    assert_eq!(
        said(&s3board.part(Some("xc3s50")).unwrap_err()),
        "s3board has no part 'xc3s50'; there is xc3s400, xc3s200, xc3s1000"
    );
    assert_eq!(
        said(&icestick.carries(&NAMES, LimitWiring::None).unwrap_err()),
        "icestick has pins for 6 axes, and none for 'u', 'v': leave out axes, or take another board"
    );
    assert_eq!(
        said(&icestick.carries(&NAMES[..6], LimitWiring::Pair).unwrap_err()),
        "icestick has pins for 6 switches at low ends and 0 at high ends, too few for two for each of 6 axes: \
         limits = \"each\" or \"one\" would do"
    );
    assert_eq!(
        said(&icestick.wire("limit_max[0]").unwrap_err()),
        "icestick has no pin for limit_max[0]"
    );
    assert_eq!(
        said(&icestick.clock(40_000_000).unwrap_err()),
        "icestick: the PLL makes no clock of 40 MHz from 12 MHz; the nearest that it makes is 39.75 MHz; it is proposed \
         to run at 48 MHz (ticks of 2000 ns in 16 phases) or 75 MHz (ticks of 1280 ns in 16 phases)"
    );
}

/// 37.5 MHz cannot make 3 Mbaud within 2 %.
#[test]
fn default_baud_rate_of_a_board_is_the_fastest_that_its_clock_makes() {
    let default = |name| {
        let board: &Board = board(name).unwrap();
        let uart = board.uart(board.clocks[0].clock_hz).unwrap();
        (uart.baud(), uart.bit_clocks())
    };
    assert_eq!(default("icestick"), (3_000_000, 16));
    assert_eq!(default("icebreaker"), (2_000_000, 19));
    assert_eq!(default("alchitry-cu"), (3_000_000, 27));
    assert_eq!(default("s3board"), (115_200, 347));
    for board in boards() {
        assert!(
            board.clocks.iter().all(|clock| board.uart(clock.clock_hz).is_ok()),
            "{}",
            board.name
        );
    }
    assert!(board("s3board").unwrap().uart(500_000).is_err());
}

/// The pins of the SPI are those of inputs and outputs where the host uses the UART.
#[test]
fn boards_connect_inputs_and_outputs_that_they_have_pins_for() {
    let timebase = Timebase::new(48_000_000, 2000, 16).unwrap();
    let build = Build { timebase, phase: StartPhase::Half, pins: [PinTiming::SHORTEST; AXES] };
    let build = |probe: bool, general: u8, latch: bool, exist: u8, pwm_divider: u32| {
        let mut build = EngineBuild::minimal(&build, 1);
        build.guard.inputs[0].exist = u8::from(probe) | general << 1;
        build.guard.latches = latch.then(|| Latch::of_pin(false, 1)).into_iter().collect();
        build.outputs = Outputs { exist, pwm_divider, off_at_ramps: true };
        build
    };
    let (icestick, hx8k) = (board("icestick").unwrap(), board("hx8k-evn").unwrap());
    let small = build(true, 0, false, 3, 0);
    assert_eq!(icestick.connects(&small, true), Ok(()));
    assert_eq!(hx8k.connects(&build(true, 15, true, 15, 1), false), Ok(()));
    for (build, uart, missing) in [
        (small, false, "0 of the 1 pins that this machine needs for the probe"),
        (
            build(false, 1, false, 0, 0),
            true,
            "0 of the 1 pins that this machine needs for general inputs",
        ),
        (
            build(false, 0, true, 0, 0),
            true,
            "0 of the 1 pins that this machine needs for the latch",
        ),
        (build(false, 0, false, 7, 0), true, "2 of the 3 pins that this machine needs for outputs"),
        (build(false, 0, false, 0, 1), true, "0 of the 1 pins that this machine needs for the PWM"),
    ] {
        let refused = icestick.connects(&build, uart).unwrap_err().to_string();
        assert!(refused.starts_with(&format!("icestick has {missing}: leave")), "{refused}");
    }
}

#[test]
fn every_board_was_measured_and_is_large_enough() {
    for board in boards() {
        let (rams, of) = match board.measured().expect(&board.name) {
            Measured::Placed(placed) => {
                assert!(
                    placed.logic_cells <= board.parts[0].logic_cells.unwrap(),
                    "{}",
                    board.name
                );
                assert!(
                    placed.nextpnr_mhz * 1e6 >= board.clocks[0].clock_hz as f64,
                    "{}",
                    board.name
                );
                let with_each_seed =
                    placed.least_mhz.is_none_or(|mhz| mhz * 1e6 >= board.clocks[0].clock_hz as f64);
                assert!(with_each_seed, "{}", board.name);
                let needs = board.family.facts().placer().is_some_and(Placer::needs_each_seed);
                assert_eq!(placed.least_mhz.is_some(), needs, "{}", board.name);
                (placed.block_rams, board.parts[0].block_rams)
            }
            Measured::Mapped(mapped) => (mapped.block_rams, board.parts[0].block_rams),
        };
        assert!(rams <= of, "{}", board.name);
    }
}

#[test]
fn every_board_passes_the_check_at_its_own_clocks() {
    for board in boards() {
        for clock in &board.clocks {
            board.may_reach(&board.parts[0], clock.clock_hz, 6).unwrap();
        }
    }
}

#[test]
fn clock_far_too_fast_is_refused_with_the_clocks_of_the_board() {
    let icebreaker = board("icebreaker").unwrap();
    let refused = |axes| {
        icebreaker.may_reach(&icebreaker.parts[0], 48_000_000, axes).unwrap_err().to_string()
    };
    let said = refused(6);
    assert!(
        said.ends_with(
            "37.5 MHz (ticks of 2560 ns in 16 phases) or 30 MHz (ticks of 3200 ns in 16 phases)"
        ),
        "{said}"
    );
    // The time slots of eight axes need 106 clocks.
    assert!(refused(8).contains("37.5 MHz (ticks of 3840 ns"), "{}", refused(8));
}
