//! The lines between the component and a board in simulated time, and what goes over them.

use std::fmt::Write as _;

/// The line between both.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Line {
    /// A UART whose rate suits the segments.
    Uart,
    /// An SPI, by the stand-in for spidev of `bench/spi_bench.c`.
    Spi,
}

/// Rate of the SPI, Hz.
pub const SCK_HZ: u64 = 4_000_000;

/// Writes that may be unacknowledged over SPI (docs/protocol.md).
pub const WINDOW: usize = 6;

/// Bytes as a bench reads them.
pub fn hex(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut text, byte| {
        write!(text, "{byte:02x}").unwrap();
        text
    })
}

/// Bytes as a bench writes them.
pub fn bytes(hex: &str) -> Vec<u8> {
    let byte = |pair: &[u8]| u8::from_str_radix(std::str::from_utf8(pair).unwrap(), 16).unwrap();
    hex.as_bytes().chunks(2).map(byte).collect()
}

/// Number of writes among the requests of a transfer (docs/protocol.md): frames of 12 bytes or more.
/// OPEN and STOP have no place in their order.
pub fn writes(out: &[u8]) -> usize {
    let frames = out.split(|&byte| byte == 0xc0);
    let plain = |frame: &[u8]| {
        // An escape of two bytes stands for one.
        let bytes: Vec<u8> = frame.iter().copied().filter(|&byte| byte != 0xdb).collect();
        (bytes.len() >= 12).then(|| bytes[1])
    };
    frames.filter_map(plain).filter(|address| ![0xa5, 0xa6].contains(address)).count()
}
