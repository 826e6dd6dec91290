//! The files of a LinuxCNC configuration for one board: INI, HAL and tool table.

use std::fmt::Write as _;

/// A joint: axis N of the board, and the axis of this letter of LinuxCNC.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    /// Letter of the axis, X to W.
    pub letter: char,
    /// Steps per unit; negative turns the direction. Not 0.
    pub scale: f64,
    /// Greatest speed, units/s, over 0.
    pub speed: f64,
    /// Greatest acceleration, units/s^2, over 0.
    pub acceleration: f64,
    /// The lowest and the highest machine coordinate, units.
    pub travel: (f64, f64),
    /// Whether the axis turns: units are degrees.
    pub angular: bool,
}

/// A configuration.
#[derive(Debug, Clone, PartialEq)]
pub struct Configuration {
    /// Name of the machine, and of the files.
    pub name: String,
    /// The serial port.
    pub port: String,
    /// Its rate, bit/s.
    pub baud: u32,
    /// Build id of the gateware; `None`: any.
    pub build: Option<u64>,
    /// Servo periods in a segment, 1 to 64.
    pub periods: u32,
    /// Time from a command to its pulses, ms.
    pub horizon_ms: u32,
    /// The joints, in the order of the board's axes.
    pub joints: Vec<Joint>,
    /// LinuxCNC's user interface.
    pub display: String,
    /// More HAL files.
    pub hal_files: Vec<String>,
}

/// Period of the servo thread, ns.
const SERVO_NS: u32 = 1_000_000;

/// How far the speed of LinuxCNC may be from the limit until the component reports a jump: corners
/// are blended on other axes' account.
const MARGIN: f64 = 1.1;

impl Configuration {
    /// Name and text of each file.
    pub fn files(&self) -> Vec<(String, String)> {
        vec![
            (format!("{}.ini", self.name), self.ini()),
            (format!("{}.hal", self.name), self.hal()),
            (format!("{}.tbl", self.name), "T1 P1 ; no tool is measured\n".to_owned()),
        ]
    }

    fn ini(&self) -> String {
        let name = &self.name;
        let letters: Vec<String> =
            self.joints.iter().map(|joint| joint.letter.to_string()).collect();
        let straight = self.joints.iter().filter(|joint| !joint.angular);
        let path = straight.map(|joint| joint.speed * joint.speed).sum::<f64>().sqrt();
        let display = &self.display;
        let mut text = format!(
            "[EMC]\nVERSION = 1.1\nMACHINE = {name}\nDEBUG = 0\n\n\
             [DISPLAY]\nDISPLAY = {display}\nCYCLE_TIME = 0.1\nPOSITION_FEEDBACK = ACTUAL\n\
             MAX_FEED_OVERRIDE = 1.2\nPROGRAM_PREFIX = .\n\n\
             [TASK]\nTASK = milltask\nCYCLE_TIME = 0.002\n\n\
             [RS274NGC]\nPARAMETER_FILE = {name}.var\n\n\
             [EMCMOT]\nEMCMOT = motmod\nCOMM_TIMEOUT = 4.0\nSERVO_PERIOD = {SERVO_NS}\n\n\
             [EMCIO]\nEMCIO = io\nCYCLE_TIME = 0.1\nTOOL_TABLE = {name}.tbl\n\n\
             [HAL]\nHALFILE = {name}.hal\n"
        );
        let mut line = |words: std::fmt::Arguments<'_>| {
            let _ = text.write_fmt(words);
            text.push('\n');
        };
        self.hal_files.iter().for_each(|file| line(format_args!("HALFILE = {file}")));
        line(format_args!("\n[TRAJ]\nCOORDINATES = {}", letters.join(" ")));
        line(format_args!("LINEAR_UNITS = mm\nANGULAR_UNITS = degree"));
        line(format_args!("DEFAULT_LINEAR_VELOCITY = {}", path / 4.0));
        line(format_args!("MAX_LINEAR_VELOCITY = {path}"));
        line(format_args!("\n[KINS]\nKINEMATICS = trivkins coordinates={}", letters.concat()));
        line(format_args!("JOINTS = {}", self.joints.len()));
        for (number, joint) in self.joints.iter().enumerate() {
            let limits = format!(
                "MAX_VELOCITY = {}\nMAX_ACCELERATION = {}\nMIN_LIMIT = {}\nMAX_LIMIT = {}",
                joint.speed, joint.acceleration, joint.travel.0, joint.travel.1
            );
            let kind = if joint.angular { "ANGULAR" } else { "LINEAR" };
            // A step is the least following error that means something.
            let error = 2.0 / joint.scale.abs();
            line(format_args!("\n[AXIS_{}]\n{limits}", joint.letter));
            line(format_args!("\n[JOINT_{number}]\nTYPE = {kind}\n{limits}"));
            line(format_args!("SCALE = {}\nMAXVEL = {}", joint.scale, joint.speed * MARGIN));
            line(format_args!("FERROR = {error}\nMIN_FERROR = {error}"));
            line(format_args!("HOME = 0\nHOME_OFFSET = 0\nHOME_SEARCH_VEL = 0"));
            line(format_args!("HOME_LATCH_VEL = 0\nHOME_SEQUENCE = 0"));
        }
        text
    }

    fn hal(&self) -> String {
        let Self { port, baud, periods, horizon_ms, joints, .. } = self;
        let count = joints.len();
        let build = self.build.unwrap_or(0);
        let mut text = format!(
            "loadrt [KINS]KINEMATICS\n\
             loadrt [EMCMOT]EMCMOT servo_period_nsec=[EMCMOT]SERVO_PERIOD num_joints=[KINS]JOINTS\n\
             loadrt carrystep port={port} baud={baud} joints={count} periods={periods} \
             horizon={horizon_ms} build={build:x}\n\
             addf motion-command-handler servo-thread\n\
             addf motion-controller servo-thread\n\
             addf carrystep.0.update servo-thread\n\n"
        );
        for joint in 0..count {
            let own = format!("carrystep.0.joint.{joint}");
            let _ = write!(
                text,
                "setp {own}.scale [JOINT_{joint}]SCALE\n\
                 setp {own}.maxvel [JOINT_{joint}]MAXVEL\n\
                 net joint-{joint}-cmd joint.{joint}.motor-pos-cmd => {own}.position-cmd\n\
                 net joint-{joint}-fb {own}.position-fb => joint.{joint}.motor-pos-fb\n\
                 net joint-{joint}-on joint.{joint}.amp-enable-out => {own}.enable\n\
                 net joint-{joint}-fault {own}.fault => joint.{joint}.amp-fault-in\n\n"
            );
        }
        text.push_str(
            "net estop iocontrol.0.user-enable-out => iocontrol.0.emc-enable-in\n\
             net tool-prepare iocontrol.0.tool-prepare => iocontrol.0.tool-prepared\n\
             net tool-change iocontrol.0.tool-change => iocontrol.0.tool-changed\n",
        );
        text
    }
}
