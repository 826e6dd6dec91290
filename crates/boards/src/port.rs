//! The ports of a board's top level: name, direction and purpose.

/// Direction of a port, seen from the FPGA.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Way {
    /// Input.
    In,
    /// Input with a pull-up, so that an open wire reads high.
    PulledUp,
    /// Output.
    Out,
}

/// A port of the top level.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BoardPort {
    /// Name of the port.
    pub name: &'static str,
    /// Direction.
    pub way: Way,
    /// Whether the port is a list of pins, one for each axis for example.
    pub is_list: bool,
    /// Purpose of the port.
    pub what: &'static str,
}

const fn port(name: &'static str, way: Way, is_list: bool, what: &'static str) -> BoardPort {
    BoardPort { name, way, is_list, what }
}

/// Name of the oscillator's port.
pub const OSCILLATOR: &str = "oscillator";

/// All ports that a board may have, except [`OSCILLATOR`] and its ties.
pub const PORTS: [BoardPort; 19] = [
    port("step", Way::Out, true, "STEP of the axis' driver"),
    port("dir", Way::Out, true, "DIR of the axis' driver; high is backward"),
    port("enable_n", Way::Out, false, "ENABLE of all drivers; low: they have power"),
    port("estop", Way::PulledUp, false, "e-stop switch"),
    port("limit_min", Way::PulledUp, true, "limit switch at the low end, or the axis' only one"),
    port("limit_max", Way::PulledUp, true, "limit switch at the high end"),
    port("probe", Way::PulledUp, false, "probe"),
    port("interlock", Way::PulledUp, false, "interlock, a door switch for example"),
    port("latch", Way::PulledUp, false, "latch of the positions"),
    port("general", Way::PulledUp, true, "general input"),
    port("outputs", Way::Out, true, "output that changes with the motion; high is active"),
    port("pwm", Way::Out, false, "PWM that changes with the motion; high is active"),
    port("uart_rx", Way::PulledUp, false, "UART, from the host"),
    port("uart_tx", Way::Out, false, "UART, to the host"),
    port("spi_cs_n", Way::PulledUp, false, "SPI chip select, low is active"),
    port("spi_sck", Way::PulledUp, false, "SPI clock"),
    port("spi_mosi", Way::PulledUp, false, "SPI, from the host"),
    port("spi_miso", Way::Out, false, "SPI, to the host"),
    port("led", Way::Out, false, "light"),
];
