//! The part of an axis that the fast model moves.

use super::cubic::Cubic;
use super::shaper;
use super::stage::Stage;

/// The part of an axis that changes while strobes only add.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Moving {
    pub p: u64,
    pub cubic: Cubic,
    pub computed: Stage,
    pub emitted: Stage,
    pub shaper: shaper::ShaperState,
}
