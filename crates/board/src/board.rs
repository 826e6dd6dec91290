//! Engine and link on one clock, and the line to the host.

use crate::line::{Ear, Speaker};
use carrystep_model::fast::Edges;
use carrystep_model::{FastEngine, Link};
use carrystep_spec::EngineBuild;
use carrystep_spec::engine::{EngineInputs, EngineOutputs};
use carrystep_spec::link::{LinkInputs, LinkOutputs, Uart};

/// Switches at the board's inputs; `true` and a bit that is set are active, whatever the level of the pin.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Switches {
    /// The e-stop is pressed.
    pub estop: bool,
    /// Limits at the low ends, a bit each axis.
    pub limit_min: u8,
    /// Limits at the high ends, a bit each axis.
    pub limit_max: u8,
}

/// The board.
#[derive(Debug, Clone)]
pub struct Board {
    engine: FastEngine,
    link: Link,
    speaker: Speaker,
    ear: Ear,
    /// What the switches drive, with the polarity of their pins.
    pins: EngineInputs,
    started: Option<u64>,
}

impl Board {
    /// A board as it is configured, in cycle 0, with no switch pressed.
    pub fn new(build: &EngineBuild, uart: Uart) -> Self {
        let clock_hz = build.timebase.clock_hz();
        let mut board = Self {
            engine: FastEngine::new(build),
            link: Link::new(build, uart),
            speaker: Speaker::new(clock_hz, uart),
            ear: Ear::new(clock_hz, uart),
            pins: EngineInputs::default(),
            started: None,
        };
        board.press(Switches::default());
        board
    }

    /// The cycle it is in.
    pub fn cycle(&self) -> u64 {
        self.engine.cycle()
    }

    /// Its engine.
    pub fn engine(&self) -> &FastEngine {
        &self.engine
    }

    /// What the engine says in this cycle.
    pub fn outputs(&self) -> EngineOutputs {
        self.engine.outputs(&self.inputs(&self.link.outputs()))
    }

    /// The cycle in which the first segments of the first start are loaded, once there was one.
    pub fn started(&self) -> Option<u64> {
        self.started
    }

    /// Says a byte to it, at the line's pace.
    pub fn say(&mut self, byte: u8) {
        self.speaker.say(byte);
    }

    /// Bytes that have not yet gone to it.
    pub fn unsaid(&self) -> usize {
        self.speaker.unsaid()
    }

    /// The next byte from it.
    pub fn next_byte(&mut self) -> Option<u8> {
        self.ear.next_byte()
    }

    /// Sets the switches from this cycle on.
    pub fn press(&mut self, switches: Switches) {
        let guard = &self.engine.core().build().guard;
        let low = |wired_low| if wired_low { 0xff } else { 0 };
        self.pins.estop = switches.estop != guard.estop_low;
        self.pins.limit_min = switches.limit_min ^ low(guard.limits_low);
        self.pins.limit_max = switches.limit_max ^ low(guard.limits_low);
    }

    /// Goes on to this cycle; `to` hears of the pins.
    pub fn run(&mut self, end: u64, to: &mut impl Edges) {
        while self.cycle() < end {
            let rx = self.speaker.level(self.cycle());
            if self.leap(rx, end - self.cycle(), to) == 0 {
                self.clock(rx, to);
            }
            self.ear.hear(self.cycle(), self.link.outputs().tx);
        }
    }

    /// Passes clocks in which the link only waits; how many they were.
    fn leap(&mut self, rx: bool, most: u64, to: &mut impl Edges) -> u64 {
        let quiet = self.link.quiet(rx).min(self.speaker.stays(self.cycle())).min(most);
        // An axis that waits for its limit says its position in each of its turns.
        if quiet == 0 || self.engine.core().waits_for_limits() {
            return 0;
        }
        let inputs = self.inputs(&self.link.outputs());
        let clocks = self.engine.leap(&inputs, quiet, to);
        let core = self.engine.core();
        self.link.pass(clocks, rx, core.answers_before(clocks), |axis, item| core.item(axis, item));
        clocks
    }

    /// One clock of everything.
    fn clock(&mut self, rx: bool, to: &mut impl Edges) {
        let asks = self.link.outputs();
        let inputs = self.inputs(&asks);
        let says = self.engine.outputs(&inputs);
        let told = self.told(rx, &asks, &says);
        self.link.clock(&told);
        self.engine.clock(&inputs, to);
        if says.started {
            self.started.get_or_insert(self.cycle());
        }
    }

    fn inputs(&self, asks: &LinkOutputs) -> EngineInputs {
        let EngineInputs { estop, limit_min, limit_max, .. } = self.pins;
        EngineInputs { estop, limit_min, limit_max, ..asks.engine }
    }

    fn told(&self, rx: bool, asks: &LinkOutputs, says: &EngineOutputs) -> LinkInputs {
        let core = self.engine.core();
        let (axis, item) = says.latch.map_or((asks.get_axis, asks.get_item), |axis| (axis, POSITION));
        LinkInputs { rx, engine: *says, get_data: core.item(axis, item), get_valid: core.answers() }
    }
}

/// The item of an axis that is its position.
const POSITION: u8 = 2;
