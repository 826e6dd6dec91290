//! Simulations whose output is known from an earlier run.
//!
//! A simulation may print a line for every clock, so the output itself is not kept but its SHA-256.
//! The caller knows which output is expected. If the kept hash is that of the expected output, the
//! simulation would print just this again. In every other case it is run.

use super::record::Record;
use super::{ASKED, KEPT, answers, identity, is_fresh, record};
use crate::programs::Tool;
use sha2::{Digest as _, Sha256};
use std::hash::{Hash, Hasher};
use std::path::Path;
use std::sync::atomic::Ordering;

/// The first difference between a simulation's output and the `expected` one; `None` if they are
/// equal.
///
/// `question` is everything on which the output depends, apart from the simulator itself. `run`
/// runs the simulation, and compares its output with all of `expected`.
///
/// # Errors
/// Those of `run`.
pub fn difference<E>(
    tool: &Tool,
    question: impl Hash,
    expected: impl Hash,
    run: impl FnOnce() -> Result<Option<String>, E>,
) -> Result<Option<String>, E> {
    difference_in(answers().as_deref(), is_fresh(), tool, question, expected, run)
}

/// As [`difference`], with the folder of answers; without one nothing is kept.
pub(super) fn difference_in<E>(
    answers: Option<&Path>,
    is_fresh: bool,
    tool: &Tool,
    question: impl Hash,
    expected: impl Hash,
    run: impl FnOnce() -> Result<Option<String>, E>,
) -> Result<Option<String>, E> {
    let place = answers.and_then(|answers| {
        let question = hash(("the output of a simulation", identity::of(tool)?, question));
        Some(answers.join(question))
    });
    let expected = hash(expected).into_bytes();
    let kept = place.as_deref().filter(|_| !is_fresh).and_then(Record::read);
    if kept.is_some_and(|kept| kept.stdout == expected) {
        KEPT.fetch_add(1, Ordering::Relaxed);
        return Ok(None);
    }
    let found = run()?;
    ASKED.fetch_add(1, Ordering::Relaxed);
    if let (Some(place), None) = (place, &found) {
        // What cannot be kept is simulated again.
        let _ = Record { stdout: expected, stderr: vec![], files: [].into() }.write(&place);
    }
    Ok(found)
}

/// The SHA-256 of a value, in hexadecimal digits.
fn hash(value: impl Hash) -> String {
    let mut bytes = Bytes(Sha256::new());
    value.hash(&mut bytes);
    record::hex(&bytes.0.finalize())
}

/// Takes the bytes that a value gives to be hashed.
struct Bytes(Sha256);

impl Hasher for Bytes {
    fn write(&mut self, bytes: &[u8]) {
        self.0.update(bytes);
    }

    /// A part of the SHA-256. Only [`hash`] uses this type, and takes all of it.
    fn finish(&self) -> u64 {
        self.0.clone().finalize().iter().take(8).fold(0, |all, byte| all << 8 | u64::from(*byte))
    }
}
