//! What the connections want: real-time characters act at once, lines are taken in their order.

use super::accessories::Coolant;
use super::clients::Heard;
use super::requests::{Flush, Requests, Todo};
use crate::arguments::WhenGone;
use crate::control::{Control, ProgramControl};
use carrystep_grbl::{
    Dialect, ErrorCode, OverrideStep, Overrides, Realtime, State, WELCOME, message,
};
use carrystep_link::Status;
use carrystep_runner::OverrideSetting;
use std::io;

impl Requests {
    /// Looks at the connections, and does what they want as far as nothing has to rest for it.
    ///
    /// # Errors
    /// The pseudo-terminal has failed.
    pub fn poll(&mut self, status: &Status, control: &mut Control) -> io::Result<()> {
        self.see(status);
        self.heed(control);
        for heard in self.clients.poll(self.input.is_full())? {
            match heard {
                Heard::Came(id, drives) => {
                    if drives {
                        self.input.clear();
                        self.dialect.reporter.restart();
                    }
                    self.clients.say(id, WELCOME);
                    if self.alarm && drives {
                        self.clients.say(id, &message("'$H'|'$X' to unlock"));
                    }
                    if !drives {
                        self.clients.say(id, &message("another sender drives: only ? is answered"));
                    }
                }
                Heard::Gone(true) => self.gone(),
                Heard::Gone(false) => {}
                Heard::Bytes(id, bytes) if self.clients.driver() == Some(id) => {
                    for byte in bytes {
                        if let Some(realtime) = self.input.take(byte) {
                            self.realtime(realtime, control);
                        }
                    }
                }
                Heard::Bytes(id, bytes) => self.watcher(id, &bytes),
                Heard::Word(id, word) => self.page(id, word, control),
            }
        }
        self.take_lines();
        Ok(())
    }

    /// What a watcher may: ask for the state.
    fn watcher(&mut self, id: u64, bytes: &[u8]) {
        if bytes.contains(&b'?') && !self.clients.is_slow(id) {
            // The cadence of fields is that of the connection that drives.
            let mut dialect = self.dialect.clone();
            let report = dialect.report(&self.seen());
            self.clients.say(id, &report);
        }
        for _ in bytes.iter().filter(|&&byte| byte == b'\n') {
            self.clients.say(id, &Dialect::error(ErrorCode::NotIdle));
        }
    }

    /// The sender that drives is gone.
    fn gone(&mut self) {
        self.input.clear();
        if (self.when_gone == WhenGone::Stop || self.jogs) && self.is_busy() {
            self.flush = Some(Flush::Gone);
        }
    }

    /// What other commands want through the socket.
    fn heed(&mut self, control: &mut Control) {
        let Some(program) = control.program() else { return };
        self.holds |= program.holds() && !self.alarm;
        let OverrideSetting { feed, rapid, spindle } = program.overrides();
        self.overrides = Overrides { feed, rapid, spindle };
        if program.resumed() {
            self.resume(control);
        }
    }

    fn resume(&mut self, control: &mut Control) {
        // As with Grbl, not before the machine rests.
        if self.door && !self.accessories.is_parked() {
            return;
        }
        (self.holds, self.door) = (false, false);
        control.program().into_iter().for_each(ProgramControl::moves);
    }

    /// A real-time character of the connection that drives, or of a page that has the token.
    pub fn realtime(&mut self, realtime: Realtime, control: &mut Control) {
        let locked = self.alarm || self.sleeps || self.checks || self.homes;
        match realtime {
            Realtime::Report => self.report(),
            Realtime::Hold if self.jogs => self.cancel(),
            Realtime::Hold if !locked => self.holds = true,
            Realtime::Resume if !locked && self.flush.is_none() => self.resume(control),
            Realtime::Door if self.jogs => self.cancel(),
            Realtime::Door if !locked => (self.holds, self.door) = (true, true),
            Realtime::JogCancel if self.jogs => self.cancel(),
            Realtime::Reset => {
                self.input.clear();
                self.flush = Some(Flush::Reset);
                if self.sleeps {
                    self.todo = Some(Todo::Wake);
                }
            }
            Realtime::Override(step) => self.overriding(step, control),
            Realtime::SpindleStop => {
                if matches!(self.state(), State::Hold { .. }) {
                    self.accessories.toggle_spindle();
                }
            }
            Realtime::Flood => self.toggle(Coolant::Flood),
            Realtime::Mist => self.toggle(Coolant::Mist),
            Realtime::Hold | Realtime::Resume | Realtime::Door | Realtime::JogCancel => {}
        }
    }

    /// Switches a coolant, as a line with M7, M8 or M9 does: the modes follow. Machines without an
    /// output for it ignore this.
    fn toggle(&mut self, coolant: Coolant) {
        let may = matches!(self.state(), State::Idle | State::Run | State::Hold { .. });
        let Some(was_on) = self.accessories.is_on(coolant).filter(|_| may) else { return };
        self.accessories.toggle(coolant);
        let modes = self.lines.interpreter().modes();
        let flood = if coolant == Coolant::Flood { !was_on } else { modes.flood };
        let mist = if coolant == Coolant::Mist { !was_on } else { modes.mist };
        for (line, _) in [("M9", true), ("M8", flood), ("M7", mist)].iter().filter(|line| line.1) {
            // The outputs are switched already. It cannot be refused.
            let _ = self.lines.execute(line);
        }
    }

    fn cancel(&mut self) {
        self.flush.get_or_insert(Flush::Jog);
    }

    fn overriding(&mut self, step: OverrideStep, control: &mut Control) {
        self.overrides = self.overrides.after(step);
        let Overrides { feed, rapid, spindle } = self.overrides;
        let setting = OverrideSetting { feed, rapid, spindle };
        control.program().into_iter().for_each(|program| program.set_overrides(setting));
    }

    fn report(&mut self) {
        if self.clients.driver().is_some_and(|id| !self.clients.is_slow(id)) {
            let seen = self.seen();
            let report = self.dialect.report(&seen);
            self.clients.tell(&report);
        }
    }
}
