//! Axes with limit switches on a clean line. Each switch has a place on its axis; time is the
//! board's.

use super::random::Random;
use crate::repeats;
use carrystep_core::EngineBuild;
use carrystep_core::engine::LimitWiring;
use carrystep_core::link::Uart;
use carrystep_files::machine::End;
use carrystep_files::{InputError, Machine, SourceText};
use carrystep_link::{Clock, Exchanged, Host, Line, Patience, Timing};
use carrystep_model::fast::Edge;
use carrystep_virtual_board::{Edges, ModelBoard, SimulatedBoard, Switches, VerilatedBoard};
use std::cell::{Ref, RefCell};
use std::num::NonZeroU16;
use std::rc::Rc;

/// Reads a machine file.
pub fn read(text: &str) -> Result<Machine, InputError> {
    Machine::from_source(&SourceText { path: "machine.toml".into(), text: text.into() })
}

/// Reads a valid machine file.
pub fn machine(text: &str) -> Machine {
    read(text).unwrap_or_else(|error| panic!("{error}"))
}

/// A kind of board.
pub trait Make: SimulatedBoard + Sized {
    fn make(build: &EngineBuild, uart: Uart) -> Self;
    /// Ticks between two updates of the switches.
    fn slice(round: u32) -> u32;
    /// How often a test homes such a board, each time from where it came to rest before.
    fn homes() -> u32;
}

impl Make for ModelBoard {
    fn make(build: &EngineBuild, uart: Uart) -> Self {
        Self::new(build, uart)
    }

    fn slice(round: u32) -> u32 {
        (round / 4).max(1)
    }

    fn homes() -> u32 {
        2
    }
}

impl Make for VerilatedBoard {
    fn make(build: &EngineBuild, uart: Uart) -> Self {
        Self::new(build, uart).unwrap()
    }

    fn slice(round: u32) -> u32 {
        round
    }

    fn homes() -> u32 {
        if repeats::in_full() { 2 } else { 1 }
    }
}

/// Start of an axis relative to its switch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Start {
    /// Off its switch.
    Open,
    /// On its switch, at a depth from which moving off still opens the switch.
    Closed,
    /// At the edge of the switch, which bounces until the axis has left it.
    Bouncing,
}

/// The switches of one axis. Positions are in steps; `sign` is the direction toward the switch that
/// is searched.
#[derive(Debug, Clone, Copy)]
struct Switched {
    /// The motors that move the axis' letter forward, and those that move it backward.
    motors: [u8; 2],
    sign: i32,
    edge: i32,
    /// Position of the switch at the other end.
    far: i32,
    there: bool,
    stuck: bool,
    bounces: bool,
    stood: i32,
    deepest: i32,
}

impl Switched {
    fn depth(&self, position: i32) -> i32 {
        (position - self.edge) * self.sign
    }

    /// Where the letter is, rounded down to whole steps.
    fn place(&self, board: &impl SimulatedBoard) -> i32 {
        let sum = |mask: u8| -> i32 {
            (0..8).filter(|motor| mask >> motor & 1 == 1).map(|motor| board.position(motor)).sum()
        };
        let [forward, backward] = self.motors;
        let count = (forward | backward).count_ones() as i32;
        (sum(forward) - sum(backward)).div_euclid(count)
    }
}

pub struct World<B> {
    board: B,
    axes: Vec<Switched>,
    limits: LimitWiring,
    estop: bool,
    /// Cycles between two updates of the switches.
    slice: u64,
    ms: u64,
    random: Random,
    /// Cycles until a bouncing switch changes, and its level.
    bounce: (u64, bool),
    /// Shortest bounce, cycles: at least one sample sees it, but fewer than are needed to accept
    /// it.
    shortest_bounce: u64,
    bounce_range: u64,
}

struct Deaf;

impl Edges for Deaf {
    fn edge(&mut self, _: Edge) {}
}

