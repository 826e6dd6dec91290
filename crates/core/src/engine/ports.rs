//! The ports of the engine, and which field of [`EngineInputs`] or [`EngineOutputs`] is at each.

use super::{
    CAUSE_BITS, EngineBuild, EngineInputs, EngineOutputs, STATE_AXIS_BITS, STATE_ITEM_BITS,
    StateWord, StateWords,
};
use crate::ports::{CLOCK, Direction, Peer, Port, Width, input, output};

const BIT: Width = Width::Bits(1);
const PER_ADDER: Width = Width::PerAdder(1);
const AXIS: Width = Width::Bits(3);
const WORD: Width = Width::Bits(32);

/// The ports of `carrystep_engine`, in order.
pub const ENGINE_PORTS: &[Port] = &[
    CLOCK,
    input("put_valid", BIT, Peer::Host, "the host offers a word of a segment"),
    input("put_axis", AXIS, Peer::Host, "the axis of that word, and of `room`"),
    input("put_word", Width::Bits(4), Peer::Host, "the number of the word; 7 commits the segment"),
    input("put_data", WORD, Peer::Host, "the word; 7: bit 0 is `last`, 31..1 outputs"),
    output("put_ready", BIT, Peer::Host, "the engine accepts an offered word in this clock"),
    input("start_valid", BIT, Peer::Host, "the host offers a start"),
    input("start_mask", Width::Axes, Peer::Host, "the axes to start on one tick"),
    output("start_ready", BIT, Peer::Host, "the engine accepts an offered start in this clock"),
    input("cut", BIT, Peer::Host, "the host requests a cut in the axes that it has named"),
    output("cut_busy", BIT, Peer::Host, "a cut was requested and is not decided yet"),
    output("cut_refused", BIT, Peer::Host, "the last cut was refused"),
    input("clear", BIT, Peer::Host, "resume after a stop"),
    input("reset", BIT, Peer::Nobody, "return to the state at configuration; tie to 0 if unused"),
    input("stop", BIT, Peer::Host, "the host requests a controlled stop"),
    input("broken", BIT, Peer::Host, "the host has broken the segment protocol"),
    input("seek_source_valid", BIT, Peer::Host, "the host replaces the source of seeks"),
    input("seek_source", Width::Bits(7), Peer::Host, "axis 3, row 2, own 1, level 1"),
    input("seek_valid", BIT, Peer::Host, "the host replaces the mask of the axes that seek"),
    input("seek_mask", Width::Axes, Peer::Host, "the axes that wait for the source from now on"),
    input("latch_arm", BIT, Peer::Host, "the host arms the latch"),
    input("snapshot", BIT, Peer::Host, "the host requests a snapshot of the state of all axes"),
    input("kick", BIT, Peer::Host, "a valid request has arrived: the watchdog restarts"),
    input("enable", BIT, Peer::Host, "the host requests power for the drivers"),
    input("estop", BIT, Peer::Pins, "the e-stop pin, asynchronous"),
    input("limit_min", Width::Axes, Peer::Pins, "the limit pins at the low ends, asynchronous"),
    input("limit_max", Width::Axes, Peer::Pins, "the limit pins at the high ends, asynchronous"),
    input("inputs_0", Width::Axes, Peer::Pins, "bit 0 the probe, general inputs, asynchronous"),
    input("inputs_1", Width::Axes, Peer::Pins, "bit 0 the interlock, general inputs, asynchronous"),
    input("latch", BIT, Peer::Pins, "the pin of the latch, asynchronous"),
    output("state_valid", PER_ADDER, Peer::Host, "a word of state is output in this clock"),
    output(
        "state_page",
        Width::PerAdder(2),
        Peer::Host,
        "its page: 0 hit of a seek, 1 live, 2 snapshot, 3 latch",
    )
    .valid_with("state_valid"),
    output("state_axis", Width::PerAdder(STATE_AXIS_BITS), Peer::Host, "its axis")
        .valid_with("state_valid"),
    output(
        "state_item",
        Width::PerAdder(STATE_ITEM_BITS),
        Peer::Host,
        "0 discarded, 1 left, 2 switch, 3 ticks, 4 5 P, 6 position, 7 status",
    )
    .valid_with("state_valid"),
    output("state", Width::PerAdder(32), Peer::Host, "the word; of the status bits 15 to 0 only")
        .valid_with("state_valid"),
    output("refreshed", BIT, Peer::Host, "all live words of this tick have been output"),
    output(
        "room",
        Width::Bits(5),
        Peer::Host,
        "segments for which the queue of `put_axis` has room",
    )
    .valid_with("room_valid"),
    output("room_valid", BIT, Peer::Host, "`room` is valid, once in a time slot of that axis"),
    output("step", Width::Axes, Peer::Pins, "the STEP pins"),
    output("dir", Width::Axes, Peer::Pins, "the DIR pins; 1 is backward"),
    output("outputs", Width::Bits(8), Peer::Pins, "the outputs; 1 is active"),
    output("pwm", BIT, Peer::Pins, "the pin of the PWM; 1 is active"),
    output("enabled", BIT, Peer::Pins, "the drivers are to have power"),
    output("idle", BIT, Peer::Host, "all axes are at rest and no start is armed"),
    output("fault", BIT, Peer::Host, "a stop is in force"),
    output("halted", BIT, Peer::Host, "a stop is in force and no axis moves any more"),
    output("resetting", BIT, Peer::Nobody, "the engine is returning to that state"),
    output("cause", Width::Bits(CAUSE_BITS as u32), Peer::Host, "the number of its cause")
        .valid_with("fault"),
    output("culprits", Width::Axes, Peer::Host, "the axes that it came from").valid_with("fault"),
    output("armed", BIT, Peer::Host, "a start is armed"),
    output("ready", BIT, Peer::Host, "the drivers have had power for long enough"),
    output("seeking", Width::Axes, Peer::Host, "the axes that wait for the source of their seek"),
    output("hits", Width::Axes, Peer::Host, "the axes that have hit it, until the seek is ended"),
    output("latch_armed", BIT, Peer::Host, "the latch waits for its edge"),
    output("latch_edges", Width::Bits(4), Peer::Host, "further edges since it was armed"),
    output("started", BIT, Peer::Nobody, "axes start at the end of this clock"),
];

