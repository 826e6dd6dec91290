//! Reads a board's file and checks it.

use super::configuration::{ConfigurationMode, Package};
use super::{Board, Clocking, Family, IoStandard, Oscillator, Part, PllInput, Tie};
use carrystep_core::build::Timebase;
use carrystep_core::engine::{MAX_AXES, QUEUE_DEPTHS, check_schedule};
use carrystep_files::error::{InputError, SourceText};
use configuration::{Exception, RESERVED, RawGate};
use pins::Pins;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;
use toml::Spanned;

mod configuration;
mod pins;
mod wires;

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a board")]
struct RawBoard {
    name: Spanned<String>,
    title: String,
    family: Spanned<Family>,
    io: Spanned<IoStandard>,
    pll: Option<Spanned<PllInput>>,
    vccaux: Option<Spanned<String>>,
    flash: Spanned<String>,
    bitstream: Option<String>,
    bitgen: Option<String>,
    usb: Option<Spanned<String>>,
    queue_depth: Option<Spanned<usize>>,
    configured: Spanned<Vec<ConfigurationMode>>,
    #[serde(default)]
    exception: Vec<Exception>,
    gate: Option<RawGate>,
    #[serde(default)]
    package: Vec<Package>,
    #[serde(default)]
    led_low: bool,
    max_baud: Option<u32>,
    sources: Spanned<Vec<String>>,
    #[serde(default)]
    conflicts: Vec<String>,
    #[serde(default)]
    notes: Vec<String>,
    part: Vec<Spanned<RawPart>>,
    oscillator: RawOscillator,
    timebase: Vec<Spanned<RawTimebase>>,
    pins: Ports,
    #[serde(default)]
    pins_beside_uart: Ports,
    #[serde(default)]
    onboard: Ports,
    #[serde(default)]
    standards: Standards,
    #[serde(default)]
    tie: Vec<RawTie>,
    #[serde(default)]
    reserved: Vec<Reserved>,
    #[serde(default)]
    connectors: Connectors,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a [[part]] table")]
struct RawPart {
    name: String,
    package: String,
    speed: Option<u8>,
    logic_cells: Option<u32>,
    block_rams: u32,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "an [oscillator] table")]
struct RawOscillator {
    pin: Spanned<String>,
    hz: Spanned<u64>,
    io: Option<Spanned<IoStandard>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a [[timebase]] table")]
struct RawTimebase {
    clock_hz: Spanned<u64>,
    tick_ns: u64,
    phases: u32,
    why: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a [[tie]] table")]
struct RawTie {
    port: String,
    pin: Spanned<String>,
    level: Spanned<u8>,
    why: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a [[reserved]] table")]
struct Reserved {
    pin: Spanned<String>,
    why: String,
}

/// A table of ports and their pins.
type Ports = BTreeMap<Spanned<String>, Spanned<Pins>>;

/// The electrical standard of each port whose bank has a voltage of its own. This type is that of a
/// connector's labels, so that the command contains the code that reads it once.
type Standards = BTreeMap<Spanned<String>, String>;

/// Connectors by name; each maps its labels to the package's pins.
type Connectors = BTreeMap<String, BTreeMap<Spanned<String>, String>>;

pub(super) fn read(source: &SourceText) -> Result<Board, InputError> {
    let raw: RawBoard = source.parse()?;
    Reader { source, used: BTreeMap::new() }.board(raw)
}

/// The file, and the pins of the package that already have a use.
struct Reader<'a> {
    source: &'a SourceText,
    /// By pin: its use, and the bytes of the file that assign it.
    used: BTreeMap<String, (String, Range<usize>)>,
}

impl Reader<'_> {
    fn refuse<T>(&self, span: Range<usize>, message: impl Into<String>) -> Result<T, InputError> {
        Err(InputError::at(self.source, span, message))
    }

