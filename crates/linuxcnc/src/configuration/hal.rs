//! The HAL file: the component, its thread, and the nets between it and LinuxCNC.

use super::{Configuration, Homing, Joint, OutputNets};
use std::fmt::Write as _;

pub fn text(configuration: &Configuration) -> String {
    let Configuration { baud, periods, horizon_ms, joints, .. } = configuration;
    let count = joints.len();
    let build = configuration.build.unwrap_or(0);
    let mut text = format!(
        "# Written by `carrystep linuxcnc`. The build id is that of the machine file.\n\
         loadrt [KINS]KINEMATICS\n\
         loadrt [EMCMOT]EMCMOT servo_period_nsec=[EMCMOT]SERVO_PERIOD num_joints=[KINS]JOINTS\n\
         loadrt carrystep port=[CARRYSTEP]PORT baud={baud} joints={count} periods={periods} \
         horizon={horizon_ms} build={build:x}\n\
         addf motion-command-handler servo-thread\n\
         addf motion-controller servo-thread\n\
         addf carrystep.0.update servo-thread\n\n"
    );
    for (number, joint) in joints.iter().enumerate() {
        text.push_str(&of_joint(number, joint, configuration.limits));
    }
    if configuration.probe {
        text.push_str("net probe carrystep.0.probe => motion.probe-input\n");
    }
    text.push_str(&of_outputs(&configuration.outputs));
    text.push_str(
        "net estop iocontrol.0.user-enable-out => iocontrol.0.emc-enable-in\n\
         net tool-prepare iocontrol.0.tool-prepare => iocontrol.0.tool-prepared\n\
         net tool-change iocontrol.0.tool-change => iocontrol.0.tool-changed\n",
    );
    text
}

fn of_joint(number: usize, joint: &Joint, limits: bool) -> String {
    let own = format!("carrystep.0.joint.{number}");
    let mut text = format!(
        "setp {own}.scale [JOINT_{number}]SCALE\n\
         setp {own}.maxvel [JOINT_{number}]MAXVEL\n\
         net joint-{number}-cmd joint.{number}.motor-pos-cmd => {own}.position-cmd\n\
         net joint-{number}-fb {own}.position-fb => joint.{number}.motor-pos-fb\n\
         net joint-{number}-on joint.{number}.amp-enable-out => {own}.enable\n\
         net joint-{number}-fault {own}.fault => joint.{number}.amp-fault-in\n"
    );
    if limits {
        let _ = write!(
            text,
            "net joint-{number}-min {own}.limit-min => joint.{number}.neg-lim-sw-in\n\
             net joint-{number}-max {own}.limit-max => joint.{number}.pos-lim-sw-in\n"
        );
    }
    if let Homing::Switch { pin, .. } = &joint.homing {
        let _ = writeln!(text, "net {pin} carrystep.0.{pin} => joint.{number}.home-sw-in");
    }
    text + "\n"
}

fn of_outputs(_outputs: &OutputNets) -> String {
    String::new()
}
