//! The ports of link and line as the replay on their Verilog names them.

use carrystep_core::AXES;
use carrystep_core::link::{LinkInputs, LinkOutputs};
use carrystep_hdl::line::LineOutputs;
use carrystep_simulators::vectors::{Bits, Vectors};

const MASK: u32 = AXES as u32;

const LINK_INPUTS: &[(&str, u32)] = &[
    ("received_valid", 1),
    ("received", 8),
    ("answer_take", 1),
    ("put_ready", 1),
    ("room_valid", 1),
    ("room", 3),
    ("start_ready", 1),
    ("get_valid", 1),
    ("get_data", 32),
    ("latch", 1),
    ("latch_axis", 3),
    ("fault", 1),
    ("cause", 3),
    ("culprits", MASK),
    ("halted", 1),
    ("idle", 1),
    ("ready", 1),
    ("armed", 1),
    ("homing", MASK),
];

const LINK_OUTPUTS: &[(&str, u32)] = &[
    ("answer_valid", 1),
    ("answer", 8),
    ("put_valid", 1),
    ("put_axis", 3),
    ("put_word", 3),
    ("put_data", 32),
    ("start_valid", 1),
    ("start_mask", MASK),
    ("clear", 1),
    ("stop", 1),
    ("broken", 1),
    ("home_valid", 1),
    ("home_mask", MASK),
    ("kick", 1),
    ("enable", 1),
    ("get_axis", 3),
    ("get_item", 2),
];

const UART_INPUTS: &[(&str, u32)] = &[("rx", 1), ("answer_valid", 1), ("answer", 8)];
const SPI_INPUTS: &[(&str, u32)] =
    &[("sck", 1), ("select_n", 1), ("mosi", 1), ("answer_valid", 1), ("answer", 8)];
const UART_OUTPUTS: &[(&str, u32)] =
    &[("received_valid", 1), ("received", 8), ("answer_take", 1), ("tx", 1)];
const SPI_OUTPUTS: &[(&str, u32)] =
    &[("received_valid", 1), ("received", 8), ("answer_take", 1), ("miso", 1)];

/// An empty recording of a link.
pub const fn link() -> Vectors {
    Vectors::new(LINK_INPUTS, LINK_OUTPUTS)
}

/// An empty recording of a UART.
pub const fn uart() -> Vectors {
    Vectors::new(UART_INPUTS, UART_OUTPUTS)
}

/// An empty recording of an SPI.
pub const fn spi() -> Vectors {
    Vectors::new(SPI_INPUTS, SPI_OUTPUTS)
}

pub(super) fn link_inputs(seen: &LinkInputs, line: LineOutputs) -> Bits {
    let engine = &seen.engine;
    let number = |value: Option<u8>| u64::from(value.unwrap_or(0));
    let (cause, culprits) =
        engine.fault.map_or((0, 0), |(cause, culprits)| (cause as u64, culprits));
    Bits::default()
        .and(1, u64::from(line.received.is_some()))
        .and(8, number(line.received))
        .and(1, u64::from(line.take))
        .and(1, u64::from(engine.put_ready))
        .and(1, u64::from(engine.room.is_some()))
        .and(3, number(engine.room))
        .and(1, u64::from(engine.start_ready))
        .and(1, u64::from(seen.get_valid))
        .and(32, u64::from(seen.get_data))
        .and(1, u64::from(engine.latch.is_some()))
        .and(3, number(engine.latch))
        .and(1, u64::from(engine.fault.is_some()))
        .and(3, cause)
        .and(MASK, u64::from(culprits))
        .and(1, u64::from(engine.halted))
        .and(1, u64::from(engine.idle))
        .and(1, u64::from(engine.ready))
        .and(1, u64::from(engine.armed))
        .and(MASK, u64::from(engine.homing))
}

pub(super) fn link_outputs(shown: &LinkOutputs, offered: Option<u8>) -> Bits {
    let engine = &shown.engine;
    Bits::default()
        .and(1, u64::from(offered.is_some()))
        .and(8, offered.map(u64::from))
        .and(1, u64::from(engine.put.is_some()))
        .and(3, u64::from(engine.put.map_or(engine.room_of, |put| put.axis)))
        .and(3, engine.put.map(|put| put.word.into()))
        .and(32, engine.put.map(|put| put.data.into()))
        .and(1, u64::from(engine.start.is_some()))
        .and(MASK, engine.start.map(u64::from))
        .and(1, u64::from(engine.clear))
        .and(1, u64::from(engine.stop))
        .and(1, u64::from(engine.broken))
        .and(1, u64::from(engine.home.is_some()))
        .and(MASK, engine.home.map(u64::from))
        .and(1, u64::from(engine.kick))
        .and(1, u64::from(engine.enable))
        .and(3, u64::from(shown.get_axis))
        .and(2, u64::from(shown.get_item))
}

pub(super) fn line_outputs(line: LineOutputs, level: bool) -> Bits {
    Bits::default()
        .and(1, u64::from(line.received.is_some()))
        .and(8, line.received.map(u64::from))
        .and(1, u64::from(line.take))
        .and(1, u64::from(level))
}
