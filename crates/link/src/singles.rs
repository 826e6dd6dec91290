//! Requests outside of the sequence of writes: reads, OPEN and STOP. An answer is matched to its
//! request by number and address. A request without an answer is sent again after a time. Once in
//! this time it is sent again as soon as a request that was sent behind it is answered, because
//! answers come in the order of requests.

use crate::frame::{Answer, Body};
use crate::registers::MOST_AXES;
use crate::window::Full;

/// Greatest number of unanswered reads.
const READS: usize = MOST_AXES as usize;

#[derive(Debug, Clone, Copy)]
struct Single {
    address: u8,
    /// The word of a write; `None` for a read.
    word: Option<u32>,
    sequence: u8,
    /// How it was sent; `None` if it was not.
    asked: Option<Asked>,
}

/// How a request was sent at last.
#[derive(Debug, Clone, Copy)]
struct Asked {
    /// When, ms.
    at: u32,
    /// Its place in the order of these requests.
    order: u8,
    /// Sequence number of the next write that was to be sent then.
    before: u8,
    overtaken: Overtaken,
}

/// Whether a request that was sent behind another one was answered before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Overtaken {
    No,
    /// It was, so this one is to be sent again.
    Yes,
    /// It was, and this one was sent again for that reason; now it waits for its time.
    SentAgain,
}

impl Single {
    const fn writes(&self, register: u8) -> bool {
        self.word.is_some() && self.address == register
    }
}

/// Up to eight registers that are being read, one OPEN and one STOP.
#[derive(Debug, Clone, Default)]
pub struct Singles {
    places: [Option<Single>; READS + 2],
    sequence: u8,
    /// Place of the request that was sent last, in the order of these requests.
    order: u8,
}

impl Singles {
    /// Reads a register. If it is being read already, no second read is added.
    ///
    /// # Errors
    /// [`Full`] if eight registers are being read.
    pub fn read(&mut self, address: u8) -> Result<(), Full> {
        let reads = self.places.iter().flatten().filter(|single| single.word.is_none());
        if reads.clone().any(|single| single.address == address) {
            return Ok(());
        }
        if reads.count() == READS {
            return Err(Full);
        }
        self.add(address, None);
        Ok(())
    }

    /// Sends OPEN or STOP, once more if it was sent and not answered.
    pub fn write(&mut self, register: u8, word: u32) {
        self.withdraw(register);
        self.add(register, Some(word));
    }

    /// Whether an OPEN or STOP has no answer yet.
    pub fn writing(&self, register: u8) -> bool {
        self.places.iter().flatten().any(|single| single.writes(register))
    }

    /// Forgets an OPEN or STOP.
    pub fn withdraw(&mut self, register: u8) {
        for place in &mut self.places {
            place.take_if(|single| single.writes(register));
        }
    }

    fn add(&mut self, address: u8, word: Option<u32>) {
        if let Some(place) = self.places.iter_mut().find(|place| place.is_none()) {
            *place = Some(Single { address, word, sequence: self.sequence, asked: None });
            self.sequence = self.sequence.wrapping_add(1);
        }
    }

    /// Whether an answer is outstanding.
    pub fn waiting(&self) -> bool {
        self.places.iter().any(Option::is_some)
    }

    /// The number and the body of the request to be sent at the time `now`, ms; writes come first.
    /// A request without an answer is sent again after `resend` ms. `before` is the number of the
    /// next write that is to be sent.
    pub fn transmit(&mut self, now: u32, resend: u32, before: u8) -> Option<(u8, Body)> {
        let is_late = |asked: &Asked| now.wrapping_sub(asked.at) >= resend;
        let is_due = |single: &&mut Single| {
            single.asked.is_none_or(|asked| asked.overtaken == Overtaken::Yes || is_late(&asked))
        };
        let due = self.places.iter_mut().flatten().filter(is_due);
        let single = due.min_by_key(|single| single.word.is_none())?;
        let overtaken = match single.asked {
            Some(asked) if !is_late(&asked) => Overtaken::SentAgain,
            _ => Overtaken::No,
        };
        self.order = self.order.wrapping_add(1);
        single.asked = Some(Asked { at: now, order: self.order, before, overtaken });
        let address = single.address;
        let body = match single.word {
            Some(word) => Body::Write { address, word },
            None => Body::Read { address },
        };
        Some((single.sequence, body))
    }

    /// Whether this answer belongs to one of these requests, which it completes. The others that were
    /// sent before it are overtaken.
    pub fn answer(&mut self, answer: &Answer) -> bool {
        let own = |place: &&mut Option<Single>| {
            place.is_some_and(|single| {
                let same = match single.word {
                    Some(_) => answer.is_write_of(single.address),
                    None => answer.is_read_of(single.address),
                };
                single.asked.is_some() && same && single.sequence == answer.sequence
            })
        };
        let place = self.places.iter_mut().find(own).and_then(Option::take);
        let Some(Asked { order, .. }) = place.and_then(|single| single.asked) else {
            return false;
        };
        self.overtake(|asked| is_at_or_behind(order, asked.order));
        true
    }

    /// A write with this sequence number was answered: it overtakes the requests that were sent before
    /// it.
    pub fn answer_of_write(&mut self, sequence: u8) {
        self.overtake(|asked| is_at_or_behind(sequence, asked.before));
    }

    fn overtake(&mut self, was_before: impl Fn(&Asked) -> bool) {
        let asked = self.places.iter_mut().flatten().filter_map(|single| single.asked.as_mut());
        asked
            .filter(|asked| asked.overtaken == Overtaken::No && was_before(asked))
            .for_each(|asked| asked.overtaken = Overtaken::Yes);
    }
}

/// Whether this number is the other one, or one of the 127 behind it.
const fn is_at_or_behind(number: u8, other: u8) -> bool {
    number.wrapping_sub(other) < 0x80
}
