//! A line as what it asks for.

use crate::code::ErrorCode;
use crate::state::State;

/// What `$RST=` restores.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Restore {
    /// `$`: the settings.
    Settings,
    /// `#`: offsets and stored places.
    Parameters,
    /// `*`: both.
    All,
}

/// What a line asks for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Request<'a> {
    /// Nothing: the line is empty.
    Empty,
    /// G-code.
    Gcode(&'a str),
    /// `$`.
    Help,
    /// `$$`.
    Settings,
    /// `$x=value`.
    Write {
        /// Number of the setting.
        number: u16,
        /// Its new value.
        value: f64,
    },
    /// `$#`.
    Parameters,
    /// `$G`.
    ParserState,
    /// `$I`.
    Build,
    /// `$I=text`.
    WriteBuild(&'a str),
    /// `$N`.
    Startup,
    /// `$Nx=line`.
    WriteStartup(&'a str),
    /// `$J=line`: the line.
    Jog(&'a str),
    /// `$H`; of one axis `$HX`.
    Home(Option<char>),
    /// `$X`.
    Unlock,
    /// `$C`.
    Check,
    /// `$SLP`.
    Sleep,
    /// `$RST=`.
    Restore(Restore),
}

impl<'a> Request<'a> {
    /// Reads a line without blanks and comments, in capitals.
    ///
    /// # Errors
    /// A `$` command that does not exist, or whose number is none.
    pub fn of(line: &'a str) -> Result<Self, ErrorCode> {
        let Some(command) = line.strip_prefix('$') else {
            return Ok(if line.is_empty() { Self::Empty } else { Self::Gcode(line) });
        };
        Ok(match command {
            "" => Self::Help,
            "$" => Self::Settings,
            "#" => Self::Parameters,
            "G" => Self::ParserState,
            "I" => Self::Build,
            "N" => Self::Startup,
            "H" => Self::Home(None),
            "HX" | "HY" | "HZ" | "HA" | "HB" | "HC" => Self::Home(command.chars().nth(1)),
            "X" => Self::Unlock,
            "C" => Self::Check,
            "SLP" => Self::Sleep,
            "RST=$" => Self::Restore(Restore::Settings),
            "RST=#" => Self::Restore(Restore::Parameters),
            "RST=*" => Self::Restore(Restore::All),
            _ => return Self::assignment(command),
        })
    }

    fn assignment(command: &'a str) -> Result<Self, ErrorCode> {
        if command.starts_with('J') {
            let line = command.strip_prefix("J=").filter(|line| !line.is_empty());
            return line.map(Self::Jog).ok_or(ErrorCode::BadJog);
        }
        let (name, value) = command.split_once('=').ok_or(ErrorCode::Unsupported)?;
        match name {
            "I" => return Ok(Self::WriteBuild(value)),
            "N0" | "N1" => return Ok(Self::WriteStartup(value)),
            _ => {}
        }
        if !name.bytes().all(|byte| byte.is_ascii_digit()) {
            return Err(ErrorCode::Unsupported);
        }
        let number = name.parse().map_err(|_| ErrorCode::Unsupported)?;
        let is_plain =
            value.bytes().all(|byte| byte.is_ascii_digit() || matches!(byte, b'.' | b'-' | b'+'));
        let value: f64 = value.parse().ok().filter(|_| is_plain).ok_or(ErrorCode::BadNumber)?;
        if value < 0.0 { Err(ErrorCode::Negative) } else { Ok(Self::Write { number, value }) }
    }

    /// Whether the machine may do this in its state.
    ///
    /// # Errors
    /// [`ErrorCode::Locked`] for G-code in an alarm and while the machine jogs or sleeps;
    /// [`ErrorCode::NotIdle`] for commands that need a machine at rest.
    pub fn is_allowed(&self, state: State) -> Result<(), ErrorCode> {
        use State::{Alarm, Check, Door, Hold, Home, Idle, Jog, Run, Sleep};
        let rests = matches!(state, Idle | Alarm | Check);
        match self {
            Self::Empty | Self::Help | Self::ParserState | Self::Unlock => Ok(()),
            Self::Gcode(_) if matches!(state, Alarm | Jog | Sleep) => Err(ErrorCode::Locked),
            Self::Gcode(_) => Ok(()),
            Self::Settings if matches!(state, Run | Hold { .. } | Jog | Home | Door(_)) => {
                Err(ErrorCode::NotIdle)
            }
            Self::Settings => Ok(()),
            Self::Jog(_) if matches!(state, Idle | Jog) => Ok(()),
            Self::Check if matches!(state, Idle | Check) => Ok(()),
            Self::Home(_) | Self::Sleep if matches!(state, Idle | Alarm) => Ok(()),
            Self::Jog(_) | Self::Check | Self::Home(_) | Self::Sleep => Err(ErrorCode::NotIdle),
            _ if rests => Ok(()),
            _ => Err(ErrorCode::NotIdle),
        }
    }
}
