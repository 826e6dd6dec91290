//! `queue_depth`: the number of segments that can wait for an axis.

use crate::error::{InputError, SourceText};
use carrystep_core::engine::QUEUE_DEPTHS;
use toml::Spanned;

/// Checks the depth; without one, the queues are the shortest.
pub(super) fn check(
    source: &SourceText,
    depth: Option<&Spanned<usize>>,
) -> Result<usize, InputError> {
    let Some(depth) = depth else { return Ok(QUEUE_DEPTHS[0]) };
    if QUEUE_DEPTHS.contains(depth.as_ref()) {
        return Ok(*depth.as_ref());
    }
    let message = format!("queue_depth = {}: it is 7, 15 or 31", depth.as_ref());
    Err(InputError::at(source, depth.span(), message).help(
        "it is the number of segments that can wait for an axis; deeper queues need more block RAM",
    ))
}
