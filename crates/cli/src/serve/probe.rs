//! Probe moves of senders: a batch of one line, which ends at rest where the probe closes or opens.
//!
//! ```text
//! G38.2 -> at rest: closed already? ALARM:4
//!       -> seek with all axes -> stream the batch -> hit: [PRB:the place of the hit:1], ok
//!                                                 -> no hit: ALARM:5 or none, [PRB:..:0], ok
//! ```

use super::requests::Requests;
use super::server::{Next, Server};
use super::terms;
use crate::connection::ConnectedBoardError;
use crate::drive::{all_axes, exact_position, is_closed, point_at, settle};
use crate::failure::Failure;
use carrystep_grbl::{Alarm, Dialect, Probed};
use carrystep_link::registers::MOST_AXES;
use carrystep_link::{AxisState, Ended, HostError, SeekSource};
use carrystep_program::{Point, ProbeLine};

/// The states of all axes in the tick of a hit.
pub type States = [AxisState; MOST_AXES as usize];

/// How a stretch ended.
pub enum Probing {
    /// As any stretch does.
    Ended(Ended),
    /// The probe has ended it.
    Tripped(States),
}

impl Requests {
    /// The machine rests, and the line with the probe move is the next one that is planned.
    pub fn begins_probe(&mut self, probe: ProbeLine) {
        self.growing.add(std::mem::take(&mut self.probe_line));
        self.probing = Some(probe);
    }

    /// A probe move has ended with the probe at `at`, and the machine rests at `rests`.
    fn probe_ends(&mut self, at: Point, tripped: bool, rests: Point) {
        self.probing = None;
        self.lines.probed(at, tripped, rests);
        let letters = self.lines.letters();
        self.probed = Probed { at: terms::of_axes(letters, |letter| at[letter]), tripped };
        let inches = self.lines.interpreter().modes().inches;
        self.clients.tell(&(self.probed.text(inches) + &Dialect::ok()));
    }
}

impl Server<'_> {
    /// From now on the probe ends the motion of all axes. False if it has the wanted state already:
    /// then nothing moves, and the machine is locked.
    pub fn arms(&mut self, probe: ProbeLine) -> Result<bool, Failure> {
        let looked = is_closed(self.board);
        if looked.map_err(|error| self.lost(&error))? == probe.contact {
            let state = if probe.contact { "closed" } else { "open" };
            let why = format!("the probe is {state} before the move, which waits for that");
            self.requests.alarms(Alarm::ProbeState, &why);
            self.requests.rests_at(&self.board.status().positions);
            self.requests.clients.tell(&Dialect::ok());
            return Ok(false);
        }
        let axes = all_axes(self.board);
        let armed = self.board.seek(axes, SeekSource::probe(probe.contact));
        armed.map_err(|error| self.lost(&error))?;
        Ok(true)
    }

    /// A stretch has ended; if it was one of a probe move, the probe ends nothing any more.
    pub fn disarms(
        &mut self,
        probe: Option<ProbeLine>,
        ended: Result<Ended, ConnectedBoardError>,
    ) -> Result<Probing, ConnectedBoardError> {
        let Some(probe) = probe else { return ended.map(Probing::Ended) };
        match ended {
            Ok(ended @ (Ended::Done | Ended::SeekEnded)) => {
                Ok(self.board.end_seek()?.map_or(Probing::Ended(ended), Probing::Tripped))
            }
            _ => {
                // What the sender has to know is how the move ended.
                let _ = self.board.seek(0, SeekSource::probe(probe.contact));
                ended.map(Probing::Ended)
            }
        }
    }

    /// The probe has ended the move, and the axes rest a little further.
    pub fn tripped(&mut self, states: &States) -> Result<Next, Failure> {
        let settled = settle(self.board, self.machine).and_then(|()| self.board.read_status());
        let positions = match settled {
            Ok(status) => status.positions,
            Err(HostError::Fault { .. }) => return self.fault(),
            Err(error) => return Err(self.lost(&error)),
        };
        let requests = &mut self.requests;
        let exact = states.map(|state| exact_position(&state));
        let at = point_at(requests.lines.letters(), &requests.place.zero, &exact);
        requests.rests_at(&positions);
        requests.probe_ends(at, true, requests.at(&positions));
        Ok(Next::GoesOn)
    }

    /// The probe has not ended the move: the axes rest at its target.
    pub fn missed(&mut self, probe: ProbeLine) {
        if probe.required {
            let what = if probe.contact { "closed" } else { "opened" };
            let why = format!("the probe has not {what} up to the end of the move");
            self.requests.alarms(Alarm::ProbeContact, &why);
        }
        let at = self.requests.lines.end();
        self.requests.probe_ends(at, false, at);
    }
}
