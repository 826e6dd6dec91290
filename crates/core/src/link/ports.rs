//! The ports of the link in one clock cycle, as the model and its twins in simulation see them.

use crate::engine::{EngineInputs, EngineOutputs};

/// What the link sees.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LinkInputs {
    /// The line from the host: a UART's, high at rest, or MOSI.
    pub rx: bool,
    /// SCK and select (low) of an SPI.
    pub spi: [bool; 2],
    /// What the engine shows.
    pub engine: EngineOutputs,
    /// What the engine's `get` port shows.
    pub get_data: u32,
    /// It is the answer to what was asked.
    pub get_valid: bool,
}

/// What the link shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LinkOutputs {
    /// The line to the host: a UART's, or MISO.
    pub tx: bool,
    /// What it tells the engine; the pins are not the link's.
    pub engine: EngineInputs,
    /// The engine is asked about this axis,
    pub get_axis: u8,
    /// this item.
    pub get_item: u8,
}
