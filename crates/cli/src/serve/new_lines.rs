//! The lines of the sender that drives, in their order. Each is answered when it is done, refused,
//! or in the queue of the plan.

use super::requests::{Flush, Requests, Todo};
use super::{refusal, terms};
use carrystep_gcode::{AXIS_LETTERS, Offsets};
use carrystep_grbl::{Action, Alarm, Dialect, ErrorCode, Line, Outcome, message};
use carrystep_program::{LineBreak, LineFault, Lines, PlannedLine};

impl Requests {
    /// Takes lines as long as they can be done.
    pub fn take_lines(&mut self) {
        while self.may_take() {
            let Some(line) = self.input.next_line() else { return };
            let answer = match line {
                Line::TooLong => Some(Dialect::error(ErrorCode::Overflow)),
                Line::Text(text) if text.contains("HTTP1.") => {
                    // A web page that has got past the beginning of a connection.
                    self.clients.driver().into_iter().for_each(|id| self.clients.close(id));
                    self.input.clear();
                    return;
                }
                Line::Text(text) => self.take(&text),
            };
            answer.into_iter().for_each(|answer| self.clients.tell(&answer));
        }
    }

    fn may_take(&self) -> bool {
        let is_slow = self.clients.driver().is_some_and(|id| self.clients.is_slow(id));
        let waits = self.todo.is_some() || self.probing.is_some() || self.flush.is_some();
        !waits && !is_slow && self.growing.free() > 0
    }

    /// Does a line, and returns its answer; `None` if it is answered later.
    fn take(&mut self, text: &str) -> Option<String> {
        // Programs begin and end with it, and Grbl's senders leave it out.
        if text == "%" {
            return Some(Dialect::ok());
        }
        let state = self.state();
        let Self { dialect, lines, probed, .. } = self;
        let parameters = || terms::parameters(lines.interpreter(), lines.letters(), probed);
        let modes = || terms::modes(lines.interpreter());
        let action = match dialect.line(text, state, parameters, modes) {
            Outcome::Answered(answer) => return Some(answer),
            Outcome::Do(action) => action,
        };
        match action {
            Action::Gcode(words) => self.gcode(words),
            Action::Jog(words) => Some(match self.jog(words) {
                Ok(()) => Dialect::ok(),
                Err(code) => Dialect::error(code),
            }),
            Action::Home(axis) => self.later(Todo::Home(axis)),
            Action::Sleep => self.later(Todo::Sleep),
            Action::Unlock if self.alarm => self.later(Todo::Unlock),
            Action::Unlock => Some(Dialect::ok()),
            Action::Check if self.checks => {
                self.flush = Some(Flush::Reset);
                Some(message("Disabled") + &Dialect::ok())
            }
            Action::Check => {
                self.checks = true;
                Some(message("Enabled") + &Dialect::ok())
            }
            Action::Restore(restored) => {
                if restored.parameters {
                    self.lines.restart(self.lines.end(), Offsets::default());
                }
                self.flush = Some(Flush::Reset);
                Some(message("Restoring defaults") + &Dialect::ok())
            }
        }
    }

    fn later(&mut self, todo: Todo) -> Option<String> {
        self.todo = Some(todo);
        None
    }

    fn gcode(&mut self, words: &str) -> Option<String> {
        match self.executes(words, Lines::execute) {
            Ok(parts) => {
                self.numbered(words);
                if parts.contains(&PlannedLine::Break(LineBreak::End)) {
                    // The end of a program brings back these modes; it cannot be refused.
                    let _ = self.lines.execute("G1G17G54G90G94");
                }
                if self.checks {
                    return Some(Dialect::ok());
                }
                if let Some(&PlannedLine::Break(LineBreak::Probe(probe))) = parts.last() {
                    self.probe_line = parts;
                    return self.later(Todo::Probe(probe));
                }
                self.growing.add(parts);
                Some(Dialect::ok())
            }
            Err(fault) if fault.is_travel() && !self.checks => {
                // As Grbl does: what has come before comes to rest, and nothing is locked open.
                self.soft_limit(&fault);
                None
            }
            Err(fault) => Some(self.refused(&fault)),
        }
    }

    /// Executes a line. As with Grbl, F of a line that changes the units is in the new ones.
    fn executes(
        &mut self,
        words: &str,
        execute: fn(&mut Lines, &str) -> Result<Vec<PlannedLine>, LineFault>,
    ) -> Result<Vec<PlannedLine>, LineFault> {
        let inches = self.lines.interpreter().modes().inches;
        let (code, before) = if inches { ("G21", "G20") } else { ("G20", "G21") };
        if !words.contains('F') || !words.contains(code) {
            return execute(&mut self.lines, words);
        }
        self.lines.execute(code)?;
        let parts = execute(&mut self.lines, &words.replacen(code, "", 1));
        if parts.is_err() {
            self.lines.execute(before)?;
        }
        parts
    }

    /// The error of a line, after a message that says more.
    fn refused(&self, fault: &LineFault) -> String {
        message(&one_line(fault)) + &Dialect::error(refusal::code(fault))
    }

    fn soft_limit(&mut self, fault: &LineFault) {
        self.alarms(Alarm::SoftLimit, &one_line(fault));
        if self.is_busy() {
            self.flush = Some(Flush::Gone);
        }
    }

    /// A jog: the words of a G1 with a feed of its own, which change no mode.
    fn jog(&mut self, words: &str) -> Result<(), ErrorCode> {
        let has = |letter: char| words.contains(letter);
        let codes: Vec<&str> = words
            .match_indices([
                'G', 'M', 'T', 'S', 'P', 'R', 'I', 'J', 'K', 'L', 'Q', 'H', 'D', 'O', '#', '[',
            ])
            .map(|(at, _)| &words[at..])
            .collect();
        let known = |code: &&str| {
            let end = code[1..].find(|c: char| !c.is_ascii_digit() && c != '.');
            let code = &code[..end.map_or(code.len(), |end| end + 1)];
            matches!(code, "G20" | "G21" | "G53" | "G90" | "G91")
        };
        if !codes.iter().all(known) {
            return Err(ErrorCode::BadJog);
        }
        if !has('F') {
            return Err(ErrorCode::NoFeed);
        }
        if !AXIS_LETTERS.iter().any(|letter| has(letter.to_ascii_uppercase())) {
            return Err(ErrorCode::NoAxes);
        }
        // Machine coordinates are absolute.
        let absolute = words.contains("G53") && !words.contains("G9");
        let line = format!("{}G94G1{words}", if absolute { "G90" } else { "" });
        let inches = self.lines.interpreter().modes().inches;
        let parts = self.executes(&line, Lines::execute_aside);
        // A jog changes no mode; the units were one of their own.
        let _ = self.lines.execute(if inches { "G20" } else { "G21" });
        let parts = parts.map_err(|fault| refusal::code(&fault))?;
        if parts.iter().any(|part| matches!(part, PlannedLine::Item(_))) {
            self.jogs = true;
            self.growing.add(parts);
        }
        Ok(())
    }
}

/// What is wrong, in one line that holds no bracket.
fn one_line(fault: &LineFault) -> String {
    let text = match fault {
        LineFault::Gcode(error) => error.kind.to_string(),
        other => other.to_string(),
    };
    text.replace(['\r', '\n'], " ").replace(['[', ']'], "")
}
