//! `regex-lite` under the name of `regex`, for crates of others that ask for `regex`.
//!
//! Both crates have the same authors and, for what is used here, the same interface. Rust-HDL asks for
//! `regex` and searches a few short names with it. `regex` takes 14 s of a processor to compile, a twentieth of a clean build
//! of the command, and `regex-lite` takes 2 s. It knows no classes of Unicode and is slower on long
//! texts; `docs/decisions/0118-rust-hdl-gets-small-regular-expressions.md` says what was measured.

pub use regex_lite::{Captures, Error, Match, Regex, Replacer};

/// Compiles a pattern within a limit of size. This type exists because `jsonschema` also limits the size
/// of an automaton, which `regex_lite::RegexBuilder` does not have.
pub struct RegexBuilder(regex_lite::RegexBuilder);

impl RegexBuilder {
    /// A builder for this pattern.
    pub fn new(pattern: &str) -> Self {
        Self(regex_lite::RegexBuilder::new(pattern))
    }

    /// Limits the size of the compiled expression, bytes.
    pub fn size_limit(&mut self, limit: usize) -> &mut Self {
        self.0.size_limit(limit);
        self
    }

    /// Changes nothing: there is no automaton.
    pub fn dfa_size_limit(&mut self, _: usize) -> &mut Self {
        self
    }

    /// Compiles the pattern.
    ///
    /// # Errors
    /// It is no pattern, or greater than its limit.
    pub fn build(&self) -> Result<Regex, Error> {
        self.0.build()
    }
}
