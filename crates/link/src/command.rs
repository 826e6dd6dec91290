//! The commands of a program for the gateware: segments and starts. A program is checked as a whole
//! before anything is sent.

use crate::registers::MOST_AXES;
use core::cell::RefCell;
use thiserror::Error;

pub use carrystep_core::{OutputChange, Segment};

/// Segments of several axes with the same ticks, which one frame carries.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct WideSegment {
    /// The axes, one bit each.
    pub mask: u8,
    /// Number of ticks, 1 or more.
    pub ticks: u32,
    /// V, A and J of each axis as in [`Segment`]; those of other axes have no meaning.
    pub cubics: [[i64; 3]; MOST_AXES as usize],
    /// Whether the axes stop when the segment is over.
    pub last: bool,
    /// What changes at the outputs where the segment begins, if axis 0 is one of the axes.
    pub outputs: OutputChange,
}

impl WideSegment {
    /// Number, and V, A and J, of each of its axes in ascending order.
    pub fn axes(&self) -> impl Iterator<Item = (u8, [i64; 3])> + '_ {
        (0..MOST_AXES).zip(self.cubics).filter(|(axis, _)| self.mask >> axis & 1 == 1)
    }
}

/// A cut: the slot of the last segment that each axis keeps, and `None` for an axis that takes no
/// part. In all other axes, the segments behind it are dropped in one tick, or in none of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct CutSlots(pub [Option<u8>; MOST_AXES as usize]);

impl CutSlots {
    /// Bit of an axis' word: the axis takes part.
    const NAMED: u32 = 1 << 24;

    /// The words of the frame, one for each axis.
    pub(crate) fn words(&self) -> [u32; MOST_AXES as usize] {
        self.0.map(|slot| slot.map_or(0, |slot| Self::NAMED | u32::from(slot)))
    }

    /// The slots in these words.
    pub(crate) fn of_words(words: [u32; MOST_AXES as usize]) -> Self {
        Self(words.map(|word| (word >> 24 != 0).then_some(word as u8 & 0x1f)))
    }
}

/// One command of a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Command {
    /// A segment for an axis.
    Segment {
        /// Number of the axis, from 0.
        axis: u8,
        /// The segment.
        segment: Segment,
    },
    /// Changes outputs where the next segment of axis 0 begins. Several of these before one segment
    /// have the effect of one after the other.
    Outputs(OutputChange),
    /// Starts axes on the same tick.
    Start {
        /// Bit i starts axis i.
        mask: u8,
    },
}

/// Why a program cannot be sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum ProgramError {
    /// The program uses an axis that this build does not have.
    #[error("the program moves axis {axis}, and this build has {axes} (from 0)")]
    Axis {
        /// Number of the axis, from 0.
        axis: u8,
        /// Number of axes of the build.
        axes: u8,
    },
    /// A segment has 0 ticks.
    #[error("a segment of no ticks for axis {axis}: 1 or more are needed")]
    NoTicks {
        /// Number of the axis, from 0.
        axis: u8,
    },
    /// A start includes an axis that has no move waiting for it.
    #[error("start of axes {mask:#04x}: axis {axis} has no move for it")]
    NoMove {
        /// Number of the axis, from 0.
        axis: u8,
        /// Mask of the start.
        mask: u8,
    },
    /// The last segment of an axis is not marked `last`.
    #[error("the segments of axis {axis} end without a last one: its queue would run dry")]
    NoEnd {
        /// Number of the axis, from 0.
        axis: u8,
    },
    /// Segments of an axis remain after the last start.
    #[error("axis {axis} has a move that no start starts")]
    NoStart {
        /// Number of the axis, from 0.
        axis: u8,
    },
    /// A change of outputs has no segment of axis 0 behind it.
    #[error("outputs change, and no segment of axis 0 follows with which they could")]
    NoSegment,
    /// A start while the drivers have no power. The gateware would refuse it as long as they have
    /// none.
    #[error(
        "the drivers have no power: write CONTROL = 1 and wait for `ready` before the first START"
    )]
    NoPower,
}

