//! The virtual board: the models of engine and link on one clock, with the line to the host.

#[cfg(test)]
mod tests;

use crate::pin_levels::PinLevels;
use crate::wire::{Driven, Wire};
use carrystep_core::EngineBuild;
use carrystep_core::engine::{Cause, EngineInputs, EngineOutputs, Guard};
use carrystep_core::link::{LineKind, LinkInputs, LinkOutputs, Uart};
use carrystep_model::fast::Edges;
use carrystep_model::{Awaited, HostedEngine, Link};

/// State of the switches at the board's inputs. `true`, or a bit that is set, means active,
/// regardless of the level of the pin.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Switches {
    /// The e-stop is pressed.
    pub estop: bool,
    /// Mask of the limits at the low ends that are reached.
    pub limit_min: u8,
    /// Mask of the limits at the high ends that are reached.
    pub limit_max: u8,
    /// Masks of the inputs of rows 2 and 3 that are active: bit 0 is the probe, and the interlock.
    pub inputs: [u8; 2],
    /// Mask of the latches whose own pin is active.
    pub latch: u8,
}

impl Switches {
    /// The probe touches, or does not.
    pub fn touch_probe(&mut self, touches: bool) {
        self.set(0, 0, touches);
    }

    /// The interlock is open, or closed.
    pub fn open_interlock(&mut self, open: bool) {
        self.set(1, 0, open);
    }

    /// A general input, from 0 on, is active or not. Even numbers are in row 2 behind the probe, odd
    /// ones in row 3 behind the interlock.
    pub fn set_input(&mut self, number: u8, active: bool) {
        self.set(usize::from(number % 2), 1 + number / 2, active);
    }

    fn set(&mut self, row: usize, bit: u8, active: bool) {
        let mask = 1_u8.checked_shl(bit.into()).unwrap_or(0);
        self.inputs[row] = self.inputs[row] & !mask | if active { mask } else { 0 };
    }

    /// Levels of the input pins, with the polarity of the build and the sources of its latches.
    pub(crate) fn pins(self, guard: &Guard) -> EngineInputs {
        let Self { estop, limit_min, limit_max, inputs, latch } = self;
        let inputs = [0, 1].map(|row| inputs[row] & guard.inputs[row].exist);
        let pins =
            EngineInputs { estop, limit_min, limit_max, inputs, latch, ..EngineInputs::default() };
        pins.levels(guard).with_sources(guard)
    }
}

/// A board of models: fast engine, link and line.
#[derive(Debug, Clone)]
pub struct ModelBoard {
    engine: HostedEngine,
    link: Link,
    wire: Wire,
    /// Levels of the switch inputs, with the polarity of their pins.
    pins: EngineInputs,
    loads: Vec<u64>,
    stops: Vec<(u64, Cause)>,
}

impl ModelBoard {
    /// A board right after configuration, in cycle 0, with a UART and with no switch pressed.
    pub fn new(build: &EngineBuild, uart: Uart) -> Self {
        Self::with(build, uart.into(), Wire::uart(build.timebase.clock_hz(), uart))
    }

    /// As [`Self::new`], with an SPI of this rate, Hz.
    pub fn on_spi(build: &EngineBuild, sck_hz: u64) -> Self {
        Self::with(build, LineKind::Spi, Wire::spi(build.timebase.clock_hz(), sck_hz))
    }

    fn with(build: &EngineBuild, line: LineKind, wire: Wire) -> Self {
        let mut board = Self {
            engine: HostedEngine::new(build),
            link: Link::new(build, line),
            wire,
            pins: EngineInputs::default(),
            loads: Vec::new(),
            stops: Vec::new(),
        };
        board.press(Switches::default());
        board
    }

    /// Number of the current clock cycle.
    pub fn cycle(&self) -> u64 {
        self.engine.cycle()
    }

    /// The model of the engine.
    pub fn engine(&self) -> &HostedEngine {
        &self.engine
    }

    /// The outputs of the engine in this cycle.
    pub fn outputs(&self) -> EngineOutputs {
        self.engine.outputs(&self.inputs(&self.link.outputs()))
    }

    /// The cycles in which starts loaded their first segments.
    pub fn loads(&self) -> &[u64] {
        &self.loads
    }

    /// The stops so far: the first cycle with the fault, and the cause.
    pub fn stops(&self) -> &[(u64, Cause)] {
        &self.stops
    }

    /// Queues a byte for transmission to the board, at the line's rate.
    pub fn say(&mut self, byte: u8) {
        self.wire.say(byte);
    }

    /// Number of bytes that were not transmitted completely.
    pub fn unsaid(&self) -> usize {
        self.wire.unsaid()
    }

    /// Whether bytes are being transmitted in either direction, or an answer is being assembled.
    pub fn talks(&self) -> bool {
        self.wire.unsaid() > 0 || self.wire.is_hearing() || self.link.quiet(true) != u64::MAX
    }

    /// Whether the board is within a byte to the host.
    pub fn is_answering(&self) -> bool {
        self.wire.is_hearing()
    }

    /// The next byte received from the board.
    pub fn next_byte(&mut self) -> Option<u8> {
        self.wire.next_byte()
    }

    /// Sets the switches from this cycle on.
    pub fn press(&mut self, switches: Switches) {
        self.pins = switches.pins(&self.engine.core().build().guard);
    }

