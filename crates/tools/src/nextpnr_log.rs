//! Reads the log of nextpnr: the resources that a design uses, and its greatest clock.

use crate::SynthesisError;
use crate::cells::pattern;
use crate::programs::Tool;
use std::collections::HashMap;

/// A log, and the tool that wrote it.
pub(crate) struct NextpnrLog<'a> {
    pub tool: &'a Tool,
    pub text: &'a str,
}

impl NextpnrLog<'_> {
    /// The number behind a name in the report on packing.
    pub fn used(&self, name: &str) -> Result<u32, SynthesisError> {
        let line = self.text.lines().find(|line| line.contains(name) && line.contains('%'));
        let number =
            line.and_then(|line| line.split(name).nth(1)?.split('/').next()?.trim().parse().ok());
        number.ok_or_else(|| self.unread(name))
    }

    /// The greatest clock of the routed design, MHz: the last figure of each clock counts, and the
    /// slowest clock is the design's.
    pub fn greatest_clock(&self) -> Result<f64, SynthesisError> {
        let clock = pattern(r"Max frequency for clock +'(\S+)': ([0-9.]+) MHz");
        let last: HashMap<&str, f64> = clock
            .captures_iter(self.text)
            .filter_map(|found| Some((found.get(1)?.as_str(), found[2].parse().ok()?)))
            .collect();
        last.into_values()
            .min_by(f64::total_cmp)
            .ok_or_else(|| self.unread("Max frequency for clock"))
    }

    fn unread(&self, what: &str) -> SynthesisError {
        SynthesisError::Unread { tool: self.tool.name, what: what.to_owned() }
    }
}
