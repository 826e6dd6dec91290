//! Support for the tests: a gateware in miniature, a line with faults, and clients in Rust and C
//! that understand the same commands.
#![allow(dead_code)]

pub mod bench_line;
pub mod c_library;
pub mod client;
pub mod conversation;
pub mod device;
pub mod random;
pub mod soak;
pub mod wire;

/// Bytes as hexadecimal text, such as `c0 01`.
pub fn hex(bytes: &[u8]) -> String {
    let pairs: Vec<String> = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
    if pairs.is_empty() { "-".to_owned() } else { pairs.join(" ") }
}

/// The bytes of such a text.
pub fn unhex(text: &str) -> Vec<u8> {
    let byte = |pair: &str| {
        u8::from_str_radix(pair, 16).unwrap_or_else(|_| panic!("{pair:?} in {text:?}"))
    };
    text.split_whitespace().filter(|&word| word != "-").map(byte).collect()
}