    /// Runs the board up to cycle `end`; `to` receives the edges of the pins. The run ends early,
    /// once, when the first start has loaded its segments. Up to then, and for a tick after, there
    /// are no edges.
    pub fn run(&mut self, end: u64, to: &mut dyn Edges) {
        let waits = self.loads.is_empty();
        while self.cycle() < end && self.loads.is_empty() == waits {
            let inputs = self.inputs(&self.link.outputs());
            let per_tick = u64::from(self.engine.core().build().timebase.clocks_per_tick());
            let starts = waits && self.engine.outputs(&inputs).armed;
            let target = if starts { end.min(self.cycle() + per_tick) } else { end };
            let alone = self.run_link(target);
            if alone > self.cycle() {
                self.follow(&inputs, alone, to);
            } else if !self.run_waiting(&inputs, target, to) {
                let says = self.engine.outputs(&inputs);
                self.clock(&inputs, &says, to);
            }
        }
    }

    /// Runs the board up to cycle `end`, clock by clock; `seen` receives the levels of all pins in
    /// each cycle in which one of them has changed.
    pub fn watch(&mut self, end: u64, seen: &mut dyn FnMut(u64, PinLevels)) {
        let mut inputs = self.inputs(&self.link.outputs());
        let mut says = self.engine.outputs(&inputs);
        let mut told = self.levels(&says);
        while self.cycle() < end {
            self.clock(&inputs, &says, &mut ());
            inputs = self.inputs(&self.link.outputs());
            says = self.engine.outputs(&inputs);
            let now = self.levels(&says);
            if now != told {
                seen(self.cycle(), now);
                told = now;
            }
        }
    }

    /// The levels of the pins in this cycle, in which the engine outputs `says`.
    fn levels(&self, says: &EngineOutputs) -> PinLevels {
        let EngineOutputs { step, dir, outputs, pwm, enabled, .. } = *says;
        PinLevels { step, dir, outputs, pwm, enabled, line: self.link.tx() }
    }

    /// Runs the link alone as long as the engine does not affect it, at most up to cycle `end`.
    /// Returns the cycle that it has reached.
    fn run_link(&mut self, end: u64) -> u64 {
        let Self { engine, link, wire, .. } = self;
        let mut cycle = engine.cycle();
        while cycle < end && link.is_alone() {
            let Driven { rx, spi, stays } = wire.drive(cycle);
            let (begun, most) = (cycle, stays.clamp(1, end - cycle));
            cycle += link.run_alone((rx, spi), most, |clocks, tx| wire.hear(begun + clocks, tx));
            wire.reach(cycle);
        }
        cycle
    }

    /// While the link waits for the engine, runs both up to the first clock in which the wait may
    /// end, at most up to cycle `end`. Returns false if the link does not wait, or if the wait may
    /// end in the present clock.
    fn run_waiting(&mut self, inputs: &EngineInputs, end: u64, to: &mut dyn Edges) -> bool {
        let Self { engine, link, wire, .. } = self;
        let first = engine.cycle();
        let most = match link.awaits() {
            None => return false,
            // A leap ends before the engine accepts anything.
            Some(Awaited::Acceptance) if engine.core().fault().is_some() => return false,
            Some(Awaited::Acceptance) => end - first,
            Some(Awaited::Refresh) => engine.until_refresh().min(end - first),
            Some(Awaited::RoomOrRefresh(axis)) => {
                engine.until_refresh().min(engine.until_room(axis)).min(end - first)
            }
        };
        engine.leap(inputs, most, to, &mut |word| link.store(word));
        let mut cycle = first;
        while cycle < engine.cycle() {
            let Driven { rx, spi, stays } = wire.drive(cycle);
            let (begun, clocks) = (cycle, stays.clamp(1, engine.cycle() - cycle));
            link.run_waiting((rx, spi), clocks, |clocks, tx| wire.hear(begun + clocks, tx));
            cycle += clocks;
            wire.reach(cycle);
        }
        cycle > first
    }

    /// Runs the engine up to the cycle that the link has reached, and delivers what it has output
    /// meanwhile to the link.
    fn follow(&mut self, inputs: &EngineInputs, end: u64, to: &mut dyn Edges) {
        while self.cycle() < end {
            let Self { engine, link, .. } = self;
            if engine.leap(inputs, end - engine.cycle(), to, &mut |word| link.store(word)) == 0 {
                let says = engine.outputs(inputs);
                says.state.into_iter().for_each(|word| link.store(word));
                self.clock_engine(inputs, &says, to);
            }
        }
    }

    /// Runs link and engine for one clock, in which the engine outputs `says`.
    fn clock(&mut self, inputs: &EngineInputs, says: &EngineOutputs, to: &mut dyn Edges) {
        let Driven { rx, spi, .. } = self.wire.drive(self.cycle());
        self.link.clock(&LinkInputs { rx, spi, engine: *says });
        self.clock_engine(inputs, says, to);
        self.wire.hear(self.cycle(), self.link.tx());
    }

    fn clock_engine(&mut self, inputs: &EngineInputs, says: &EngineOutputs, to: &mut dyn Edges) {
        self.engine.clock(inputs, to);
        if says.started {
            self.loads.push(self.cycle());
        }
        if says.fault.is_none()
            && let Some((cause, _)) = self.engine.core().fault()
        {
            self.stops.push((self.cycle(), cause));
        }
    }

    fn inputs(&self, asks: &LinkOutputs) -> EngineInputs {
        asks.engine.with_pins(&self.pins)
    }
}
