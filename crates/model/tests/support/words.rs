//! The words of state that an engine has output in a tick, checked for their clocks.

use super::host::Cycle;
use carrystep_core::engine::StateItem::{
    Discarded, Left, PHigh, PLow, Position, Status, Switch, Ticks as Tick,
};
use carrystep_core::engine::{AxisStatus, StatePage, StateWord};

/// The words of an axis in a tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AxisWords {
    pub page: StatePage,
    pub p: u64,
    /// The word of beat 5, which page 0 lacks.
    pub left: Option<u32>,
    pub discarded: Option<u32>,
    pub position: i32,
    pub ticks: u32,
    pub status: AxisStatus,
    /// The row and the word of a switch that was sampled.
    pub switch: Option<(StatePage, u32)>,
}

/// The words of all axes in the cycles of a whole tick. Panics if a word is missing, is output in
/// another clock than its own, or if `refreshed` is wrong.
pub fn of_tick(tick: &[Cycle], axes: usize) -> Vec<AxisWords> {
    let mut all = Vec::new();
    for axis in 0..axes {
        let beat = |beat: usize| tick[13 * axis + beat].1.state.of_adder(0);
        let word = |at: usize, item| {
            let word = beat(at).unwrap_or_else(|| panic!("axis {axis}: no word in beat {at}"));
            assert_eq!((word.axis, word.item), (axis as u8, item));
            word
        };
        for quiet in [0, 1, 2, 3, 8, 9] {
            assert_eq!(beat(quiet), None);
        }
        let words = [(4, PLow), (6, Position), (10, PHigh), (11, Tick), (12, Status)]
            .map(|(at, item)| word(at, item));
        let [p, position, p_high, ticks, status] = words.map(|word: StateWord| word.word);
        let page = words[0].page;
        let switch = beat(7).map(|_| word(7, Switch)).map(|word| (word.page, word.word));
        assert!(words.iter().chain(&beat(5)).all(|word| word.page == page), "axis {axis}");
        let status = AxisStatus::of_word(status);
        let of = |item| beat(5).filter(|word| word.item == item).map(|word| word.word);
        let (left, discarded) = (of(Left), of(Discarded));
        let shown = [status.running, !status.running].map(|shown| shown && page != StatePage::Seek);
        assert_eq!([left.is_some(), discarded.is_some()], shown, "axis {axis} on {page:?}");
        let p = u64::from(p_high) << 32 | u64::from(p);
        let position = position.cast_signed();
        all.push(AxisWords { page, p, left, discarded, position, ticks, status, switch });
    }
    let is_live = all.last().is_some_and(|words| words.page == StatePage::Live);
    for (clock, (_, outputs)) in tick.iter().enumerate() {
        let last = clock + 1 == 13 * axes;
        assert_eq!(outputs.refreshed, last && is_live, "refreshed in clock {clock}");
        assert!(clock < 13 * axes || outputs.state.is_none());
    }
    all
}

/// The positions of all axes in each cycle, counted on the pins.
pub fn positions(history: &[Cycle], axes: usize) -> Vec<Vec<i32>> {
    let mut now = vec![0; axes];
    let mut high = 0;
    let count = |(_, outputs): &Cycle| {
        let rises = outputs.step & !high;
        high = outputs.step;
        for (axis, position) in now.iter_mut().enumerate() {
            let step = if outputs.dir >> axis & 1 == 1 { -1 } else { 1 };
            *position += if rises >> axis & 1 == 1 { step } else { 0 };
        }
        now.clone()
    };
    history.iter().map(count).collect()
}

/// The position that an axis counts in the next tick, if it counts `counted` in this one and has
/// made `made` steps in beat 6.
pub fn counted(counted: i32, made: i32) -> i32 {
    counted + (made - counted).clamp(-1, 1)
}
