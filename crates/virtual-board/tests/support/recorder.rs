//! A board of models that records what reaches it, with the clocks, and the replay of a recording on
//! other boards.
//!
//! ```text
//! host --bytes--> Recorder (skips clocks) --> Recording --> model, clock by clock --> pins
//!      switches->                                      \--> exported Verilog      --> pins
//! ```
//!
//! The pins of both replays are compared in every clock, and with the edges of the recorded run.

use carrystep_core::engine::Cause;
use carrystep_core::link::END;
use carrystep_model::fast::{Change, Edge};
use carrystep_simulators::LevelError;
use carrystep_virtual_board::{Edges, ModelBoard, PinLevels, SimulatedBoard, Switches};

/// Greatest number of clocks between two looks at whether a replay differs.
const LOOK: u64 = 100_000;

/// What reaches a board.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Event {
    /// The host has handed a byte to its end of the line.
    Byte(u8),
    /// The switches at the inputs have changed.
    Press(Switches),
}

/// What has reached a board, and what it has done.
#[derive(Debug, Clone, Default)]
pub struct Recording {
    /// In order, each with the cycle from which on it counts.
    pub events: Vec<(u64, Event)>,
    /// The bytes that the host has received.
    pub answers: Vec<u8>,
    /// The edges of STEP and DIR.
    pub edges: Vec<Edge>,
    /// The levels of the outputs, each with the first cycle.
    pub levels: Vec<(u64, u8)>,
    /// The cycle in which the recording ends.
    pub clocks: u64,
}

/// The levels of the pins of a replay, each with the first cycle.
pub type Pins = Vec<(u64, PinLevels)>;

/// The board.
#[derive(Debug)]
pub struct Recorder {
    board: ModelBoard,
    pressed: Switches,
    recording: Recording,
}

impl Recorder {
    /// Records from this cycle on, which must be 0: a replay begins at configuration.
    pub fn new(board: ModelBoard) -> Self {
        assert_eq!(board.cycle(), 0);
        Self { board, pressed: Switches::default(), recording: Recording::default() }
    }

    /// The board of models.
    pub fn model(&self) -> &ModelBoard {
        &self.board
    }

    /// Ends the recording in the present cycle.
    pub fn finish(mut self) -> Recording {
        while self.next_byte().is_some() {}
        Recording { clocks: self.board.cycle(), ..self.recording }
    }
}

/// Records what another receiver of edges gets, too.
struct Both<'a>(&'a mut Recording, &'a mut dyn Edges);

impl Edges for Both<'_> {
    fn edge(&mut self, edge: Edge) {
        self.0.edges.push(edge);
        self.1.edge(edge);
    }

    fn levels(&mut self, clock: u64, levels: u8) {
        self.0.levels.push((clock, levels));
        self.1.levels(clock, levels);
    }
}

impl SimulatedBoard for Recorder {
    fn cycle(&self) -> u64 {
        self.board.cycle()
    }

    fn rests(&self) -> bool {
        self.board.rests()
    }

    fn fault(&self) -> Option<(Cause, u8)> {
        self.board.fault()
    }

    fn position(&self, axis: usize) -> i32 {
        self.board.position(axis)
    }

    fn step(&self) -> u8 {
        self.board.step()
    }

    fn discarded(&self, axis: usize) -> Option<u32> {
        self.board.discarded(axis)
    }

    fn alone(&self) -> Option<u64> {
        self.board.alone()
    }

    fn loads(&self) -> &[u64] {
        self.board.loads()
    }

    fn stops(&self) -> &[(u64, Cause)] {
        self.board.stops()
    }

    fn say(&mut self, byte: u8) {
        self.recording.events.push((self.board.cycle(), Event::Byte(byte)));
        self.board.say(byte);
    }

    fn unsaid(&self) -> usize {
        self.board.unsaid()
    }

    fn talks(&self) -> bool {
        self.board.talks()
    }

    fn is_answering(&self) -> bool {
        self.board.is_answering()
    }

    fn next_byte(&mut self) -> Option<u8> {
        let byte = self.board.next_byte();
        self.recording.answers.extend(byte);
        byte
    }

    fn press(&mut self, switches: Switches) {
        if std::mem::replace(&mut self.pressed, switches) != switches {
            self.recording.events.push((self.board.cycle(), Event::Press(switches)));
        }
        self.board.press(switches);
    }

    fn run(&mut self, end: u64, to: &mut dyn Edges) -> Result<(), LevelError> {
        let Self { board, recording, .. } = self;
        board.run(end, &mut Both(recording, to));
        Ok(())
    }

    fn watch(&mut self, end: u64, seen: &mut dyn FnMut(u64, PinLevels)) -> Result<(), LevelError> {
        SimulatedBoard::watch(&mut self.board, end, seen)
    }
}

