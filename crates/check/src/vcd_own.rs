//! The marks of a capture that was written by carrystep: the start of its time in the header, and a
//! last line that shows that the file is complete.
//!
//! Existing captures contain these texts, so they may not change.

use carrystep_core::Timebase;
use std::fmt;

/// The last comment of a capture by carrystep. A file without it was cut off.
pub(crate) const END: &str = "carrystep end";

/// The last word of the header of a file that shows a part of a run.
const PART: &str = " part";

/// The header of a capture by carrystep: a comment `carrystep origin_ps=... clock_hz=...
/// tick_ns=... phases=...`, and ` part` if the file does not show the whole run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct OwnCapture {
    /// The load of the first move plus the latency L, ps of the capture.
    pub origin_ps: i64,
    /// Clock, tick and phases of the gateware.
    pub timebase: Timebase,
    /// Whether the file shows only a part of the run, or some of its axes. Its pulses are then not
    /// all.
    pub is_part: bool,
}

impl fmt::Display for OwnCapture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "carrystep origin_ps={} clock_hz={} tick_ns={} phases={}",
            self.origin_ps,
            self.timebase.clock_hz(),
            self.timebase.tick_ns(),
            self.timebase.phases()
        )?;
        f.write_str(if self.is_part { PART } else { "" })
    }
}

impl OwnCapture {
    /// Reads a comment. Returns `None` if it is not a comment by carrystep.
    pub fn from_comment(comment: &str) -> Option<Self> {
        let mut words = comment.split_whitespace();
        words.next().filter(|&first| first == "carrystep")?;
        let mut field = |key: &str| {
            let (name, value) = words.next()?.split_once('=')?;
            (name == key).then_some(value)
        };
        let origin_ps = field("origin_ps")?.parse().ok()?;
        let clock_hz = field("clock_hz")?.parse().ok()?;
        let tick_ns = field("tick_ns")?.parse().ok()?;
        let phases = field("phases")?.parse().ok()?;
        let is_part = words.next() == Some(PART.trim_start());
        let timebase = Timebase::new(clock_hz, tick_ns, phases).ok()?;
        Some(Self { origin_ps, timebase, is_part })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comment_reads_back_and_foreign_comments_are_ignored() {
        let timebase = Timebase::new(48_000_000, 1000, 16).unwrap();
        for is_part in [false, true] {
            let own = OwnCapture { origin_ps: -5, timebase, is_part };
            assert_eq!(OwnCapture::from_comment(&own.to_string()), Some(own));
        }
        for foreign in [
            "",
            "carrystep",
            "carrystep end",
            "carrystep origin_ps=1",
            "made by carrystep origin_ps=1",
        ] {
            assert_eq!(OwnCapture::from_comment(foreign), None);
        }
    }
}
