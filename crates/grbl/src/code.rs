//! The numbers of errors and alarms, with their texts.

use thiserror::Error;

/// Why a line was not executed: `error:N`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Error)]
#[repr(u8)]
pub enum ErrorCode {
    /// A word without its letter.
    #[error("G-code words consist of a letter and a value. Letter was not found.")]
    ExpectedLetter = 1,
    /// A word without its number.
    #[error("Missing the expected G-code word value or numeric value format is not valid.")]
    BadNumber = 2,
    /// A `$` command that does not exist.
    #[error("Grbl '$' system command was not recognized or supported.")]
    Unsupported = 3,
    /// A value below 0.
    #[error("Negative value received for an expected positive value.")]
    Negative = 4,
    /// Homing without limit switches.
    #[error("Homing cycle failure. Homing is not enabled via settings.")]
    NoHoming = 5,
    /// A `$` command that needs a machine at rest.
    #[error("Grbl '$' command cannot be used unless Grbl is IDLE.")]
    NotIdle = 8,
    /// G-code in an alarm, or while the machine jogs.
    #[error("G-code commands are locked out during alarm or jog state.")]
    Locked = 9,
    /// A line that is too long.
    #[error("Max characters per line exceeded. Received command line was not executed.")]
    Overflow = 11,
    /// A jog beyond the travel of an axis.
    #[error("Jog target exceeds machine travel. Jog command has been ignored.")]
    Travel = 15,
    /// A jog with words that no jog has.
    #[error("Jog command has no '=' or contains prohibited g-code.")]
    BadJog = 16,
    /// A code that is unknown or not done.
    #[error("Unsupported or invalid g-code command found in block.")]
    UnknownCode = 20,
    /// Two codes of one modal group.
    #[error("More than one g-code command from same modal group found in block.")]
    SameGroup = 21,
    /// A feed move without a feed.
    #[error("Feed rate has not yet been set or is undefined.")]
    NoFeed = 22,
    /// A number that must be whole.
    #[error("G-code command in block requires an integer value.")]
    NotWhole = 23,
    /// Two codes that use the axis words.
    #[error("More than one g-code command that requires axis words found in block.")]
    AxesTwice = 24,
    /// A letter twice.
    #[error("Repeated g-code word found in block.")]
    Repeated = 25,
    /// A motion without axis words.
    #[error("No axis words found in block for g-code command which requires them.")]
    NoAxes = 26,
    /// N out of its range.
    #[error("Line number value is invalid.")]
    LineNumber = 27,
    /// A word that a code needs.
    #[error("G-code command is missing a required value word.")]
    MissingWord = 28,
    /// G53 with another motion than G0 and G1.
    #[error("G53 only allowed with G0 and G1 motion modes.")]
    MachineMotion = 30,
    /// Axis words that nothing uses.
    #[error("Axis words found in block when no command or current modal state uses them.")]
    UnusedAxes = 31,
    /// A target that cannot be reached.
    #[error("Motion command target is invalid.")]
    BadTarget = 33,
    /// An arc by radius that cannot be.
    #[error("Arc radius value is invalid.")]
    BadRadius = 34,
    /// Words that nothing uses.
    #[error("Unused value words found in block.")]
    UnusedWords = 36,
    /// A tool that does not exist.
    #[error("Tool number greater than max supported value.")]
    Tool = 38,
}

impl ErrorCode {
    /// Its number.
    pub const fn number(self) -> u8 {
        self as u8
    }
}

/// Why G-code is locked out: `ALARM:N`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Error)]
#[repr(u8)]
pub enum Alarm {
    /// A limit switch, or another stop that may have lost the position.
    #[error("Hard limit has been triggered. Machine position is likely lost due to sudden halt.")]
    HardLimit = 1,
    /// A target beyond the travel of an axis.
    #[error("Soft limit alarm. G-code motion target exceeds machine travel.")]
    SoftLimit = 2,
    /// A stop while the machine moved.
    #[error("Reset while in motion. Machine position is likely lost due to sudden halt.")]
    Abort = 3,
    /// The probe was in the wrong state before a probe move.
    #[error("Probe fail. Probe is not in the expected initial state before starting probe cycle.")]
    ProbeState = 4,
    /// The probe has not tripped.
    #[error("Probe fail. Probe did not contact the workpiece within the programmed travel.")]
    ProbeContact = 5,
    /// Homing was ended.
    #[error("Homing fail. The active homing cycle was reset.")]
    HomingReset = 6,
    /// The switch has not opened.
    #[error("Homing fail. Pull off travel failed to clear limit switch.")]
    HomingPullOff = 8,
    /// The switch was not found.
    #[error("Homing fail. Could not find limit switch within search distances.")]
    HomingSearch = 9,
}

impl Alarm {
    /// Its number.
    pub const fn number(self) -> u8 {
        self as u8
    }
}