/// The further ports of `carrystep_engine` in a build with several latches, in order.
pub const MORE_LATCH_PORTS: &[Port] = &[
    input("more_latches", Width::Bits(3), Peer::Pins, "the pins of latches 1 to 3, asynchronous"),
    input("more_latch_arm", Width::Bits(3), Peer::Host, "the host arms these latches"),
    output("more_latch_armed", Width::Bits(3), Peer::Host, "these latches wait for their edges"),
    output("more_latch_edges", Width::Bits(12), Peer::Host, "further edges of each of them"),
    output("latch_records", Width::Bits(8), Peer::Host, "the record of each latch from 0 on"),
    output("state_record", Width::Bits(2), Peer::Host, "the record of the words of page 3")
        .valid_with("state_valid"),
];

/// The ports of `carrystep_engine` in this build, in order.
pub fn engine_ports(build: &EngineBuild) -> impl Iterator<Item = &'static Port> + Clone + use<> {
    let more = if build.has_several_latches() { MORE_LATCH_PORTS } else { &[] };
    ENGINE_PORTS.iter().chain(more)
}

/// The ports of this direction that [`EngineInputs::at_ports`] and [`EngineOutputs::at_ports`]
/// list, in their order: all but the clock. The last ones are those of [`MORE_LATCH_PORTS`].
pub fn ports_of(direction: Direction) -> impl Iterator<Item = &'static Port> {
    let all = ENGINE_PORTS.iter().chain(MORE_LATCH_PORTS);
    all.filter(move |port| port.direction == direction && port.peer != Peer::Clock)
}

