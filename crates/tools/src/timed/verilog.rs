//! Writes the Verilog of a placed netlist and its delays.

use super::netlist::{Cell, Netlist, without_model};
use super::sdf::{Check, Delays};
use super::unread;
use crate::SynthesisError;
use std::collections::BTreeSet;

/// The Verilog of the top module.
pub(super) fn written(
    netlist: &Netlist,
    delays: Delays,
    top: &str,
) -> Result<String, SynthesisError> {
    let mut writer = Writer {
        netlist,
        delays,
        delayed: BTreeSet::new(),
        ignored: BTreeSet::new(),
        cells: String::new(),
    };
    for (name, cell) in &netlist.cells {
        match cell.kind.as_str() {
            "ICESTORM_LC" => writer.logic_cell(name, cell)?,
            "ICESTORM_RAM" => writer.block_ram(name, cell)?,
            "SB_GB" => writer.global_buffer(name, cell)?,
            "SB_IO" => writer.io(name, cell)?,
            "ICESTORM_PLL" => writer.pll(name, cell)?,
            other => return Err(without_model(&format!("a cell {other}"))),
        }
    }
    writer.nothing_is_left()?;
    Ok(writer.module(top))
}

pub(super) struct Writer<'a> {
    pub(super) netlist: &'a Netlist,
    /// What is not used yet.
    delays: Delays,
    /// The nets and delays for which the module needs a delayed copy of the net.
    delayed: BTreeSet<(u64, u64)>,
    /// The inputs of LUTs on which the output does not depend.
    pub(super) ignored: BTreeSet<(String, String)>,
    pub(super) cells: String,
}

/// The name of a net.
pub(super) fn net(number: u64) -> String {
    format!("\\{number} ")
}

/// The name of a net that is delayed by some ps.
fn late(number: u64, delay: u64) -> String {
    if delay == 0 { net(number) } else { format!("\\{number}+{delay} ") }
}

impl Writer<'_> {
    /// What a pin of a cell sees: its net behind the delay of the wire and of the path from the pin
    /// to the output `to`, if there is one. `otherwise` is the level of an unconnected pin.
    pub(super) fn seen(
        &mut self,
        (name, cell): (&str, &Cell),
        pin: &str,
        to: Option<&str>,
        otherwise: &str,
    ) -> Result<String, SynthesisError> {
        // A net that nothing drives is not routed: its pins are as if they were not connected.
        let number = cell.pins.get(pin);
        let driven = number.and_then(|number| Some((*number, self.netlist.drivers.get(number)?)));
        let Some((number, driver)) = driven else {
            if number.is_some()
                && let Some(to) = to
            {
                self.path(name, pin, to)?;
            }
            return Ok(otherwise.to_owned());
        };
        let end = (name.to_owned(), pin.to_owned());
        let mut delay = *self
            .delays
            .wires
            .get(&(driver.clone(), end))
            .ok_or_else(|| unread(format!("SDF: no delay of the wire to {name}/{pin}")))?;
        if let Some(to) = to {
            delay += self.path(name, pin, to)?;
        }
        if delay > 0 {
            self.delayed.insert((number, delay));
        }
        Ok(late(number, delay))
    }

    pub(super) fn path(&mut self, name: &str, from: &str, to: &str) -> Result<u64, SynthesisError> {
        let key = ((name.to_owned(), from.to_owned()), to.to_owned());
        let delay = self.delays.paths.remove(&key);
        delay.ok_or_else(|| unread(format!("SDF: no delay of {name} from {from} to {to}")))
    }

    /// Takes the check of a connected input.
    pub(super) fn check(
        &mut self,
        (name, cell): (&str, &Cell),
        pin: &str,
        (clock, falls): (&str, bool),
    ) -> Result<(u64, u64), SynthesisError> {
        if !cell.pins.contains_key(pin) {
            return Ok((0, 0));
        }
        match self.delays.checks.remove(&(name.to_owned(), pin.to_owned())) {
            Some(Check { setup, hold, clock: by, falls: at }) if by == clock && at == falls => {
                Ok((setup, hold))
            }
            Some(_) => Err(unread(format!("SDF: the check of {name}/{pin} has another clock"))),
            None => Err(unread(format!("SDF: no check of {name}/{pin}"))),
        }
    }

    /// The clock that a pin sees, inverted if the falling edge counts.
    pub(super) fn clock(
        &mut self,
        of: (&str, &Cell),
        pin: &str,
        falls: bool,
    ) -> Result<String, SynthesisError> {
        let clock = self.seen(of, pin, None, "1'b0")?;
        Ok(if falls { format!("~{clock}") } else { clock })
    }

    /// Fails where the file of delays has a check, or a path to a connected output, that no cell
    /// has used.
    fn nothing_is_left(&self) -> Result<(), SynthesisError> {
        if let Some((cell, pin)) = self.delays.checks.keys().min() {
            return Err(unread(format!("SDF: a check of {cell}/{pin}, which is not a register")));
        }
        let is_connected = |cell: &str, pin: &str| {
            let cell = self.netlist.cells.get(cell);
            cell.is_none_or(|cell| cell.pins.contains_key(pin))
        };
        let mut paths = self.delays.paths.keys();
        let left = paths.find(|(from, to)| {
            is_connected(&from.0, &from.1)
                && is_connected(&from.0, to)
                && !(to == "O" && self.ignored.contains(from))
        });
        match left {
            Some(((cell, from), to)) => {
                Err(unread(format!("SDF: a delay of {cell} from {from} to {to}, which has none")))
            }
            None => Ok(()),
        }
    }

    fn module(&self, top: &str) -> String {
        let ports = self.netlist.ports.iter().map(|(name, (is_input, bits))| {
            let way = if *is_input { "input" } else { "output" };
            let range =
                if bits.len() > 1 { format!(" [{}:0]", bits.len() - 1) } else { String::new() };
            format!("    {way} wire{range} {name}")
        });
        let ports: Vec<String> = ports.collect();
        let nets: BTreeSet<u64> = self.netlist.drivers.keys().copied().collect();
        let nets: String =
            nets.into_iter().map(|number| format!("wire {};\n", net(number))).collect();
        let late: String = self
            .delayed
            .iter()
            .map(|&(number, delay)| {
                let (net, late) = (net(number), late(number, delay));
                format!("reg {late};\nalways begin {late}<= #{delay} {net}; @({net}); end\n")
            })
            .collect();
        format!("module {top} (\n{}\n);\n{nets}{late}{}endmodule\n", ports.join(",\n"), self.cells)
    }
}
