//! What a page can say in a text message. Bytes of the dialect come in binary messages.

use carrystep_grbl::{OverrideStep, Realtime};

/// Longest part of an unknown word that is repeated.
const REPEATED: usize = 20;

/// What a page says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Word {
    /// It asks for the state.
    State,
    /// Ramp all axes down.
    Stop,
    /// It wants to drive.
    Drive,
    /// It drives no longer.
    Release,
    /// A real-time character, from whoever has the token.
    Realtime(Realtime),
}

impl Word {
    /// The word of a text; `None` if it is unknown.
    pub fn of(text: &str) -> Option<Self> {
        use OverrideStep::{
            Feed, FeedReset, RapidFull, RapidHalf, RapidQuarter, Spindle, SpindleReset,
        };
        let step = match text {
            "?" => return Some(Self::State),
            "stop" => return Some(Self::Stop),
            "drive" => return Some(Self::Drive),
            "release" => return Some(Self::Release),
            "hold" => return Some(Self::Realtime(Realtime::Hold)),
            "resume" => return Some(Self::Realtime(Realtime::Resume)),
            "feed 100" => FeedReset,
            "feed +10" => Feed(10),
            "feed -10" => Feed(-10),
            "rapid 100" => RapidFull,
            "rapid 50" => RapidHalf,
            "rapid 25" => RapidQuarter,
            "spindle 100" => SpindleReset,
            "spindle +10" => Spindle(10),
            "spindle -10" => Spindle(-10),
            _ => return None,
        };
        Some(Self::Realtime(Realtime::Override(step)))
    }

    /// Whether a page without the token may say it.
    pub const fn is_free(self) -> bool {
        matches!(self, Self::State | Self::Stop)
    }
}

/// A line for a page that may not, or cannot, do what a text says.
pub fn refused(text: &str, why: &str) -> String {
    let plain = |c: &char| c.is_ascii_graphic() || *c == ' ';
    let name: String = text.chars().filter(plain).take(REPEATED).collect();
    format!("web refused {name}: {why}\n")
}