impl<B: Make> World<B> {
    fn press(&mut self) {
        let (mut min, mut max) = (0_u8, 0_u8);
        if self.bounce.0 < self.slice {
            self.bounce =
                (self.shortest_bounce + self.random.below(self.bounce_range), !self.bounce.1);
        }
        self.bounce.0 = self.bounce.0.saturating_sub(self.slice);
        for (number, axis) in self.axes.iter_mut().enumerate() {
            let position = axis.place(&self.board);
            let depth = axis.depth(position);
            axis.deepest = axis.deepest.max(depth);
            axis.bounces &= depth >= -1;
            let near = if axis.bounces && depth <= 0 { self.bounce.1 } else { depth >= 0 };
            let near = (near && axis.there) || axis.stuck;
            let far = (position - axis.far) * axis.sign <= 0;
            let (low, high) = if axis.sign < 0 { (near, far) } else { (far, near) };
            min |= u8::from(low) << number;
            max |= u8::from(high) << number;
        }
        let (limit_min, limit_max) = match self.limits {
            LimitWiring::Pair | LimitWiring::None => (min, max),
            LimitWiring::Each => (min | max, 0),
            LimitWiring::One => (u8::from(min | max != 0), 0),
        };
        let estop = self.estop;
        self.board.press(Switches { estop, limit_min, limit_max, ..Switches::default() });
    }

    fn pass(&mut self) {
        let end = self.board.cycle() + self.ms;
        while self.board.cycle() < end {
            self.press();
            // Speeds are below 10 steps per millisecond.
            let near = |axis: &Switched| {
                let position = axis.place(&self.board);
                axis.bounces
                    || axis.edge.abs_diff(position) < 20
                    || axis.far.abs_diff(position) < 20
            };
            let still = self.board.rests() && !self.axes.iter().any(|axis| axis.bounces);
            let still = still || !self.axes.iter().any(near);
            let next = if still { end } else { end.min(self.board.cycle() + self.slice) };
            while self.board.cycle() < next {
                self.board.run(next, &mut Deaf).unwrap();
            }
        }
    }
}

/// The bench, shared with its host.
pub struct Bench<B>(Rc<RefCell<World<B>>>);

impl<B> Clone for Bench<B> {
    fn clone(&self) -> Self {
        Self(self.0.clone())
    }
}

fn uart(machine: &Machine) -> Uart {
    Uart::new(machine.timebase.clock_hz(), machine.baud).unwrap()
}

impl<B: Make> Bench<B> {
    /// All axes stand at position zero; `starts` determines the places of their switches.
    pub fn new(machine: &Machine, starts: &[Start], seed: u64) -> Self {
        let mut random = Random::new(seed ^ 0x5eed);
        let guard = &machine.guard;
        let tick = u64::from(machine.timebase.clocks_per_tick());
        let mut axes = Vec::new();
        for (number, (axis, start)) in machine.axes.iter().zip(starts).enumerate() {
            let home = axis.home.unwrap();
            let sign = if home.toward == End::Max { 1 } else { -1 };
            let length = axis.travel.map_or(600, |[low, high]| (high - low) as i32);
            // At least two steps of moving off are made with an open switch.
            let depth = match start {
                Start::Open => -1 - random.below(length as u64 / 2) as i32,
                Start::Closed => random.below(u64::from(home.move_off) - 2) as i32,
                Start::Bouncing => 0,
            };
            let edge = -depth * sign;
            let far = edge - sign * (length + home.move_off as i32);
            // A bounce is shorter than the debounce, at whatever time the samples fall.
            let bounces = *start != Start::Open && guard.debounce > 4;
            let stood = depth.max(0);
            axes.push(Switched {
                motors: machine.homing_motors(number),
                sign,
                edge,
                far,
                there: true,
                stuck: false,
                bounces,
                stood,
                deepest: depth,
            });
        }
        let round = u64::from(guard.round) * tick;
        let slice = u64::from(B::slice(guard.round)) * tick;
        let mut world = World {
            board: B::make(&machine.engine(), uart(machine)),
            axes,
            limits: guard.limits,
            estop: false,
            slice,
            ms: machine.timebase.clock_hz() / 1000,
            random,
            bounce: (0, false),
            shortest_bounce: round + slice,
            bounce_range: (u64::from(guard.debounce.saturating_sub(3)) * round)
                .saturating_sub(2 * slice)
                .max(1),
        };
        world.press();
        Self(Rc::new(RefCell::new(world)))
    }

