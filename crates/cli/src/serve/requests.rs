//! The state of the dialect on a machine: what senders have sent, what of it is planned, and what
//! is left to do at rest. It does not move anything.
//!
//! ```text
//! clients -> real-time characters -> hold, resume, flush, overrides      at once
//!         -> lines -> dialect -> answered here
//!                             -> Lines -> Growing                        `ok` when it is there
//!                             -> todo: home, probe, unlock, sleep        at rest
//! ```

use super::accessories::Accessories;
use super::clients::Clients;
use super::terms;
use crate::arguments::WhenGone;
use crate::drive::{Place, point_at};
use carrystep_gcode::Offsets;
use carrystep_grbl::{
    Alarm, Dialect, Door, Input, Overrides, Pins, Probed, State, WELCOME, message,
};
use carrystep_program::{Lines, PlannedLine, Point, ProbeLine};
use carrystep_runner::{Growing, MotionGuard};
use std::collections::VecDeque;
use std::time::{Duration, Instant};

/// Longest time in which the last words are sent.
const FAREWELL: Duration = Duration::from_millis(200);

/// The parameters of G92.
const G92: std::ops::RangeInclusive<u16> = 5210..=5216;

/// What is done at rest, before any further line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Todo {
    /// `$H`, of all axes or of one.
    Home(Option<char>),
    /// `$X`.
    Unlock,
    /// G38.2 to G38.5, whose motion waits in the queue of the plan from then on.
    Probe(ProbeLine),
    /// `$SLP`.
    Sleep,
    /// A reset while the drivers have no power.
    Wake,
}

/// Why all that is planned is dropped as soon as the axes rest.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flush {
    /// A soft reset.
    Reset,
    /// A jog is cancelled.
    Jog,
    /// The sender is gone.
    Gone,
}

/// The position registers, steps.
pub type Positions = [i32; 8];

/// What the axes do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Motion {
    /// They rest.
    #[default]
    Rests,
    /// They move, or the rest of a batch waits behind a hold.
    Moves,
}

/// The dialect on a machine.
pub struct Requests {
    pub dialect: Dialect,
    pub clients: Clients,
    pub input: Input,
    pub lines: Lines,
    pub growing: Growing,
    pub place: Place,
    pub overrides: Overrides,
    /// What is wanted of spindle and coolant.
    pub accessories: Accessories,
    pub when_gone: WhenGone,
    /// Whether the work offsets are kept.
    pub keeps: bool,
    /// Whether G-code is locked out.
    pub alarm: bool,
    pub sleeps: bool,
    pub checks: bool,
    pub homes: bool,
    /// Whether a hold was asked for, and whether it was by the safety door.
    pub holds: bool,
    pub door: bool,
    /// The state in which the machine waits for the spindle behind a hold.
    pub restores: Option<State>,
    /// Whether what is planned are jogs.
    pub jogs: bool,
    pub flush: Option<Flush>,
    /// Whether a page wants all axes to ramp down.
    pub stops: bool,
    /// Why the last alarm began.
    pub why: Option<String>,
    pub todo: Option<Todo>,
    /// What the line with a probe move gives the planner, until the move begins.
    pub probe_line: Vec<PlannedLine>,
    /// The probe move that is planned or executed. No line is taken before its end.
    pub probing: Option<ProbeLine>,
    /// The last probe move.
    pub probed: Probed,
    pub motion: Motion,
    pub pins: Pins,
    /// What refuses lines of the next batch.
    pub guard: Option<MotionGuard>,
    /// Where the next batch begins: the coordinates of the axes.
    pub from: Vec<f64>,
    /// The direction in which each axis was last seen moving.
    pub ways: [i8; 8],
    /// Whether the axes rest, as far as is known.
    pub rests: bool,
    /// The line in which the tool is, and N of the lines.
    pub line: Option<u64>,
    pub numbers: VecDeque<(u64, u64)>,
    /// The speed of reports, mm/min, and when and where it was measured.
    pub speed: (Instant, Point, f64),
    pub positions: Positions,
}

impl Requests {
    pub fn new(
        (dialect, clients): (Dialect, Clients),
        lines: Lines,
        place: Place,
        when_gone: WhenGone,
    ) -> Self {
        let from = lines.coordinates(&place.start);
        let probed = Probed { at: terms::of_axes(lines.letters(), |_| 0.0), tripped: false };
        Self {
            dialect,
            clients,
            input: Input::default(),
            lines,
            growing: Growing::default(),
            place,
            overrides: Overrides::NONE,
            accessories: Accessories::default(),
            when_gone,
            keeps: true,
            alarm: false,
            sleeps: false,
            checks: false,
            homes: false,
            holds: false,
            door: false,
            restores: None,
            jogs: false,
            flush: None,
            stops: false,
            why: None,
            todo: None,
            probe_line: Vec::new(),
            probing: None,
            probed,
            motion: Motion::Rests,
            pins: Pins::default(),
            guard: None,
            from,
            ways: [0; 8],
            rests: true,
            line: None,
            numbers: VecDeque::new(),
            speed: (Instant::now(), Point::default(), 0.0),
            positions: Positions::default(),
        }
    }

