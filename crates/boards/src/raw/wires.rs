//! Gives every port of the gateware its pins, and every pin of the package at most one use.

use super::pins::Pins;
use super::{Connectors, Ports, Reader};
use crate::port::{BoardPort, PORTS};
use crate::{Place, Wire};
use carrystep_files::did_you_mean;
use carrystep_files::error::InputError;
use std::collections::BTreeMap;
use toml::Spanned;

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
        onboard: Ports,
        connectors: &Connectors,
    ) -> Result<Vec<Wire>, InputError> {
        let mut wires: Vec<Wire> = Vec::new();
        let labelled = pins.into_iter().map(|row| (row, true));
        for ((name, pins), on_connector) in
            labelled.chain(onboard.into_iter().map(|row| (row, false)))
        {
            let port = self.port(&name)?;
            if wires.iter().any(|wire| wire.port.split('[').next() == Some(port.name)) {
                return self.refuse(
                    name.span(),
                    format!("{} stands in [pins] and in [onboard]", port.name),
                );
            }
            let span = pins.span();
            let pins = match (pins.into_inner(), port.per_axis) {
                (Pins::One(pin), false) => vec![Spanned::new(span, pin)],
                (Pins::Many(pins), true) => pins,
                (Pins::One(_), true) => {
                    return self
                        .refuse(span, format!("{} has a pin for each axis: a list", port.name));
                }
                (Pins::Many(_), false) => {
                    return self.refuse(span, format!("{} is one pin", port.name));
                }
            };
            for (index, spanned) in pins.into_iter().enumerate() {
                let bit = if port.per_axis {
                    format!("{}[{index}]", port.name)
                } else {
                    port.name.to_owned()
                };
                let (pin, at) = match on_connector {
                    false => (spanned.as_ref().clone(), None),
                    true => self.labelled(&spanned, connectors)?,
                };
                self.take(&Spanned::new(spanned.span(), pin.clone()), &bit)?;
                wires.push(Wire { port: bit, pin, at });
            }
        }
        let place = |wire: &Wire| {
            PORTS.iter().position(|port| wire.port.split('[').next() == Some(port.name))
        };
        wires.sort_by_key(place);
        Ok(wires)
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
