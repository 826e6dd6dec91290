//! `$H`: the homing of `carrystep home`.

use super::requests::Flush;
use super::server::Server;
use crate::failure::Failure;
use crate::homing;
use carrystep_grbl::{Alarm, Dialect, ErrorCode, message};
use carrystep_link::{Homed, HomingFault, HostError, Wish};

impl Server<'_> {
    /// Homes all axes that can, or one, and returns the answer.
    pub fn home(&mut self, axis: Option<char>) -> Result<String, Failure> {
        let names: Vec<String> = axis.iter().map(|axis| axis.to_ascii_lowercase().into()).collect();
        let machine = self.machine;
        let refused = |why: &str| message(why) + &Dialect::error(ErrorCode::NoHoming);
        let groups = match homing::groups(machine, &names) {
            Ok(groups) => groups,
            Err(why) => return Ok(refused(why.message().lines().next().unwrap_or_default())),
        };
        let mut homing = homing::of(machine, &groups);
        if let Err((axis, why)) = homing.check() {
            return Ok(refused(&format!("axis {}: {why}", machine.axes[usize::from(axis)].name)));
        }
        if self.board.status().answer.fault {
            // Whoever homes ends the alarm with it.
            let cleared = self.board.clear();
            if let Err(error @ (HostError::StillPressed | HostError::TooLong { .. })) = cleared {
                return Ok(message(&error.to_string()) + &Dialect::error(ErrorCode::NotIdle));
            }
            cleared.map_err(|error| self.lost(&error))?;
        }
        homing.others = homing::others(machine, homing.mask(), self.board.status(), self.memory);
        (self.requests.homes, self.requests.alarm) = (true, false);
        let Self { board, control, requests, failed, .. } = self;
        let outcome = board.home(&homing, |_, _, progress| {
            if let Err(error) = requests.poll(progress.status, control) {
                failed.get_or_insert(Failure::Run(format!("the pseudo-terminal is gone: {error}")));
                return Wish::Stop;
            }
            if requests.flush == Some(Flush::Reset) || requests.stops {
                Wish::Stop
            } else {
                control.wish(progress.status)
            }
        });
        (self.requests.homes, self.requests.stops) = (false, false);
        // Until homing has succeeded, the axes to be homed have no machine coordinate.
        let mask = homing.mask();
        homing::forget(self.memory, machine, mask);
        match outcome {
            Ok(Homed::At(places)) => {
                homing::note(self.memory, machine, mask, &places);
                self.placed()?;
                Ok(Dialect::ok())
            }
            Ok(Homed::Stopped) => {
                self.board.clear().map_err(|error| self.lost(&error))?;
                Ok(self.unhomed(Alarm::HomingReset, "homing was ended"))
            }
            Err(HostError::Homing { axes, why }) => {
                let alarm = match why {
                    HomingFault::StillClosed | HomingFault::Closed => Alarm::HomingPullOff,
                    _ => Alarm::HomingSearch,
                };
                let text = homing::fault(machine, axes, why);
                Ok(self.unhomed(alarm, &text))
            }
            Err(HostError::Fault { .. }) => {
                self.fault()?;
                Ok(Dialect::error(ErrorCode::Locked))
            }
            Err(error) => Err(self.lost(&error)),
        }
    }

    fn unhomed(&mut self, alarm: Alarm, why: &str) -> String {
        self.requests.alarms(alarm, why);
        self.requests.rests_at(&self.board.status().positions);
        Dialect::error(ErrorCode::Locked)
    }
}