    /// Connects a host to the board, and opens a session.
    pub fn connect(&self, machine: &Machine) -> Host<Self, Self> {
        let patience = Patience {
            timing: Timing { resend: 12, pause: 2 },
            silence: 500,
            lost: 500,
            change: 500,
            status_period: 5,
        };
        let id = uart(machine).build_id(&machine.engine());
        let mut host = Host::connect(self.clone(), self.clone(), Some(id.0), patience).unwrap();
        host.open(NonZeroU16::MIN).unwrap();
        host
    }

    pub fn board(&self) -> Ref<'_, B> {
        Ref::map(self.0.borrow(), |world| &world.board)
    }

    /// The place of an axis' letter, rounded down to whole steps.
    pub fn place(&self, axis: usize) -> i32 {
        let world = self.0.borrow();
        world.axes[axis].place(&world.board)
    }

    /// Position at which the switch of an axis closes.
    pub fn edge(&self, axis: usize) -> i32 {
        self.0.borrow().axes[axis].edge
    }

    /// Greatest depth of an axis within its switch, and its depth at the start, steps.
    pub fn deepest(&self, axis: usize) -> i32 {
        self.0.borrow().axes[axis].deepest
    }

    pub fn stood(&self, axis: usize) -> i32 {
        self.0.borrow().axes[axis].stood
    }

    pub fn slice_ticks(&self) -> u32 {
        let world = self.0.borrow();
        (world.slice / (world.ms * 4 / 1000)) as u32
    }

    /// Puts the switch of an axis at this position, and that of its other end as far away as before.
    pub fn put_edge(&self, axis: usize, position: i32) {
        let mut world = self.0.borrow_mut();
        let one = &mut world.axes[axis];
        one.far += position - one.edge;
        one.edge = position;
        world.press();
    }

    /// Removes the switch of an axis.
    pub fn remove(&self, axis: usize) {
        self.0.borrow_mut().axes[axis].there = false;
    }

    /// Keeps the switch of an axis closed.
    pub fn stick(&self, axis: usize) {
        self.0.borrow_mut().axes[axis].stuck = true;
    }

    /// Sets the position of the switch at the other end of an axis.
    pub fn far(&self, axis: usize, position: i32) {
        self.0.borrow_mut().axes[axis].far = position;
    }

    pub fn press_estop(&self, pressed: bool) {
        self.0.borrow_mut().estop = pressed;
    }
}

impl<B: Make> Clock for Bench<B> {
    fn milliseconds(&mut self) -> u32 {
        let world = self.0.borrow();
        (world.board.cycle() / world.ms) as u32
    }
}

/// The error of a line that never fails.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Never {}

impl<B: Make> Line for Bench<B> {
    type Error = Never;

    fn exchange(&mut self, out: &[u8], into: &mut [u8]) -> Result<Exchanged, Never> {
        let world = &mut *self.0.borrow_mut();
        let sent = out.len().min(40_usize.saturating_sub(world.board.unsaid()));
        out[..sent].iter().for_each(|&byte| world.board.say(byte));
        world.pass();
        let mut received = 0;
        while received < into.len()
            && let Some(byte) = world.board.next_byte()
        {
            into[received] = byte;
            received += 1;
        }
        Ok(Exchanged { sent, received })
    }
}
