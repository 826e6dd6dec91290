//! Requests that a board cannot satisfy. Each error names what the board has instead.

use super::{Family, boards, names};
use crate::clock::ClockError;
use carrystep_core::link::BaudError;
use carrystep_core::one_of;
use carrystep_core::self_test::SelfTestError;
use carrystep_core::tick::mhz;
use carrystep_files::did_you_mean;
use thiserror::Error;

/// The families with boards whose engines may have several adders, as in `ECP5, Gowin or Spartan-7`.
fn with_several_adders() -> String {
    let mut families: Vec<Family> = boards().iter().map(|board| board.family).collect();
    families.dedup();
    let facts = families.into_iter().map(Family::facts).filter(|it| it.has_several_adders());
    let titles: Vec<String> = facts.map(|facts| facts.title().to_owned()).collect();
    one_of(&titles)
}

/// A request that a board cannot satisfy.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum BoardError {
    /// No board has this name.
    #[error("no board is called '{name}'{}; there are {}", did_you_mean(name, boards().iter().map(|board| &*board.name)), names())]
    Unknown {
        /// The name that was given.
        name: String,
    },
    /// The board is not sold with this part.
    #[error("{board} has no part '{part}'; there is {}", .parts.join(", "))]
    Part {
        /// Name of the board.
        board: String,
        /// The part that was given.
        part: String,
        /// The parts that the board is sold with.
        parts: Vec<String>,
    },
    /// The machine has more axes than the board has pins for.
    #[error(
        "{board} has pins for {has} axes, and none for {}: leave out axes, or take another board", .without.join(", ")
    )]
    Axes {
        /// Name of the board.
        board: String,
        /// Number of axes that have STEP and DIR pins.
        has: usize,
        /// Names of the axes that have no pins: the last ones of the machine file.
        without: Vec<String>,
    },
    /// The machine has several adders, and the board's family keeps one.
    #[error(
        "{board}: an engine in a part of the family {family} has one adder, not {adders}: leave out \
         `adders` in [machine], with a longer tick, or take a board of the family {}",
        with_several_adders()
    )]
    Adders {
        /// Name of the board.
        board: String,
        /// Name of its family.
        family: &'static str,
        /// Number of adders of the machine.
        adders: usize,
    },
    /// The block RAMs of the board's part do not hold the memories of the machine's gateware.
    #[error(
        "{board}: engine and link with adders = {adders} and queue_depth = {depth} take {needs} \
         block RAMs, and its {part} has {has}: {instead}"
    )]
    BlockRams {
        /// Name of the board.
        board: String,
        /// Name of the part.
        part: String,
        /// Number of block RAMs that the part has.
        has: u32,
        /// Number of block RAMs that the gateware needs.
        needs: u32,
        /// Number of adders of the machine.
        adders: usize,
        /// Depth of its queues, segments.
        depth: usize,
        /// What fits, in words.
        instead: String,
    },
    /// The machine has more limit switches than the board has pins for.
    #[error(
        "{board} has pins for {low} switches at low ends and {high} at high ends, too few for {wanted}: {instead}"
    )]
    Limits {
        /// Name of the board.
        board: String,
        /// Number of pins for switches at low ends.
        low: usize,
        /// Number of pins for switches at high ends.
        high: usize,
        /// The switches of the machine, in words.
        wanted: String,
        /// A wiring that the board has pins for.
        instead: &'static str,
    },
    /// The board has no pin for a port.
    #[error("{board} has no pin for {port}")]
    Port {
        /// Name of the board.
        board: String,
        /// Name of the port.
        port: String,
    },
    /// The board has no pins, or too few, for an input or an output.
    #[error(
        "{board} has {has} of the {wanted} pins that this machine needs for {what}: leave some out of [machine.inputs] or [machine.outputs]{}, take another board, or instantiate the engine in a design of your own",
        if *has == 0 { ", use the UART if the machine has an SPI" } else { "" }
    )]
    Unconnected {
        /// Name of the board.
        board: String,
        /// What has no pin, in words.
        what: &'static str,
        /// Number of pins that the board has for it.
        has: usize,
        /// Number of pins that the machine needs.
        wanted: usize,
    },
    /// The board's serial chip does not support this baud rate.
    #[error(
        "{board}'s serial chip takes at most {most} baud, not {wanted}: set `baud` in [machine.link]"
    )]
    Baud {
        /// Name of the board.
        board: String,
        /// The greatest rate that it supports, bits per second.
        most: u32,
        /// The rate of the machine, bits per second.
        wanted: u32,
    },
    /// The board cannot make this clock.
    #[error("{board}: {source}; it is proposed to run at {proposed}")]
    Clock {
        /// Name of the board.
        board: String,
        /// The clock manager's error.
        source: ClockError,
        /// The clocks that the board is known to make.
        proposed: String,
    },
    /// The clock is faster than the board's part was measured to reach.
    #[error(
        "{board}: nextpnr reaches {} MHz with the shipped gateware, far less than the machine's {} MHz; \
         it is proposed to run at {proposed}",
        mhz(*.measured_hz),
        mhz(*.wanted_hz)
    )]
    Slow {
        /// Name of the board.
        board: String,
        /// The clock of the machine, Hz.
        wanted_hz: u64,
        /// The fastest clock that was measured, Hz.
        measured_hz: u64,
        /// The clocks that the board is known to make.
        proposed: String,
    },
    /// The clock does not make the baud rate of self-tests.
    #[error("{board}: {source}; a self-test has this rate")]
    SelfTestBaud {
        /// Name of the board.
        board: String,
        /// The error of the UART.
        source: BaudError,
    },
    /// The board's pins or names do not fit in a self-test.
    #[error("{board}: {source}")]
    SelfTest {
        /// Name of the board.
        board: String,
        /// The error of the self-test.
        source: SelfTestError,
    },
}