    fn board(mut self, raw: RawBoard) -> Result<Board, InputError> {
        let (family, io) = (*raw.family.as_ref(), *raw.io.as_ref());
        self.supply(&raw, family, io)?;
        let parts = self.parts(&raw, family)?;
        for Reserved { pin, why } in &raw.reserved {
            self.take(pin, &format!("{RESERVED}{why}"))?;
        }
        self.take(&raw.oscillator.pin, "the oscillator")?;
        let mut ties = Vec::new();
        for RawTie { port, pin, level, why } in raw.tie {
            self.take(&pin, &port)?;
            if *level.as_ref() > 1 {
                return self.refuse(level.span(), "a level is 0 or 1");
            }
            ties.push(Tie { port, pin: pin.into_inner(), level: level.into_inner(), why });
        }
        let mut wires = self.wires(raw.pins, raw.pins_beside_uart, raw.onboard, &raw.connectors)?;
        self.standards(&raw.standards, &mut wires)?;
        let gate = raw.gate.map(|gate| self.gate(gate, &wires)).transpose()?;
        let (shared, configuration_sources) =
            self.configuration(&raw.package, &raw.configured, &raw.exception, &raw.part, &parts)?;
        let mut board = Board {
            name: raw.name.into_inner(),
            title: raw.title,
            family,
            parts,
            oscillator: Oscillator {
                pin: raw.oscillator.pin.into_inner(),
                hz: raw.oscillator.hz.into_inner(),
                io: raw.oscillator.io.map_or(io, Spanned::into_inner),
            },
            clocks: Vec::new(),
            queue_depth: raw.queue_depth.map_or(QUEUE_DEPTHS[0], Spanned::into_inner),
            io,
            pll: raw.pll.map(Spanned::into_inner),
            vccaux: raw.vccaux.map(Spanned::into_inner),
            wires,
            ties,
            configured: raw.configured.into_inner(),
            shared,
            configuration_sources,
            gate,
            led_low: raw.led_low,
            max_baud: raw.max_baud,
            flash: raw.flash.into_inner(),
            bitstream: raw.bitstream.unwrap_or_else(|| family.facts().bitstream().to_owned()),
            bitgen: raw.bitgen,
            usb: raw.usb.map(Spanned::into_inner),
            notes: raw.notes,
            conflicts: raw.conflicts,
            sources: raw.sources.into_inner(),
        };
        self.axes(&board)?;
        board.clocks = raw
            .timebase
            .into_iter()
            .map(|timebase| self.clocking(&board, timebase))
            .collect::<Result<_, _>>()?;
        if board.clocks.is_empty() {
            return self.refuse(0..0, "a board without a [[timebase]]");
        }
        Ok(board)
    }

    /// Checks the entries at the head of the file: name, sources, flash command, USB identity and
    /// supplies.
    fn supply(&self, raw: &RawBoard, family: Family, io: IoStandard) -> Result<(), InputError> {
        let name = raw.name.as_ref();
        if name.is_empty()
            || !name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-')
        {
            return self
                .refuse(raw.name.span(), "a name of a board has small letters, digits and - only");
        }
        if raw.sources.as_ref().is_empty() {
            return self.refuse(raw.sources.span(), "no source: where do its pins come from?");
        }
        let refused = |depth: &&Spanned<usize>| !QUEUE_DEPTHS.contains(depth.as_ref());
        if let Some(depth) = raw.queue_depth.as_ref().filter(refused) {
            return self.refuse(depth.span(), "the depth of a queue is 7, 15 or 31 segments");
        }
        if !raw.flash.as_ref().contains("FILE") {
            return self.refuse(
                raw.flash.span(),
                "the command that loads the bitstream has no FILE in it",
            );
        }
        if let Some(usb) = &raw.usb {
            let hex = |text: &str| {
                text.len() == 4 && text.chars().all(|c| matches!(c, '0'..='9' | 'a'..='f'))
            };
            if !usb
                .as_ref()
                .split_once(':')
                .is_some_and(|(vendor, product)| hex(vendor) && hex(product))
            {
                return self.refuse(usb.span(), "vendor and product are expected, as in 0403:6010");
            }
        }
        match (&raw.pll, family.facts().has_pll_input()) {
            (None, true) => {
                return self.refuse(raw.family.span(), "an iCE40 needs `pll`: \"pad\" or \"core\"");
            }
            (Some(pll), false) => {
                return self.refuse(pll.span(), format!("`pll` is an iCE40's, not a {family}'s"));
            }
            _ => {}
        }
        match (&raw.vccaux, family.facts().vccaux()) {
            (None, [_, ..]) => {
                return self
                    .refuse(raw.family.span(), "a Spartan-6 needs `vccaux`: \"2.5\" or \"3.3\"");
            }
            (Some(volts), []) => {
                return self
                    .refuse(volts.span(), format!("`vccaux` is a Spartan-6's, not a {family}'s"));
            }
            (Some(volts), supplies) if !supplies.contains(&volts.as_ref().as_str()) => {
                return self.refuse(volts.span(), "VCCAUX is \"2.5\" or \"3.3\"");
            }
            _ => {}
        }
        if let Some(other) = raw
            .oscillator
            .io
            .as_ref()
            .filter(|other| other.as_ref().millivolts() != io.millivolts())
        {
            let (theirs, ours) = (other.as_ref().name(), io.name());
            let message =
                format!("{theirs} beside pins of {ours}: the voltages of their banks differ");
            return self.refuse(other.span(), message);
        }
        Ok(())
    }

