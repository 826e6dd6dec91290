//! A property in which two reports differ, so that they are not of one sweep.

/// A property in which two reports differ.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference {
    /// The property.
    pub what: &'static str,
    /// Its value in the first report.
    pub one: String,
    /// Its value in the other report.
    pub other: String,
}
