//! What a host wants done: segments and starts, and a program of them that is checked before anything is sent.

use crate::feeder::Source;
use crate::registers::MOST_AXES;
use thiserror::Error;

/// A stretch of whole ticks over which one axis follows a cubic.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Segment {
    /// Length in ticks, at least 1.
    pub ticks: u32,
    /// Speed, 2^-64 step per tick.
    pub v: i64,
    /// Acceleration, 2^-64 step per tick^2.
    pub a: i64,
    /// Jerk, 2^-64 step per tick^3.
    pub j: i64,
    /// The axis stops when this segment is over.
    pub last: bool,
}

/// One step of a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Command {
    /// A segment for an axis.
    Segment {
        /// Axis, from 0.
        axis: u8,
        /// The segment.
        segment: Segment,
    },
    /// Starts axes together, a bit each.
    Start {
        /// Bit i starts axis i.
        mask: u8,
    },
}

/// Why a program cannot be sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum ProgramError {
    /// An axis that this build does not have.
    #[error("the program moves axis {axis}, and this build has {axes} (from 0)")]
    Axis {
        /// The axis.
        axis: u8,
        /// How many there are.
        axes: u8,
    },
    /// A segment of no ticks.
    #[error("a segment of no ticks for axis {axis}: 1 or more are needed")]
    NoTicks {
        /// The axis.
        axis: u8,
    },
    /// A start for an axis that has no segments for it.
    #[error("start of axes {mask:#04x}: axis {axis} has no move for it")]
    NoMove {
        /// The axis.
        axis: u8,
        /// The start's axes.
        mask: u8,
    },
    /// The segments of an axis end without one that is the last of its move.
    #[error("the segments of axis {axis} end without a last one: its queue would run dry")]
    NoEnd {
        /// The axis.
        axis: u8,
    },
    /// Segments that no start starts.
    #[error("axis {axis} has a move that no start starts")]
    NoStart {
        /// The axis.
        axis: u8,
    },
    /// A start while the drivers have no power: the gateware would refuse it for as long as they have none.
    #[error("the drivers have no power: write CONTROL = 1 and wait for `ready` before the first START")]
    NoPower,
}

/// Segments and starts in order, as a [`Source`]: each axis takes its own.
#[derive(Debug, Clone)]
pub struct Program<'a> {
    commands: &'a [Command],
    segment: [usize; MOST_AXES as usize],
    start: usize,
}

impl<'a> Program<'a> {
    /// A program for a build of so many axes.
    ///
    /// # Errors
    /// [`ProgramError`] names the axis and what is wrong: nothing of it has been sent yet.
    pub fn new(commands: &'a [Command], axes: u8) -> Result<Self, ProgramError> {
        for axis in 0..MOST_AXES {
            let (mut begun, mut started, mut open) = (0_usize, 0, false);
            for command in commands {
                match *command {
                    Command::Segment { axis: other, .. } if other >= axes => {
                        return Err(ProgramError::Axis { axis: other, axes });
                    }
                    Command::Segment { axis: own, segment } if own == axis => {
                        if segment.ticks == 0 {
                            return Err(ProgramError::NoTicks { axis });
                        }
                        begun += usize::from(!open);
                        open = !segment.last;
                    }
                    Command::Start { mask } if mask >> axis & 1 == 1 => {
                        if axis >= axes {
                            return Err(ProgramError::Axis { axis, axes });
                        }
                        started += 1;
                    }
                    Command::Segment { .. } | Command::Start { .. } => {}
                }
            }
            if open {
                return Err(ProgramError::NoEnd { axis });
            }
            if started > begun {
                let with = |command: &&Command| matches!(**command, Command::Start { mask } if mask >> axis & 1 == 1);
                let beyond = commands.iter().filter(with).nth(begun);
                let mask = if let Some(&Command::Start { mask }) = beyond { mask } else { 0 };
                return Err(ProgramError::NoMove { axis, mask });
            }
            if started < begun {
                return Err(ProgramError::NoStart { axis });
            }
        }
        Ok(Self { commands, segment: [0; MOST_AXES as usize], start: 0 })
    }
}

impl Source for Program<'_> {
    fn segment(&mut self, axis: u8) -> Option<Segment> {
        let at = self.segment.get_mut(usize::from(axis))?;
        while let Some(command) = self.commands.get(*at) {
            *at += 1;
            match *command {
                Command::Segment { axis: own, segment } if own == axis => return Some(segment),
                _ => {}
            }
        }
        None
    }

    fn start(&mut self) -> Option<u8> {
        while let Some(command) = self.commands.get(self.start) {
            self.start += 1;
            if let Command::Start { mask } = *command {
                return Some(mask);
            }
        }
        None
    }
}

#[cfg(feature = "std")]
mod from_core {
    use super::{Command, Segment};
    use carrystep_core as planned;

    impl From<planned::Segment> for Segment {
        fn from(planned::Segment { ticks, v, a, j, last }: planned::Segment) -> Self {
            Self { ticks, v, a, j, last }
        }
    }

    impl Command {
        /// A planned command, where the link has it: a wait or a clear is no part of a program here.
        pub fn of(command: &planned::Command) -> Option<Self> {
            match *command {
                planned::Command::Segment { axis, segment } => Some(Self::Segment { axis, segment: segment.into() }),
                planned::Command::Start { mask } => Some(Self::Start { mask }),
                planned::Command::Wait { .. } | planned::Command::Clear => None,
            }
        }
    }
}
