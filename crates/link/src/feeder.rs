//! The feeder: sends the segments of a program in the order in which the queues need them, and each
//! start as early as possible.

pub use crate::command::SegmentSource;
use crate::command::{OutputChange, ProgramError, Segment, WideSegment};
use crate::frame::Body;
use crate::registers::{MOST_AXES, START};

#[derive(Debug, Clone, Copy, Default)]
struct Axis {
    /// The next segment, already read from the source.
    ahead: Option<Segment>,
    /// Whether the source has no more segments.
    dry: bool,
    /// Whether the last segment that was sent was not the last of its move.
    open: bool,
    /// Number of moves whose first segment was sent and whose start was not.
    waiting: u32,
    /// Sum of the ticks of all segments that were sent.
    ticks: u64,
    /// Number of segments that were sent and not cut off.
    sent: u32,
}

/// Chooses what to send next. Of the axes with a free queue place, the one whose sent segments last
/// for the shortest time comes first. A start is sent when each of its axes has its first segment,
/// no other start is pending, and no segment can be sent instead.
///
/// A wide feeder joins the next segments of several axes to one frame if they have the same ticks
/// and the same place in their axes' time: those of axes that move along one path.
#[derive(Debug, Clone)]
pub struct Feeder<S> {
    source: S,
    wide: bool,
    /// Number of segments that the queue of an axis holds; 0 if it is not known.
    depth: u8,
    axes: [Axis; MOST_AXES as usize],
    /// What changes with the next segment of axis 0.
    outputs: OutputChange,
    start: Option<u8>,
    last_start: bool,
    /// The state before a cut that is not decided yet.
    uncut: Option<([Axis; MOST_AXES as usize], OutputChange)>,
}

impl<S: SegmentSource> Feeder<S> {
    /// A feeder that has sent nothing yet, and sends a frame for each segment.
    pub fn new(source: S) -> Self {
        let axes = [Axis::default(); MOST_AXES as usize];
        let outputs = OutputChange::NONE;
        Self {
            source,
            wide: false,
            depth: 0,
            axes,
            outputs,
            start: None,
            last_start: false,
            uncut: None,
        }
    }

    /// A wide feeder.
    pub fn wide(source: S) -> Self {
        Self { wide: true, ..Self::new(source) }
    }

    /// The same for queues of so many segments, so that it can ask the source whether it
    /// [may send](SegmentSource::may_send) the next one. Without it, each free place is filled.
    #[must_use]
    pub fn with_queues(self, depth: u8) -> Self {
        Self { depth, ..self }
    }

    /// Whether the source gives this axis nothing now, because enough of its motion waits. `room` is
    /// the number of free places of its queue.
    pub fn holds_back(&self, axis: u8, room: u8) -> bool {
        let Some(axis) = self.axes.get(usize::from(axis)).filter(|_| self.depth > 0) else {
            return false;
        };
        let begun = axis.sent.saturating_sub(self.depth.saturating_sub(room).into());
        axis.ahead.is_none() && !axis.dry && !self.source.may_send(begun, axis.sent)
    }

    /// Reads the next segment of each axis that may be sent, and the next start, from the source.
    fn look_ahead(&mut self, axes: u8, room: &[u8]) {
        for (number, &room) in (0..axes).zip(room) {
            let waits = self.holds_back(number, room);
            let Some(axis) = self.axes.get_mut(usize::from(number)).filter(|_| !waits) else {
                continue;
            };
            if axis.ahead.is_none() && !axis.dry {
                axis.ahead = self.source.segment(number);
                axis.dry = axis.ahead.is_none();
                if number == 0 {
                    self.outputs = self.source.outputs();
                }
            }
        }
        if self.start.is_none() && !self.last_start {
            self.start = self.source.start();
            self.last_start = self.start.is_none();
        }
    }