/// The edges in a cycle whose pins have these levels after those, in the order in which models report
/// them.
pub fn edges_between(clock: u64, before: PinLevels, now: PinLevels) -> impl Iterator<Item = Edge> {
    (0..8).flat_map(move |axis| {
        let is = |level: u8| level >> axis & 1 == 1;
        let backward = is(now.dir);
        let rises = is(now.step & !before.step).then_some(Change::Rise);
        let turns = is(now.dir ^ before.dir).then_some(Change::DirChange);
        let changes = rises.into_iter().chain(turns);
        changes.map(move |change| Edge { clock, axis, change, backward })
    })
}

impl Recording {
    /// Replays it on a board at configuration. `seen` receives the levels of the pins, and ends the
    /// replay early with `false`. Returns the bytes of the answers.
    pub fn replay(
        &self,
        mut board: impl SimulatedBoard,
        mut seen: impl FnMut(u64, PinLevels) -> bool,
    ) -> Vec<u8> {
        assert_eq!(board.cycle(), 0);
        let mut goes_on = true;
        let mut answers = Vec::new();
        let end = (self.clocks, None);
        for (at, event) in self.events.iter().map(|&(at, event)| (at, Some(event))).chain([end]) {
            while board.cycle() < at && goes_on {
                let stop = at.min(board.cycle() + LOOK);
                let mut seen = |cycle, levels| goes_on = goes_on && seen(cycle, levels);
                board.watch(stop, &mut seen).unwrap();
                answers.extend(std::iter::from_fn(|| board.next_byte()));
            }
            match event {
                Some(Event::Byte(byte)) => board.say(byte),
                Some(Event::Press(switches)) => board.press(switches),
                None => {}
            }
        }
        answers
    }

    /// The pins of a board of models that skips no clock, while this recording is replayed on it. The
    /// edges, outputs and answers must be those of the recorded run.
    pub fn pins(&self, board: ModelBoard) -> Pins {
        let mut pins = Pins::new();
        let answers = self.replay(board, |cycle, levels| {
            pins.push((cycle, levels));
            true
        });
        assert!(answers == self.answers, "other answers of the model");
        let (mut edges, mut levels) = (Vec::new(), Vec::new());
        let mut before = PinLevels::default();
        for &(clock, now) in &pins {
            edges.extend(edges_between(clock, before, now));
            if now.outputs != before.outputs {
                levels.push((clock, now.outputs));
            }
            before = now;
        }
        assert!(edges == self.edges, "other edges of the model");
        assert_eq!(levels, self.levels, "outputs");
        pins
    }

    /// The first cycle in which the pins of a board differ from these while this recording is
    /// replayed on it, and how; or that its answers differ.
    pub fn difference(&self, board: impl SimulatedBoard, pins: &Pins) -> Option<String> {
        let mut due = pins.iter().copied();
        let mut differs = None;
        let answers = self.replay(board, |cycle, levels| {
            let wanted = due.next();
            if wanted != Some((cycle, levels)) {
                differs = Some(format!("cycle {cycle}: {levels:?} instead of {wanted:?}"));
            }
            differs.is_none()
        });
        differs
            .or_else(|| due.next().map(|missing| format!("nothing changes as in {missing:?}")))
            .or_else(|| (answers != self.answers).then(|| "other answers".to_owned()))
    }

    /// The same recording, but for one byte that arrives late, and by how many clocks it is handed
    /// over later: the end of a frame behind which the line is idle for a while. A byte lasts
    /// `byte_clocks`.
    pub fn with_a_late_byte(&self, byte_clocks: u64) -> (Self, u64) {
        let mut late = self.clone();
        // The cycle from which on the line is idle.
        let mut idle = 0;
        for number in 1..self.events.len() {
            let ((at, event), (next, _)) = (self.events[number - 1], self.events[number]);
            if !matches!(event, Event::Byte(_)) {
                continue;
            }
            idle = at.max(idle) + byte_clocks;
            let shift = idle - at + 7;
            if event == Event::Byte(END) && next > at + 2 * shift {
                late.events[number - 1].0 += shift;
                return (late, shift);
            }
        }
        panic!("the line is never idle")
    }

    /// The same recording, but for one bit of a byte.
    pub fn with_a_wrong_bit(&self) -> Self {
        let mut wrong = self.clone();
        // Neither such a byte nor what it becomes ends a frame.
        let plain = |event: &Event| matches!(event, Event::Byte(byte) if *byte < 0x80);
        let mut bytes: Vec<&mut Event> =
            wrong.events.iter_mut().map(|(_, event)| event).filter(|event| plain(event)).collect();
        let some = bytes.len() / 8;
        if let Event::Byte(byte) = &mut *bytes[some] {
            *byte ^= 1;
        }
        wrong
    }
}
