//! What a gateware says of itself, and whether this host was made for it.

use crate::registers::{IDENTITY_VALUE, PROTOCOL_VERSION};
use thiserror::Error;

/// The facts of a build, as its registers give them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Facts {
    /// Who it is; carrystep says [`IDENTITY_VALUE`].
    pub identity: u32,
    /// The version of its protocol.
    pub protocol: u32,
    /// Hash of its register map and of all its build parameters.
    pub build: u64,
    /// Its axes.
    pub axes: u32,
    /// Its clock, Hz.
    pub clock_hz: u32,
    /// Its tick, ns.
    pub tick_ns: u32,
    /// Phases of a tick.
    pub phases: u32,
    /// Ticks of silence after which it stops; 0: never.
    pub watchdog_ticks: u32,
}

/// Why a host does not drive this gateware.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum Refusal {
    /// It answers in frames, but as someone else.
    #[error("what answers is not carrystep: identity {0:#010x}")]
    Identity(u32),
    /// Another protocol.
    #[error(
        "the gateware speaks protocol {found}, this driver {PROTOCOL_VERSION}: use the driver of the gateware's release, or flash its gateware"
    )]
    Protocol {
        /// The gateware's version.
        found: u32,
    },
    /// Another build.
    #[error(
        "the gateware is build {found:016x}, this machine needs build {wanted:016x}: flash the gateware made from this machine file, or use the machine file that it was made from"
    )]
    Build {
        /// The gateware's build id.
        found: u64,
        /// The one that was expected.
        wanted: u64,
    },
}

impl Facts {
    /// Whether a host that was made for build `wanted`, or for any, may drive this.
    ///
    /// # Errors
    /// [`Refusal`] says which it found and which it wanted.
    pub fn check(&self, wanted: Option<u64>) -> Result<(), Refusal> {
        if self.identity != IDENTITY_VALUE {
            return Err(Refusal::Identity(self.identity));
        }
        if self.protocol != PROTOCOL_VERSION {
            return Err(Refusal::Protocol { found: self.protocol });
        }
        match wanted {
            Some(wanted) if wanted != self.build => Err(Refusal::Build { found: self.build, wanted }),
            _ => Ok(()),
        }
    }
}