    /// The next request for a build of `axes` axes. `room` is the number of free queue places of
    /// each axis; a start is returned only if `may_start` is true.
    ///
    /// # Errors
    /// [`ProgramError`] if the source returns a segment or a start that no gateware accepts.
    pub fn next(
        &mut self,
        axes: u8,
        room: &[u8],
        may_start: bool,
    ) -> Result<Option<Body>, ProgramError> {
        self.look_ahead(axes, room);
        let able = |(axis, room): &(&Axis, &u8)| axis.ahead.is_some() && **room > 0;
        let waiting = (0..axes).zip(self.axes.iter().zip(room)).filter(|(_, pair)| able(pair));
        let hungriest = waiting.min_by_key(|(_, (axis, _))| axis.ticks);
        if let Some((number, (&Axis { ticks, ahead: Some(segment), .. }, _))) = hungriest {
            if segment.ticks == 0 {
                return Err(ProgramError::NoTicks { axis: number });
            }
            let mut wide =
                WideSegment { ticks: segment.ticks, last: segment.last, ..WideSegment::default() };
            let queues = self.axes.iter_mut().zip(room).zip(&mut wide.cubics);
            for (other, ((axis, &room), cubic)) in (0..axes).zip(queues) {
                let joins = |ahead: &Segment| {
                    let same = (ahead.ticks, ahead.last) == (segment.ticks, segment.last);
                    self.wide && room > 0 && axis.ticks == ticks && same
                };
                if let Some(Segment { v, a, j, .. }) =
                    axis.ahead.take_if(|ahead| other == number || joins(ahead))
                {
                    wide.mask |= 1 << other;
                    *cubic = [v, a, j];
                    axis.waiting += u32::from(!axis.open);
                    axis.open = !segment.last;
                    axis.ticks += u64::from(segment.ticks);
                    axis.sent += 1;
                }
            }
            if wide.mask & 1 == 1 {
                wide.outputs = core::mem::take(&mut self.outputs);
            }
            return Ok(Some(if wide.mask == 1 << number {
                Body::Segment { axis: number, segment, outputs: wide.outputs }
            } else {
                Body::Segments(wide)
            }));
        }
        match self.start {
            Some(mask) if may_start && self.start_is_due(axes)? => {
                for (_, axis) in
                    self.axes.iter_mut().enumerate().filter(|(number, _)| mask >> number & 1 == 1)
                {
                    axis.waiting -= 1;
                }
                self.start = None;
                Ok(Some(Body::Write { address: START, word: mask.into() }))
            }
            _ => Ok(None),
        }
    }

    /// Whether the first segments of all axes of the next start were sent, so that only the
    /// gateware's state can delay the start.
    ///
    /// # Errors
    /// [`ProgramError`] if the start can never be sent.
    pub fn start_is_due(&self, axes: u8) -> Result<bool, ProgramError> {
        let Some(mask) = self.start else { return Ok(false) };
        for (number, axis) in
            (0..MOST_AXES).zip(&self.axes).filter(|(number, _)| mask >> number & 1 == 1)
        {
            if number >= axes {
                return Err(ProgramError::Axis { axis: number, axes });
            }
            if axis.waiting == 0 {
                return if axis.dry {
                    Err(ProgramError::NoMove { axis: number, mask })
                } else {
                    Ok(false)
                };
            }
        }
        Ok(true)
    }

    /// Whether a segment of this axis is waiting to be sent.
    pub fn wants(&self, axis: u8) -> bool {
        self.axes.get(usize::from(axis)).is_some_and(|axis| axis.ahead.is_some())
    }

    /// Number of segments of an axis that were sent and not cut off.
    pub fn sent(&self, axis: u8) -> u32 {
        self.axes.get(usize::from(axis)).map_or(0, |axis| axis.sent)
    }

    /// The source. Only [`SegmentSource::may_cut`] is asked of it.
    pub const fn source(&self) -> &S {
        &self.source
    }

    /// A cut is sent now, behind the first `keep` segments of each axis: the next segments of the
    /// source follow these, and go on with their move. Until [`Self::decided`] is called, the state
    /// of before is kept.
    pub fn cut(&mut self, axes: u8, keep: u32) {
        self.uncut = Some((self.axes, core::mem::take(&mut self.outputs)));
        let ticks = self.axes.iter().map(|axis| axis.ticks).max().unwrap_or_default();
        for (_, axis) in (0..axes).zip(&mut self.axes) {
            *axis = Axis { ahead: None, dry: false, open: true, waiting: 0, ticks, sent: keep };
        }
    }

    /// Whether a cut was sent and is not decided.
    pub const fn is_cutting(&self) -> bool {
        self.uncut.is_some()
    }

    /// The cut was granted, or nothing was dropped: then the state is that of before.
    pub fn decided(&mut self, granted: bool) {
        if let Some((axes, outputs)) = self.uncut.take()
            && !granted
        {
            (self.axes, self.outputs) = (axes, outputs);
            self.source.cut_refused();
        }
    }

    /// Whether a start is waiting to be sent.
    pub const fn wants_start(&self) -> bool {
        self.start.is_some()
    }

    /// Whether the whole program was sent.
    pub fn is_done(&self, axes: u8) -> bool {
        self.last_start
            && self.start.is_none()
            && self.axes.iter().take(axes.into()).all(|axis| axis.dry)
    }
}
