//! Finds the signal of a capture for each pin.
//!
//! The names of carrystep's own signals are those that `waves.rs` writes.

use crate::edge::Pin;
use crate::error::ReadError;
use crate::wave_format::PWM;
use carrystep_core::AXES;
use carrystep_core::engine::MAX_AXES;
use vcd::{IdCode, ReferenceIndex};

/// The signals of a foreign capture: `x.step=top.la.D0`, `y.dir=bench.pins[3]`, `output_2=la.D7`,
/// `pwm=la.D6`.
///
/// A pin that the map does not contain is searched under the names of carrystep: `<axis>.step` and
/// `<axis>.dir` in any scope, or the vectors `step` and `dir`, whose bit i is axis i; `output_<n>`,
/// or a vector `outputs` of eight bits; `pwm`.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct SignalMap {
    entries: Vec<Entry>,
    /// The outputs with the paths of their signals.
    outputs: Vec<(u8, String)>,
    /// The path of the PWM's signal.
    pwm: Option<String>,
}

/// The name of an output without its number.
const OUTPUT: &str = "output_";
/// A vector of all outputs, and its width: the port of the engine.
const OUTPUTS: (&str, u32) = ("outputs", 8);

#[derive(Debug, Clone, PartialEq, Eq)]
struct Entry {
    axis: String,
    pin: Pin,
    path: String,
}

impl SignalMap {
    /// Reads a map from lines `<axis>.<step|dir>=<path of the signal>`.
    ///
    /// # Errors
    /// [`ReadError::Map`] names the line and what is wrong with it.
    pub fn parse<S: AsRef<str>>(lines: impl IntoIterator<Item = S>) -> Result<Self, ReadError> {
        let mut map = Self::default();
        for line in lines {
            let line = line.as_ref();
            let wrong = |message: &str| ReadError::Map {
                entry: line.to_owned(),
                message: message.to_owned(),
            };
            let form = || {
                wrong(
                    "write <axis>.step=<signal>, <axis>.dir=<signal>, output_<number>=<signal> or \
                     pwm=<signal>",
                )
            };
            let (left, path) = line.split_once('=').ok_or_else(form)?;
            if left.trim() == PWM && !path.trim().is_empty() {
                if map.pwm.replace(path.trim().to_owned()).is_some() {
                    return Err(wrong("the PWM is already mapped"));
                }
                continue;
            }
            let number = left.trim().strip_prefix(OUTPUT).and_then(|number| number.parse().ok());
            if let Some(number) = number.filter(|_| !path.trim().is_empty()) {
                if map.outputs.iter().any(|(known, _)| *known == number) {
                    return Err(wrong("this output is already mapped"));
                }
                map.outputs.push((number, path.trim().to_owned()));
                continue;
            }
            let (axis, pin) = left.trim().rsplit_once('.').ok_or_else(form)?;
            let pin = match pin {
                "step" => Pin::Step,
                "dir" => Pin::Dir,
                _ => return Err(form()),
            };
            if axis.is_empty() || path.trim().is_empty() {
                return Err(form());
            }
            if map.path(axis, pin).is_some() {
                return Err(wrong("this pin is already mapped"));
            }
            map.entries.push(Entry { axis: axis.to_owned(), pin, path: path.trim().to_owned() });
        }
        Ok(map)
    }

    fn path(&self, axis: &str, pin: Pin) -> Option<&str> {
        self.entries.iter().find(|e| e.axis == axis && e.pin == pin).map(|e| e.path.as_str())
    }
}

/// A signal as the header of a VCD declares it.
#[derive(Debug, Clone)]
pub(crate) struct Signal {
    /// Scopes and name, joined by dots, without a range.
    pub(crate) path: String,
    pub(crate) code: IdCode,
    pub(crate) bits: u32,
    /// Index of the most and of the least significant bit.
    pub(crate) range: (i64, i64),
}

impl Signal {
    pub(crate) fn new(
        scopes: &[String],
        name: &str,
        index: Option<ReferenceIndex>,
        code: IdCode,
        bits: u32,
    ) -> Self {
        // Some simulators append the range to the name without a space.
        let glued = name.find('[').filter(|&at| at > 0 && !name.starts_with('\\'));
        let (name, tail) = name.split_at(glued.unwrap_or(name.len()));
        let mut path = scopes.join(".");
        if !path.is_empty() {
            path.push('.');
        }
        path.push_str(name);
        let range = match index.or_else(|| tail.parse().ok()) {
            Some(ReferenceIndex::Range(high, low)) => (i64::from(high), i64::from(low)),
            Some(ReferenceIndex::BitSelect(bit)) => {
                // A single bit of a vector keeps its index in its name.
                path.push_str(&format!("[{bit}]"));
                (0, 0)
            }
            None => (i64::from(bits) - 1, 0),
        };
        Self { path, code, bits, range }
    }

