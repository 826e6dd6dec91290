//! `[machine.link]`: how the gateware talks to its host.

use crate::build::Timebase;
use crate::error::{InputError, Source};
use crate::link::{DEFAULT_BAUD, Uart};
use serde::Deserialize;
use toml::Spanned;

/// The table as the file has it.
#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields, expecting = "a [machine.link] table")]
pub(super) struct RawLink {
    baud: Option<Spanned<u32>>,
}

impl RawLink {
    /// The baud rate, which the clock can make where the file names it.
    pub(super) fn check(&self, source: &Source, timebase: &Timebase) -> Result<u32, InputError> {
        let Some(baud) = &self.baud else { return Ok(DEFAULT_BAUD) };
        Uart::new(timebase.clock_hz(), *baud.as_ref())
            .map(Uart::baud)
            .map_err(|error| InputError::at(source, baud.span(), error.to_string()))
    }
}
