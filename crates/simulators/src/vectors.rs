//! Recorded inputs and outputs of one module, cycle by cycle, and their replay on its exported
//! Verilog in Icarus.

use crate::LevelError;
use crate::tool::{self, ICARUS, VVP};
use carrystep_tools::kept;
use std::borrow::Cow;
use std::fmt::Write as _;
use std::process::Command;

const BENCH: &str = include_str!("../bench/vectors_bench.v");

/// The values of several ports in one cycle, packed into one number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Bits {
    bits: u128,
    counts: u128,
}

impl Bits {
    /// Adds a port below the others. `None` marks a value that is not compared.
    ///
    /// `width` is at most 64, and all ports together have at most 128 bits.
    #[must_use]
    pub fn and(self, width: u32, value: impl Into<Option<u64>>) -> Self {
        let ones = (1 << width) - 1;
        let value = value.into();
        Self {
            bits: self.bits << width | (u128::from(value.unwrap_or(0)) & ones),
            counts: self.counts << width | if value.is_some() { ones } else { 0 },
        }
    }
}

/// The ports of a module, and its recorded cycles.
#[derive(Debug, Clone)]
pub struct Vectors {
    /// Name of the clock's port.
    pub clock: &'static str,
    /// Name and width of each input, in the order of the recorded values.
    pub inputs: Cow<'static, [(&'static str, u32)]>,
    /// Name and width of each output, in the order of the recorded values.
    pub outputs: Cow<'static, [(&'static str, u32)]>,
    /// Inputs and outputs, each with a number of cycles.
    rows: Vec<(u64, Bits, Bits)>,
    /// The sum of these numbers.
    cycles: u64,
}

impl Vectors {
    /// A recording without cycles.
    pub fn new(
        inputs: impl Into<Cow<'static, [(&'static str, u32)]>>,
        outputs: impl Into<Cow<'static, [(&'static str, u32)]>>,
    ) -> Self {
        let (inputs, outputs) = (inputs.into(), outputs.into());
        Self { clock: "clock", inputs, outputs, rows: Vec::new(), cycles: 0 }
    }

    /// Records a cycle.
    pub fn add(&mut self, inputs: Bits, outputs: Bits) {
        self.cycles += 1;
        match self.rows.last_mut() {
            Some((count, before, shown)) if *before == inputs && *shown == outputs => *count += 1,
            _ => self.rows.push((1, inputs, outputs)),
        }
    }

    /// Number of recorded cycles.
    pub fn cycles(&self) -> u64 {
        self.cycles
    }

    /// Describes the first cycle in which the module of this name in this Verilog has other
    /// outputs; `None` if there is none. A replay whose output is known from an earlier run is not
    /// repeated, see [`kept::difference`].
    ///
    /// # Errors
    /// [`LevelError`] if Icarus is missing or fails.
    pub fn difference(&self, module: &str, verilog: &str) -> Result<Option<String>, LevelError> {
        tool::find(&ICARUS)?;
        let (bench, vectors) = (self.bench(BENCH, module), self.text());
        let same = format!("same {}", self.cycles());
        kept::difference(&ICARUS, (verilog, &bench, &vectors), &same, || {
            let folder = tempfile::tempdir().map_err(tool::io("cannot make a temporary folder"))?;
            let files = [("module.v", verilog), ("bench.v", &bench), ("vectors.txt", &vectors)];
            tool::put(folder.path(), &files)?;
            let compiles = ["-g2005", "-o", "bench.vvp", "bench.v", "module.v"];
            tool::complete(&ICARUS, Command::new(ICARUS.name).args(compiles).current_dir(&folder))?;
            let runs = ["-n", "bench.vvp", "+vectors=vectors.txt"];
            let said = Command::new(VVP.name).args(runs).current_dir(&folder).output();
            let said = said.map_err(tool::io("cannot start the simulation"))?;
            let said = String::from_utf8_lossy(&said.stdout).trim().to_owned();
            Ok((said != same).then_some(said))
        })
    }

    /// The cycles in the format of the benches.
    pub(crate) fn text(&self) -> String {
        let mut text = String::new();
        for (count, inputs, Bits { bits, counts }) in &self.rows {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "{count} {:x} {bits:x} {counts:x}", inputs.bits);
        }
        text
    }

    /// A bench for the module of this name, made from its template.
    pub(crate) fn bench(&self, template: &str, module: &str) -> String {
        let mut connections = String::new();
        let mut widths = [0; 2];
        for (side, (vector, ports)) in
            [("inputs", &self.inputs), ("outputs", &self.outputs)].into_iter().enumerate()
        {
            let mut below: u32 = ports.iter().map(|(_, width)| width).sum();
            widths[side] = below;
            for (name, width) in ports.iter() {
                below -= width;
                let _ = write!(
                    connections,
                    ",\n        .{name}({vector}[{}:{below}])",
                    below + width - 1
                );
            }
        }
        let [inputs, outputs] = widths.map(|width| width.to_string());
        template
            .replace("CLOCK", self.clock)
            .replace("CONNECTIONS", &connections)
            .replace("MODULE", module)
            .replace("OUTPUTS", &outputs)
            .replace("INPUTS", &inputs)
    }
}
