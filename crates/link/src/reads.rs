//! Reads in progress: an answer is matched to its read by number and address; a read without an
//! answer is sent again.

use crate::frame::{Answer, Body, Request};
use crate::registers::MOST_AXES;
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
    /// Reads a register. If it is being read already, no second read is added.
    ///
    /// # Errors
    /// [`Full`] if eight registers are being read.
    pub fn ask(&mut self, address: u8) -> Result<(), Full> {
        if self.questions.iter().flatten().any(|question| question.address == address) {
            return Ok(());
        }
        let place = self.questions.iter_mut().find(|place| place.is_none()).ok_or(Full)?;
        *place = Some(Question { address, sequence: self.sequence, asked: None });
        self.sequence = self.sequence.wrapping_add(1);
        Ok(())
    }

    /// Whether an answer is outstanding.
    pub fn waiting(&self) -> bool {
        self.questions.iter().any(Option::is_some)
    }

    /// The read to be sent at the time `now`, ms. A read without an answer is sent again after
    /// `resend` ms.
    pub fn transmit(&mut self, now: u32, resend: u32) -> Option<Request> {
        let due = |question: &&mut Question| {
            question.asked.is_none_or(|asked| now.wrapping_sub(asked) >= resend)
        };
        let question = self.questions.iter_mut().flatten().find(due)?;
        question.asked = Some(now);
        Some(Request {
            sequence: question.sequence,
            body: Body::Read { address: question.address },
        })
    }

    /// Whether this answer belongs to a read, which it completes.
    pub fn answer(&mut self, answer: &Answer) -> bool {
        let own = |place: &&mut Option<Question>| {
            place.is_some_and(|question| {
                question.asked.is_some()
                    && answer.is_read_of(question.address)
                    && question.sequence == answer.sequence
            })
        };
        self.questions.iter_mut().find(own).map(Option::take).is_some()
    }
}
