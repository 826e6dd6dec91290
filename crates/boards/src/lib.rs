//! Boards as data: the parts on a board, the function of each pin, and the clocks that it can make.
//! Each board is one file of `data/boards/`, which the build script lists.
//!
//! A new board of a known family is its file; `cargo xtask long boards` measures it, and `cargo
//! xtask generate` writes its pages and its directory. A new family is a variant of [`Family`], a
//! file of `family/` and its templates. If no known clock manager and no known program fits it, it
//! needs these too: `clock.rs` with a file of `clock/`, and `crates/tools/src/programs.rs`.

use crate::clock::ClockManager;
use carrystep_core::EngineBuild;
use carrystep_core::engine::{Latch, LatchSource, LimitWiring};
use carrystep_core::link::{BaudError, Uart};
use carrystep_files::error::{InputError, SourceText};
use schemars::JsonSchema;
use serde::Serialize;
use std::path::Path;
use std::sync::LazyLock;

mod block_rams;
pub mod clock;
mod configuration;
mod error;
mod family;
mod measured;
mod port;
mod raw;
mod reach;
mod self_test;
mod toolchain;

pub use block_rams::{Blocks, block_rams};
pub use configuration::{ConfigurationMode, Gate, Shared};
pub use error::BoardError;
pub use family::{
    BlockRam, Family, FpgaFamily, Ice40Synthesis, IoStandard, Part, Placer, PllInput, PullUp,
    PullUps,
};
pub use measured::{AllMeasured, MEASURED_AT, Mapped, Measured, Placed};
pub use port::{BoardPort, OSCILLATOR, PORTS, Way};
pub use self_test::{BoardSelfTest, SELF_TEST_BAUD};
pub use toolchain::{ISE, Toolchain};

/// The baud rates that are proposed, the fastest first: rates that USB serial chips make exactly,
/// and the usual ones.
pub const BAUDS: [u32; 7] = [3_000_000, 2_000_000, 1_500_000, 1_000_000, 500_000, 230_400, 115_200];

/// The boards' files in the order of their names: path in this crate, and text.
const DATA: &[(&str, &str)] = &include!(concat!(env!("OUT_DIR"), "/boards.rs"));

/// A board. All entries of its file have been checked against each other.
#[derive(Debug, Clone, PartialEq, Eq, JsonSchema, Serialize)]
pub struct Board {
    /// Name of the board on the command line.
    pub name: String,
    /// Full name, as its maker uses it.
    pub title: String,
    /// FPGA family, which determines toolchain and clock manager.
    pub family: Family,
    /// The parts that it is sold with; the first is the default.
    pub parts: Vec<Part>,
    /// The external oscillator.
    pub oscillator: Oscillator,
    /// The clocks that are proposed; the first is the default.
    pub clocks: Vec<Clocking>,
    /// Segments in the queue of an axis of a machine that is made for the board: the deepest queue
    /// that fits its parts, with which the first clock is reached; 7 if its file names none.
    pub queue_depth: usize,
    /// Electrical standard of the gateware's pins.
    pub io: IoStandard,
    /// How the oscillator reaches an iCE40's PLL.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pll: Option<PllInput>,
    /// VCCAUX of a Spartan-6, V. The default of ISE is 2.5 V.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub vccaux: Option<String>,
    /// The pin of each port of the top level, in the order of [`PORTS`].
    pub wires: Vec<Wire>,
    /// Pins that must be driven although the gateware does not use them.
    pub ties: Vec<Tie>,
    /// Modes in which its bitstream may be loaded, besides JTAG.
    pub configured: Vec<ConfigurationMode>,
    /// The ports that are on configuration pins, and why this does no harm.
    pub shared: Vec<Shared>,
    /// Sources of the tables of configuration pins.
    pub configuration_sources: Vec<String>,
    /// The gate: an input that determines when some lines of the board may be driven.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gate: Option<Gate>,
    /// Whether the LED lights while its pin is low.
    pub led_low: bool,
    /// Greatest baud rate of the serial chip, if it is less than the fastest of [`BAUDS`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_baud: Option<u32>,
    /// The command that loads the bitstream; `FILE` stands for its path.
    pub flash: String,
    /// Extension of the bitstream.
    pub bitstream: String,
    /// Additional options of ISE's `bitgen`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bitgen: Option<String>,
    /// Vendor and product id of the USB chip, such as `0403:6010`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub usb: Option<String>,
    /// Notes for the user.
    pub notes: Vec<String>,
    /// Contradictions between the sources.
    pub conflicts: Vec<String>,
    /// Repository, commit and file of each source.
    pub sources: Vec<String>,
}

