//! Clocks in which the processor does not need the engine, so that the virtual board can execute
//! the two one after the other, and clocks in which it only waits.

use super::{EXECUTE, Inputs, LinkProcessor};
use carrystep_core::engine::EngineOutputs;
use carrystep_core::link::processor::{
    ACTS, BROKEN, CONDITION, CONTROL, CRC_BEGIN, CRC_FEED, CRC_STEP, Code, Condition, FOR_ROOM,
    GOES, JUMPS, KICK, PUTS, SETS, STARTS, STORES, ValueSource, WAIT,
};

/// The reason for which the processor waits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::link) enum Waits {
    /// It does not wait, or it waits for the engine.
    No,
    /// It waits for a byte.
    ForByte,
    /// It waits for the transmitter.
    ToSend,
}

/// What the link waits for the engine to do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Awaited {
    /// It accepts the word or the start that the link offers, or reports a fault.
    Acceptance,
    /// It has output all words of a tick.
    Refresh,
    /// It reports the room of this axis, or has output all words of a tick.
    RoomOrRefresh(u8),
}

impl LinkProcessor {
    /// True if this clock depends on the engine's outputs or on its words of state, or changes an
    /// input of the engine other than the axis whose room it requests.
    #[inline]
    pub(in crate::link) fn minds_the_engine(&self) -> bool {
        const TELLS: Code = PUTS | STARTS | BROKEN | KICK | CONTROL;
        let acts = self.does(0) && self.code & TELLS != 0;
        let waits = self.does(WAIT) && !self.does(GOES);
        let reads = self.executes(SETS) && self.code >> 8 & 7 == ValueSource::Engine as Code;
        let asks = self.executes(JUMPS) && self.code >> CONDITION & 7 == Condition::Fault as Code;
        acts || waits || reads || asks || self.asks_room() || self.reads_register()
    }

    /// True from the clock on in which the memory is read for an instruction that loads its word
    /// into the CRC.
    #[inline]
    fn reads_register(&self) -> bool {
        const READS: Code = ACTS | CRC_BEGIN | CRC_FEED;
        self.stage > 0 && self.code & (SETS | STORES | JUMPS) == 0 && self.code & READS == READS
    }

    /// What the processor waits for the engine to do, if it waits in this clock.
    #[inline]
    pub(in crate::link) fn awaits(&self) -> Option<Awaited> {
        const OFFERS_WORD: Code = ACTS | WAIT | PUTS;
        const OFFERS_START: Code = ACTS | WAIT | STARTS;
        const FOR_REFRESH: Code = ACTS | WAIT;
        const FOR_ROOM_TOO: Code = ACTS | WAIT | FOR_ROOM;
        match self.code {
            _ if self.stage != EXECUTE => None,
            OFFERS_WORD | OFFERS_START => Some(Awaited::Acceptance),
            FOR_REFRESH => Some(Awaited::Refresh),
            FOR_ROOM_TOO => Some(Awaited::RoomOrRefresh(self.room_of())),
            _ => None,
        }
    }

    #[inline]
    pub(in crate::link) fn waits(&self) -> Waits {
        let polls = JUMPS | (Condition::Nothing as Code) << CONDITION | self.pc;
        if self.code == polls && self.read_from == self.written {
            Waits::ForByte
        } else if self.does(WAIT | GOES) {
            Waits::ToSend
        } else {
            Waits::No
        }
    }

    /// Executes at most `clocks` clocks, up to the first one in which the processor needs the engine
    /// or waits; no byte is received meanwhile. Returns the number of clocks.
    pub(in crate::link) fn work(&mut self, clocks: u64, engine: &EngineOutputs) -> u64 {
        let inputs = Inputs { received: None, taken: false, fact: 0, engine };
        let mut done = 0;
        while done < clocks && !self.minds_the_engine() && self.waits() == Waits::No {
            if self.stage < EXECUTE {
                self.read_memories();
                self.stage += 1;
                done += 1;
            } else if self.does(CRC_STEP) && !self.crc.over() {
                // Only the CRC changes before the eighth bit.
                let bits = self.crc.left().min(clocks - done);
                (0..bits).for_each(|_| self.crc.clock(self.tells_check(0)));
                done += bits;
            } else {
                self.clock(&inputs);
                done += 1;
            }
        }
        done
    }

    /// Skips this many clocks in which the processor waits.
    #[inline]
    pub(in crate::link) fn pass(&mut self, clocks: u64) {
        if self.waits() == Waits::ForByte {
            self.stage = ((u64::from(self.stage) + clocks) % 3) as u8;
        }
    }
}
