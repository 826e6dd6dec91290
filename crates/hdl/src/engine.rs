//! The engine: one adder for up to eight axes, the same pulses as that many parallel ones (docs/engine.md).
//!
//! ```text
//!             .------.  beat, axis                                    estop, kick, enable
//!             | turn |-----+----------+-----------+                         v
//!             '------'     v          v           v                     .-------.
//!  put_*  -------------> .-------.  .-------.   .-------. steps, phases | watch |
//!                        | queue |->| store |==>| adder |-------.       '-------'
//!                        '-------'  '-------'<==|       |       v           v
//!                          ^ pulses, losses     '-------'   .-------.   .-------.
//!                          |                        v V     | wheel |   | stops |
//!                        .--------.             .--------.  '-------'   '-------'
//!   step, dir <----------| pulser |<--.         | limits |------|--> hit  ^   | frozen, ramp,
//!                        '--------'   |         '--------'      |             v halted, cause
//!                        one an axis  '---- the events of this phase
//! ```
//!
//! All state of an axis is in block RAM but its pins' timers. In each tick every axis has its turn; what
//! the turns have found takes effect at the strobe that ends the tick, for all axes at once.
//!
//! Here are its ports and its parts; `wiring` connects them.

use crate::HdlError;
use crate::parameters::CLOCKS_PER_TICK;
use crate::primitives::constant::{Literal, Parameter, Refusal};
use crate::primitives::formula::Formula;
use crate::primitives::lanes::Lanes;
use crate::primitives::register::{Input, Register};
use crate::primitives::word::Word;
use carrystep_core::EngineBuild;
use carrystep_core::engine::least_clocks;
use rust_hdl::prelude::*;

pub mod adder;
pub mod homes;
pub mod limits;
pub mod pulser;
pub mod queue;
mod sim;
pub mod stops;
pub mod store;
pub mod turn;
pub mod watch;
pub mod wheel;
mod wiring;

pub use sim::{AnyEngine, EngineSim, engine};

use adder::Adder;
use homes::Homes;
use limits::Limits;
use pulser::Pulser;
use queue::Queue;
use stops::Stops;
use store::Store;
use turn::Turn;
use watch::Watch;
use wheel::Wheel;

