//! A latch of a build: its pin and its looks.

/// A latch, which keeps the state of all axes at an edge of its pin.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Latch {
    /// The pin of the machine to which a board connects the latch.
    pub source: LatchSource,
    /// Whether its pin is active while it is low. The edge is the change to the active level.
    pub low: bool,
    /// Number of consecutive ticks that must find the pin active, 1 to [`super::MAX_LOOKS`].
    pub looks: u8,
}

impl Latch {
    /// A latch with a pin of its own.
    pub const fn of_pin(low: bool, looks: u8) -> Self {
        Self { source: LatchSource::Pin, low, looks }
    }
}

/// The pin of the machine to which a board connects a latch. The engine has a port for each latch
/// in any case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum LatchSource {
    /// A pin of its own.
    Pin,
    /// The pin of a switch, which the engine also samples as this switch.
    Switch {
        /// The row of the switch.
        row: u8,
        /// The number of its axis.
        axis: u8,
    },
}