/// True if benches print the value of this port when it changes. Words of state change in most
/// clocks: of them the benches print a checksum ([`EngineOutputs::state_sum`]).
pub fn is_recorded(port: &Port) -> bool {
    port.name != "refreshed" && !port.name.starts_with("state")
}

impl EngineInputs {
    /// Name and value of each input in the order of [`ports_of`]. `None` is a value that is
    /// not offered and has no effect; it is driven as 0.
    pub fn at_ports(&self) -> [(&'static str, Option<u64>); 27] {
        let Self {
            put,
            room_of,
            start,
            cut,
            clear,
            reset,
            stop,
            broken,
            seek_source,
            seek,
            latch_arm,
            snapshot,
            kick,
            enable,
            estop,
            limit_min,
            limit_max,
            inputs: [inputs_0, inputs_1],
            latch,
        } = *self;
        [
            ("put_valid", Some(put.is_some().into())),
            ("put_axis", Some(put.map_or(room_of, |put| put.axis).into())),
            ("put_word", put.map(|put| put.word.into())),
            ("put_data", put.map(|put| put.data.into())),
            ("start_valid", Some(start.is_some().into())),
            ("start_mask", start.map(u64::from)),
            ("cut", Some(cut.into())),
            ("clear", Some(clear.into())),
            ("reset", Some(reset.into())),
            ("stop", Some(stop.into())),
            ("broken", Some(broken.into())),
            ("seek_source_valid", Some(seek_source.is_some().into())),
            ("seek_source", seek_source.map(|source| source.byte().into())),
            ("seek_valid", Some(seek.is_some().into())),
            ("seek_mask", seek.map(u64::from)),
            ("latch_arm", Some(u64::from(latch_arm & 1))),
            ("snapshot", Some(snapshot.into())),
            ("kick", Some(kick.into())),
            ("enable", Some(enable.into())),
            ("estop", Some(estop.into())),
            ("limit_min", Some(limit_min.into())),
            ("limit_max", Some(limit_max.into())),
            ("inputs_0", Some(inputs_0.into())),
            ("inputs_1", Some(inputs_1.into())),
            ("latch", Some(u64::from(latch & 1))),
            ("more_latches", Some(u64::from(latch >> 1 & 7))),
            ("more_latch_arm", Some(u64::from(latch_arm >> 1 & 7))),
        ]
    }
}

impl EngineOutputs {
    /// Name and value of each output in the order of [`ports_of`]. `None` is a value that is
    /// not valid in this cycle. Of the words of state it gives that of the first adder.
    pub fn at_ports(&self) -> [(&'static str, Option<u64>); 34] {
        let Self {
            put_ready,
            start_ready,
            cut_busy,
            cut_refused,
            step,
            dir,
            outputs,
            pwm,
            enabled,
            idle,
            fault,
            halted,
            resetting,
            armed,
            ready,
            seeking,
            hits,
            latch_armed,
            latch_edges,
            latch_records,
            state: words,
            refreshed,
            room,
            started,
        } = *self;
        let state = words.of_adder(0);
        [
            ("put_ready", Some(put_ready.into())),
            ("start_ready", Some(start_ready.into())),
            ("cut_busy", Some(cut_busy.into())),
            ("cut_refused", Some(cut_refused.into())),
            ("state_valid", Some(state.is_some().into())),
            ("state_page", state.map(|state| state.page as u64)),
            ("state_axis", state.map(|state| state.axis.into())),
            ("state_item", state.map(|state| state.item as u64)),
            ("state", state.map(|state| state.word.into())),
            ("refreshed", Some(refreshed.into())),
            ("room", room.map(u64::from)),
            ("room_valid", Some(room.is_some().into())),
            ("step", Some(step.into())),
            ("dir", Some(dir.into())),
            ("outputs", Some(outputs.into())),
            ("pwm", Some(pwm.into())),
            ("enabled", Some(enabled.into())),
            ("idle", Some(idle.into())),
            ("fault", Some(fault.is_some().into())),
            ("halted", Some(halted.into())),
            ("resetting", Some(resetting.into())),
            ("cause", fault.map(|(cause, _)| cause as u64)),
            ("culprits", fault.map(|(_, culprits)| culprits.into())),
            ("armed", Some(armed.into())),
            ("ready", Some(ready.into())),
            ("seeking", Some(seeking.into())),
            ("hits", Some(hits.into())),
            ("latch_armed", Some(u64::from(latch_armed & 1))),
            ("latch_edges", Some(u64::from(latch_edges[0]))),
            ("started", Some(started.into())),
            ("more_latch_armed", Some(u64::from(latch_armed >> 1))),
            ("more_latch_edges", Some(packed(&latch_edges[1..], 4))),
            ("latch_records", Some(packed(&latch_records, 2))),
            ("state_record", state.map(|state| state.record.into())),
        ]
    }
}

/// Numbers of this many bits each, the first one lowest.
fn packed(numbers: &[u8], bits: u32) -> u64 {
    numbers.iter().rev().fold(0, |all, number| all << bits | u64::from(*number))
}

impl EngineOutputs {
    /// These outputs as benches print them: without the words of state.
    #[must_use]
    pub const fn recorded(self) -> Self {
        Self { state: StateWords::NONE, refreshed: false, ..self }
    }

