//! The self-test gateware of a board: which lines it reports and which pins they are about
//! (docs/self-test.md). Model and Rust-HDL module are both made from a [`SelfTest`].
//!
//! Rows are numbered in this order, and bit i of every mask of pins is the pin of row i:
//!
//! ```text
//! 0              the heading
//! 1 ..           outputs, one of which is active at a time
//! then           inputs, whose changes are reported
//! then           what does not change: drivers' enable, LED, the UART's own pins
//! ```

use crate::link::Uart;
use alloc::string::String;
use alloc::vec;
use alloc::vec::Vec;
use thiserror::Error;

/// Most rows, the heading included: the width of the masks of pins.
pub const MAX_ROWS: usize = 64;

/// Bytes of a row in the memory of the texts, which is also the length of the longest row, with its
/// end of line.
pub const ROW_BYTES: usize = 64;

/// The byte of a row for which the gateware sends the level of the row's pin, `0` or `1`.
pub const LEVEL: u8 = 1;

/// The bit that marks the last byte of a row.
pub const LAST: u8 = 0x80;

/// Most clocks of half a period.
pub const MAX_HALF_CLOCKS: u32 = 1 << 30;

/// What stands at the end of each row.
const END_OF_LINE: &str = "\r\n";

/// The self-test of a board. All values have been checked ([`SelfTest::new`]).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SelfTest {
    uart: Uart,
    half_clocks: u32,
    outputs: usize,
    inputs: usize,
    rows: Vec<String>,
}

/// Why there is no such self-test.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum SelfTestError {
    /// Half a period is 0, or longer than its counter.
    #[error("half a period of {0} clocks: from 1 to {MAX_HALF_CLOCKS} can be counted")]
    HalfPeriod(u64),
    /// There are more pins than rows.
    #[error("{0} pins: a self-test reports at most {most}", most = MAX_ROWS - 1)]
    Pins(usize),
    /// A row does not fit in its place in the memory.
    #[error(
        "the line '{text}' has {bytes} bytes: a self-test sends at most {most} in a line",
        bytes = .text.len(),
        most = ROW_BYTES - END_OF_LINE.len()
    )]
    Long {
        /// The row without its end of line.
        text: String,
    },
    /// A row contains a byte that is not printable ASCII.
    #[error("the line '{text}' is not plain ASCII, which is all that a self-test sends")]
    NotAscii {
        /// The row without its end of line.
        text: String,
    },
}

/// The rows of a self-test by their kind, without their ends of line. A character [`LEVEL`] stands
/// where the level of the row's pin is sent.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Rows {
    /// The heading.
    pub heading: String,
    /// Outputs, one of which is active at a time.
    pub outputs: Vec<String>,
    /// Inputs.
    pub inputs: Vec<String>,
    /// Pins whose level is not reported.
    pub fixed: Vec<String>,
}

impl SelfTest {
    /// A self-test with half a period of this many clocks.
    ///
    /// # Errors
    /// [`SelfTestError`] names what is out of range.
    pub fn new(uart: Uart, half_clocks: u64, rows: Rows) -> Result<Self, SelfTestError> {
        let Rows { heading, outputs, inputs, fixed } = rows;
        let half_clocks = checked(half_clocks)?;
        let (walked, watched) = (outputs.len(), inputs.len());
        let rows: Vec<String> =
            [heading].into_iter().chain(outputs).chain(inputs).chain(fixed).collect();
        if rows.len() > MAX_ROWS {
            return Err(SelfTestError::Pins(rows.len() - 1));
        }
        for text in &rows {
            let sent = |byte: u8| byte == LEVEL || (b' '..=b'~').contains(&byte);
            if !text.bytes().all(sent) {
                return Err(SelfTestError::NotAscii { text: text.clone() });
            }
            if text.len() + END_OF_LINE.len() > ROW_BYTES {
                return Err(SelfTestError::Long { text: text.clone() });
            }
        }
        Ok(Self { uart, half_clocks, outputs: walked, inputs: watched, rows })
    }

    /// The same self-test with another UART and another half of a period, in clocks.
    ///
    /// # Errors
    /// [`SelfTestError::HalfPeriod`] if the half is out of range.
    pub fn with_times(&self, uart: Uart, half_clocks: u64) -> Result<Self, SelfTestError> {
        Ok(Self { uart, half_clocks: checked(half_clocks)?, ..self.clone() })
    }

    /// The UART.
    pub const fn uart(&self) -> Uart {
        self.uart
    }

    /// Clocks of half a period, from 1 to [`MAX_HALF_CLOCKS`].
    pub const fn half_clocks(&self) -> u32 {
        self.half_clocks
    }

    /// The number of the last row.
    pub const fn last_row(&self) -> usize {
        self.rows.len() - 1
    }

    /// The row of the last output; 0 if there are no outputs.
    pub const fn last_output(&self) -> usize {
        self.outputs
    }

    /// The first row of an input.
    pub const fn first_input(&self) -> usize {
        self.outputs + 1
    }

