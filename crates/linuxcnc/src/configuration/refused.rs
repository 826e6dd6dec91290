//! Why LinuxCNC or the component cannot have a machine.

use super::home_switch::SwitchRefused;
use thiserror::Error;

/// Rates that a serial port can be set to, bit/s, as `carrystep_uart.c` lists them.
pub const BAUDS: [u32; 12] = [
    115_200, 230_400, 460_800, 500_000, 576_000, 921_600, 1_000_000, 1_152_000, 1_500_000,
    2_000_000, 2_500_000, 3_000_000,
];

/// Why LinuxCNC cannot have a machine.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum MachineRefused {
    /// An axis has no letter.
    #[error("axis '{axis}' has no letter: call it x, y, z, a, b, c, u, v or w, as LinuxCNC does")]
    Name {
        /// Its name.
        axis: String,
    },
    /// Two axes have one letter.
    #[error(
        "two axes have the letter {letter}: LinuxCNC does not tell {letter} from {small}",
        small = .letter.to_ascii_lowercase()
    )]
    Twice {
        /// The letter.
        letter: char,
    },
    /// Several motors move one letter.
    #[error(
        "the letter {letter} has several motors, '{axis}' for one: the configuration that is written \
         has a joint for each letter. Run programs of this machine with `carrystep run`"
    )]
    Gantry {
        /// The letter.
        letter: String,
        /// The second motor.
        axis: String,
    },
    /// Two crossed belts move x and y.
    #[error(
        "kinematics = \"corexy\": the configuration that is written has trivkins, with a joint for each \
         letter. Run programs of this machine with `carrystep run`"
    )]
    Kinematics,
    /// An axis has another unit than LinuxCNC.
    #[error(
        "axis '{axis}' is in {unit}: LinuxCNC has it in {wanted}. Give lead or steps_per_unit in that unit"
    )]
    Unit {
        /// Its name.
        axis: String,
        /// The unit of the machine file.
        unit: String,
        /// The units of LinuxCNC for this letter.
        wanted: &'static str,
    },
    /// Some axes are in mm and others in inches.
    #[error(
        "axis '{axis}' is in {unit}, and an axis before it is not: LinuxCNC has one unit of length"
    )]
    Mixed {
        /// Its name.
        axis: String,
        /// Its unit.
        unit: String,
    },
    /// A home switch cannot be.
    #[error(transparent)]
    Switch(#[from] SwitchRefused),
    /// Places are not those that the component computes.
    #[error("phase = \"zero\": the component needs phase = \"half\", the default")]
    Phase,
    /// The engine or the rate cannot be built.
    #[error("{0}")]
    Build(String),
    /// No serial port has this rate.
    #[error("baud = {baud}: the component's serial ports have one of {all}", all = all_bauds())]
    Baud {
        /// The rate of the machine file.
        baud: u32,
    },
    /// The line does not hold the segments.
    #[error(
        "the line is too slow: segments of {joints} joints in 16 ms take more than half of {rate} bit/s"
    )]
    SlowLine {
        /// Its rate, bit/s.
        rate: u32,
        /// The number of joints.
        joints: u32,
    },
    /// The queues do not hold the horizon.
    #[error(
        "the board's queues do not hold the segments of this horizon: at most {most_ms} ms with \
         this queue_depth"
    )]
    LongHorizon {
        /// The longest one.
        most_ms: u32,
    },
    /// The horizon does not hold two segments.
    #[error("the horizon is shorter than two segments: at least {least_ms} ms on this line")]
    ShortHorizon {
        /// The shortest one.
        least_ms: u32,
    },
}

fn all_bauds() -> String {
    BAUDS.map(|baud| baud.to_string()).join(", ")
}

#[cfg(test)]
mod tests {
    use super::BAUDS;
    use crate::component;

    #[test]
    fn rates_are_those_of_the_component() {
        let uart = component().find(|(name, _)| *name == "carrystep_uart.c").unwrap().1;
        let (_, rows) = uart.split_once("RATES[] = {").unwrap();
        let (rows, _) = rows.split_once("};").unwrap();
        let rates: Vec<u32> = rows
            .split('{')
            .skip(1)
            .map(|row| row.split(',').next().unwrap().parse().unwrap())
            .collect();
        assert_eq!(rates, BAUDS);
    }
}
