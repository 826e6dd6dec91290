//! The HAL file: the component, its thread, and the nets between it and LinuxCNC.

use super::{BoardLine, Configuration, Homing, Joint, OutputNets};
use std::fmt::Write as _;

pub fn text(configuration: &Configuration) -> String {
    let Configuration { line, periods, horizon_ms, joints, .. } = configuration;
    let count = joints.len();
    let build = configuration.build.unwrap_or(0);
    let dio = if configuration.outputs.count > 4 { " num_dio=8" } else { "" };
    let has = built_in(configuration);
    let rate = match line {
        BoardLine::Uart { baud } => format!("baud={baud}"),
        BoardLine::Spi { sck_hz } => format!("speed={sck_hz}"),
    };
    let mut text = format!(
        "# Written by `carrystep linuxcnc`. The build id is that of the machine file.\n\
         loadrt [KINS]KINEMATICS\n\
         loadrt [EMCMOT]EMCMOT servo_period_nsec=[EMCMOT]SERVO_PERIOD num_joints=[KINS]JOINTS{dio}\n\
         loadrt carrystep port=[CARRYSTEP]PORT {rate} joints={count} periods={periods} \
         horizon={horizon_ms} build={build:x}{has}\n\
         addf motion-command-handler servo-thread\n\
         addf motion-controller servo-thread\n\
         addf carrystep.0.update servo-thread\n\n"
    );
    for (number, joint) in joints.iter().enumerate() {
        text.push_str(&of_joint(configuration, number, joint));
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

/// Parameters of the component for what the build has.
fn built_in(configuration: &Configuration) -> String {
    let OutputNets { count, pwm, .. } = configuration.outputs;
    let mut text = String::new();
    let mut add = |name: &str, value: Option<u8>| {
        if let Some(value) = value {
            let _ = write!(text, " {name}={value}");
        }
    };
    add("outputs", (count > 0).then_some(count));
    add("pwm", pwm.then_some(1));
    add("probe_latch", configuration.probe_latch);
    add("index_latch", configuration.index_latch);
    text
}

fn of_joint(configuration: &Configuration, number: usize, joint: &Joint) -> String {
    let own = format!("carrystep.0.joint.{number}");
    let mut text = format!(
        "setp {own}.scale [JOINT_{number}]SCALE\n\
         setp {own}.maxvel [JOINT_{number}]MAXVEL\n\
         net joint-{number}-cmd joint.{number}.motor-pos-cmd => {own}.position-cmd\n\
         net joint-{number}-fb {own}.position-fb => joint.{number}.motor-pos-fb\n\
         net joint-{number}-on joint.{number}.amp-enable-out => {own}.enable\n\
         net joint-{number}-fault {own}.fault => joint.{number}.amp-fault-in\n\
         net joint-{number}-homing joint.{number}.homing => {own}.homing\n"
    );
    if configuration.index_latch.is_some() {
        let _ = writeln!(
            text,
            "net joint-{number}-index joint.{number}.index-enable <=> {own}.index-enable"
        );
    }
    if configuration.limits {
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

fn of_outputs(outputs: &OutputNets) -> String {
    let OutputNets { spindle, spindle_reverse, mist, flood, .. } = *outputs;
    let uses = [
        (spindle, "spindle-on", "spindle.0.on"),
        (spindle_reverse, "spindle-reverse", "spindle.0.reverse"),
        (mist, "mist", "iocontrol.0.coolant-mist"),
        (flood, "flood", "iocontrol.0.coolant-flood"),
    ];
    let mut text = String::new();
    for output in 0..outputs.count {
        let _ = match uses.iter().find(|(number, ..)| *number == Some(output)) {
            Some((_, net, pin)) => writeln!(text, "net {net} {pin} => carrystep.0.out-{output}"),
            None => writeln!(
                text,
                "net digital-{output} motion.digital-out-{output:02} => carrystep.0.out-{output}"
            ),
        };
    }
    let _ = match (outputs.pwm, outputs.spindle_rpm) {
        (false, _) => Ok(()),
        (true, Some(rpm)) => writeln!(
            text,
            "setp carrystep.0.pwm-scale {rpm}\n\
             net spindle-speed spindle.0.speed-out-abs => carrystep.0.pwm-duty"
        ),
        (true, None) => writeln!(text, "net duty motion.analog-out-00 => carrystep.0.pwm-duty"),
    };
    text
}
