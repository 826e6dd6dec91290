//! The board whose engine, link and line are the exported Verilog, simulated with Verilator.

use crate::board::Switches;
use crate::gateware::SimulatedBoard;
use crate::pin_levels::{Changes, PinLevels};
use crate::wire::{Driven, Wire};
use carrystep_core::EngineBuild;
use carrystep_core::engine::{Cause, EngineInputs, MAX_AXES};
use carrystep_core::link::{LineKind, Uart};
use carrystep_model::fast::{Change, Edge, Edges};
use carrystep_simulators::LevelError;
use carrystep_simulators::board::{BoardProcess, Did, Levels, Standing, SwitchedPins};

/// Greatest number of clocks sent to the process at once.
const CLOCKS: u64 = 5000;

/// A board in a Verilator process. It runs far slower than real time.
#[derive(Debug)]
pub struct VerilatedBoard {
    build: EngineBuild,
    process: BoardProcess,
    standing: Standing,
    wire: Wire,
    switches: Switches,
    loads: Vec<u64>,
    stops: Vec<(u64, Cause)>,
    levels: PinLevels,
    travelled: [i32; MAX_AXES],
    /// What came after the first load at which a run stopped; the next run delivers it.
    late: Late,
}

/// Edges and levels of outputs that are delivered later.
#[derive(Debug, Default)]
struct Late(Vec<LateChange>);

#[derive(Debug, Clone, Copy)]
enum LateChange {
    Edge(Edge),
    Levels(u64, u8),
    Pwm(u64, bool),
}

impl Late {
    fn deliver(&mut self, to: &mut dyn Edges) {
        for change in self.0.drain(..) {
            match change {
                LateChange::Edge(edge) => to.edge(edge),
                LateChange::Levels(clock, levels) => to.levels(clock, levels),
                LateChange::Pwm(clock, level) => to.pwm(clock, level),
            }
        }
    }
}

impl Edges for Late {
    fn edge(&mut self, edge: Edge) {
        self.0.push(LateChange::Edge(edge));
    }

    fn levels(&mut self, clock: u64, levels: u8) {
        self.0.push(LateChange::Levels(clock, levels));
    }

    fn pwm(&mut self, clock: u64, level: bool) {
        self.0.push(LateChange::Pwm(clock, level));
    }
}

impl VerilatedBoard {
    /// A board right after configuration, in cycle 0, with a UART and with no switch pressed.
    ///
    /// # Errors
    /// [`LevelError`] if Verilator is missing or fails, or if there is no such gateware.
    pub fn new(build: &EngineBuild, uart: Uart) -> Result<Self, LevelError> {
        Self::with(build, uart.into(), Wire::uart(build.timebase.clock_hz(), uart))
    }

    /// As [`Self::new`], with an SPI of this rate, Hz.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn on_spi(build: &EngineBuild, sck_hz: u64) -> Result<Self, LevelError> {
        Self::with(build, LineKind::Spi, Wire::spi(build.timebase.clock_hz(), sck_hz))
    }

    fn with(build: &EngineBuild, line: LineKind, wire: Wire) -> Result<Self, LevelError> {
        Ok(Self {
            build: build.clone(),
            process: BoardProcess::new(build, line)?,
            standing: Standing { idle: true, ..Standing::default() },
            wire,
            switches: Switches::default(),
            loads: Vec::new(),
            stops: Vec::new(),
            levels: PinLevels::default(),
            travelled: [0; MAX_AXES],
            late: Late::default(),
        })
    }

    /// Runs up to cycle `end`, at most [`CLOCKS`] clocks away.
    fn go(
        &mut self,
        end: u64,
        to: &mut dyn Edges,
        seen: &mut dyn FnMut(u64, PinLevels),
    ) -> Result<(), LevelError> {
        let pins = self.switches.pins(&self.build.guard);
        let axes = u8::MAX >> (MAX_AXES - self.build.axes());
        let (limit_min, limit_max) = (pins.limit_min & axes, pins.limit_max & axes);
        let pins = EngineInputs { limit_min, limit_max, ..pins };
        let mut stimuli = Vec::new();
        let mut cycle = self.cycle();
        while cycle < end {
            let Driven { rx, spi, stays } = self.wire.drive(cycle);
            let count = stays.min(end - cycle);
            stimuli.push((count, Levels { rx, spi, pins }));
            cycle += count;
        }
        let Self { process, wire, loads, stops, levels, travelled, .. } = self;
        let mut pins = [levels.step, levels.dir];
        let (mut outputs, mut high) = (levels.outputs, levels.pwm);
        let mut changes = Changes::new(*levels, seen);
        let standing = process.run(&stimuli, &mut |did| match did {
            Did::Tx(cycle, level) => {
                wire.hear(cycle, level);
                changes.change(cycle, |levels| levels.line = level);
            }
            Did::Pins(cycle, now) => {
                edges(cycle, pins, now, &mut |edge| {
                    if edge.change == Change::Rise {
                        let travelled = &mut travelled[usize::from(edge.axis)];
                        *travelled = travelled.wrapping_add(if edge.backward { -1 } else { 1 });
                    }
                    to.edge(edge);
                });
                pins = now;
                changes.change(cycle, |levels| [levels.step, levels.dir] = now);
            }
            Did::Outputs(cycle, SwitchedPins { outputs: now, pwm, enabled }) => {
                if std::mem::replace(&mut outputs, now) != now {
                    to.levels(cycle, now);
                }
                if std::mem::replace(&mut high, pwm) != pwm {
                    to.pwm(cycle, pwm);
                }
                changes.change(cycle, |levels| {
                    (levels.outputs, levels.pwm, levels.enabled) = (now, pwm, enabled);
                });
            }
            Did::Load(cycle) => loads.push(cycle),
            Did::Stop(cycle, cause) => stops.push((cycle, cause)),
        })?;
        self.levels = changes.finish();
        self.standing = standing;
        self.wire.reach(end);
        Ok(())
    }
}

