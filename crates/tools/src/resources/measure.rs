//! Measures the engine of a row.

use super::rows::{EngineRow, SEEDS};
use crate::SynthesisError;
use crate::ice40::{self, Netlist, Size};
use carrystep_core::EngineBuild;
use carrystep_core::engine::{InputRow, Latch, LimitWiring, Outputs};
use carrystep_files::{Machine, SourceText};
use carrystep_verilog::{ENGINE_NAME, engine_verilog};

/// The machine whose engine is measured; clock and tick are those of the row.
const MACHINE: &str = include_str!("../../../../sim/six-axis.toml");
const SHIPPED: &str = "sim/six-axis.toml";
/// Its clock and its tick, in whose place a row has its own.
const SHIPPED_TIME: &str = "clock_hz = 80_000_000\ntick_ns = 1000\n";

/// A top level that connects all ports of the engine to two pins by way of registers.
const HARNESS: &str = include_str!("harness.v");
const HARNESS_NAME: &str = "budget_harness";

/// Measurements of a row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RowMeasurement {
    /// Resources of the engine alone.
    pub size: Size,
    /// Clock in MHz that each of the [`SEEDS`] reaches, between registers of engine and harness.
    pub mhz: [f64; SEEDS.len()],
}

impl RowMeasurement {
    /// Measures resources and clock of a row.
    ///
    /// # Errors
    /// [`SynthesisError`] if a tool is missing or fails.
    pub fn of(row: &EngineRow) -> Result<Self, SynthesisError> {
        Self::reached(row, &synthesised(row)?, placed(row)?)
    }

    /// The same, synthesised as the cores of other projects were.
    ///
    /// # Errors
    /// As [`RowMeasurement::of`].
    pub fn as_others(row: &EngineRow) -> Result<Self, SynthesisError> {
        let netlist = ice40::synthesise_as_others(&verilog(row)?, ENGINE_NAME)?;
        let in_harness = ice40::synthesise_as_others(&harnessed(row)?, HARNESS_NAME)?;
        Self::reached(row, &netlist, speeds(row, in_harness))
    }

    fn reached(
        row: &EngineRow,
        netlist: &Netlist,
        speeds: impl Iterator<Item = Result<f64, SynthesisError>>,
    ) -> Result<Self, SynthesisError> {
        let mut mhz = [0.0; SEEDS.len()];
        for (mhz, reached) in mhz.iter_mut().zip(speeds) {
            *mhz = reached?;
        }
        Ok(Self { size: netlist.size(row.part)?, mhz })
    }

    /// Clock of the best seed, MHz.
    pub fn best(&self) -> f64 {
        self.mhz.into_iter().fold(0.0, f64::max)
    }

    /// Median of the clocks of all seeds, MHz.
    pub fn median(&self) -> f64 {
        let mut mhz = self.mhz;
        mhz.sort_by(f64::total_cmp);
        mhz[SEEDS.len() / 2]
    }
}

/// The engine of a row as Verilog.
///
/// # Errors
/// [`SynthesisError::Gateware`] if there is no such engine.
pub fn verilog(row: &EngineRow) -> Result<String, SynthesisError> {
    engine_verilog(&machine(row)?, SHIPPED).map_err(failed)
}

/// The netlist of a row's engine.
///
/// # Errors
/// [`SynthesisError`] if there is no such engine, or if yosys is missing or fails.
pub fn synthesised(row: &EngineRow) -> Result<Netlist, SynthesisError> {
    ice40::synthesise(&verilog(row)?, ENGINE_NAME, row.part.device)
}

/// Build parameters of a row's engine.
pub(super) fn machine(row: &EngineRow) -> Result<EngineBuild, SynthesisError> {
    let EngineRow { clock_hz, tick_ns, .. } = row;
    if !MACHINE.contains(SHIPPED_TIME) {
        return Err(failed(format!("{SHIPPED} has no {SHIPPED_TIME}")));
    }
    let text =
        MACHINE.replace(SHIPPED_TIME, &format!("clock_hz = {clock_hz}\ntick_ns = {tick_ns}\n"));
    let source = SourceText { path: SHIPPED.into(), text: text.into() };
    let mut build = Machine::from_source(&source).map_err(failed)?.engine();
    // If the row has more axes than the machine, the machine's axes are repeated.
    build.pins = build.pins.into_iter().cycle().take(row.axes).collect();
    build.guard.stop = build.guard.stop.into_iter().cycle().take(row.axes).collect();
    build.queue = row.queue;
    if row.all {
        let inputs = InputRow { exist: ((1_u32 << row.axes) - 1) as u8, low: 0 };
        build.guard.limits = LimitWiring::Pair;
        build.guard.inputs = [inputs; 2];
        build.guard.latches = vec![Latch::of_pin(false, 1)];
        build.outputs = Outputs { exist: 0xff, pwm_divider: 16, off_at_ramps: true };
        build.cuts = true;
    }
    Ok(build)
}

/// The error for gateware that cannot be generated.
pub(crate) fn failed(error: impl Into<Box<dyn std::error::Error>>) -> SynthesisError {
    SynthesisError::Gateware(error.into().to_string())
}

/// The clock in MHz that each seed reaches. Each is measured when the iterator is advanced.
///
/// # Errors
/// [`SynthesisError`] if a tool is missing or fails.
pub fn placed(
    row: &EngineRow,
) -> Result<impl Iterator<Item = Result<f64, SynthesisError>>, SynthesisError> {
    Ok(speeds(row, ice40::synthesise(&harnessed(row)?, HARNESS_NAME, row.part.device)?))
}

/// A row's engine in its harness.
fn harnessed(row: &EngineRow) -> Result<String, SynthesisError> {
    Ok(verilog(row)? + &HARNESS.replace("AXES = 6", &format!("AXES = {}", row.axes)))
}

fn speeds(
    row: &EngineRow,
    in_harness: Netlist,
) -> impl Iterator<Item = Result<f64, SynthesisError>> {
    let EngineRow { part, clock_hz, .. } = *row;
    SEEDS.into_iter().map(move |seed| Ok(in_harness.place(part, clock_hz, seed)?.mhz))
}
