//! Writes the Verilog of a placed netlist and its delays.

use super::netlist::{Cell, Netlist, without_model};
use super::sdf::{Check, Delays};
use super::unread;
use crate::SynthesisError;
use std::collections::BTreeSet;
use std::fmt::Write as _;

/// The inputs of a logic cell that its flip-flop examines, in the order of the model.
const INPUTS: [&str; 6] = ["I0", "I1", "I2", "I3", "CEN", "SR"];

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

struct Writer<'a> {
    netlist: &'a Netlist,
    /// What is not used yet.
    delays: Delays,
    /// The nets and delays for which the module needs a delayed copy of the net.
    delayed: BTreeSet<(u64, u64)>,
    /// The inputs of LUTs on which the output does not depend.
    ignored: BTreeSet<(String, String)>,
    cells: String,
}

/// Whether a LUT's output depends on an input.
fn depends(lut: u64, input: usize) -> bool {
    (0..16).any(|row| (lut >> row ^ lut >> (row ^ 1 << input)) & 1 == 1)
}

/// The name of a net.
fn net(number: u64) -> String {
    format!("\\{number} ")
}

/// The name of a net that is delayed by some ps.
fn late(number: u64, delay: u64) -> String {
    if delay == 0 { net(number) } else { format!("\\{number}+{delay} ") }
}

