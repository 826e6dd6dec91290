//! Checks of a board's file that concern configuration: a port lies on a configuration pin only
//! with a reason, and a gate holds outputs that exist.

use super::super::configuration::{ConfigurationMode, Gate, Package, Shared, packages};
use super::super::port::PORTS;
use super::super::{Part, Wire};
use super::{RawPart, Reader};
use carrystep_files::error::InputError;
use serde::Deserialize;
use std::collections::BTreeSet;
use toml::Spanned;

/// Configuration pins that ports may use nevertheless, with the reason.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "an [[exception]] table")]
pub(super) struct Exception {
    pins: Vec<Spanned<String>>,
    why: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a [gate] table")]
pub(super) struct RawGate {
    port: Spanned<String>,
    pin: Spanned<String>,
    wait_ns: u64,
    holds: Vec<Spanned<String>>,
    why: String,
}

/// The outputs that the top level can switch to high impedance: those of the line to the host.
const HELD: [&str; 2] = ["uart_tx", "spi_miso"];

/// Prefix of the use of a reserved pin.
pub(super) const RESERVED: &str = "reserved: ";

impl Reader<'_> {
    /// Assigns the gate's pin, and checks that the gate holds the outputs of the host's line and no
    /// others.
    pub(super) fn gate(&mut self, gate: RawGate, wires: &[Wire]) -> Result<Gate, InputError> {
        let RawGate { port, pin, wait_ns, holds, why } = gate;
        if PORTS.iter().any(|known| known.name == port.as_ref()) {
            return self.refuse(
                port.span(),
                format!("the gate needs a port of its own, not {}", port.as_ref()),
            );
        }
        self.take(&pin, port.as_ref())?;
        for held in &holds {
            if !HELD.contains(&held.as_ref().as_str()) {
                let message =
                    format!("a gate can hold {}, not '{}'", HELD.join(" and "), held.as_ref());
                return self.refuse(held.span(), message);
            }
        }
        let holds: Vec<String> = holds.into_iter().map(Spanned::into_inner).collect();
        let open = HELD.iter().find(|out| {
            wires.iter().any(|wire| wire.port == **out) && !holds.iter().any(|held| held == *out)
        });
        if let Some(open) = open {
            return self.refuse(
                pin.span(),
                format!("the gate does not hold {open}: the host's lines belong together"),
            );
        }
        Ok(Gate { port: port.into_inner(), pin: pin.into_inner(), wait_ns, holds, why })
    }

    /// The ports on configuration pins, and the sources of the tables that list those pins.
    ///
    /// If the pin has a function in a mode that the board uses, the port needs an exception. If it
    /// has one in another mode only, the design owns the pin from the start, and the port is listed
    /// without one.
    pub(super) fn configuration(
        &self,
        own: &[Package],
        configured: &Spanned<Vec<ConfigurationMode>>,
        exceptions: &[Exception],
        written: &[Spanned<RawPart>],
        parts: &[Part],
    ) -> Result<(Vec<Shared>, Vec<String>), InputError> {
        let modes = configured.as_ref();
        if modes.is_empty() || modes.contains(&ConfigurationMode::Any) {
            return self.refuse(
                configured.span(),
                "the modes in which the board is configured are expected, as in [\"spi\"]",
            );
        }
        let mut tables = Vec::new();
        for (part, written) in parts.iter().zip(written) {
            let mut all = own.iter().chain(packages());
            let Some(table) =
                all.find(|table| table.name == part.package && table.parts.contains(&part.name))
            else {
                let message = format!(
                    "the configuration pins of {} in {} are not known",
                    part.name, part.package
                );
                return Err(InputError::at(self.source, written.span(), message)
                    .help("add a [[package]] table to this file, in the form of crates/boards/data/packages.toml"));
            };
            tables.push(table);
        }
        let sources: BTreeSet<&String> = tables.iter().flat_map(|table| &table.sources).collect();
        let mut shared = Vec::new();
        for (pin, (port, span)) in
            self.used.iter().filter(|(_, (port, _))| !port.starts_with(RESERVED))
        {
            let found: BTreeSet<(ConfigurationMode, &str)> =
                tables.iter().flat_map(|table| table.functions(pin)).collect();
            if found.is_empty() {
                continue;
            }
            let mut functions: Vec<&str> = Vec::new();
            for (_, function) in &found {
                if !functions.contains(function) {
                    functions.push(function);
                }
            }
            let (function, in_modes) =
                (functions.join("/"), found.iter().map(|(mode, _)| *mode).collect::<BTreeSet<_>>());
            let why = exceptions
                .iter()
                .find(|exception| exception.pins.iter().any(|named| named.as_ref() == pin));
            let now = in_modes
                .iter()
                .find(|mode| **mode == ConfigurationMode::Any || modes.contains(mode));
            if let (Some(mode), None) = (now, why) {
                let message =
                    format!("{port} is on {pin}, which is {function} in configuration ({mode})");
                return Err(InputError::at(self.source, span.clone(), message).help(
                    "take another pin, or say in an [[exception]] why this one does no harm",
                ));
            }
            shared.push(Shared {
                port: port.clone(),
                pin: pin.clone(),
                function,
                modes: in_modes.into_iter().collect(),
                why: why.map(|exception| exception.why.clone()),
            });
        }
        for named in exceptions.iter().flat_map(|exception| &exception.pins) {
            if !shared.iter().any(|shared| shared.pin == *named.as_ref()) {
                let message = format!(
                    "no port is on the configuration pin {}: this exception is none",
                    named.as_ref()
                );
                return self.refuse(named.span(), message);
            }
        }
        Ok((shared, sources.into_iter().cloned().collect()))
    }
}
