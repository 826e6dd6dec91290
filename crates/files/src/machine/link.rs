//! `[machine.link]`: the line between the gateware and its host.

use crate::error::{InputError, SourceText};
use carrystep_core::build::Timebase;
use carrystep_core::link::{DEFAULT_BAUD, Uart};
use serde::Deserialize;
use toml::Spanned;

/// The table as it is written.
#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields, expecting = "a [machine.link] table")]
pub(super) struct RawLink {
    baud: Option<Spanned<u32>>,
    spi: Option<Spanned<bool>>,
}

impl RawLink {
    /// Whether the line is an SPI. An SPI has no baud rate; giving one is an error.
    pub(super) fn spi(&self, source: &SourceText) -> Result<bool, InputError> {
        match (&self.spi, &self.baud) {
            (Some(spi), Some(_)) if *spi.as_ref() => Err(InputError::at(
                source,
                spi.span(),
                "an SPI has no baud rate: its host says how fast it is".to_owned(),
            )),
            (spi, _) => Ok(spi.as_ref().is_some_and(|spi| *spi.as_ref())),
        }
    }

    /// The baud rate, bits per second. If the file gives it, the clock must be able to make it.
    pub(super) fn baud(&self, source: &SourceText, timebase: &Timebase) -> Result<u32, InputError> {
        let Some(baud) = &self.baud else { return Ok(DEFAULT_BAUD) };
        Uart::new(timebase.clock_hz(), *baud.as_ref())
            .map(Uart::baud)
            .map_err(|error| InputError::at(source, baud.span(), error.to_string()))
    }
}
