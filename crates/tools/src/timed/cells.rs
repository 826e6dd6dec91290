//! Writes each kind of cell.

use super::netlist::{Cell, without_model};
use super::unread;
use super::verilog::{Writer, net};
use crate::SynthesisError;
use std::fmt::Write as _;

/// The inputs of a logic cell that its flip-flop examines, in the order of the model.
const INPUTS: [&str; 6] = ["I0", "I1", "I2", "I3", "CEN", "SR"];

/// Whether a LUT's output depends on an input.
fn depends(lut: u64, input: usize) -> bool {
    (0..16).any(|row| (lut >> row ^ lut >> (row ^ 1 << input)) & 1 == 1)
}

impl Writer<'_> {
    // Writing to a string cannot fail: the results of `writeln` are dropped below.

    pub(super) fn logic_cell(&mut self, name: &str, cell: &Cell) -> Result<(), SynthesisError> {
        let of = (name, cell);
        if cell.pins.contains_key("LO") {
            return Err(without_model("a cascade of LUTs"));
        }
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

    pub(super) fn block_ram(&mut self, name: &str, cell: &Cell) -> Result<(), SynthesisError> {
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

    pub(super) fn global_buffer(&mut self, name: &str, cell: &Cell) -> Result<(), SynthesisError> {
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

    pub(super) fn io(&mut self, name: &str, cell: &Cell) -> Result<(), SynthesisError> {
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

    pub(super) fn pll(&mut self, name: &str, cell: &Cell) -> Result<(), SynthesisError> {
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
}