impl SimulatedBoard for VerilatedBoard {
    fn cycle(&self) -> u64 {
        self.standing.cycle
    }

    fn rests(&self) -> bool {
        self.standing.idle || self.standing.halted
    }

    fn fault(&self) -> Option<(Cause, u8)> {
        self.standing.fault
    }

    fn position(&self, axis: usize) -> i32 {
        self.travelled[axis]
    }

    fn step(&self) -> u8 {
        self.levels.step
    }

    /// Not visible at the pins.
    fn discarded(&self, _: usize) -> Option<u32> {
        None
    }

    /// Not visible at the pins.
    fn alone(&self) -> Option<u64> {
        None
    }

    fn loads(&self) -> &[u64] {
        &self.loads
    }

    fn stops(&self) -> &[(u64, Cause)] {
        &self.stops
    }

    fn say(&mut self, byte: u8) {
        self.wire.say(byte);
    }

    fn unsaid(&self) -> usize {
        self.wire.unsaid()
    }

    /// Whether an answer is being assembled is not visible at the pins.
    fn talks(&self) -> bool {
        self.wire.unsaid() > 0 || self.wire.is_hearing()
    }

    fn is_answering(&self) -> bool {
        self.wire.is_hearing()
    }

    fn next_byte(&mut self) -> Option<u8> {
        self.wire.next_byte()
    }

    fn press(&mut self, switches: Switches) {
        self.switches = switches;
    }

    fn run(&mut self, end: u64, to: &mut dyn Edges) -> Result<(), LevelError> {
        self.late.deliver(to);
        let waits = self.loads.is_empty();
        while self.cycle() < end && self.loads.is_empty() == waits {
            let stop = end.min(self.cycle() + CLOCKS);
            if waits {
                let mut late = Late::default();
                self.go(stop, &mut late, &mut |_, _| ())?;
                self.late = late;
            } else {
                self.go(stop, to, &mut |_, _| ())?;
            }
        }
        Ok(())
    }

    fn watch(&mut self, end: u64, seen: &mut dyn FnMut(u64, PinLevels)) -> Result<(), LevelError> {
        while self.cycle() < end {
            self.go(end.min(self.cycle() + CLOCKS), &mut (), seen)?;
        }
        Ok(())
    }
}

/// Calls `to` with the changes of STEP and DIR, axis by axis.
fn edges(clock: u64, [step, dir]: [u8; 2], [step_now, dir_now]: [u8; 2], to: &mut dyn FnMut(Edge)) {
    for axis in 0..MAX_AXES as u8 {
        let backward = dir_now >> axis & 1 == 1;
        let mut tell = |change| to(Edge { clock, axis, change, backward });
        if step_now & !step & 1 << axis != 0 {
            tell(Change::Rise);
        }
        if (dir_now ^ dir) & 1 << axis != 0 {
            tell(Change::DirChange);
        }
    }
}
