//! Executes O-words, M98 and M99: which line is the next one.
//!
//! A loop, a branch and a call are jumps in the files; only the return addresses and the counters
//! of `repeat` and M98 are kept.

use crate::error::{ErrorKind, Fault};
use crate::evaluate::{evaluate, whole};
use crate::files::{Address, Files};
use crate::memory::{ARGUMENTS, SetAside};
use crate::outcome::Jump;
use crate::outline::{Outline, Style};
use crate::source::Place;
use crate::state::State;
use crate::syntax::{Control, Label, OWord};
use std::io::{Read, Seek};

/// Greatest depth of calls in calls.
const DEEPEST_CALL: usize = 100;

/// A subroutine that is running.
#[derive(Debug)]
struct Call {
    /// Where it returns to.
    back: Address,
    aside: SetAside,
    /// Number of `repeat` loops outside of it.
    repeats: usize,
    /// For M98: where the subroutine begins, and how often it still has to run, this time included.
    numbered: Option<(Address, u32)>,
}

/// A `repeat` that is running.
#[derive(Debug)]
struct Repeat {
    node: usize,
    /// Rounds that remain, this one included.
    left: f64,
}

/// Where a program is.
#[derive(Debug, Default)]
pub(crate) struct Flow {
    calls: Vec<Call>,
    repeats: Vec<Repeat>,
    /// The `elseif` whose condition has to be computed next, because no branch before it was taken.
    /// An `elseif` that is reached in another way ends the branch before it.
    untested: Option<usize>,
}

impl Flow {
    /// Whether a subroutine is running.
    pub(crate) fn is_in_call(&self) -> bool {
        !self.calls.is_empty()
    }

    /// Executes the O-word of the line that begins at `at`. The result is the next line, if it is
    /// not the following one.
    pub(crate) fn execute<R: Read + Seek>(
        &mut self,
        files: &mut Files<R>,
        at: Address,
        control: &Control,
        state: &mut State,
    ) -> Result<Option<Address>, Fault> {
        let outline = files.outline();
        let Some(this) = outline.node_at(at.place.offset) else {
            return Err(Fault::new(control.column, ErrorKind::Changed));
        };
        let word = outline.nodes[this].word;
        let is_needed = word != OWord::ElseIf || self.untested == Some(this);
        let value = control.values.first().filter(|_| is_needed);
        let value = value.map(|value| evaluate(value, state)).transpose()?;
        match word {
            OWord::Call => {
                let back = files.here(outline.nodes[this].after);
                self.call(files, back, control, state).map(Some)
            }
            OWord::Return | OWord::EndSub => {
                let place = self.leave(value, state);
                place.map_err(|kind| Fault::new(control.column, kind))
            }
            _ => {
                let next = self.next_in_file(outline, this, value);
                Ok(next.map(|place| files.here(place)))
            }
        }
    }

    /// The next line after an O-word other than a call and a return.
    fn next_in_file(
        &mut self,
        outline: &Outline,
        this: usize,
        value: Option<f64>,
    ) -> Option<Place> {
        let nodes = &outline.nodes;
        let node = nodes[this];
        let first = node.leads_to;
        let holds = value.is_some_and(|value| value != 0.0);
        match node.word {
            OWord::If => self.branch(outline, holds, this),
            OWord::ElseIf if self.untested.take() == Some(this) => {
                self.branch(outline, holds, this)
            }
            OWord::ElseIf | OWord::Else => Some(nodes[node.end].after),
            OWord::While if node.ends_do => holds.then_some(nodes[first].after),
            OWord::While => (!holds).then_some(nodes[first].after),
            OWord::EndWhile => Some(nodes[first].at),
            OWord::Repeat => {
                let left = value.unwrap_or(0.0).round();
                if left < 1.0 {
                    return Some(nodes[first].after);
                }
                self.repeats.push(Repeat { node: this, left });
                None
            }
            OWord::EndRepeat => self.end_of_round(outline),
            OWord::Break => {
                self.leave_repeats(first);
                Some(nodes[nodes[first].leads_to].after)
            }
            OWord::Continue => {
                self.leave_repeats(first + 1);
                let start = nodes[first];
                Some(if start.word == OWord::While { start.at } else { nodes[start.leads_to].at })
            }
            OWord::Sub => Some(nodes[first].after),
            OWord::Do
            | OWord::EndIf
            | OWord::Program
            | OWord::Call
            | OWord::Return
            | OWord::EndSub => None,
        }
    }

