//! What an ordinary run of the tests leaves to the long runs *repeats*, *cases* and *proofs* (`cargo
//! xtask long`): repetition. An ordinary run has a fixed seed, so it draws the same random cases each
//! time.
//!
//! Tests of other crates include this file, too.

use std::ops::Div;

/// True in a run that runs in full what ordinary runs shorten.
pub fn in_full() -> bool {
    std::env::var_os("CARRYSTEP_REPEATS").is_some()
}

/// All of this work in such a run, and otherwise one of this many parts of it.
pub fn part<Work: Div<Output = Work>>(whole: Work, parts: Work) -> Work {
    if in_full() { whole } else { whole / parts }
}
