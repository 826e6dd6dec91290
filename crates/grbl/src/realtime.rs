//! Real-time characters: single bytes that act at once, wherever they stand in the stream, and that
//! are never a part of a line.

use crate::overrides::OverrideStep;

/// A real-time character.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Realtime {
    /// `?`: a status report.
    Report,
    /// `!`: feed hold.
    Hold,
    /// `~`: cycle start, or resume.
    Resume,
    /// 0x18: soft reset.
    Reset,
    /// 0x84: safety door.
    Door,
    /// 0x85: jog cancel.
    JogCancel,
    /// 0x90 to 0x9D but 0x98: an override.
    Override(OverrideStep),
    /// 0x9E: stops the spindle in a hold, and starts it again.
    SpindleStop,
    /// 0xA0: flood coolant on and off.
    Flood,
    /// 0xA1: mist coolant on and off.
    Mist,
}

/// What a byte of the stream is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Received {
    /// A real-time character.
    Realtime(Realtime),
    /// A byte of the extended set (0x80 to 0xFF) without a meaning. It is dropped.
    Unknown,
    /// A byte of a line.
    Text(u8),
}

impl Received {
    /// What this byte is.
    pub const fn of(byte: u8) -> Self {
        use OverrideStep::{
            Feed, FeedReset, RapidFull, RapidHalf, RapidQuarter, Spindle, SpindleReset,
        };
        let step = match byte {
            b'?' => return Self::Realtime(Realtime::Report),
            b'!' => return Self::Realtime(Realtime::Hold),
            b'~' => return Self::Realtime(Realtime::Resume),
            0x18 => return Self::Realtime(Realtime::Reset),
            0x84 => return Self::Realtime(Realtime::Door),
            0x85 => return Self::Realtime(Realtime::JogCancel),
            0x9e => return Self::Realtime(Realtime::SpindleStop),
            0xa0 => return Self::Realtime(Realtime::Flood),
            0xa1 => return Self::Realtime(Realtime::Mist),
            0x90 => FeedReset,
            0x91 => Feed(10),
            0x92 => Feed(-10),
            0x93 => Feed(1),
            0x94 => Feed(-1),
            0x95 => RapidFull,
            0x96 => RapidHalf,
            0x97 => RapidQuarter,
            0x99 => SpindleReset,
            0x9a => Spindle(10),
            0x9b => Spindle(-10),
            0x9c => Spindle(1),
            0x9d => Spindle(-1),
            0x80.. => return Self::Unknown,
            _ => return Self::Text(byte),
        };
        Self::Realtime(Realtime::Override(step))
    }
}
