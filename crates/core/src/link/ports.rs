//! The ports of the link in one clock cycle, as the model and the simulators see them.

use crate::engine::{EngineInputs, EngineOutputs};

/// Input values of the link in one clock cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LinkInputs {
    /// Receive line: the UART's RX, high when idle, or the SPI's MOSI.
    pub rx: bool,
    /// SCK and the active-low chip select of an SPI.
    pub spi: [bool; 2],
    /// Outputs of the engine.
    pub engine: EngineOutputs,
    /// Value at the engine's `get` port.
    pub get_data: u32,
    /// Whether that value answers the current request.
    pub get_valid: bool,
}

/// Output values of the link in one clock cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LinkOutputs {
    /// Transmit line: the UART's TX, or the SPI's MISO.
    pub tx: bool,
    /// Inputs of the engine that the link drives. The engine's pin inputs are not the link's.
    pub engine: EngineInputs,
    /// Axis that the `get` port asks for.
    pub get_axis: u8,
    /// Item of that axis that the `get` port asks for.
    pub get_item: u8,
}