    /// The checksum of all words of state up to this cycle, `sum` being that of the cycles before.
    /// A cycle without a word and without `refreshed` does not change it.
    ///
    /// With several adders the words of a cycle follow each other in the order of the adders;
    /// `refreshed` counts with the first of these steps.
    ///
    /// ```text
    /// sum <= rotate_left(sum, 7) ^ (record 2 | refreshed 1 | page 2 | item 3 | axis 3 | word 32)
    /// ```
    pub fn state_sum(&self, sum: u64) -> u64 {
        if self.state.is_none() && !self.refreshed {
            return sum;
        }
        let bits = |state: StateWord| {
            let (record, address) = (u64::from(state.record), u64::from(state.address()));
            record << 41 | address << 32 | u64::from(state.word)
        };
        let mut words = self.state.iter().map(bits);
        let first = u64::from(self.refreshed) << 40 | words.next().unwrap_or(0);
        words.fold(sum.rotate_left(7) ^ first, |sum, word| sum.rotate_left(7) ^ word)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::{CAUSES, CUT_WORD, MAX_AXES, StateItem};
    use alloc::vec::Vec;

    fn names(direction: Direction) -> Vec<&'static str> {
        ports_of(direction).map(|port| port.name).collect()
    }

    #[test]
    fn values_are_those_of_the_table_in_its_order() {
        let inputs = EngineInputs::default().at_ports();
        let outputs = EngineOutputs::default().at_ports();
        assert_eq!(inputs.map(|(name, _)| name).to_vec(), names(Direction::Input));
        assert_eq!(outputs.map(|(name, _)| name).to_vec(), names(Direction::Output));
        // Without a fault, a word of state or room, exactly those outputs are not valid that say
        // so.
        for (port, (name, value)) in ports_of(Direction::Output).zip(outputs) {
            assert_eq!(port.valid_with.is_some(), value.is_none(), "{name}");
        }
    }

    #[test]
    fn numbers_fit_their_ports() {
        let most = |name| {
            let port = ENGINE_PORTS.iter().find(|port| port.name == name).unwrap();
            (1_usize << port.width.of(1)) - 1
        };
        assert!(most("cause") >= CAUSES.len() - 1);
        assert!(most("put_axis") >= MAX_AXES - 1 && most("state_axis") >= MAX_AXES - 1);
        assert!(most("put_word") >= CUT_WORD.into());
        assert!(most("state_item") >= StateItem::Status as usize);
    }
}
