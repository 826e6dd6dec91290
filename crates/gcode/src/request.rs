//! A line with its values computed: one code of each modal group, and one value of each letter.

use crate::codes::{Code, GROUPS, Group};
use crate::error::{ErrorKind, Fault};
use crate::evaluate::{Values, evaluate, whole};
use crate::syntax::Block;

/// A value of a letter.
#[derive(Debug, Clone, Copy)]
struct Given {
    value: f64,
    column: u32,
    is_used: bool,
}

/// What a line asks for.
#[derive(Debug)]
pub(crate) struct Request {
    /// Column of the first word.
    pub(crate) column: u32,
    codes: [Option<Code>; GROUPS],
    letters: [Option<Given>; LETTERS],
}

impl Request {
    /// Computes the words of a block.
    ///
    /// # Errors
    /// Values that are not defined, letters and codes that are unknown, occur twice or exclude each
    /// other.
    pub(crate) fn new(block: &Block, values: &impl Values) -> Result<Self, Fault> {
        let column = block.words.first().map_or(0, |word| word.column);
        let mut request = Self { column, codes: [None; GROUPS], letters: [None; LETTERS] };
        for word in &block.words {
            let fault = |kind| Fault::new(word.column, kind);
            let value = evaluate(&word.value, values)?;
            match word.letter {
                b'g' | b'm' => {
                    let code = Code::new(word.letter, value, word.column).map_err(fault)?;
                    request.add_code(code).map_err(fault)?;
                }
                b'a'..=b'f' | b'h'..=b'l' | b'p'..=b't' | b'x'..=b'z' | b'@' | b'^'
                    if word.letter != b'd' =>
                {
                    let given = Given { value, column: word.column, is_used: false };
                    let place = &mut request.letters[index(word.letter)];
                    if place.replace(given).is_some() {
                        return Err(fault(ErrorKind::LetterTwice(upper(word.letter))));
                    }
                }
                letter => return Err(fault(ErrorKind::UnknownLetter(upper(letter)))),
            }
        }
        Ok(request)
    }

    fn add_code(&mut self, code: Code) -> Result<(), ErrorKind> {
        let group = code.group()? as usize;
        match self.codes[group].replace(code) {
            None => Ok(()),
            Some(first) => {
                let (first, second) = (first.to_string(), code.to_string());
                Err(ErrorKind::SameGroup { first, second })
            }
        }
    }

    /// The code of a group.
    pub(crate) fn code(&self, group: Group) -> Option<Code> {
        self.codes[group as usize]
    }

    /// Whether the line has a letter whose value is not used yet.
    pub(crate) fn has(&self, letter: u8) -> bool {
        self.letters[index(letter)].is_some_and(|given| !given.is_used)
    }

    /// Uses the value of a letter.
    pub(crate) fn take(&mut self, letter: u8) -> Option<f64> {
        let given = self.letters[index(letter)].as_mut().filter(|given| !given.is_used)?;
        given.is_used = true;
        Some(given.value)
    }

    /// Uses the value of a letter that a code needs.
    pub(crate) fn need(
        &mut self,
        letter: u8,
        code: Code,
        word: &'static str,
    ) -> Result<f64, Fault> {
        let missing = ErrorKind::Missing { code: code.to_string(), word };
        self.take(letter).ok_or(Fault::new(code.column, missing))
    }

    /// Uses the value of a letter that must be whole and within 0 and `most`.
    pub(crate) fn take_whole(
        &mut self,
        letter: u8,
        most: u32,
        range: &'static str,
    ) -> Result<Option<u32>, Fault> {
        let Some(value) = self.take(letter) else { return Ok(None) };
        match whole(value) {
            None => Err(self.fault(letter, ErrorKind::NotWhole { letter: upper(letter), value })),
            Some(number) if (0.0..=f64::from(most)).contains(&number) => Ok(Some(number as u32)),
            Some(_) => Err(self.out_of_range(letter, value, range)),
        }
    }

    /// A mistake at a letter of this line, or at its first word if the letter does not occur.
    pub(crate) fn fault(&self, letter: u8, kind: ErrorKind) -> Fault {
        Fault::new(self.letters[index(letter)].map_or(self.column, |given| given.column), kind)
    }

    /// The error for a value out of its range.
    pub(crate) fn out_of_range(&self, letter: u8, value: f64, range: &'static str) -> Fault {
        self.fault(letter, ErrorKind::OutOfRange { letter: upper(letter), value, range })
    }

    /// Checks that every word was used.
    pub(crate) fn finish(&self) -> Result<(), Fault> {
        let unused = (b'a'..=b'z').chain([b'@', b'^']).find(|&letter| self.has(letter));
        match unused {
            None => Ok(()),
            Some(letter) => Err(self.fault(letter, ErrorKind::Unused(upper(letter)))),
        }
    }
}

/// The letters, `@` and `^`.
const LETTERS: usize = 28;

fn index(letter: u8) -> usize {
    match letter {
        b'@' => 26,
        b'^' => 27,
        _ => usize::from(letter.saturating_sub(b'a')).min(25),
    }
}

fn upper(letter: u8) -> char {
    char::from(letter.to_ascii_uppercase())
}
