//! The INI file: everything that has a unit.

use super::{Configuration, Homing, Joint};
use std::fmt::Write as _;

/// Period of the servo thread, ns.
pub const SERVO_NS: u32 = 1_000_000;

/// The speed at which the component reports a jump, in tenths of the limit: where LinuxCNC blends
/// corners, an axis can be faster than its limit for a few periods.
const JUMP_TENTHS: f64 = 11.0;

/// The greatest following error, in steps. A step is the least one that means something.
const ERROR_STEPS: f64 = 2.0;

/// From an edge at a pin to its report, at the most, s.
const REPORT_S: f64 = 0.1;

/// Why the greatest following error is that large.
const JUMPS: &str = "\
# In the period in which a probe, a home switch or an index pulse is shown, position-fb is its place,
# and not the command, which is a horizon ahead. The component itself faults if a step is lost.
";

pub fn text(configuration: &Configuration) -> String {
    let Configuration { name, port, display, joints, .. } = configuration;
    let letters: Vec<String> = joints.iter().map(|joint| joint.letter.to_string()).collect();
    let straight = joints.iter().filter(|joint| !joint.angular);
    let path = straight.map(|joint| joint.speed * joint.speed).sum::<f64>().sqrt();
    let turning = joints.iter().filter(|joint| joint.angular).map(|joint| joint.speed);
    let turning = turning.fold(0.0_f64, f64::max);
    let units = if configuration.inches { "inch" } else { "mm" };
    let mut text = format!(
        "# Written by `carrystep linuxcnc` from the machine file: steps, speeds, limits.\n\
         [EMC]\nVERSION = 1.1\nMACHINE = {name}\nDEBUG = 0\n\n\
         [DISPLAY]\nDISPLAY = {display}\nCYCLE_TIME = 0.1\nPOSITION_FEEDBACK = ACTUAL\n\
         MAX_FEED_OVERRIDE = 1.2\nPROGRAM_PREFIX = .\n\n\
         [TASK]\nTASK = milltask\nCYCLE_TIME = 0.002\n\n\
         [RS274NGC]\nPARAMETER_FILE = {name}.var\n\n\
         [EMCMOT]\nEMCMOT = motmod\nCOMM_TIMEOUT = 4.0\nSERVO_PERIOD = {SERVO_NS}\n\n\
         [EMCIO]\nEMCIO = io\nCYCLE_TIME = 0.1\nTOOL_TABLE = {name}.tbl\n\n\
         # The board's serial port, or its spidev.\n\
         [CARRYSTEP]\nPORT = {port}\n\n\
         [HAL]\nHALFILE = {name}.hal\n"
    );
    let mut line = |words: std::fmt::Arguments<'_>| {
        let _ = text.write_fmt(words);
        text.push('\n');
    };
    configuration.hal_files.iter().for_each(|file| line(format_args!("HALFILE = {file}")));
    line(format_args!("\n[TRAJ]\nCOORDINATES = {}", letters.join(" ")));
    line(format_args!("LINEAR_UNITS = {units}\nANGULAR_UNITS = degree"));
    if path > 0.0 {
        line(format_args!("DEFAULT_LINEAR_VELOCITY = {}", path / 4.0));
        line(format_args!("MAX_LINEAR_VELOCITY = {path}"));
    }
    if turning > 0.0 {
        line(format_args!("DEFAULT_ANGULAR_VELOCITY = {}", turning / 4.0));
        line(format_args!("MAX_ANGULAR_VELOCITY = {turning}"));
    }
    line(format_args!("\n[KINS]\nKINEMATICS = trivkins coordinates={}", letters.concat()));
    line(format_args!("JOINTS = {}", joints.len()));
    for (number, joint) in joints.iter().enumerate() {
        line(format_args!("{}", of_joint(configuration, number, joint)));
    }
    text
}

/// The sections of a joint and of its axis.
fn of_joint(configuration: &Configuration, number: usize, joint: &Joint) -> String {
    let Joint { letter, scale, speed, acceleration, .. } = joint;
    let travel = joint
        .travel
        .map_or_else(String::new, |(low, high)| format!("MIN_LIMIT = {low}\nMAX_LIMIT = {high}\n"));
    let limits = format!("MAX_VELOCITY = {speed}\nMAX_ACCELERATION = {acceleration}\n{travel}");
    let kind = if joint.angular { "ANGULAR" } else { "LINEAR" };
    let searches = matches!(joint.homing, Homing::Switch { .. });
    let jumps = configuration.probe || configuration.index_latch.is_some() || searches;
    let (why, error) = if jumps {
        let behind = f64::from(configuration.horizon_ms) * 1e-3 + REPORT_S;
        (JUMPS, speed * behind + ERROR_STEPS / scale.abs())
    } else {
        ("", ERROR_STEPS / scale.abs())
    };
    let homing = match &joint.homing {
        Homing::InPlace { at } => format!(
            "# The place where the joint is gets the coordinate HOME_OFFSET.\n\
             HOME = {at}\nHOME_OFFSET = {at}\nHOME_SEARCH_VEL = 0\nHOME_LATCH_VEL = 0"
        ),
        Homing::Switch { search, latch, at, rest, index, .. } => format!(
            "HOME = {rest}\nHOME_OFFSET = {at}\nHOME_SEARCH_VEL = {search}\n\
             HOME_LATCH_VEL = {latch}{}",
            if *index { "\nHOME_USE_INDEX = YES\nHOME_INDEX_NO_ENCODER_RESET = YES" } else { "" }
        ),
    };
    format!(
        "\n[AXIS_{letter}]\n{limits}\n[JOINT_{number}]\nTYPE = {kind}\n{limits}\
         SCALE = {scale}\nMAXVEL = {}\n{why}FERROR = {error}\nMIN_FERROR = {error}\n\
         {homing}\nHOME_SEQUENCE = {}",
        speed * JUMP_TENTHS / 10.0,
        joint.sequence
    )
}