    fn parts(&self, raw: &RawBoard, family: Family) -> Result<Vec<Part>, InputError> {
        let mut parts: Vec<Part> = Vec::new();
        for spanned in &raw.part {
            let RawPart { name, package, speed, logic_cells, block_rams } = spanned.as_ref();
            if speed.is_some() != family.facts().has_speed_grades() {
                return self.refuse(
                    spanned.span(),
                    "all parts but an iCE40 need a `speed` grade, and an iCE40 has none",
                );
            }
            if parts.iter().any(|part| part.name == *name) {
                return self.refuse(spanned.span(), format!("two parts are called '{name}'"));
            }
            let (name, package) = (name.clone(), package.clone());
            let (speed, logic_cells, block_rams) = (*speed, *logic_cells, *block_rams);
            parts.push(Part { family, name, package, speed, logic_cells, block_rams });
        }
        if parts.is_empty() {
            self.refuse(raw.family.span(), "a board without a [[part]]")
        } else {
            Ok(parts)
        }
    }

    /// Checks that every axis has STEP and DIR, and that the board has pins for a host and for the
    /// e-stop.
    fn axes(&self, board: &Board) -> Result<(), InputError> {
        let (step, dir) = (board.bits("step"), board.bits("dir"));
        if step != dir || !(1..=MAX_AXES).contains(&step) {
            let message = format!(
                "{step} pins for `step` and {dir} for `dir`: one to {MAX_AXES}, and as many, are needed"
            );
            return self.refuse(0..0, message);
        }
        for ends in ["limit_min", "limit_max"] {
            if board.bits(ends) > step {
                return self.refuse(0..0, format!("more pins for `{ends}` than axes"));
            }
        }
        let count = |names: &[&str]| names.iter().map(|name| board.bits(name)).sum::<usize>();
        match (
            count(&["uart_rx", "uart_tx"]),
            count(&["spi_cs_n", "spi_sck", "spi_mosi", "spi_miso"]),
        ) {
            (0 | 2, 4) | (2, 0) => {}
            _ => {
                return self
                    .refuse(0..0, "a host needs both pins of a UART, or all four of an SPI");
            }
        }
        match count(&["estop"]) {
            1 => Ok(()),
            _ => self.refuse(0..0, "a board without a pin for the e-stop"),
        }
    }

    /// Checks a proposed clock: the board can make it, and the time slots of all its axes fit into
    /// its tick.
    fn clocking(
        &self,
        board: &Board,
        timebase: Spanned<RawTimebase>,
    ) -> Result<Clocking, InputError> {
        let span = timebase.span();
        let RawTimebase { clock_hz, tick_ns, phases, why } = timebase.into_inner();
        let at_clock = |error: &dyn fmt::Display| {
            InputError::at(self.source, clock_hz.span(), error.to_string())
        };
        let made_by =
            board.family.facts().clock_managers().solve(board.oscillator.hz, *clock_hz.as_ref());
        let made_by = made_by.map_err(|error| at_clock(&error))?;
        let checked = Timebase::new(*clock_hz.as_ref(), tick_ns, phases);
        let checked = checked
            .map_err(|error| InputError::at(self.source, span.clone(), error.to_string()))?;
        check_schedule(board.bits("step"), &checked)
            .map_err(|error| InputError::at(self.source, span, error.to_string()))?;
        Ok(Clocking { clock_hz: clock_hz.into_inner(), tick_ns, phases, made_by, why })
    }
}
