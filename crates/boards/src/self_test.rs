//! The rows of a board's self-test (docs/self-test.md): which ports it has, in which order, and the
//! line of text for each.

use crate::port::{BoardPort, PORTS, Way};
use crate::{Board, BoardError, Place, Wire};
use carrystep_core::SelfTest;
use carrystep_core::link::Uart;
use carrystep_core::self_test::{LEVEL, Rows};

/// Baud rate of a self-test, with which most terminal programs begin. It is less where the board's
/// serial chip supports only less.
pub const SELF_TEST_BAUD: u32 = 115_200;

/// A board's self-test, and the ports of its rows.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BoardSelfTest {
    /// The texts, the UART and the times.
    pub test: SelfTest,
    /// The outputs that become active, such as `step[0]`; the first one has row 1.
    pub outputs: Vec<String>,
    /// The inputs; the rows follow those of the outputs.
    pub inputs: Vec<String>,
    /// All ports of the top level that have a pin, in the order of [`PORTS`]. These are the outputs
    /// and the inputs above, `enable_n`, the LED and the UART.
    pub ports: Vec<String>,
}

impl Board {
    /// The self-test at a clock, Hz. With `spi`, a host is wired to the SPI: pins that the SPI shares
    /// with other ports are then those of the SPI.
    ///
    /// # Errors
    /// [`BoardError::Port`] if the board has no UART, or no SPI although `spi` is true;
    /// [`BoardError::SelfTestBaud`] if the clock does not make the baud rate; and
    /// [`BoardError::SelfTest`] if its pins or names do not fit.
    pub fn self_test(&self, clock_hz: u64, spi: bool) -> Result<BoardSelfTest, BoardError> {
        let line: &[_] =
            if spi { &["uart_rx", "uart_tx", "spi_miso"] } else { &["uart_rx", "uart_tx"] };
        for port in line {
            self.wire(port)?;
        }
        let baud = self.max_baud.map_or(SELF_TEST_BAUD, |most| most.min(SELF_TEST_BAUD));
        let uart = Uart::new(clock_hz, baud)
            .map_err(|source| BoardError::SelfTestBaud { board: self.name.clone(), source })?;
        let used: Vec<(&Wire, &BoardPort)> = self.self_test_wires(spi).collect();
        let of_kind =
            |kind: Kind| used.iter().filter(move |(wire, port)| kind_of(wire, port) == kind);
        let names = |kind| of_kind(kind).map(|(wire, _)| wire.port.clone()).collect::<Vec<_>>();
        let level = char::from(LEVEL);
        let texts = |kind, way: &str| {
            let text = |(wire, _): &(&Wire, &BoardPort)| measured(way, wire, level);
            of_kind(kind).map(text).collect::<Vec<_>>()
        };
        let fixed = of_kind(Kind::Fixed).map(|(wire, port)| match wire.port.as_str() {
            "enable_n" => measured("out", wire, '1'),
            name => {
                let way = if port.way == Way::Out { "out" } else { "in" };
                format!("{way} {name}, {}", place(wire))
            }
        });
        let ties = self
            .ties
            .iter()
            .map(|tie| format!("out {} = {}, on the board, pin {}", tie.port, tie.level, tie.pin));
        let rows = Rows {
            heading: format!("carrystep self-test: {}, no output is 1", self.name),
            outputs: texts(Kind::Output, "out"),
            inputs: texts(Kind::Input, "in"),
            fixed: fixed.chain(ties).collect(),
        };
        let test = SelfTest::new(uart, clock_hz.div_ceil(2), rows)
            .map_err(|source| BoardError::SelfTest { board: self.name.clone(), source })?;
        Ok(BoardSelfTest {
            test,
            outputs: names(Kind::Output),
            inputs: names(Kind::Input),
            ports: used.iter().map(|(wire, _)| wire.port.clone()).collect(),
        })
    }

    /// The wires that the self-test has, each with its port.
    fn self_test_wires(&self, spi: bool) -> impl Iterator<Item = (&Wire, &'static BoardPort)> {
        let is_of_spi = |wire: &Wire| wire.port.starts_with("spi_");
        let is_shared = move |wire: &Wire| {
            let same = |other: &&Wire| other.pin == wire.pin && other.port != wire.port;
            self.wires.iter().any(|other| same(&other))
        };
        let used = move |wire: &&Wire| match (is_of_spi(wire), spi) {
            (true, _) if wire.at.is_none() => false,
            (true, false) => !is_shared(wire),
            (false, true) => !wire.beside_uart,
            _ => true,
        };
        let wires = self.wires.iter().filter(used).filter_map(|wire| {
            let name = wire.port.split('[').next();
            PORTS.iter().find(|port| Some(port.name) == name).map(|port| (wire, port))
        });
        // An output that is wired on the board belongs to something else there.
        wires.filter(|(wire, port)| {
            port.way != Way::Out || wire.at.is_some() || kind_of(wire, port) == Kind::Fixed
        })
    }
}

/// How a row is treated.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Output,
    Input,
    Fixed,
}

fn kind_of(wire: &Wire, port: &BoardPort) -> Kind {
    match (wire.port.as_str(), port.way) {
        ("enable_n" | "led" | "uart_rx" | "uart_tx", _) => Kind::Fixed,
        (_, Way::Out) => Kind::Output,
        (_, Way::In | Way::PulledUp) => Kind::Input,
    }
}

/// The line of a pin with its level.
fn measured(way: &str, wire: &Wire, level: char) -> String {
    format!("{way} {} = {level}, {}", wire.port, place(wire))
}

/// Where a pin is, in words.
fn place(wire: &Wire) -> String {
    let pin = &wire.pin;
    match &wire.at {
        Some(Place { connector, label }) => format!("{label} on {connector}, pin {pin}"),
        None => format!("on the board, pin {pin}"),
    }
}