/// The engine of N axes.
#[derive(LogicBlock, Default)]
pub struct Engine<const N: usize> {
    /// The clock.
    pub clock: Input<Clock>,
    /// A word of a segment is offered; it stays until it is taken.
    pub put_valid: Input<Bit>,
    /// For this axis.
    pub put_axis: Input<Word<3>>,
    /// Which word; 7 commits.
    pub put_word: Input<Word<3>>,
    /// The word; bit 0 of a commit: the segment is the last of its move.
    pub put_data: Input<Word<32>>,
    /// The offered word is taken in this cycle.
    pub put_ready: Signal<Out, Bit>,
    /// A start is offered; it stays until it is taken.
    pub start_valid: Input<Bit>,
    /// Of these axes.
    pub start_mask: Input<Word<N>>,
    /// The offered start is taken in this cycle.
    pub start_ready: Signal<Out, Bit>,
    /// Resume after a stop: hold it until `fault` falls.
    pub clear: Input<Bit>,
    /// The host's controlled stop.
    pub stop: Input<Bit>,
    /// The host has broken the segment protocol: stop.
    pub broken: Input<Bit>,
    /// The host says anew which axes wait for their limit,
    pub home_valid: Input<Bit>,
    /// namely these.
    pub home_mask: Input<Word<N>>,
    /// The host was heard of: the watchdog starts anew.
    pub kick: Input<Bit>,
    /// The host wants the drivers to be powered.
    pub enable: Input<Bit>,
    /// The e-stop's pin, asynchronous.
    pub estop: Input<Bit>,
    /// The limit pins at the low ends, asynchronous.
    pub limit_min: Input<Word<N>>,
    /// The limit pins at the high ends, asynchronous.
    pub limit_max: Input<Word<N>>,
    /// The axis that the host asks about.
    pub get_axis: Input<Word<3>>,
    /// What it asks for: 0 and 1 P, low and high, 2 position, 3 discarded steps.
    pub get_item: Input<Word<2>>,
    /// The answer,
    pub get_data: Signal<Out, Word<32>>,
    /// in this cycle, to what was asked in the cycle before.
    pub get_valid: Signal<Out, Bit>,
    /// `get_data` is the position of the axis of `turn`, which waits for its limit.
    pub latch: Signal<Out, Bit>,
    /// The axis whose turn it is.
    pub latch_axis: Signal<Out, Word<3>>,
    /// Segments that the axis of `put_axis` has room for,
    pub room: Signal<Out, Word<3>>,
    /// in this cycle.
    pub room_valid: Signal<Out, Bit>,
    /// The STEP pins.
    pub step: Lanes<Signal<Out, Bit>, N>,
    /// The DIR pins, 1 is backward.
    pub dir: Lanes<Signal<Out, Bit>, N>,
    /// The drivers are to be powered.
    pub enabled: Signal<Out, Bit>,
    /// All axes are done and no start is armed.
    pub idle: Signal<Out, Bit>,
    /// A stop has been called,
    pub fault: Signal<Out, Bit>,
    /// and no axis moves any more.
    pub halted: Signal<Out, Bit>,
    /// Why, numbered as [`carrystep_core::engine::Cause`];
    pub cause: Signal<Out, Word<3>>,
    /// the axes that it came from.
    pub culprits: Signal<Out, Word<N>>,
    /// A start is armed.
    pub armed: Signal<Out, Bit>,
    /// The drivers have had power for long enough, and shall have it: starts can be taken.
    pub ready: Signal<Out, Bit>,
    /// The axes that wait for their limit.
    pub homing: Signal<Out, Word<N>>,
    /// Axes start at the end of this cycle.
    pub started: Signal<Out, Bit>,
    turn: Turn<N>,
    adder: Adder,
    queue: Queue,
    pub(crate) store: Store,
    wheel: Wheel<N>,
    limits: Limits<N>,
    homes: Homes<N>,
    stops: Stops<N>,
    watch: Watch,
    pulser: Lanes<Pulser, N>,
    waits: Register<Bit>,    // `armed`
    mask: Register<Word<N>>, // of the start, turning with the turns: bit 0 is the present axis
    going: Register<Bit>,
    taken: Register<Bit>,
    taken_word: Register<Word<3>>,
    unfed: Register<Bit>,  // a masked axis has nothing waiting
    held: Register<Bit>,   // a masked axis runs on
    active: Register<Bit>, // an axis runs or waits
    rest_1: Register<Bit>, // none did in the last tick,
    rest_2: Register<Bit>, // and none in the two before
    strobe: Signal<Local, Bit>,
    masked: Signal<Local, Bit>,
    nobody: Signal<Local, Bit>,
    listens: Signal<Local, Bit>, // the axis of `put_axis` looks at the port
    take: Signal<Local, Bit>,
    may_start: Signal<Local, Bit>,
    free: Signal<Local, Bit>,
    decides: Signal<Local, Bit>,
    go: Signal<Local, Bit>,
    rests: Signal<Local, Bit>,
    pins_busy: Signal<Local, Bit>,
    late: Signal<Local, Word<N>>,
    late_bit: Lanes<Signal<Local, Word<N>>, N>,
    counted: Lanes<Signal<Local, Word<6>>, N>,
    counts: Signal<Local, Word<6>>,
    none: Literal<6, 0>,
    no_axes: Literal<N, 0>,
    one_axis: Lanes<Parameter<N>, N>,
    commit: Literal<3, 7>,
    by_one: Literal<1, 1>,
    to_top: Parameter<3>,
    axes: Parameter<4>,
    clocks_per_tick_too_few_for_the_axes: Refusal,
}

impl<const N: usize> Engine<N> {
    /// The engine of this build, which has been checked and has N axes.
    fn new(build: &EngineBuild) -> Result<Self, HdlError> {
        let mut pulser = Lanes::<Pulser, N>::default();
        for (pulser, pins) in pulser.iter_mut().zip(&build.pins) {
            *pulser = Pulser::new(pins)?;
        }
        let clocks = CLOCKS_PER_TICK.of::<32>(build.timebase.clocks_per_tick());
        let least = u64::from(least_clocks(N, build.timebase.phases()));
        Ok(Self {
            turn: Turn::new(),
            store: Store::new(build.phase, &build.guard.stop),
            wheel: Wheel::new(&build.timebase),
            limits: Limits::new(&build.guard),
            homes: Homes::new(),
            stops: Stops::new(&build.guard),
            watch: Watch::new(&build.guard),
            pulser,
            axes: Parameter::new(N as u64),
            clocks_per_tick_too_few_for_the_axes: Refusal::of(&clocks.whole().is_less(&Formula::number(least))),
            to_top: Parameter::new(N as u64 - 1),
            one_axis: Lanes::from_fn(|axis| Parameter::new(1 << axis)),
            rest_1: Register::new(true),
            rest_2: Register::new(true),
            ..Self::default()
        })
    }
}

#[cfg(test)]
mod tests;
