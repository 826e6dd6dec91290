//! Places of a program at which whoever runs it stops: for the operator, for a tool, or for an input.
//!
//! The planner carries such a place as a mark, as it carries changes of outputs (`row_outputs.rs`):
//! the row that begins there has it, and the tool rests before that row.

use crate::switch::Switch;
use carrystep_job::Row;
use std::fmt;

/// Bit of a mark: the mark is a place to wait at, and not a change of outputs.
const WAITS: u64 = 1 << 63;
/// Bits of such a mark that hold the index of [`KINDS`], and the first of them.
const KIND: u64 = 0b11 << FIRST;
const FIRST: u32 = 61;
/// Bits of such a mark that hold the line.
const LINE: u64 = (1 << FIRST) - 1;
/// What is waited for.
const KINDS: [Switch; 4] = [Switch::Pause, Switch::ToolChange, Switch::Probe, Switch::Input];

/// A place at which whoever runs the program waits until somebody lets it go on, reads an input, or
/// begins or ends a probe move. The tool rests.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SyncPoint {
    /// [`Switch::Pause`], [`Switch::ToolChange`] or [`Switch::Input`]: what is waited for.
    /// [`Switch::Probe`]: a probe move begins or ends here.
    pub switch: Switch,
    /// Line of the program.
    pub line: u64,
}

impl SyncPoint {
    /// The place of this event of a program; `None` if nobody waits there.
    pub(crate) fn of(switch: Switch, line: u64) -> Option<Self> {
        KINDS.contains(&switch).then_some(Self { switch, line })
    }

    /// The mark that the planner carries.
    pub(crate) fn mark(self) -> u64 {
        let kind = KINDS.iter().position(|&kind| kind == self.switch).unwrap_or_default();
        WAITS | (kind as u64) << FIRST | (self.line & LINE)
    }

    fn of_mark(mark: u64) -> Option<Self> {
        if !is_wait(mark) {
            return None;
        }
        let switch = *KINDS.get(((mark & KIND) >> FIRST) as usize)?;
        Some(Self { switch, line: mark & LINE })
    }
}

impl fmt::Display for SyncPoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let codes = match self.switch {
            Switch::ToolChange => "M6",
            Switch::Probe => "G38.2 to G38.5",
            Switch::Input => "M66",
            _ => "M0, M1 or M60",
        };
        write!(f, "{} in line {} ({codes})", self.switch, self.line)
    }
}

/// The places at which to stop before a row begins, in their order.
pub fn sync_points(row: &Row) -> impl Iterator<Item = SyncPoint> {
    row.marks.iter().filter_map(|&mark| SyncPoint::of_mark(mark))
}

/// Whether a mark is a place to wait at.
pub(crate) const fn is_wait(mark: u64) -> bool {
    mark & WAITS != 0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::RowOutputs;
    use carrystep_core::OutputChange;

    #[test]
    fn mark_gives_its_place_back() {
        for (switch, line) in KINDS.into_iter().zip([0, 1 << 40, 7, (1 << 61) - 1]) {
            let point = SyncPoint::of(switch, line).unwrap();
            assert_eq!(SyncPoint::of_mark(point.mark()), Some(point));
        }
        assert_eq!(SyncPoint::of(Switch::Spindle, 3), None);
        assert_eq!(SyncPoint::of_mark(u32::MAX.into()), None);
    }

    #[test]
    fn row_has_both_kinds_of_marks() {
        let change = OutputChange::of_word(1 << 4 | 1 << 12);
        let pause = SyncPoint { switch: Switch::Pause, line: 7 };
        let marks = vec![change.word().into(), pause.mark()];
        let row = Row {
            ticks: 1,
            segments: Vec::new(),
            line: 0,
            block: 0,
            feed: 0.0,
            off: 0.0,
            corner: 0.0,
            marks,
            rests: false,
        };
        assert_eq!(RowOutputs::default().change(&row), change);
        assert_eq!(sync_points(&row).collect::<Vec<_>>(), [pause]);
    }
}