/// The external oscillator.
#[derive(Debug, Clone, PartialEq, Eq, JsonSchema, Serialize)]
pub struct Oscillator {
    /// Pin of the package.
    pub pin: String,
    /// Hz.
    pub hz: u64,
    /// Electrical standard of its pin.
    pub io: IoStandard,
}

/// A clock that is proposed for a board, with its tick and phases.
#[derive(Debug, Clone, PartialEq, Eq, JsonSchema, Serialize)]
pub struct Clocking {
    /// Hz.
    pub clock_hz: u64,
    /// Tick, ns.
    pub tick_ns: u64,
    /// Phases of a tick: 1, 4 or 16.
    pub phases: u32,
    /// Settings of the clock manager that make it from the oscillator.
    pub made_by: ClockManager,
    /// Why this clock is proposed.
    pub why: String,
}

/// The pin of one bit of a port.
#[derive(Debug, Clone, PartialEq, Eq, JsonSchema, Serialize)]
pub struct Wire {
    /// The bit, such as `uart_rx` or `step[0]`.
    pub port: String,
    /// Pin of the package.
    pub pin: String,
    /// Place of the pin on a connector, if it is on one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at: Option<Place>,
    /// Electrical standard of the pin, if it differs from that of the board.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub io: Option<IoStandard>,
    /// Whether the pin may be that of an SPI port, so that the port exists only if the host uses
    /// the UART.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub beside_uart: bool,
}

/// A pin of a connector.
#[derive(Debug, Clone, PartialEq, Eq, JsonSchema, Serialize)]
pub struct Place {
    /// Name of the connector.
    pub connector: String,
    /// Label of the pin.
    pub label: String,
}

/// A pin that is always driven to the same level.
#[derive(Debug, Clone, PartialEq, Eq, JsonSchema, Serialize)]
pub struct Tie {
    /// Name of its port of the top level.
    pub port: String,
    /// Pin of the package.
    pub pin: String,
    /// Level, 0 or 1.
    pub level: u8,
    /// Purpose.
    pub why: String,
}

/// All boards that carrystep ships, by family and name.
pub fn boards() -> &'static [Board] {
    static BOARDS: LazyLock<Vec<Board>> = LazyLock::new(|| {
        let read = |&(path, text): &(&str, &str)| {
            let source = SourceText { path: path.into(), text: text.into() };
            Board::from_source(&source).unwrap_or_else(|error| unreachable!("{error}"))
        };
        let mut boards: Vec<Board> = DATA.iter().map(read).collect();
        boards.sort_by(|a, b| (a.family, &a.name).cmp(&(b.family, &b.name)));
        boards
    });
    &BOARDS
}

/// The names of all boards, for messages.
fn names() -> String {
    let names: Vec<&str> = boards().iter().map(|board| board.name.as_str()).collect();
    names.join(", ")
}

/// The board of this name.
///
/// # Errors
/// [`BoardError::Unknown`] if there is none; it names the boards that exist.
pub fn board(name: &str) -> Result<&'static Board, BoardError> {
    boards()
        .iter()
        .find(|board| board.name == name)
        .ok_or_else(|| BoardError::Unknown { name: name.to_owned() })
}

impl Board {
    /// Reads a user's own board file.
    ///
    /// # Errors
    /// [`InputError`] with file, line and column of the first mistake.
    pub fn load(path: &Path) -> Result<Self, InputError> {
        Self::from_source(&SourceText::read(path)?)
    }

    /// Checks the text of a board file.
    ///
    /// # Errors
    /// [`InputError`] with file, line and column of the first mistake.
    pub fn from_source(source: &SourceText) -> Result<Self, InputError> {
        raw::read(source)
    }

    /// The part of this name, or the default part if no name is given.
    ///
    /// # Errors
    /// [`BoardError::Part`] if the board is not sold with it; it names the parts that exist.
    pub fn part(&self, name: Option<&str>) -> Result<&Part, BoardError> {
        let found = self.parts.iter().find(|part| name.is_none_or(|name| part.name == name));
        found.ok_or_else(|| BoardError::Part {
            board: self.name.clone(),
            part: name.unwrap_or_default().to_owned(),
            parts: self.parts.iter().map(|part| part.name.clone()).collect(),
        })
    }

    /// The clock manager's settings for this clock, Hz.
    ///
    /// # Errors
    /// [`BoardError::Clock`] if it cannot be made; it names the nearest possible clock.
    pub fn clock(&self, clock_hz: u64) -> Result<ClockManager, BoardError> {
        self.family.facts().clock_managers().solve(self.oscillator.hz, clock_hz).map_err(|source| {
            BoardError::Clock { board: self.name.clone(), source, proposed: self.proposed(None) }
        })
    }

