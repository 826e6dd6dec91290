//! Executes the codes of inputs and outputs: M62 to M68.

use crate::canon::{Canon, Input, Until};
use crate::codes::{Code, Group};
use crate::error::{ErrorKind, Fault};
use crate::motion::MOST_SECONDS;
use crate::outcome::Outcome;
use crate::request::Request;
use crate::state::{State, numbers};

/// Greatest number of an input or an output.
const LAST: u32 = 255;

/// The same in words, for messages.
const RANGE: &str = "0 to 255";

/// M62 to M68.
pub(crate) fn execute(
    state: &mut State,
    request: &mut Request,
    out: &mut Outcome,
) -> Result<(), Fault> {
    let Some(code) = request.code(Group::Output) else { return Ok(()) };
    let with_motion = matches!(code.tenths, 620 | 630 | 670);
    out.before.push_back(match code.tenths {
        660 => read_input(state, request, code)?,
        670 | 680 => {
            let index = number(request, b'e', code, "E, the output")?;
            let value = request.need(b'q', code, "Q, the value")?;
            Canon::AnalogOutput { index, value, with_motion }
        }
        tenths => {
            let index = number(request, b'p', code, "P, the output")?;
            Canon::DigitalOutput { index, on: matches!(tenths, 620 | 640), with_motion }
        }
    });
    Ok(())
}

/// M66. Until it is reported otherwise, the input becomes what is wanted.
fn read_input(state: &mut State, request: &mut Request, code: Code) -> Result<Canon, Fault> {
    let input = if request.has(b'e') {
        Input::Analog(number(request, b'e', code, "E, the input")?)
    } else {
        Input::Digital(number(request, b'p', code, "P or E, the input")?)
    };
    let until = match request.take_whole(b'l', 4, "0 to 4")?.unwrap_or(0) {
        0 => Until::Now,
        1 => Until::Rise,
        2 => Until::Fall,
        3 => Until::High,
        _ => Until::Low,
    };
    let mut seconds = 0.0;
    if until != Until::Now {
        if matches!(input, Input::Analog(_)) {
            return Err(request.fault(b'l', ErrorKind::AnalogWait));
        }
        seconds = request.need(b'q', code, "Q, the longest time of waiting in s")?;
        if seconds <= 0.0 || seconds > MOST_SECONDS {
            return Err(request.out_of_range(b'q', seconds, "above 0, to 10^9 s"));
        }
    }
    let is_high = matches!(until, Until::Rise | Until::High);
    state.memory.set(numbers::INPUT, f64::from(u8::from(is_high)));
    Ok(Canon::ReadInput { input, until, seconds })
}

/// The number of an input or an output.
fn number(request: &mut Request, letter: u8, code: Code, word: &'static str) -> Result<u32, Fault> {
    let missing = ErrorKind::Missing { code: code.to_string(), word };
    let number = request.take_whole(letter, LAST, RANGE)?;
    number.ok_or(Fault::new(code.column, missing))
}
