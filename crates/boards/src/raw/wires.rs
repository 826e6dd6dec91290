//! Gives every port of the gateware its pins, and every pin of the package at most one use.

use super::pins::Pins;
use super::{Connectors, Ports, Reader, Standards};
use crate::port::{BoardPort, PORTS};
use crate::{IoStandard, Place, Wire};
use carrystep_files::did_you_mean;
use carrystep_files::error::InputError;
use std::collections::BTreeMap;
use toml::Spanned;

/// The table of the board's file in which a port stands.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Table {
    /// Pins of connectors.
    Pins,
    /// Pins of connectors that may also be those of the SPI, where the host uses the UART.
    BesideUart,
    /// Pins that are wired on the board.
    Onboard,
}

impl Reader<'_> {
    /// Assigns a use to a pin of the package; a second use is an error.
    pub(super) fn take(&mut self, pin: &Spanned<String>, purpose: &str) -> Result<(), InputError> {
        if let Some((other, _)) =
            self.used.insert(pin.as_ref().clone(), (purpose.to_owned(), pin.span()))
        {
            return self.refuse(pin.span(), format!("pin {} is taken: {other}", pin.as_ref()));
        }
        Ok(())
    }

    /// The wires of all ports, in the order of [`PORTS`].
    pub(super) fn wires(
        &mut self,
        pins: Ports,
        beside_uart: Ports,
        onboard: Ports,
        connectors: &Connectors,
    ) -> Result<Vec<Wire>, InputError> {
        let mut wires: Vec<Wire> = Vec::new();
        let of = |ports: Ports, table| ports.into_iter().map(move |row| (row, table));
        for ((name, pins), table) in of(pins, Table::Pins)
            .chain(of(onboard, Table::Onboard))
            .chain(of(beside_uart, Table::BesideUart))
        {
            let port = self.port(&name)?;
            if wires.iter().any(|wire| wire.port.split('[').next() == Some(port.name)) {
                return self
                    .refuse(name.span(), format!("{} stands in two tables of pins", port.name));
            }
            let span = pins.span();
            let pins = match (pins.into_inner(), port.is_list) {
                (Pins::One(pin), false) => vec![Spanned::new(span, pin)],
                (Pins::Many(pins), true) => pins,
                (Pins::One(_), true) => {
                    return self.refuse(span, format!("{} is a list of pins", port.name));
                }
                (Pins::Many(_), false) => {
                    return self.refuse(span, format!("{} is one pin", port.name));
                }
            };
            for (index, spanned) in pins.into_iter().enumerate() {
                let bit = if port.is_list {
                    format!("{}[{index}]", port.name)
                } else {
                    port.name.to_owned()
                };
                let (pin, at) = match table {
                    Table::Onboard => (spanned.as_ref().clone(), None),
                    Table::Pins | Table::BesideUart => self.labelled(&spanned, connectors)?,
                };
                let beside_uart = table == Table::BesideUart;
                let is_of_spi = |wire: &Wire| wire.pin == pin && wire.port.starts_with("spi_");
                if beside_uart && wires.iter().any(is_of_spi) {
                    let taken = |wire: &Wire| wire.beside_uart && wire.pin == pin;
                    if let Some(wire) = wires.iter().find(|wire| taken(wire)) {
                        let message = format!("pin {pin} is taken: {}", wire.port);
                        return self.refuse(spanned.span(), message);
                    }
                } else {
                    self.take(&Spanned::new(spanned.span(), pin.clone()), &bit)?;
                }
                wires.push(Wire { port: bit, pin, at, beside_uart, io: None });
            }
        }
        let place = |wire: &Wire| {
            PORTS.iter().position(|port| wire.port.split('[').next() == Some(port.name))
        };
        wires.sort_by_key(place);
        Ok(wires)
    }

    /// Gives the wires of some ports an electrical standard of their own.
    pub(super) fn standards(
        &self,
        standards: &Standards,
        wires: &mut [Wire],
    ) -> Result<(), InputError> {
        for (name, io) in standards {
            let Some(io) = IoStandard::named(io) else {
                return self.refuse(name.span(), format!("{io} is no electrical standard"));
            };
            let port = self.port(name)?.name;
            let mut of_port = wires
                .iter_mut()
                .filter(|wire| wire.port.split('[').next() == Some(port))
                .peekable();
            if of_port.peek().is_none() {
                return self.refuse(name.span(), format!("{port} has no pin on this board"));
            }
            of_port.for_each(|wire| wire.io = Some(io));
        }
        Ok(())
    }

    fn port(&self, name: &Spanned<String>) -> Result<&'static BoardPort, InputError> {
        PORTS.iter().find(|port| port.name == name.as_ref()).ok_or_else(|| {
            let known: Vec<&str> = PORTS.iter().map(|port| port.name).collect();
            let meant = did_you_mean(name.as_ref(), known.iter().copied());
            InputError::at(
                self.source,
                name.span(),
                format!("no port is called '{}'{meant}", name.as_ref()),
            )
            .help(format!("known: {}", known.join(", ")))
        })
    }

    /// The pin behind a connector's label, and the place of the label.
    fn labelled(
        &self,
        label: &Spanned<String>,
        connectors: &Connectors,
    ) -> Result<(String, Option<Place>), InputError> {
        let text = label.as_ref();
        let on = |(connector, labels): (&String, &BTreeMap<Spanned<String>, String>)| {
            let (_, pin) = labels.iter().find(|(label, _)| label.as_ref() == text)?;
            Some((pin.clone(), Some(Place { connector: connector.clone(), label: text.clone() })))
        };
        let mut found = connectors.iter().filter_map(on);
        match (found.next(), found.next()) {
            (Some(one), None) => Ok(one),
            (None, _) => {
                self.refuse(label.span(), format!("no connector has a pin labelled '{text}'"))
            }
            (Some(_), Some(_)) => {
                self.refuse(label.span(), format!("two connectors have a pin labelled '{text}'"))
            }
        }
    }
}