    /// The UART with the fastest of the [`BAUDS`] that this clock (Hz) makes within 2 % and that
    /// the board's serial chip supports.
    ///
    /// # Errors
    /// [`BaudError`] if there is no such rate.
    pub fn uart(&self, clock_hz: u64) -> Result<Uart, BaudError> {
        let most = self.max_baud.unwrap_or(BAUDS[0]);
        let made = BAUDS
            .into_iter()
            .filter(|baud| *baud <= most)
            .find_map(|baud| Uart::new(clock_hz, baud).ok());
        made.map_or_else(|| Uart::new(clock_hz, most), Ok)
    }

    /// Checks that the board's serial chip supports this baud rate, bits per second.
    ///
    /// # Errors
    /// [`BoardError::Baud`] names the greatest rate that it supports.
    pub fn takes(&self, baud: u32) -> Result<(), BoardError> {
        match self.max_baud {
            Some(most) if most < baud => {
                Err(BoardError::Baud { board: self.name.clone(), most, wanted: baud })
            }
            _ => Ok(()),
        }
    }

    /// Checks that the board has pins for the axes of these names and for their limit switches.
    ///
    /// # Errors
    /// [`BoardError::Axes`] or [`BoardError::Limits`] if not; each gives the number of pins.
    pub fn carries(&self, axes: &[&str], limits: LimitWiring) -> Result<(), BoardError> {
        let board = || self.name.clone();
        let has = self.bits("step");
        if axes.len() > has {
            let without = axes[has..].iter().map(|name| format!("'{name}'")).collect();
            return Err(BoardError::Axes { board: board(), has, without });
        }
        let axes = axes.len();
        let (low, high) = (self.bits("limit_min"), self.bits("limit_max"));
        let (needs_low, needs_high, wanted) = match limits {
            LimitWiring::None => (0, 0, String::new()),
            LimitWiring::One => (1, 0, "one for all axes".to_owned()),
            LimitWiring::Each => (axes, 0, format!("one for each of {axes} axes")),
            LimitWiring::Pair => (axes, axes, format!("two for each of {axes} axes")),
        };
        if needs_low <= low && needs_high <= high {
            return Ok(());
        }
        let instead = if axes <= low {
            "limits = \"each\" or \"one\" would do"
        } else {
            "limits = \"one\" would do"
        };
        Err(BoardError::Limits { board: board(), low, high, wanted, instead })
    }

    /// Checks that engines of the board's family may have this number of adders.
    ///
    /// # Errors
    /// [`BoardError::Adders`] if not.
    pub fn has_adders(&self, adders: usize) -> Result<(), BoardError> {
        let facts = self.family.facts();
        if adders == 1 || facts.has_several_adders() {
            return Ok(());
        }
        Err(BoardError::Adders { board: self.name.clone(), family: facts.title(), adders })
    }

    /// Checks that the board has pins for all inputs and outputs of this build besides e-stop and
    /// limits. `uart` says whether the host uses the UART: then they may be the pins of the SPI.
    ///
    /// # Errors
    /// [`BoardError::Unconnected`] names the first one for which it has none.
    pub fn connects(&self, build: &EngineBuild, uart: bool) -> Result<(), BoardError> {
        let [first, second] = build.guard.inputs.map(|row| row.exist);
        let general = ((first & !1).count_ones() + (second & !1).count_ones()) as usize;
        let outputs = build.outputs.exist.count_ones() as usize;
        let own = |latch: &&Latch| latch.source == LatchSource::Pin;
        let latches = build.guard.latches.iter().filter(own).count();
        let needs = [
            ("probe", (first & 1).into(), "the probe"),
            ("interlock", (second & 1).into(), "the interlock"),
            ("general", general, "general inputs"),
            ("latch", latches, if latches > 1 { "latches" } else { "the latch" }),
            ("outputs", outputs, "outputs"),
            ("pwm", (build.outputs.pwm_divider != 0).into(), "the PWM"),
        ];
        for (port, wanted, what) in needs {
            let wires = self.wires.iter().filter(|wire| uart || !wire.beside_uart);
            let has = wires.filter(|wire| wire.port.split('[').next() == Some(port)).count();
            if has < wanted {
                let board = self.name.clone();
                return Err(BoardError::Unconnected { board, what, has, wanted });
            }
        }
        Ok(())
    }

    /// The wire of one bit of a port, such as `step[0]`.
    ///
    /// # Errors
    /// [`BoardError::Port`] if this board has no pin for it.
    pub fn wire(&self, port: &str) -> Result<&Wire, BoardError> {
        let found = self.wires.iter().find(|wire| wire.port == port);
        found.ok_or_else(|| BoardError::Port { board: self.name.clone(), port: port.to_owned() })
    }

    /// The number of bits of a port that have a pin.
    pub fn bits(&self, port: &str) -> usize {
        self.wires.iter().filter(|wire| wire.port.split('[').next() == Some(port)).count()
    }
}
