//! Reads the names in a constraint file for ISE (UCF) or Vivado (XDC).
//!
//! Only lines as the board's templates write them are understood, so that no name is overlooked.

use super::Mismatch;
use std::collections::BTreeSet;

/// The ports that a constraint file names, bits of a bus as `step[0]`.
#[derive(Debug, Default)]
pub(super) struct Constraints {
    /// Those with a pin.
    pub placed: BTreeSet<String>,
    /// Those with the period of a clock.
    pub clocks: BTreeSet<String>,
}

/// What a line says.
enum Line<'a> {
    /// Nothing about a port.
    General,
    Placed(&'a str),
    /// The group of a port for [`Line::Period`].
    Group(&'a str, &'a str),
    Period(&'a str),
    Clock(&'a str),
}

impl Constraints {
    pub(super) fn of(text: &str) -> Result<Self, Mismatch> {
        let mut all = Self::default();
        let mut groups = Vec::new();
        for (index, line) in text.lines().enumerate() {
            let unread = || Mismatch::Line { number: index + 1, line: line.to_owned() };
            match ucf(line).or_else(|| xdc(line)).ok_or_else(unread)? {
                Line::General => {}
                Line::Placed(port) => {
                    if !all.placed.insert(bit(port)) {
                        return Err(Mismatch::Twice { port: bit(port) });
                    }
                }
                Line::Group(port, group) => groups.push((port, group)),
                Line::Period(group) => {
                    let of_group = groups.iter().filter(|(_, name)| *name == group);
                    let before = all.clocks.len();
                    all.clocks.extend(of_group.map(|(port, _)| bit(port)));
                    if all.clocks.len() == before {
                        return Err(unread());
                    }
                }
                Line::Clock(port) => {
                    all.clocks.insert(bit(port));
                }
            }
        }
        Ok(all)
    }
}

/// The name of a bit in yosys' notation, to which the build script converts the UCF.
fn bit(port: &str) -> String {
    port.replace('<', "[").replace('>', "]")
}

fn ucf(line: &str) -> Option<Line<'_>> {
    if line.is_empty() || line.starts_with('#') {
        return Some(Line::General);
    }
    let line = line.strip_suffix(';')?;
    if line.starts_with("CONFIG ") {
        return Some(Line::General);
    }
    if let Some(period) = line.strip_prefix("TIMESPEC \"TS_") {
        let (_, after) = period.split_once("\" = PERIOD \"")?;
        return Some(Line::Period(after.split_once("\" ")?.0));
    }
    let (port, what) = line.strip_prefix("NET \"")?.split_once("\" ")?;
    match what.strip_prefix("TNM_NET = \"") {
        Some(group) => Some(Line::Group(port, group.strip_suffix('"')?)),
        None if what.starts_with("LOC = \"") => Some(Line::Placed(port)),
        None => None,
    }
}

fn xdc(line: &str) -> Option<Line<'_>> {
    if line.starts_with("set_property ") && line.ends_with(" [current_design]") {
        return Some(Line::General);
    }
    let (what, port) = line.strip_suffix("}]")?.split_once(" [get_ports {")?;
    if what.starts_with("set_property -dict { PACKAGE_PIN ") {
        return Some(Line::Placed(port));
    }
    what.starts_with("create_clock -name ").then_some(Line::Clock(port))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn line_of_another_form_is_refused() {
        for (line, number) in [("NET \"a\" LOC = \"P1\"", 1), ("\nset_false_path -from x", 2)] {
            let found = Constraints::of(line).unwrap_err();
            assert!(matches!(found, Mismatch::Line { number: at, .. } if at == number), "{found}");
        }
        // A period of a group that no net belongs to.
        let ucf = "NET \"a\" TNM_NET = \"a\";\nTIMESPEC \"TS_b\" = PERIOD \"b\" 20 ns HIGH 50 %;";
        assert!(matches!(Constraints::of(ucf), Err(Mismatch::Line { number: 2, .. })));
    }
}
