//! Questions on their way: an answer is known again by its number and address, a lost one is asked again.

use crate::frame::{Answer, Body, Request};
use crate::registers::{MOST_AXES, WRITE};
use crate::window::Full;

#[derive(Debug, Clone, Copy)]
struct Question {
    address: u8,
    sequence: u8,
    asked: Option<u32>,
}

/// Up to eight registers that are being read.
#[derive(Debug, Clone, Default)]
pub struct Reads {
    questions: [Option<Question>; MOST_AXES as usize],
    sequence: u8,
}

impl Reads {
    /// Reads a register; once, where it is being read already.
    ///
    /// # Errors
    /// [`Full`].
    pub fn ask(&mut self, address: u8) -> Result<(), Full> {
        let address = address & !WRITE;
        if self.questions.iter().flatten().any(|question| question.address == address) {
            return Ok(());
        }
        let place = self.questions.iter_mut().find(|place| place.is_none()).ok_or(Full)?;
        *place = Some(Question { address, sequence: self.sequence, asked: None });
        self.sequence = self.sequence.wrapping_add(1);
        Ok(())
    }

    /// Whether an answer is still to come.
    pub fn waiting(&self) -> bool {
        self.questions.iter().any(Option::is_some)
    }

    /// What is to be sent at this time, ms; after `resend` ms without its answer a question is asked again.
    pub fn transmit(&mut self, now: u32, resend: u32) -> Option<Request> {
        let due = |question: &&mut Question| question.asked.is_none_or(|asked| now.wrapping_sub(asked) >= resend);
        let question = self.questions.iter_mut().flatten().find(due)?;
        question.asked = Some(now);
        Some(Request { sequence: question.sequence, body: Body::Read { address: question.address } })
    }

    /// Whether this answers a question, which is done with it.
    pub fn answer(&mut self, answer: &Answer) -> bool {
        let own = |place: &&mut Option<Question>| {
            place.is_some_and(|question| {
                question.asked.is_some() && (question.address, question.sequence) == (answer.address, answer.sequence)
            })
        };
        self.questions.iter_mut().find(own).map(Option::take).is_some()
    }
}
