//! The line to the host, as bytes: a UART or an SPI, with the same ports to the link.
//!
//! ```text
//! received_valid  ____/^\____________      received
//! answer_valid    ________/^^^^^^\____      answer, offered until it is taken
//! answer_take     _____________/^\____
//! ```

mod sim;
pub mod spi;
pub mod uart;
pub mod uart_in;
pub mod uart_out;

pub use sim::{LineOutputs, SpiSim, UartSim};
pub use spi::Spi;
pub use uart::UartLine;
