//! Reads the log of nextpnr: the resources that a design uses, and its greatest clock.

use crate::SynthesisError;
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
        let last: HashMap<&str, f64> = self.text.lines().filter_map(clock).collect();
        last.into_values()
            .min_by(f64::total_cmp)
            .ok_or_else(|| self.unread("Max frequency for clock"))
    }

    fn unread(&self, what: &str) -> SynthesisError {
        SynthesisError::Unread { tool: self.tool.name, what: what.to_owned() }
    }
}

/// The name and the MHz of a clock, in the line `Max frequency for clock 'NAME': 72.34 MHz`. A
/// regular expression here would be the only one in the command, and add 0.7 MB to it.
fn clock(line: &str) -> Option<(&str, f64)> {
    let (_, clock) = line.split_once("Max frequency for clock ")?;
    let (name, figure) = clock.trim_start().strip_prefix('\'')?.split_once("': ")?;
    let (figure, _) = figure.split_once(" MHz")?;
    Some((name, figure.trim_start().parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::NextpnrLog;
    use crate::tool::NEXTPNR;

    #[test]
    fn slowest_clock_of_the_routed_design_counts() {
        let text = "\
Info: Max frequency for clock 'clk$SB_IO_IN_$glb_clk': 10.00 MHz (FAIL at 48.00 MHz)
Info: Routing..
Info: Max frequency for clock 'clk$SB_IO_IN_$glb_clk': 72.34 MHz (PASS at 48.00 MHz)
Info: Max frequency for clock                  'spi':  61.50 MHz (PASS at 12.00 MHz)
Info: Max delay <async> -> <async>: 8.21 ns
";
        assert_eq!(NextpnrLog { tool: &NEXTPNR, text }.greatest_clock().ok(), Some(61.5));
        assert!(NextpnrLog { tool: &NEXTPNR, text: "Info: Routing.." }.greatest_clock().is_err());
    }
}