    /// The row of the last input; one less than the first if there are no inputs.
    pub const fn last_input(&self) -> usize {
        self.outputs + self.inputs
    }

    /// The mask of the inputs: bit i is 1 if row i is that of an input.
    pub fn inputs(&self) -> u64 {
        (self.first_input()..=self.last_input()).fold(0, |mask, row| mask | 1 << row)
    }

    /// A row as it is sent if its pin has this level, with its end of line.
    ///
    /// # Panics
    /// Panics if there is no such row.
    pub fn line(&self, row: usize, level: bool) -> String {
        let digit = if level { '1' } else { '0' };
        self.rows[row].replace(char::from(LEVEL), digit.encode_utf8(&mut [0; 4])) + END_OF_LINE
    }

    /// The memory of the texts: [`ROW_BYTES`] bytes for each row. Bytes behind the [`LAST`] one of
    /// a row are 0.
    pub fn image(&self) -> Vec<u8> {
        let mut image = vec![0; self.rows.len() * ROW_BYTES];
        for (row, text) in self.rows.iter().enumerate() {
            let bytes = text.bytes().chain(END_OF_LINE.bytes());
            let length = text.len() + END_OF_LINE.len();
            for (place, byte) in bytes.enumerate() {
                let last = if place + 1 == length { LAST } else { 0 };
                image[row * ROW_BYTES + place] = byte | last;
            }
        }
        image
    }
}

/// Half a period whose range has been checked.
fn checked(half_clocks: u64) -> Result<u32, SelfTestError> {
    let half = u32::try_from(half_clocks).ok();
    let half = half.filter(|clocks| (1..=MAX_HALF_CLOCKS).contains(clocks));
    half.ok_or(SelfTestError::HalfPeriod(half_clocks))
}

/// Input values of the self-test in one clock cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SelfTestInputs {
    /// The line from the host, high when idle.
    pub rx: bool,
    /// The levels of the inputs, each at the bit of its row. Bits of other rows must be 0.
    pub pins: u64,
}

/// Output values of the self-test in one clock cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SelfTestOutputs {
    /// The line to the host, high when idle.
    pub tx: bool,
    /// Whether the LED is lit.
    pub lit: bool,
    /// The row of the output that is active, as a mask with one bit; bit 0: none is.
    pub active: u64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::borrow::ToOwned as _;
    use alloc::format;
    use alloc::string::ToString as _;

    fn rows(outputs: usize, inputs: usize) -> Rows {
        let text = |row: usize| format!("pin {row} = \u{1}");
        Rows {
            heading: "board".to_owned(),
            outputs: (0..outputs).map(text).collect(),
            inputs: (0..inputs).map(text).collect(),
            fixed: vec!["enable_n = 1".to_owned()],
        }
    }

    fn made(rows: Rows) -> Result<SelfTest, SelfTestError> {
        SelfTest::new(Uart::new(48_000_000, 115_200).unwrap(), 24_000_000, rows)
    }

    #[test]
    fn rows_are_numbered_and_every_text_ends_with_its_mark() {
        let test = made(rows(2, 3)).unwrap();
        assert_eq!((test.last_output(), test.first_input(), test.last_input()), (2, 3, 5));
        assert_eq!((test.last_row(), test.inputs()), (6, 0b11_1000));
        assert_eq!(test.line(4, true), "pin 1 = 1\r\n");
        let image = test.image();
        assert_eq!(image.len(), 7 * ROW_BYTES);
        for row in image.chunks(ROW_BYTES) {
            let end = row.iter().position(|byte| byte & LAST != 0).unwrap();
            assert_eq!(row[end], b'\n' | LAST);
            assert!(row[end + 1..].iter().all(|byte| *byte == 0));
        }
        assert_eq!(image[4 * ROW_BYTES + 8], LEVEL);
        assert_eq!(made(rows(0, 0)).unwrap().inputs(), 0);
    }

    #[test]
    fn what_does_not_fit_is_refused_with_its_text() {
        made(rows(40, 22)).unwrap();
        assert_eq!(made(rows(40, 23)), Err(SelfTestError::Pins(64)));
        let heading = |heading: String| made(Rows { heading, ..rows(1, 1) });
        heading("x".repeat(62)).unwrap();
        let long = heading("x".repeat(63)).unwrap_err().to_string();
        assert!(long.ends_with("has 63 bytes: a self-test sends at most 62 in a line"), "{long}");
        assert!(matches!(heading("Tür".into()), Err(SelfTestError::NotAscii { .. })));
        assert!(matches!(heading("a\nb".into()), Err(SelfTestError::NotAscii { .. })));
        let uart = Uart::new(48_000_000, 115_200).unwrap();
        for clocks in [0, u64::from(MAX_HALF_CLOCKS) + 1, u64::MAX] {
            let refused = SelfTest::new(uart, clocks, rows(1, 1));
            assert_eq!(refused, Err(SelfTestError::HalfPeriod(clocks)));
        }
    }
}
