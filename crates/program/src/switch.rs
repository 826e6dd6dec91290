//! What a program switches, or waits for, and the machine does not.

use std::fmt;

/// Something that a program switches or waits for, and that the machine does not.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Switch {
    /// M0, M1: the machine rests until it is resumed.
    Pause,
    /// M6: the machine rests until the tool is changed.
    ToolChange,
    /// M3 and M4, on a machine without an output for the spindle.
    Spindle,
    /// M7 and M8, on a machine without an output for it.
    Coolant,
    /// M62 to M68, on a machine without outputs.
    Output,
    /// M66: the input is assumed to become what the program waits for.
    Input,
    /// G38.2 to G38.5: the probe is assumed to trip at the target.
    Probe,
}

impl Switch {
    /// All of them, in the order of reports.
    pub const ALL: [Self; 7] = [
        Self::Pause,
        Self::ToolChange,
        Self::Spindle,
        Self::Coolant,
        Self::Output,
        Self::Input,
        Self::Probe,
    ];

    /// Its name in documents.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pause => "pause",
            Self::ToolChange => "tool change",
            Self::Spindle => "spindle",
            Self::Coolant => "coolant",
            Self::Output => "output",
            Self::Input => "input",
            Self::Probe => "probe",
        }
    }

    /// What the plan does instead.
    pub const fn instead(self) -> &'static str {
        match self {
            Self::Pause | Self::ToolChange => "the job rests; its time has no waiting",
            Self::Spindle | Self::Coolant | Self::Output => "the job rests; nothing is switched",
            Self::Input => "assumed to become what the program waits for",
            Self::Probe => "assumed to trip at its target",
        }
    }
}

/// How often a program does something.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SwitchCount {
    /// What it does.
    pub switch: Switch,
    /// How often.
    pub count: u64,
    /// The first line that does it.
    pub line: u64,
}

impl fmt::Display for Switch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
