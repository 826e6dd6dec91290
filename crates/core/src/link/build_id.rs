//! The build id: a hash by which a driver recognises the gateware that it was made for.

use super::registers::{LATCHES, MappedRegister, PROTOCOL_VERSION, REGISTERS};
use super::{ANSWER, Field};
use crate::EngineBuild;
use crate::engine::{Latch, LatchSource};
use alloc::borrow::ToOwned;
use alloc::format;
use alloc::string::String;
use core::fmt;
use sha2::{Digest, Sha256};

/// The build id: the first 64 bits of a SHA-256 over the register map and all build parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct BuildId(pub u64);

impl BuildId {
    /// The id of a build. `line` describes the build parameters of the link, such as its baud rate.
    pub fn new(build: &EngineBuild, line: &str) -> Self {
        let mut hash = Sha256::new();
        for part in [protocol(build), parameters(build), line.to_owned()] {
            hash.update(part);
            hash.update("\n--\n");
        }
        let digest = hash.finalize();
        Self(digest.iter().take(8).fold(0, |id, &byte| id << 8 | u64::from(byte)))
    }

    /// The two words as the registers [`registers::BUILD_LOW`] and [`registers::BUILD_HIGH`] hold
    /// them.
    pub const fn halves(self) -> [u32; 2] {
        [self.0 as u32, (self.0 >> 32) as u32]
    }
}

impl fmt::Display for BuildId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:016x}", self.0)
    }
}

/// The register map and the fields of an answer as text: names and places, without descriptions. A
/// register that the build does not have is left out.
fn protocol(build: &EngineBuild) -> String {
    let exists = |register: &&MappedRegister| {
        build.has_several_latches() || register.address != LATCHES || !register.access.is_read()
    };
    let registers = REGISTERS.iter().filter(exists).map(
        |MappedRegister { name, address, access, per_axis, .. }| {
            format!("{name} {address} {access:?} {per_axis}\n")
        },
    );
    let answer = ANSWER
        .iter()
        .map(|Field { name, byte, bit, bits, .. }| format!("{name} {byte} {bit} {bits}\n"));
    let version = format!("protocol {PROTOCOL_VERSION}\n");
    [version].into_iter().chain(registers).chain(answer).collect()
}

/// All build parameters as text. It uses the `Debug` output, so that a field added to a build
/// enters the hash without a change here.
///
/// A build that has no latch, or one with a pin of its own, keeps the text that it had when no
/// build had several latches, and so does one with one adder, so that their ids stay the same.
fn parameters(build: &EngineBuild) -> String {
    let text = format!("{build:?}").replace(", adders: 1 }", " }");
    match build.guard.latches.as_slice() {
        [] => text.replace("latches: []", "latch: None"),
        [latch @ Latch { source: LatchSource::Pin, low, looks }] => {
            let before = format!("latch: Some(Latch {{ low: {low}, looks: {looks} }})");
            text.replace(&format!("latches: [{latch:?}]"), &before)
        }
        _ => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{AXES, Build, PinTiming, StartPhase, Timebase};

    #[test]
    fn builds_with_at_most_one_latch_keep_their_text() {
        let timebase = Timebase::new(48_000_000, 2000, 16).unwrap();
        let build = Build { timebase, phase: StartPhase::Half, pins: [PinTiming::SHORTEST; AXES] };
        let mut build = EngineBuild::minimal(&build, 1);
        assert!(parameters(&build).contains(" latch: None, stop:"));
        build.guard.latches.push(Latch::of_pin(true, 3));
        let text = parameters(&build);
        assert!(text.contains(" latch: Some(Latch { low: true, looks: 3 }), stop:"), "{text}");
        build.guard.latches.push(Latch::of_pin(true, 3));
        assert!(parameters(&build).contains(" latches: [Latch { source: Pin, low: true"));
    }

    #[test]
    fn every_parameter_changes_the_build_id() {
        let timebase = Timebase::new(48_000_000, 2000, 16).unwrap();
        let build = Build { timebase, phase: StartPhase::Half, pins: [PinTiming::SHORTEST; AXES] };
        let build = EngineBuild::minimal(&build, 1);
        let id = |change: fn(&mut EngineBuild)| {
            let mut other = build.clone();
            change(&mut other);
            BuildId::new(&other, "uart")
        };
        let ids = [
            id(|_| ()),
            id(|build| build.pins[5].dir_hold = 2),
            id(|build| build.guard.watchdog = 9),
            id(|build| build.guard.stop[0] = 2),
            id(|build| build.phase = StartPhase::Zero),
            id(|build| build.timebase = Timebase::new(48_000_000, 2000, 4).unwrap()),
            BuildId::new(&build, "spi"),
        ];
        for (index, one) in ids.iter().enumerate() {
            assert!(!ids[..index].contains(one), "{index}");
        }
        assert_eq!(ids[0], BuildId::new(&build, "uart"));
    }
}
