//! The state of the machine, as a page shows it, and what a page wants of it.

use super::client::Id;
use super::clients::Driving;
use super::requests::Requests;
use super::web::Word;
use crate::control::Control;
use crate::json;
use carrystep_grbl::Seen;
use serde::Serialize;

/// The letters of the axes.
const LETTERS: [char; 6] = ['X', 'Y', 'Z', 'A', 'B', 'C'];

/// What a page shows.
#[derive(Serialize)]
struct State {
    state: String,
    /// The letters of the axes that the machine has; the places are in their order.
    axes: Vec<char>,
    /// Machine and work places, mm or degrees.
    machine: Vec<f64>,
    work: Vec<f64>,
    /// Speed along the path, mm/min, and of the spindle, turns per minute.
    feed: f64,
    rpm: f64,
    /// The inputs that are active, in the letters of `Pn:`.
    pins: String,
    /// Of feed, rapid moves and spindle, percent.
    overrides: [u8; 3],
    line: Option<u64>,
    driver: &'static str,
    may: bool,
    /// Why the machine is in an alarm.
    why: Option<String>,
}

impl Requests {
    /// Does what a page says.
    pub fn page(&mut self, id: Id, word: Word, control: &mut Control) {
        match word {
            Word::State if self.clients.is_slow(id) => {}
            Word::State => {
                let state = self.shown(id);
                // It cannot be refused: it holds no map whose keys are no text.
                let text = json::line(&state).unwrap_or_default();
                self.clients.say(id, &(text + "\n"));
            }
            Word::Stop => self.stops = true,
            Word::Realtime(realtime) => self.realtime(realtime, control),
            // The connections have done it.
            Word::Drive | Word::Release => {}
        }
    }

    fn shown(&self, id: Id) -> State {
        let Seen { state, machine, offset, line, feed, rpm, pins, overrides, .. } = self.seen();
        let has = |letter: &usize| self.lines.letters().axis(*letter).is_some();
        let letters: Vec<usize> = (0..machine.len().min(LETTERS.len())).filter(has).collect();
        let of = |value: &dyn Fn(usize) -> f64| letters.iter().map(|&at| value(at)).collect();
        State {
            state: state.to_string(),
            axes: letters.iter().map(|&at| LETTERS[at]).collect(),
            machine: of(&|at| machine[at]),
            work: of(&|at| machine[at] - offset[at]),
            feed,
            rpm,
            pins: pins.to_string(),
            overrides: [overrides.feed, overrides.rapid, overrides.spindle],
            line,
            driver: match self.clients.driving(id) {
                Driving::Nobody => "nobody",
                Driving::This => "this",
                Driving::Other => "other",
            },
            may: self.clients.may(id),
            why: self.why.clone().filter(|_| self.alarm),
        }
    }
}