    /// The place of the bit with this index, counted from the least significant.
    fn place(&self, index: i64) -> Option<u32> {
        let (high, low) = self.range;
        let place = if high >= low { index - low } else { low - index };
        u32::try_from(place).ok().filter(|&place| place < self.bits)
    }

    fn depth(&self) -> usize {
        self.path.matches('.').count()
    }

    /// Whether the path is `tail`, or ends with `tail` after a scope.
    fn ends_with(&self, tail: &str) -> bool {
        self.path
            .strip_suffix(tail)
            .is_some_and(|scopes| scopes.is_empty() || scopes.ends_with('.'))
    }
}

/// The signal and the bit that hold the level of a pin.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Source {
    pub(crate) code: IdCode,
    /// The bit, counted from the least significant.
    pub(crate) place: u32,
}

/// The number of names that an error suggests.
const CANDIDATES: usize = 8;

fn missing(signals: &[Signal], wanted: String) -> ReadError {
    let found = signals.iter().take(CANDIDATES).map(|s| s.path.clone());
    let more = signals.len().saturating_sub(CANDIDATES);
    let more = (more > 0).then(|| format!("{more} more"));
    ReadError::NoSignal { wanted, found: found.chain(more).collect() }
}

/// The signal nearest to the top among those that match. It is an error if several are equally
/// near.
fn topmost<'a>(
    fit: impl Iterator<Item = &'a Signal>,
    wanted: &str,
) -> Result<Option<&'a Signal>, ReadError> {
    let fit: Vec<&Signal> = fit.collect();
    let Some(top) = fit.iter().map(|s| s.depth()).min() else { return Ok(None) };
    let mut nearest = fit.into_iter().filter(|s| s.depth() == top);
    let first = nearest.next();
    let others: Vec<&Signal> = nearest.filter(|s| Some(s.code) != first.map(|f| f.code)).collect();
    if others.is_empty() {
        return Ok(first);
    }
    let found = first.into_iter().chain(others).take(CANDIDATES).map(|s| s.path.clone()).collect();
    Err(ReadError::Ambiguous { wanted: wanted.to_owned(), found })
}

impl SignalMap {
    /// The sources of STEP and DIR of all axes.
    pub(crate) fn resolve(
        &self,
        signals: &[Signal],
        axes: &[&str],
    ) -> Result<Vec<[Source; 2]>, ReadError> {
        if let Some(stray) = self.entries.iter().find(|e| !axes.contains(&e.axis.as_str())) {
            return Err(ReadError::Map {
                entry: format!("{}.{}={}", stray.axis, stray.pin, stray.path),
                message: format!(
                    "there is no axis '{}'; the axes are {}",
                    stray.axis,
                    axes.join(", ")
                ),
            });
        }
        let pin = |index: usize, axis: &str, pin: Pin| match self.path(axis, pin) {
            Some(path) => explicit(signals, path, &format!("{axis}.{pin}")),
            None => by_name(signals, (index, axes.len()), axis, pin),
        };
        let pair = |(index, axis): (usize, &&str)| {
            Ok([pin(index, axis, Pin::Step)?, pin(index, axis, Pin::Dir)?])
        };
        axes.iter().enumerate().map(pair).collect()
    }

    /// The sources of those outputs of this mask that the capture shows.
    pub(crate) fn resolve_outputs(
        &self,
        signals: &[Signal],
        mask: u8,
    ) -> Result<Vec<(u8, Source)>, ReadError> {
        let exists = |number: u8| number < 8 && mask >> number & 1 == 1;
        if let Some((number, path)) = self.outputs.iter().find(|(number, _)| !exists(*number)) {
            return Err(ReadError::Map {
                entry: format!("{OUTPUT}{number}={path}"),
                message: "outputs are compared with programs on machines that have them".into(),
            });
        }
        let mut found = Vec::new();
        for number in (0..8).filter(|number| exists(*number)) {
            let name = format!("{OUTPUT}{number}");
            let mapped = self.outputs.iter().find(|(known, _)| *known == number);
            let source = match mapped {
                Some((_, path)) => Some(explicit(signals, path, &name)?),
                None => output_by_name(signals, number, &name)?,
            };
            found.extend(source.map(|source| (number, source)));
        }
        Ok(found)
    }
}

