//! The state of the machine, as reports name it.

use std::fmt;

/// What a safety door has come to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Door {
    /// It is closed, and the machine may go on.
    IsClosed,
    /// The machine is brought to rest.
    Stops,
    /// Spindle and coolant are switched on again.
    Restores,
}

/// The state of the machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum State {
    /// It rests, and nothing waits.
    #[default]
    Idle,
    /// It executes G-code.
    Run,
    /// A feed hold; whether the axes already rest.
    Hold {
        /// The axes rest.
        rests: bool,
    },
    /// It jogs.
    Jog,
    /// G-code is locked out.
    Alarm,
    /// The safety door was reported.
    Door(Door),
    /// G-code is only checked.
    Check,
    /// It homes.
    Home,
    /// The drivers have no power.
    Sleep,
}

impl State {
    /// Whether fields that come only now and then come less often.
    pub const fn is_busy(self) -> bool {
        matches!(self, Self::Home | Self::Run | Self::Hold { .. } | Self::Jog | Self::Door(_))
    }
}

impl fmt::Display for State {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Idle => "Idle",
            Self::Run => "Run",
            Self::Hold { rests: true } => "Hold:0",
            Self::Hold { rests: false } => "Hold:1",
            Self::Jog => "Jog",
            Self::Alarm => "Alarm",
            Self::Door(Door::IsClosed) => "Door:0",
            Self::Door(Door::Stops) => "Door:2",
            Self::Door(Door::Restores) => "Door:3",
            Self::Check => "Check",
            Self::Home => "Home",
            Self::Sleep => "Sleep",
        })
    }
}
