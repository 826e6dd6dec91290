//! The registry of all inputs and of all unfinished outputs of this process.

use crate::place::Identity;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

static REGISTRY: Mutex<Registry> =
    Mutex::new(Registry { inputs: Vec::new(), outputs: Vec::new(), next: 0 });

struct Registry {
    inputs: Vec<Input>,
    outputs: Vec<Output>,
    next: u64,
}

/// A file that was read. Its identity is looked up at each comparison, because the inode number of
/// a removed file may be given to another file.
struct Input {
    shown: PathBuf,
    absolute: PathBuf,
}

/// A file that is being written.
struct Output {
    number: u64,
    shown: PathBuf,
    identity: Identity,
}

/// The file with which an output collides.
pub(crate) enum Collision {
    /// A file that was read.
    Input(PathBuf),
    /// Another output.
    Output(PathBuf),
}

fn registry() -> MutexGuard<'static, Registry> {
    REGISTRY.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Registers an input. The error is the path of an unfinished output that is the same file.
pub(crate) fn add_input(path: &Path) -> Result<(), PathBuf> {
    // A file that has just been opened has an identity. If it has lost it meanwhile, it cannot be
    // replaced.
    let (Ok(identity), Ok(absolute)) = (Identity::of(path), std::path::absolute(path)) else {
        return Ok(());
    };
    let mut registry = registry();
    if let Some(output) = registry.outputs.iter().find(|output| output.identity == identity) {
        return Err(output.shown.clone());
    }
    if registry.inputs.iter().all(|input| input.absolute != absolute) {
        registry.inputs.push(Input { shown: path.to_owned(), absolute });
    }
    Ok(())
}

/// Registers an output, and returns its number.
pub(crate) fn add_output(shown: &Path, identity: Identity) -> Result<u64, Collision> {
    let mut registry = registry();
    let same = |input: &&Input| Identity::of(&input.absolute).is_ok_and(|read| read == identity);
    if let Some(input) = registry.inputs.iter().find(same) {
        return Err(Collision::Input(input.shown.clone()));
    }
    if let Some(output) = registry.outputs.iter().find(|output| output.identity == identity) {
        return Err(Collision::Output(output.shown.clone()));
    }
    registry.next += 1;
    let number = registry.next;
    registry.outputs.push(Output { number, shown: shown.to_owned(), identity });
    Ok(number)
}

/// Notes that the output of this number is another file now, of the same name.
pub(crate) fn move_output(number: u64, identity: Identity) {
    if let Some(output) = registry().outputs.iter_mut().find(|output| output.number == number) {
        output.identity = identity;
    }
}

/// Removes the output of this number, because it is finished or abandoned.
pub(crate) fn drop_output(number: u64) {
    registry().outputs.retain(|output| output.number != number);
}
