//! Executes O-words: which line is the next one.
//!
//! A loop, a branch and a call are jumps in the file; only the return addresses and the counters of
//! `repeat` are kept.

use crate::error::{ErrorKind, Fault};
use crate::evaluate::{evaluate, whole};
use crate::memory::{ARGUMENTS, SetAside};
use crate::outline::Outline;
use crate::source::Place;
use crate::state::State;
use crate::syntax::{Control, Label, OWord};

/// Greatest depth of calls in calls.
const DEEPEST_CALL: usize = 100;

/// A subroutine that is running.
#[derive(Debug)]
struct Call {
    /// Where it returns to.
    back: Place,
    aside: SetAside,
    /// Number of `repeat` loops outside of it.
    repeats: usize,
}

/// A `repeat` that is running.
#[derive(Debug)]
struct Repeat {
    node: usize,
    /// Rounds that remain, this one included.
    left: f64,
}

/// Where a program is.
#[derive(Debug)]
pub(crate) struct Flow {
    outline: Outline,
    calls: Vec<Call>,
    repeats: Vec<Repeat>,
    /// The `elseif` whose condition has to be computed next, because no branch before it was taken.
    /// An `elseif` that is reached in another way ends the branch before it.
    untested: Option<usize>,
}

impl Flow {
    pub(crate) fn new(outline: Outline) -> Self {
        Self { outline, calls: Vec::new(), repeats: Vec::new(), untested: None }
    }

    /// Executes the O-word of the line that begins at `offset`. The result is the place of the next
    /// line, if it is not the following one.
    pub(crate) fn execute(
        &mut self,
        offset: u64,
        control: &Control,
        state: &mut State,
    ) -> Result<Option<Place>, Fault> {
        let Some(this) = self.outline.node_at(offset) else {
            return Err(Fault::new(control.column, ErrorKind::Changed));
        };
        let node = self.outline.nodes[this];
        let first = node.leads_to;
        let value = |state: &State| match control.values.first() {
            Some(expression) => evaluate(expression, state).map(Some),
            None => Ok(None),
        };
        let holds = |state: &State| value(state).map(|value| value.unwrap_or(0.0) != 0.0);
        Ok(match node.word {
            OWord::Do | OWord::EndIf => None,
            OWord::If => self.branch(holds(state)?, this),
            OWord::ElseIf if self.untested.take() == Some(this) => self.branch(holds(state)?, this),
            OWord::ElseIf | OWord::Else => Some(self.outline.nodes[node.end].after),
            OWord::While if node.ends_do => holds(state)?.then(|| self.outline.nodes[first].after),
            OWord::While => (!holds(state)?).then(|| self.outline.nodes[first].after),
            OWord::EndWhile => Some(self.outline.nodes[first].at),
            OWord::Repeat => {
                let left = value(state)?.unwrap_or(0.0).round();
                if left < 1.0 {
                    return Ok(Some(self.outline.nodes[first].after));
                }
                self.repeats.push(Repeat { node: this, left });
                None
            }
            OWord::EndRepeat => self.end_of_round(),
            OWord::Break => {
                self.leave_repeats(first);
                Some(self.outline.nodes[self.outline.nodes[first].leads_to].after)
            }
            OWord::Continue => {
                self.leave_repeats(first + 1);
                let start = self.outline.nodes[first];
                Some(match start.word {
                    OWord::While => start.at,
                    _ => self.outline.nodes[start.leads_to].at,
                })
            }
            OWord::Sub => Some(self.outline.nodes[first].after),
            OWord::Call => Some(self.call(node.after, control, state)?),
            OWord::Return | OWord::EndSub => {
                let place = self.leave(value(state)?, state);
                place.map_err(|kind| Fault::new(control.column, kind))?
            }
        })
    }

    /// After the condition of `if` or `elseif`: the branch itself, or the next one.
    fn branch(&mut self, holds: bool, this: usize) -> Option<Place> {
        if holds {
            return None;
        }
        let next = self.outline.nodes[this].leads_to;
        let node = self.outline.nodes[next];
        if node.word != OWord::ElseIf {
            return Some(node.after);
        }
        self.untested = Some(next);
        Some(node.at)
    }

    fn end_of_round(&mut self) -> Option<Place> {
        let round = self.repeats.last_mut()?;
        round.left -= 1.0;
        if round.left >= 1.0 {
            return Some(self.outline.nodes[round.node].after);
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

    fn call(&mut self, back: Place, control: &Control, state: &mut State) -> Result<Place, Fault> {
        let fault = |kind| Fault::new(control.column, kind);
        let label = match &control.label {
            Label::Fixed(label) => label.clone(),
            Label::Computed(expression) => {
                let value = evaluate(expression, state)?;
                whole(value).unwrap_or(value).to_string().into()
            }
        };
        let sub = self.outline.sub(&label);
        let sub = sub.ok_or_else(|| fault(ErrorKind::UnknownSub(label.to_string())))?;
        if self.calls.len() >= DEEPEST_CALL {
            return Err(fault(ErrorKind::TooManyCalls(DEEPEST_CALL)));
        }
        if control.values.len() > ARGUMENTS {
            return Err(fault(ErrorKind::TooManyArguments(ARGUMENTS)));
        }
        let values: Result<Vec<f64>, Fault> =
            control.values.iter().map(|value| evaluate(value, state)).collect();
        let aside = state.memory.enter(&values?);
        self.calls.push(Call { back, aside, repeats: self.repeats.len() });
        state.call_level = self.calls.len();
        Ok(self.outline.nodes[sub].after)
    }

    fn leave(&mut self, value: Option<f64>, state: &mut State) -> Result<Option<Place>, ErrorKind> {
        let Some(call) = self.calls.pop() else { return Ok(None) };
        self.repeats.truncate(call.repeats);
        state.memory.leave(call.aside);
        state.memory.set_name("_value", value.unwrap_or(0.0))?;
        state.memory.set_name("_value_returned", f64::from(u8::from(value.is_some())))?;
        state.call_level = self.calls.len();
        Ok(Some(call.back))
    }
}