/// A source of segments: memory, a file, or a planner that runs at the same time.
pub trait SegmentSource {
    /// The next segment of an axis; `None` when there are no more.
    fn segment(&mut self, axis: u8) -> Option<Segment>;
    /// What changes at the outputs where a segment of axis 0 begins: the one that
    /// [`segment`](Self::segment) has just returned. The feeder calls this once behind each
    /// `segment(0)`.
    fn outputs(&mut self) -> OutputChange {
        OutputChange::NONE
    }
    /// Mask of the next start; `None` when there are no more.
    fn start(&mut self) -> Option<u8>;
    /// Whether [`Wish::Cut`](crate::Wish::Cut) may be asked for while this source is streamed.
    fn may_cut(&self) -> bool {
        false
    }
    /// Whether an axis is to get its next segment now, if its queue has a free place. It was sent
    /// `sent` segments that were not cut off, of which at least `begun` have begun to run. A source
    /// that wants little motion to wait in the queues gives nothing while enough of it waits.
    fn may_send(&self, _begun: u32, _sent: u32) -> bool {
        true
    }
    /// The gateware has refused the last cut, so all segments of before are still in its queues.
    /// From now on the source gives what it would have given without the cut.
    fn cut_refused(&mut self) {}
}

impl<S: SegmentSource + ?Sized> SegmentSource for &mut S {
    fn segment(&mut self, axis: u8) -> Option<Segment> {
        (**self).segment(axis)
    }

    fn outputs(&mut self) -> OutputChange {
        (**self).outputs()
    }

    fn start(&mut self) -> Option<u8> {
        (**self).start()
    }

    fn may_cut(&self) -> bool {
        (**self).may_cut()
    }

    fn may_send(&self, begun: u32, sent: u32) -> bool {
        (**self).may_send(begun, sent)
    }

    fn cut_refused(&mut self) {
        (**self).cut_refused();
    }
}

/// A source that others change, in the same thread, while the link reads it. It is borrowed only
/// during a call.
impl<S: SegmentSource + ?Sized> SegmentSource for &RefCell<S> {
    fn segment(&mut self, axis: u8) -> Option<Segment> {
        self.borrow_mut().segment(axis)
    }

    fn outputs(&mut self) -> OutputChange {
        self.borrow_mut().outputs()
    }

    fn start(&mut self) -> Option<u8> {
        self.borrow_mut().start()
    }

    fn may_cut(&self) -> bool {
        self.borrow().may_cut()
    }

    fn may_send(&self, begun: u32, sent: u32) -> bool {
        self.borrow().may_send(begun, sent)
    }

    fn cut_refused(&mut self) {
        self.borrow_mut().cut_refused();
    }
}

/// Segments and starts in order, as a [`SegmentSource`] that gives each axis its own segments.
#[derive(Debug, Clone)]
pub struct Program<'a> {
    commands: &'a [Command],
    segment: [usize; MOST_AXES as usize],
    outputs: OutputChange,
    start: usize,
}

impl<'a> Program<'a> {
    /// Checks a program for a build with this number of axes.
    ///
    /// # Errors
    /// [`ProgramError`] names the axis and the mistake. Nothing has been sent.
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
                    Command::Segment { .. } | Command::Outputs(_) | Command::Start { .. } => {}
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
        let last = |is: fn(&Command) -> bool| commands.iter().rposition(is);
        let of_first = last(|command| matches!(command, Command::Segment { axis: 0, .. }));
        if last(|command| matches!(command, Command::Outputs(_))) > of_first {
            return Err(ProgramError::NoSegment);
        }
        let outputs = OutputChange::NONE;
        Ok(Self { commands, segment: [0; MOST_AXES as usize], outputs, start: 0 })
    }
}

impl SegmentSource for Program<'_> {
    fn segment(&mut self, axis: u8) -> Option<Segment> {
        let at = self.segment.get_mut(usize::from(axis))?;
        while let Some(command) = self.commands.get(*at) {
            *at += 1;
            match *command {
                Command::Segment { axis: own, segment } if own == axis => return Some(segment),
                Command::Outputs(change) if axis == 0 => self.outputs = self.outputs.then(change),
                _ => {}
            }
        }
        None
    }

    fn outputs(&mut self) -> OutputChange {
        core::mem::take(&mut self.outputs)
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
    use super::Command;
    use carrystep_core as planned;

    impl Command {
        /// Converts a planned command; `None` for a wait or a clear, which the link's programs do
        /// not contain.
        pub fn of(command: &planned::Command) -> Option<Self> {
            match *command {
                planned::Command::Segment { axis, segment } => {
                    Some(Self::Segment { axis, segment })
                }
                planned::Command::Start { mask } => Some(Self::Start { mask }),
                planned::Command::Outputs(change) => Some(Self::Outputs(change)),
                planned::Command::Wait { .. } | planned::Command::Clear => None,
            }
        }
    }
}
