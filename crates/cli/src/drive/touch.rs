//! A move from rest, outside of the path of a program, that ends where the probe closes or opens.
//!
//! ```text
//! seek with all axes -> stream the move -> hit: ramp, latched place, P to its start value
//!                                       -> no hit: at the target
//!                                       -> stop: ramp, clear
//! ```

use super::itinerary::Itinerary as _;
use super::moves::Moves;
use super::settle::{exact_position, settle};
use crate::connection::{ConnectedBoard, ConnectedBoardError};
use carrystep_files::Machine;
use carrystep_link::registers::{INPUTS, MOST_AXES};
use carrystep_link::{Answer, Ended, HostError, SeekSource, SegmentSource, Status, Wish};

/// The bit of the probe in the register INPUTS.
const PROBE: u32 = 16;

/// What looks at the board while it moves, and may stop it.
pub(super) type Watch<'a> = dyn FnMut(&Status) -> Wish + 'a;

/// What a move toward the probe, or away from it, has come to.
pub(super) enum Touched {
    /// The positions of all axes in the tick in which the level of the probe was accepted, steps.
    /// The axes rest a little further.
    At(Vec<f64>),
    /// The axes rest at the target.
    Missed,
    /// The axes rest where they were stopped.
    Stopped,
}

/// Whether the probe is closed.
pub fn is_closed(board: &mut ConnectedBoard) -> Result<bool, ConnectedBoardError> {
    Ok(board.register(INPUTS)? >> PROBE & 1 == 1)
}

/// All axes of the board, one bit each.
pub fn all_axes(board: &ConnectedBoard) -> u8 {
    ((1_u16 << board.facts().axes.min(MOST_AXES.into())) - 1) as u8
}

/// Makes the moves until the probe closes (`contact`) or opens. All axes rest before and behind it,
/// and behind it no axis waits for the probe.
pub(super) fn touch(
    board: &mut ConnectedBoard,
    machine: &Machine,
    (moves, contact): (&Moves, bool),
    watch: &mut Watch<'_>,
) -> Result<Touched, ConnectedBoardError> {
    let source = SeekSource::probe(contact);
    let axes = all_axes(board);
    board.seek(axes, source)?;
    let way = moves.itinerary();
    way.begin();
    let ended = go(board, way.source(), watch);
    if !matches!(ended, Ok(Ended::Done | Ended::SeekEnded)) {
        // What the caller has to know is how the move ended.
        let dropped = board.seek(0, source);
        ended?;
        return dropped.map(|()| Touched::Stopped);
    }
    let Some(states) = board.end_seek()? else { return Ok(Touched::Missed) };
    settle(board, machine)?;
    board.read_status()?;
    Ok(Touched::At(states.iter().take(machine.axes.len()).map(exact_position).collect()))
}

/// Streams a move of a board that rests. If `watch` stops it, the axes ramp down, and then the stop
/// is cleared.
pub(super) fn go<'s>(
    board: &mut ConnectedBoard,
    source: Box<dyn SegmentSource + 's>,
    watch: &mut Watch<'_>,
) -> Result<Ended, ConnectedBoardError> {
    let mut source = source;
    let ended = board.stream(&mut *source, |progress| watch(progress.status))?;
    if ended == Ended::Stopped {
        board.clear()?;
    }
    let Answer { fault, cause, culprits, .. } = board.read_status()?.answer;
    if fault {
        return Err(HostError::Fault { cause, culprits });
    }
    Ok(ended)
}
