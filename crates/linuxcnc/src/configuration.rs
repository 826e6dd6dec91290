//! The files of a LinuxCNC configuration for one board: INI, HAL and tool table.

mod hal;
mod home_switch;
mod ini;
mod machine;
mod rates;
mod refused;

pub use home_switch::{HomeSwitch, SwitchRefused};
pub use machine::Wishes;
pub use refused::MachineRefused;

/// When and how LinuxCNC gives a joint its machine coordinate.
#[derive(Debug, Clone, PartialEq)]
pub enum Homing {
    /// The joint does not move: the place where it is gets this coordinate, units.
    InPlace {
        /// The coordinate.
        at: f64,
    },
    /// LinuxCNC searches a switch: it moves onto the switch, off it, and once more slowly.
    Switch {
        /// Pin of the component that shows the switch, without `carrystep.0.`: `in-1-0`.
        pin: String,
        /// Speed of the search, units/s; its sign is the direction.
        search: f64,
        /// Speed of the last approach, units/s; its sign is the direction.
        latch: f64,
        /// Coordinate of the place where the switch closes, units.
        at: f64,
        /// Coordinate at which the joint rests afterwards, units.
        rest: f64,
        /// Whether LinuxCNC goes on, behind the switch, to the next index pulse.
        index: bool,
    },
}

/// A joint: axis N of the board, and the axis of this letter of LinuxCNC.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    /// Letter of the axis, one of [`LETTERS`].
    pub letter: char,
    /// Steps per unit; negative turns the direction. Not 0.
    pub scale: f64,
    /// Greatest speed, units/s, over 0.
    pub speed: f64,
    /// Greatest acceleration, units/s^2, over 0.
    pub acceleration: f64,
    /// The lowest and the highest machine coordinate, units; `None`: LinuxCNC does not limit it.
    pub travel: Option<(f64, f64)>,
    /// Whether the axis turns: units are degrees.
    pub angular: bool,
    /// How it homes.
    pub homing: Homing,
    /// Joints with a lower number home earlier.
    pub sequence: u32,
}

/// The letters of LinuxCNC's axes. A, B and C turn.
pub const LETTERS: &str = "XYZABCUVW";

/// The outputs that the board has, and what LinuxCNC switches with them, by their numbers. Those
/// without a use are the digital outputs of `M62` to `M65` with their number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct OutputNets {
    /// Number of outputs, 0 to 8.
    pub count: u8,
    /// Whether there is a PWM.
    pub pwm: bool,
    /// Active while the spindle turns.
    pub spindle: Option<u8>,
    /// Active while it turns counterclockwise.
    pub spindle_reverse: Option<u8>,
    /// Active while mist is on.
    pub mist: Option<u8>,
    /// Active while flood is on.
    pub flood: Option<u8>,
    /// Turns per minute at the greatest duty of the PWM, which follows the spindle's speed; without
    /// it the PWM is analog output 0 of `M67` and `M68`.
    pub spindle_rpm: Option<u32>,
}

/// The line to the board, and its rate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BoardLine {
    /// A serial port.
    Uart {
        /// bit/s
        baud: u32,
    },
    /// An SPI, by Linux' spidev.
    Spi {
        /// Rate of SCK, Hz.
        sck_hz: u32,
    },
}

/// A configuration.
#[derive(Debug, Clone, PartialEq)]
pub struct Configuration {
    /// Name of the machine, and of the files.
    pub name: String,
    /// The serial port, or the spidev.
    pub port: String,
    /// What it is, and its rate.
    pub line: BoardLine,
    /// Build id of the gateware; `None`: any.
    pub build: Option<u64>,
    /// Servo periods in a segment, 1 to 64.
    pub periods: u32,
    /// Time from a command to its pulses, ms.
    pub horizon_ms: u32,
    /// Whether lengths are in inches; otherwise they are in mm.
    pub inches: bool,
    /// The joints, in the order of the board's axes.
    pub joints: Vec<Joint>,
    /// Whether each joint has a limit switch at each end.
    pub limits: bool,
    /// Whether the board has a probe.
    pub probe: bool,
    /// The latch of the edge that closes the probe.
    pub probe_latch: Option<u8>,
    /// The latch with a pin of its own, for index pulses.
    pub index_latch: Option<u8>,
    /// The board's outputs.
    pub outputs: OutputNets,
    /// LinuxCNC's user interface.
    pub display: String,
    /// More HAL files.
    pub hal_files: Vec<String>,
}

impl Configuration {
    /// Name and text of each file.
    pub fn files(&self) -> Vec<(String, String)> {
        vec![
            (format!("{}.ini", self.name), ini::text(self)),
            (format!("{}.hal", self.name), hal::text(self)),
            (format!("{}.tbl", self.name), "T1 P1 ; no tool is measured\n".to_owned()),
        ]
    }
}
