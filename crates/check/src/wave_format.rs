//! What the waveform contains, and what a file format must be able to write.
//!
//! The names of the signals may not change: signal maps and save files refer to them.

use crate::vcd_own::OwnCapture;
use std::io;

/// The signals of one axis, in order: name and bits, with 0 bits for a real.
pub(crate) const SIGNALS: [(&str, u32); 7] = [
    ("step", 1),
    ("dir", 1),
    ("position", 32),
    ("v", 64),
    ("profile_position", 0),
    ("profile_speed", 0),
    ("error_ns", 0),
];

/// The scope that contains a scope for each axis.
pub(crate) const SCOPE: &str = "carrystep";

/// The name of the PWM's pin.
pub(crate) const PWM: &str = "pwm";

/// The program that wrote the file, with its version.
pub(crate) const VERSION: &str = concat!("carrystep ", env!("CARGO_PKG_VERSION"));

/// Millionths in 1.
pub(crate) const MILLION: f64 = 1e6;

/// A file format of waveforms, with times in ps.
pub(crate) trait Format {
    /// The identifier of a signal.
    type Id: Copy;
    /// The name of the format in error messages.
    const NAME: &'static str;

    /// Declares the signals of each axis, in scopes with the names of the axes.
    ///
    /// # Errors
    /// The error of the system if the file cannot be written.
    fn declare(
        &mut self,
        own: &OwnCapture,
        axes: &[&str],
    ) -> io::Result<Vec<[Self::Id; SIGNALS.len()]>>;

    /// Writes the first values of all signals, which they have at `ps`.
    ///
    /// # Errors
    /// The error of the system if the file cannot be written.
    fn initial(
        &mut self,
        ps: u64,
        values: impl FnOnce(&mut Self) -> io::Result<()>,
    ) -> io::Result<()>;

    /// Sets the time of the changes that follow, ps. It must be later than the previous time.
    ///
    /// # Errors
    /// The error of the system if the file cannot be written.
    fn time(&mut self, ps: u64) -> io::Result<()>;

    /// Writes the level of a pin.
    ///
    /// # Errors
    /// The error of the system if the file cannot be written.
    fn bit(&mut self, id: Self::Id, level: bool) -> io::Result<()>;

    /// Writes a number of `bits` bits in two's complement.
    ///
    /// # Errors
    /// The error of the system if the file cannot be written.
    fn vector(&mut self, id: Self::Id, value: u64, bits: u32) -> io::Result<()>;

    /// Writes a real number in millionths: finite, whole and not minus zero.
    ///
    /// # Errors
    /// The error of the system if the file cannot be written.
    fn real(&mut self, id: Self::Id, millionths: f64) -> io::Result<()>;

    /// Completes the file.
    ///
    /// # Errors
    /// The error of the system if the file cannot be written.
    fn end(&mut self) -> io::Result<()>;
}