impl SignalMap {
    /// The source of the PWM's pin, if the capture shows it.
    pub(crate) fn resolve_pwm(
        &self,
        signals: &[Signal],
        exists: bool,
    ) -> Result<Option<Source>, ReadError> {
        if let Some(path) = &self.pwm {
            if !exists {
                return Err(ReadError::Map {
                    entry: format!("{PWM}={path}"),
                    message: "the PWM is compared with programs on machines that have one".into(),
                });
            }
            return explicit(signals, path, PWM).map(Some);
        }
        let wires = signals.iter().filter(|s| s.bits == 1 && s.ends_with(PWM) && exists);
        Ok(topmost(wires, PWM)?.map(|signal| Source { code: signal.code, place: 0 }))
    }
}

/// Finds an output by the names of carrystep; `None` if the capture does not show it.
fn output_by_name(signals: &[Signal], number: u8, name: &str) -> Result<Option<Source>, ReadError> {
    let wires = signals.iter().filter(|s| s.bits == 1 && s.ends_with(name));
    if let Some(signal) = topmost(wires, name)? {
        return Ok(Some(Source { code: signal.code, place: 0 }));
    }
    let (vector, bits) = OUTPUTS;
    let vectors = signals.iter().filter(|s| s.bits == bits && s.ends_with(vector));
    let place = |signal: &Signal| Some((signal.code, signal.place(number.into())?));
    let source = topmost(vectors, vector)?.and_then(place);
    Ok(source.map(|(code, place)| Source { code, place }))
}

fn explicit(signals: &[Signal], path: &str, pin: &str) -> Result<Source, ReadError> {
    let wanted = || format!("{path} for {pin}");
    if let Some(signal) = signals.iter().find(|s| s.path == path) {
        if signal.bits == 1 {
            return Ok(Source { code: signal.code, place: 0 });
        }
        let message = format!(
            "the signal has {} bits: name one, as in {path}[{}]",
            signal.bits, signal.range.1
        );
        return Err(ReadError::Map { entry: format!("{pin}={path}"), message });
    }
    let bit = path.strip_suffix(']').and_then(|s| s.rsplit_once('['));
    let bit = bit.and_then(|(base, index)| Some((base, index.parse::<i64>().ok()?)));
    let source = bit.and_then(|(base, index)| {
        let signal = signals.iter().find(|s| s.path == base)?;
        Some(Source { code: signal.code, place: signal.place(index)? })
    });
    source.ok_or_else(|| missing(signals, wanted()))
}

/// Finds a pin of axis `index` by the names of carrystep. `axes` is the number of axes of the
/// machine.
fn by_name(
    signals: &[Signal],
    (index, axes): (usize, usize),
    axis: &str,
    pin: Pin,
) -> Result<Source, ReadError> {
    let own = format!("{axis}.{pin}");
    let width = |signal: &Signal, wanted: &str| ReadError::Width {
        signal: signal.path.clone(),
        bits: signal.bits,
        wanted: wanted.to_owned(),
    };
    let wires = signals.iter().filter(|s| s.bits == 1 && s.ends_with(&own));
    if let Some(signal) = topmost(wires, &own)? {
        return Ok(Source { code: signal.code, place: 0 });
    }
    if let Some(wide) = signals.iter().find(|s| s.bits != 1 && s.ends_with(&own)) {
        return Err(width(wide, "a pin has 1"));
    }
    let name = pin.to_string();
    let bit = index as i64;
    let vectors =
        signals.iter().filter(|s| s.bits > 1 && s.ends_with(&name) && s.place(bit).is_some());
    if let Some(signal) = topmost(vectors, &format!("{name}[{index}]"))? {
        // The vectors of the gateware may be wider than the machine.
        if ![axes, AXES, MAX_AXES].contains(&(signal.bits as usize)) {
            return Err(width(signal, &format!("the machine has {axes} axes")));
        }
        return Ok(Source { code: signal.code, place: signal.place(bit).unwrap_or(0) });
    }
    Err(missing(signals, format!("{own} (nor a vector {name} with a bit {index})")))
}