    /// Whether anything moves, or is planned, or waits to be planned.
    pub fn is_busy(&self) -> bool {
        self.motion == Motion::Moves || self.growing.is_planned() || self.growing.waits()
    }

    /// Whether the next lines are to be planned now.
    pub fn may_plan(&self) -> bool {
        let is_locked = self.alarm || self.holds || self.sleeps;
        !is_locked && self.growing.waits() && !self.growing.is_planned()
    }

    /// Whether a batch can begin; begins to plan one if lines wait.
    pub fn may_move(&mut self) -> bool {
        if self.alarm || self.holds || self.sleeps {
            return false;
        }
        if self.may_plan() {
            let guard = self.guard.take();
            match self.lines.planner(&self.from) {
                Ok(planner) => self.growing.begin_guarded(planner, self.from.clone(), guard),
                Err(fault) => {
                    self.alarms(Alarm::SoftLimit, &fault.to_string());
                    self.flush = Some(Flush::Gone);
                }
            }
        }
        let ready = self.growing.is_ready();
        if ready {
            self.motion = Motion::Moves;
        }
        ready
    }

    /// Whether overrides scale what moves. A jog has a feed of its own, and so has a probe move.
    pub const fn scales(&self) -> bool {
        !self.jogs && self.probing.is_none()
    }

    /// The state, as reports name it.
    pub fn state(&self) -> State {
        let rests = self.rests;
        match self {
            Self { sleeps: true, .. } => State::Sleep,
            Self { alarm: true, .. } => State::Alarm,
            Self { homes: true, .. } => State::Home,
            Self { checks: true, .. } => State::Check,
            Self { door: true, .. } => State::Door(self.door_state()),
            Self { restores: Some(state), holds: false, .. } => *state,
            Self { holds: true, .. } => State::Hold { rests },
            _ if self.is_busy() && self.jogs => State::Jog,
            _ if self.is_busy() => State::Run,
            _ => State::Idle,
        }
    }

    /// What the safety door has come to.
    const fn door_state(&self) -> Door {
        // An interlock that is open is an alarm, so that `Door:1` of Grbl is not shown.
        if self.accessories.is_parked() { Door::IsClosed } else { Door::Stops }
    }

    /// The machine place of the board.
    pub fn at(&self, positions: &Positions) -> Point {
        point_at(self.lines.letters(), &self.place.zero, &positions.map(f64::from))
    }

    /// The machine rests here, and nothing that was planned is to be done any more.
    pub fn rests_at(&mut self, positions: &Positions) {
        self.positions = *positions;
        let at = self.at(positions);
        self.growing.clear();
        self.lines.place(at);
        self.from = self.lines.coordinates(&at);
        (self.motion, self.jogs, self.probing) = (Motion::Rests, false, None);
    }

    /// A batch is executed to its end, at these coordinates of the axes.
    pub fn batch_ends(&mut self, place: Vec<f64>) {
        (self.from, self.motion) = (place, Motion::Rests);
        self.jogs &= self.growing.waits();
    }

    /// The machine has another place, because it was homed.
    pub fn placed(&mut self, lines: Lines, place: Place, positions: &Positions) {
        (self.lines, self.place) = (lines, place);
        self.begins();
        self.rests_at(positions);
    }

    /// Behind a soft reset: the modes of the beginning, no overrides, no hold.
    pub fn restarts(&mut self) {
        let Offsets { mut parameters, .. } = self.lines.interpreter().offsets();
        // Grbl keeps neither G92 nor the length of the tool over a reset.
        parameters.retain(|(number, _)| !G92.contains(number));
        let at = self.at(&self.positions);
        self.lines.restart(at, Offsets { parameters, ..Offsets::default() });
        self.begins();
        (self.holds, self.door, self.checks, self.flush) = (false, false, false, None);
        self.accessories.reset();
        self.dialect.reporter.restart();
        self.clients.tell(WELCOME);
        if self.alarm {
            self.clients.tell(&message("'$H'|'$X' to unlock"));
        }
    }

    /// The modes in which Grbl begins, as far as they are not those of the interpreter.
    pub fn begins(&mut self) {
        // It cannot be refused: it moves nothing.
        let _ = self.lines.execute("G0G54G17G21G90G94");
    }

    /// G-code is locked out from now on, and nothing that was planned is done any more.
    pub fn alarms(&mut self, alarm: Alarm, why: &str) {
        (self.alarm, self.holds, self.door, self.homes) = (true, false, false, false);
        self.why = Some(why.to_owned());
        self.accessories.forget();
        self.input.clear();
        self.clients.tell(&Dialect::alarm(alarm));
        self.clients.tell(&message(why));
    }

    /// Tells the sender that the command ends, as far as it reads.
    pub fn farewell(&mut self) {
        self.clients.tell(&message("carrystep serve ends"));
        let begin = Instant::now();
        while !self.clients.all_is_said() && begin.elapsed() < FAREWELL {
            if self.clients.poll(true).is_err() {
                return;
            }
            std::thread::sleep(Duration::from_millis(1));
        }
    }
}