impl Writer<'_> {
    /// What a pin of a cell sees: its net behind the delay of the wire and of the path from the pin
    /// to the output `to`, if there is one. `otherwise` is the level of an unconnected pin.
    fn seen(
        &mut self,
        (name, cell): (&str, &Cell),
        pin: &str,
        to: Option<&str>,
        otherwise: &str,
    ) -> Result<String, SynthesisError> {
        // A net that nothing drives is not routed: its pins are as if they were not connected.
        let number = cell.pins.get(pin);
        let driven = number.and_then(|number| Some((*number, self.netlist.drivers.get(number)?)));
        let Some((number, driver)) = driven else { return Ok(otherwise.to_owned()) };
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

    fn path(&mut self, name: &str, from: &str, to: &str) -> Result<u64, SynthesisError> {
        let key = ((name.to_owned(), from.to_owned()), to.to_owned());
        let delay = self.delays.paths.remove(&key);
        delay.ok_or_else(|| unread(format!("SDF: no delay of {name} from {from} to {to}")))
    }

    /// Takes the check of a connected input.
    fn check(
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
    fn clock(
        &mut self,
        of: (&str, &Cell),
        pin: &str,
        falls: bool,
    ) -> Result<String, SynthesisError> {
        let clock = self.seen(of, pin, None, "1'b0")?;
        Ok(if falls { format!("~{clock}") } else { clock })
    }

    // Writing to a string cannot fail: the results of `writeln` are dropped below.

    fn logic_cell(&mut self, name: &str, cell: &Cell) -> Result<(), SynthesisError> {
        let of = (name, cell);
        if cell.number("CARRY_ENABLE")? == 1
            && let Some(&carry) = cell.pins.get("COUT")
        {
            let first = if cell.number("CIN_CONST")? == 1 { cell.number("CIN_SET")? } else { 0 };
            let [i1, i2] = ["I1", "I2"].map(|pin| self.seen(of, pin, Some("COUT"), "1'b0"));
            let cin = self.seen(of, "CIN", Some("COUT"), &format!("1'b{first}"))?;
            let (i1, i2, carry) = (i1?, i2?, net(carry));
            let _ = writeln!(
                self.cells,
                "timed_carry \\{name}/carry (.i1({i1}), .i2({i2}), .cin({cin}), .cout({carry}));"
            );
        }
        let Some(&output) = cell.pins.get("O") else { return Ok(()) };
        let (output, lut) = (net(output), cell.number("LUT_INIT")?);
        if cell.number("DFF_ENABLE")? == 0 {
            let mut inputs = String::new();
            for (index, pin) in INPUTS[..4].iter().enumerate() {
                // nextpnr gives no delay where an input only feeds the carry.
                let seen = if depends(lut, index) {
                    self.seen(of, pin, Some("O"), "1'b0")?
                } else {
                    self.ignored.insert((name.to_owned(), (*pin).to_owned()));
                    "1'b0".to_owned()
                };
                let _ = write!(inputs, ".{}({seen}), ", pin.to_lowercase());
            }
            let _ = writeln!(
                self.cells,
                "timed_lut #(.LUT(16'h{lut:04x})) \\{name} ({inputs}.o({output}));"
            );
            return Ok(());
        }
        cell.must_be("ASYNC_SR", 0, "an asynchronous reset")?;
        let (set, falls) = (cell.number("SET_NORESET")?, cell.number("NEG_CLK")? == 1);
        let (mut inputs, mut setups, mut holds) = (String::new(), Vec::new(), Vec::new());
        for pin in INPUTS {
            let seen = self.seen(of, pin, None, if pin == "CEN" { "1'b1" } else { "1'b0" })?;
            let (setup, hold) = self.check(of, pin, ("CLK", falls))?;
            let _ = write!(inputs, ".{}({seen}), ", pin.to_lowercase());
            setups.insert(0, format!("32'd{setup}"));
            holds.insert(0, format!("32'd{hold}"));
        }
        let (clock, to_o) = (self.clock(of, "CLK", falls)?, self.path(name, "CLK", "O")?);
        let _ = writeln!(
            self.cells,
            "timed_flip_flop #(.LUT(16'h{lut:04x}), .SET(1'b{set}), .SETUP({{{}}}), .HOLD({{{}}}), \
             .CLK_TO_O({to_o})) \\{name} (.clk({clock}), {inputs}.o({output}));",
            setups.join(", "),
            holds.join(", ")
        );
        Ok(())
    }

    fn block_ram(&mut self, name: &str, cell: &Cell) -> Result<(), SynthesisError> {
        let of = (name, cell);
        let mut init = String::new();
        for row in (0..16).rev() {
            init += &cell.binary(&format!("INIT_{row:X}"))?;
        }
        if init.len() != 4096 {
            return Err(unread(format!("the first contents of {name}")));
        }
        let mut text = String::new();
        let sides = [
            ('R', [("RCLKE", 1, "1'b1"), ("RE", 1, "1'b0"), ("RADDR", 11, "1'b0")].as_slice()),
            (
                'W',
                &[
                    ("WCLKE", 1, "1'b1"),
                    ("WE", 1, "1'b0"),
                    ("WADDR", 11, "1'b0"),
                    ("MASK", 16, "1'b0"),
                    ("WDATA", 16, "1'b0"),
                ],
            ),
        ];
        let mut times = String::new();
        for (side, ports) in sides {
            let clock = format!("{side}CLK");
            let falls = cell.number(&format!("NEG_CLK_{side}"))? == 1;
            // One time for all inputs of a side; nextpnr gives them the same one.
            let (mut setup, mut hold) = (0, 0);
            for &(port, width, otherwise) in ports {
                let mut bits = Vec::new();
                for bit in (0..width).rev() {
                    let pin = if width == 1 { port.to_owned() } else { format!("{port}_{bit}") };
                    bits.push(self.seen(of, &pin, None, otherwise)?);
                    let times = self.check(of, &pin, (&clock, falls))?;
                    (setup, hold) = (times.0.max(setup), times.1.max(hold));
                }
                let _ = write!(text, ".{}({{{}}}), ", port.to_lowercase(), bits.join(", "));
            }
            let seen = self.clock(of, &clock, falls)?;
            let _ = write!(text, ".{}({seen}), ", clock.to_lowercase());
            let _ = write!(times, ".SETUP_{side}({setup}), .HOLD_{side}({hold}), ");
        }
        let (mut bits, mut to_data) = (Vec::new(), 0);
        for bit in (0..16).rev() {
            let pin = format!("RDATA_{bit}");
            let net = cell.pins.get(&pin).map(|&number| net(number));
            if net.is_some() {
                to_data = self.path(name, "RCLK", &pin)?.max(to_data);
            }
            bits.push(net.unwrap_or_else(|| format!("\\{name}/{pin} ")));
        }
        let unused = bits.iter().filter(|bit| bit.contains('/'));
        let unused: String = unused.map(|bit| format!("wire {bit};\n")).collect();
        let _ = writeln!(
            self.cells,
            "{unused}timed_ram #(.READ_MODE({}), .WRITE_MODE({}), {times}.RCLK_TO_RDATA({to_data}), \
             .INIT(4096'b{init})) \\{name} ({text}.rdata({{{}}}));",
            cell.number("READ_MODE")?,
            cell.number("WRITE_MODE")?,
            bits.join(", ")
        );
        Ok(())
    }

    fn global_buffer(&mut self, name: &str, cell: &Cell) -> Result<(), SynthesisError> {
        let (user, output) = ("USER_SIGNAL_TO_GLOBAL_BUFFER", "GLOBAL_BUFFER_OUTPUT");
        let Some(&out) = cell.pins.get(output) else { return Ok(()) };
        let input = if cell.is_for_pad {
            self.clock_of_pll(name)?
        } else {
            self.seen((name, cell), user, Some(output), "1'b0")?
        };
        let _ = writeln!(self.cells, "assign {} = {input};", net(out));
        Ok(())
    }

    /// The output of the design's only PLL, as its global buffers have it: its reference.
    fn clock_of_pll(&mut self, buffer: &str) -> Result<String, SynthesisError> {
        let netlist = self.netlist;
        let mut plls = netlist.cells.iter().filter(|(_, cell)| cell.kind == "ICESTORM_PLL");
        match (plls.next(), plls.next()) {
            (Some((name, cell)), None) => self.seen((name, cell), "REFERENCECLK", None, "1'b0"),
            _ => Err(without_model(&format!("the buffer {buffer} of a pad"))),
        }
    }

    fn io(&mut self, name: &str, cell: &Cell) -> Result<(), SynthesisError> {
        let pad = cell.pins.get("PACKAGE_PIN");
        let ports = &self.netlist.ports;
        let port = ports.iter().find_map(|(port, (_, bits))| {
            let bit = bits.iter().position(|bit| Some(bit) == pad)?;
            Some(if bits.len() == 1 { port.clone() } else { format!("{port}[{bit}]") })
        });
        let port = port.ok_or_else(|| unread(format!("the port of {name}")))?;
        // Bits 0 and 1: an input without a register. Bits 2 to 5: no output, or one that is always
        // on, without a register.
        match (cell.number("PIN_TYPE")?, cell.pins.get("D_IN_0")) {
            (0b00_0001, Some(&input)) => {
                let _ = writeln!(self.cells, "assign {} = {port};", net(input));
            }
            (0b00_0001, None) => {}
            (0b01_1001, None) => {
                let output = self.seen((name, cell), "D_OUT_0", None, "1'b0")?;
                let _ = writeln!(self.cells, "assign {port} = {output};");
            }
            _ => return Err(without_model(&format!("the type of the pin {name}"))),
        }
        Ok(())
    }

    fn pll(&mut self, name: &str, cell: &Cell) -> Result<(), SynthesisError> {
        if !cell.pins.contains_key("REFERENCECLK") {
            return Err(without_model("a PLL with a pad of its own"));
        }
        for output in ["PLLOUT_A", "PLLOUT_A_GLOBAL"] {
            if let Some(&out) = cell.pins.get(output) {
                let clock = self.seen((name, cell), "REFERENCECLK", None, "1'b0")?;
                let _ = writeln!(self.cells, "assign {} = {clock};", net(out));
            }
        }
        if let Some(&lock) = cell.pins.get("LOCK") {
            let _ = writeln!(self.cells, "assign {} = 1'b1;", net(lock));
        }
        if ["PLLOUT_B", "PLLOUT_B_GLOBAL"].iter().any(|pin| cell.pins.contains_key(*pin)) {
            return Err(without_model("a PLL with two outputs"));
        }
        Ok(())
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
