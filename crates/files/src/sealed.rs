//! Files in which a program keeps a part of its work, so that a damaged one is recognised.
//!
//! The first line has the name of the format, its version and the SHA-256 of the rest.
//!
//! ```text
//! carrystep-sweep-shard 1 9f86d081884c7d65...
//! { ... }
//! ```

use sha2::{Digest, Sha256};
use std::fmt::Write as _;
use std::io::{self, BufRead as _, BufReader, Read};
use thiserror::Error;

/// Why such a file cannot be used.
#[derive(Debug, Error)]
pub enum SealFault {
    /// The rest does not have this SHA-256.
    #[error("it is damaged: it does not have the SHA-256 that its first line gives")]
    Damaged,
    /// It has another version.
    #[error("it has version {0} of the format, which this carrystep does not read")]
    Version(String),
}

/// The SHA-256 of these bytes, in hexadecimal digits.
pub fn sha256(bytes: &[u8]) -> String {
    hex(&Sha256::digest(bytes))
}

/// The same for bytes of any number.
///
/// # Errors
/// The bytes cannot be read.
pub fn sha256_of(bytes: impl Read) -> io::Result<String> {
    let (mut bytes, mut hash) = (BufReader::new(bytes), Sha256::new());
    loop {
        let buffer = bytes.fill_buf()?;
        if buffer.is_empty() {
            return Ok(hex(&hash.finalize()));
        }
        hash.update(buffer);
        let length = buffer.len();
        bytes.consume(length);
    }
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}

/// The file with this body.
pub fn seal(name: &str, version: &str, body: &str) -> String {
    format!("{name} {version} {}\n{body}", sha256(body.as_bytes()))
}

/// The body of a file; `None` if the file has another format.
///
/// # Errors
/// The file is damaged, or has another version.
pub fn unseal<'b>(
    name: &str,
    version: &str,
    bytes: &'b [u8],
) -> Option<Result<&'b [u8], SealFault>> {
    let rest = bytes.strip_prefix(name.as_bytes())?.strip_prefix(b" ")?;
    let line = rest.iter().position(|&byte| byte == b'\n').unwrap_or(rest.len());
    let (head, body) = rest.split_at(line);
    let body = body.get(1..).unwrap_or_default();
    let head = String::from_utf8_lossy(head);
    Some(match head.split_once(' ') {
        None => Err(SealFault::Damaged),
        Some((found, _)) if found != version => Err(SealFault::Version(found.to_owned())),
        Some((_, sum)) if sum != sha256(body) => Err(SealFault::Damaged),
        Some(_) => Ok(body),
    })
}
