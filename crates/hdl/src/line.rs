//! The line to the host, which carries bytes: a UART or an SPI, with the same ports to the link.
//!
//! ```text
//! received_valid  ____/^\____________      one clock per received byte
//! answer_valid    ________/^^^^^^\____      the link offers a byte until the line accepts it
//! answer_take     _____________/^\____      the clock in which the line accepts the byte
//! ```

mod sim;
pub mod spi;
pub mod uart;
pub mod uart_in;
pub mod uart_out;

pub use sim::{LineOutputs, SpiSim, UartSim};
pub use spi::Spi;
pub use uart::UartLine;
