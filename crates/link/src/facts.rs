//! The facts that a gateware reports about its build, and the check whether this host was made for
//! it.

use crate::registers::{IDENTITY_VALUE, PROTOCOL_VERSION};
use thiserror::Error;

/// The facts of a build, as its registers report them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct BuildFacts {
    /// Identity of the device; carrystep reports [`IDENTITY_VALUE`].
    pub identity: u32,
    /// Version of the protocol.
    pub protocol: u32,
    /// Build id: a hash of the register map and of all build parameters.
    pub build: u64,
    /// Number of axes.
    pub axes: u32,
    /// Clock, Hz.
    pub clock_hz: u32,
    /// Tick, ns.
    pub tick_ns: u32,
    /// Number of phases per tick.
    pub phases: u32,
    /// Time without a valid request after which the watchdog stops all axes, in ticks; 0 if it is
    /// off.
    pub watchdog_ticks: u32,
    /// Number of segments that can wait for an axis, besides the one that runs.
    pub queue_depth: u32,
}

/// Why a host refuses to drive this gateware.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum GatewareMismatch {
    /// The device answers in frames, but its identity is not carrystep's.
    #[error("what answers is not carrystep: identity {0:#010x}")]
    Identity(u32),
    /// The gateware has another version of the protocol.
    #[error(
        "the gateware speaks protocol {found}, this driver {PROTOCOL_VERSION}: use the driver of the gateware's release, or flash its gateware"
    )]
    Protocol {
        /// Version of the gateware.
        found: u32,
    },
    /// The gateware has another build id.
    #[error(
        "the gateware is build {found:016x}, this machine needs build {wanted:016x}: flash the gateware made from this machine file, or use the machine file that it was made from"
    )]
    Build {
        /// Build id of the gateware.
        found: u64,
        /// Build id that this host was made for.
        wanted: u64,
    },
}

impl BuildFacts {
    /// Checks that a host may drive this gateware. `wanted` is the build id that the host was made
    /// for, or `None` for any.
    ///
    /// # Errors
    /// [`GatewareMismatch`] gives the found and the wanted value.
    pub fn check(&self, wanted: Option<u64>) -> Result<(), GatewareMismatch> {
        if self.identity != IDENTITY_VALUE {
            return Err(GatewareMismatch::Identity(self.identity));
        }
        if self.protocol != PROTOCOL_VERSION {
            return Err(GatewareMismatch::Protocol { found: self.protocol });
        }
        match wanted {
            Some(wanted) if wanted != self.build => {
                Err(GatewareMismatch::Build { found: self.build, wanted })
            }
            _ => Ok(()),
        }
    }
}