    /// After the condition of `if` or `elseif`: the branch itself, or the next one.
    fn branch(&mut self, outline: &Outline, holds: bool, this: usize) -> Option<Place> {
        if holds {
            return None;
        }
        let next = outline.nodes[this].leads_to;
        let node = outline.nodes[next];
        if node.word != OWord::ElseIf {
            return Some(node.after);
        }
        self.untested = Some(next);
        Some(node.at)
    }

    fn end_of_round(&mut self, outline: &Outline) -> Option<Place> {
        let round = self.repeats.last_mut()?;
        round.left -= 1.0;
        if round.left >= 1.0 {
            return Some(outline.nodes[round.node].after);
        }
        self.repeats.pop();
        None
    }

    /// Forgets the `repeat` loops of this call that begin at this O-word or behind it.
    fn leave_repeats(&mut self, from: usize) {
        let outside = self.calls.last().map_or(0, |call| call.repeats);
        while self.repeats.len() > outside
            && self.repeats.last().is_some_and(|repeat| repeat.node >= from)
        {
            self.repeats.pop();
        }
    }

    /// `call`.
    fn call<R: Read + Seek>(
        &mut self,
        files: &mut Files<R>,
        back: Address,
        control: &Control,
        state: &mut State,
    ) -> Result<Address, Fault> {
        let label = match &control.label {
            Label::Fixed(label) => label.clone(),
            Label::Computed(expression) => {
                let value = evaluate(expression, state)?;
                whole(value).unwrap_or(value).to_string().into()
            }
        };
        if control.values.len() > ARGUMENTS {
            let kind = ErrorKind::TooManyArguments(ARGUMENTS);
            return Err(Fault::new(control.column, kind));
        }
        let values: Result<Vec<f64>, Fault> =
            control.values.iter().map(|value| evaluate(value, state)).collect();
        let values = values?;
        let start = self.start(files, Style::Words, &label, control.column)?;
        let aside = state.memory.enter(&values);
        self.enter(Call { back, aside, repeats: self.repeats.len(), numbered: None }, state);
        Ok(start)
    }

    /// The first line of a subroutine that may be called.
    fn start<R: Read + Seek>(
        &self,
        files: &mut Files<R>,
        style: Style,
        label: &str,
        column: u32,
    ) -> Result<Address, Fault> {
        if self.calls.len() >= DEEPEST_CALL {
            return Err(Fault::new(column, ErrorKind::TooManyCalls(DEEPEST_CALL)));
        }
        files.find(style, label).map_err(|fault| match fault.elsewhere {
            None => Fault::new(column, fault.kind),
            Some(_) => fault,
        })
    }

    fn enter(&mut self, call: Call, state: &mut State) {
        self.calls.push(call);
        state.call_level = self.calls.len();
    }

    /// Executes M98 or M99 in the line before `next`. The result is the next line, if it is not the
    /// following one.
    pub(crate) fn jump<R: Read + Seek>(
        &mut self,
        files: &mut Files<R>,
        next: Address,
        jump: Jump,
        state: &mut State,
    ) -> Result<Option<Address>, Fault> {
        match jump {
            Jump::Call { times: 0, .. } => Ok(None),
            Jump::Call { number, times, column } => {
                let start = self.start(files, Style::Numbered, &number.to_string(), column)?;
                let (aside, repeats) = (state.memory.enter_numbered(), self.repeats.len());
                let numbered = Some((start, times));
                self.enter(Call { back: next, aside, repeats, numbered }, state);
                Ok(Some(start))
            }
            Jump::Return { column } => {
                let fault = |kind| Fault::new(column, kind);
                let call = self.calls.last_mut().filter(|call| call.numbered.is_some());
                let call = call.ok_or_else(|| fault(ErrorKind::NothingToReturn))?;
                if let Some((start, left @ 2..)) = &mut call.numbered {
                    *left -= 1;
                    self.repeats.truncate(call.repeats);
                    state.memory.forget_names();
                    return Ok(Some(*start));
                }
                Ok(self.end_call(state))
            }
        }
    }

    /// `return` and `endsub`.
    fn leave(
        &mut self,
        value: Option<f64>,
        state: &mut State,
    ) -> Result<Option<Address>, ErrorKind> {
        let back = self.end_call(state);
        if back.is_some() {
            state.memory.set_name("_value", value.unwrap_or(0.0))?;
            state.memory.set_name("_value_returned", f64::from(u8::from(value.is_some())))?;
        }
        Ok(back)
    }

    fn end_call(&mut self, state: &mut State) -> Option<Address> {
        let call = self.calls.pop()?;
        self.repeats.truncate(call.repeats);
        state.memory.leave(call.aside);
        state.call_level = self.calls.len();
        Some(call.back)
    }
}
