//! The settings that `$$` shows. Those of the machine are in the machine file: they are shown, and
//! a write of another value is refused with the name of the key. Two settings are the dialect's
//! own: what reports hold (`$10`) and whether they are in inches (`$13`).

use std::fmt::Write as _;

/// Settings of an axis.
#[derive(Debug, Clone, PartialEq)]
pub struct AxisSettings {
    /// Number of its letter: x is 0, c is 5.
    pub letter: usize,
    /// Its name in the machine file.
    pub name: String,
    /// Steps per mm or degree.
    pub steps_per_unit: f64,
    /// Greatest speed, mm or degrees per minute.
    pub rate: f64,
    /// Greatest acceleration, mm or degrees per second squared.
    pub acceleration: f64,
    /// Travel, mm or degrees; 0 if the file gives none.
    pub travel: f64,
}

/// How the machine homes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HomingSettings {
    /// Axes that home toward their lower end, one bit each.
    pub directions: u8,
    /// Speed of the slow approach of the first axis that homes, mm/min.
    pub slow: f64,
    /// That of the search.
    pub seek: f64,
    /// How far it goes off the switch, mm.
    pub pull_off: f64,
}

/// What the machine file says, in the terms of Grbl.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MachineSettings {
    /// Length of a step pulse, us.
    pub pulse_us: f64,
    /// Axes whose travel bounds programs, if there is one.
    pub soft_limits: bool,
    /// Limit switches stop the machine.
    pub hard_limits: bool,
    /// How it homes, if it does.
    pub homing: Option<HomingSettings>,
    /// Greatest speed of the spindle, turns per minute; 0 without one.
    pub spindle: u32,
    /// Whether the spindle is a laser.
    pub laser: bool,
    /// Tolerance of the path, mm: what is nearest to Grbl's junction deviation.
    pub tolerance: f64,
    /// Each axis.
    pub axes: Vec<AxisSettings>,
}

/// All settings.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Those of the machine file.
    pub machine: MachineSettings,
    /// `$10`: bit 0 is for MPos in place of WPos, bit 1 for the free buffers.
    pub report: u8,
    /// `$13`: places and speeds of reports are in inches.
    pub inches: bool,
}

/// `$10` at the beginning: machine places, with the free buffers.
const REPORT: u8 = 3;

impl Settings {
    /// The settings of a machine.
    pub const fn new(machine: MachineSettings) -> Self {
        Self { machine, report: REPORT, inches: false }
    }

    /// Sets the dialect's own settings as at the beginning.
    pub fn restore(&mut self) {
        (self.report, self.inches) = (REPORT, false);
    }

    /// Numbers, values and the keys of the machine file that give them; the key is empty for the
    /// dialect's own.
    fn all(&self) -> Vec<(u16, String, String)> {
        let machine = &self.machine;
        let homing = machine.homing.unwrap_or(HomingSettings {
            directions: 0,
            slow: 0.0,
            seek: 0.0,
            pull_off: 0.0,
        });
        let whole = |value: u32| value.to_string();
        let flag = |value: bool| u32::from(value).to_string();
        let real = |value: f64| format!("{value:.3}");
        let of = |number: u16, value: String, key: &str| (number, value, key.to_owned());
        let mut all = vec![
            of(0, format!("{:.0}", machine.pulse_us), "step_high_ns of the driver"),
            of(1, whole(255), "the drivers, which keep their power"),
            of(2, whole(0), "invert_step of the axes"),
            of(3, whole(0), "invert_dir of the axes"),
            of(4, whole(0), "the board's enable pin"),
            of(5, whole(0), "limit_level"),
            of(6, whole(0), "probe in [machine.inputs]"),
            of(10, whole(self.report.into()), ""),
            of(11, real(machine.tolerance), "path_tolerance"),
            of(12, real(machine.tolerance), "path_tolerance"),
            of(13, flag(self.inches), ""),
            of(20, flag(machine.soft_limits), "travel of the axes"),
            of(21, flag(machine.hard_limits), "[machine.guard]"),
            of(22, flag(machine.homing.is_some()), "home of the axes"),
            of(23, whole(homing.directions.into()), "toward in home"),
            of(24, real(homing.slow), "slow in home"),
            of(25, real(homing.seek), "seek in home"),
            of(26, whole(0), "debounce_us"),
            of(27, real(homing.pull_off), "pull_off in home"),
            of(30, whole(machine.spindle), "spindle_rpm in [machine.outputs]"),
            of(31, whole(0), "spindle_rpm in [machine.outputs]"),
            of(32, flag(machine.laser), "laser in [machine.outputs]"),
        ];
        for (first, key) in
            [(100, "steps_per"), (110, "speed"), (120, "acceleration"), (130, "travel")]
        {
            for axis in &machine.axes {
                let value = match first {
                    100 => axis.steps_per_unit,
                    110 => axis.rate,
                    120 => axis.acceleration,
                    _ => axis.travel,
                };
                let key = format!("{key} of axis {}", axis.name);
                all.push((first + axis.letter as u16, real(value), key));
            }
        }
        all
    }

    /// What `$$` shows, line by line.
    pub fn text(&self) -> String {
        let mut text = String::new();
        for (number, value, _) in self.all() {
            // Writing to a string cannot fail.
            let _ = write!(text, "${number}={value}\r\n");
        }
        text
    }

    /// Writes a setting. A value that is the present one is accepted, so that a sender may restore
    /// what it has read.
    ///
    /// # Errors
    /// `None`: there is no such setting. Otherwise the key of the machine file that gives it.
    pub fn write(&mut self, number: u16, value: f64) -> Result<(), Option<String>> {
        let (_, known, key) = self.all().into_iter().find(|one| one.0 == number).ok_or(None)?;
        match number {
            10 if value <= 255.0 => self.report = value as u8,
            13 => self.inches = value != 0.0,
            _ if known.parse() == Ok(value) => {}
            10 => return Err(Some("from 0 to 255".to_owned())),
            _ => return Err(Some(key)),
        }
        Ok(())
    }
}
