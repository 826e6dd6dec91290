//! The ports of the link and of its lines, and their values in one clock cycle as the model and the
//! simulators see them.

use super::LineKind;
use crate::engine::{EngineBuild, EngineInputs, EngineOutputs, engine_ports};
use crate::ports::{CLOCK, Peer, Port, Width, input, output};

const BIT: Width = Width::Bits(1);
const BYTE: Width = Width::Bits(8);

/// The ports of the link at which bytes come from the line and go to it.
pub const BYTE_PORTS: [Port; 5] = [
    input("received_valid", BIT, Peer::Host, "a byte has arrived in this clock"),
    input("received", BYTE, Peer::Host, "that byte").valid_with("received_valid"),
    output("answer_valid", BIT, Peer::Host, "the link offers a byte"),
    output("answer", BYTE, Peer::Host, "that byte").valid_with("answer_valid"),
    input("answer_take", BIT, Peer::Host, "the line takes an offered byte in this clock"),
];

const UART_PINS: [Port; 2] = [
    input("rx", BIT, Peer::Pins, "from the host, high when idle"),
    output("tx", BIT, Peer::Pins, "to the host, high when idle"),
];

const SPI_PINS: [Port; 4] = [
    input("sck", BIT, Peer::Pins, "clock of the host"),
    input("select_n", BIT, Peer::Pins, "chip select, low is active"),
    input("mosi", BIT, Peer::Pins, "from the host"),
    output("miso", BIT, Peer::Pins, "to the host"),
];

/// The pins of a line, in this order: from the host, then to it.
pub const fn line_pins(line: LineKind) -> &'static [Port] {
    match line {
        LineKind::Uart(_) => &UART_PINS,
        LineKind::Spi => &SPI_PINS,
    }
}

/// The ports of `carrystep_uart` or `carrystep_spi`, in no particular order.
pub fn line_ports(line: LineKind) -> impl Iterator<Item = Port> {
    let pins = line_pins(line).iter().copied();
    core::iter::once(CLOCK).chain(pins).chain(BYTE_PORTS.map(Port::turned))
}

/// The ports of `carrystep_link` in this build, in no particular order: those of the line, and the
/// engine's ports that are the host's.
pub fn link_ports(build: &EngineBuild) -> impl Iterator<Item = Port> + use<> {
    let engine = engine_ports(build).filter(|port| port.peer == Peer::Host);
    core::iter::once(CLOCK).chain(BYTE_PORTS).chain(engine.map(|port| port.turned()))
}

/// Input values of the link in one clock cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LinkInputs {
    /// Receive line: the UART's RX, high when idle, or the SPI's MOSI.
    pub rx: bool,
    /// SCK and the active-low chip select of an SPI.
    pub spi: [bool; 2],
    /// Outputs of the engine.
    pub engine: EngineOutputs,
}

/// Output values of the link in one clock cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LinkOutputs {
    /// Transmit line: the UART's TX, or the SPI's MISO.
    pub tx: bool,
    /// Inputs of the engine that the link drives. The engine's pin inputs are not the link's.
    pub engine: EngineInputs,
}
