//! `carrystep linuxcnc`: whole configurations from machine files, or none; every machine that
//! LinuxCNC cannot have is refused by name.

use crate::command::{Folder, Ran};

/// A machine that LinuxCNC can have.
pub const MILL: &str = "\
[machine]
queue_depth = 31
home_order = [[\"z\"], [\"x\"]]
[machine.guard]
limits = \"pair\"
[machine.inputs]
probe = \"high\"
[[machine.axis]]
name = \"x\"
unit = \"mm\"
steps_per_unit = 80
speed_limit = 100
accel_limit = 1000
driver = \"tmc2209\"
travel = [0, 300]
home = { toward = \"min\", seek_speed = 20, slow_speed = 2, pull_off = 2, position = 0 }
[[machine.axis]]
name = \"z\"
unit = \"mm\"
steps_per_unit = 400
speed_limit_per_min = 900
accel_limit = 500
driver = \"tmc2209\"
travel = [-100, 10]
home = { toward = \"max\", seek_speed = 5, slow_speed = 1, pull_off = 1.5, position = 10 }
[[machine.axis]]
name = \"A\"
unit = \"deg\"
steps_per_unit = 10
speed_limit = 720
accel_limit = 4000
driver = \"tmc2209\"
";

fn write(text: &str, options: &str) -> (Folder, Ran) {
    let folder = Folder::new();
    folder.write("mill.toml", text);
    let command = format!("linuxcnc --machine mill.toml --out out {options}");
    let ran = folder.run(command.trim_end());
    (folder, ran)
}

fn read(folder: &Folder, name: &str) -> String {
    std::fs::read_to_string(folder.path(name)).unwrap()
}

/// The value of a key in a section of an INI file.
fn value<'a>(ini: &'a str, section: &str, key: &str) -> &'a str {
    let head = format!("[{section}]\n");
    let (_, rest) = ini.split_once(&head).unwrap_or_else(|| panic!("no {head}"));
    let body = rest.split("\n[").next().unwrap();
    let line = body.lines().find_map(|line| line.strip_prefix(&format!("{key} = ")));
    line.unwrap_or_else(|| panic!("no {key} in [{section}]: {body}"))
}

#[test]
fn files_have_the_numbers_of_the_machine_file() {
    let (folder, ran) = write(MILL, "--port /dev/ttyACM3");
    assert_eq!(ran.status, 0, "{}", ran.stderr);
    assert!(ran.stdout.contains("start it: linuxcnc out/mill.ini"), "{}", ran.stdout);
    let (ini, hal) = (read(&folder, "out/mill.ini"), read(&folder, "out/mill.hal"));
    let wanted = [
        ("KINS", "KINEMATICS", "trivkins coordinates=XZA"),
        ("KINS", "JOINTS", "3"),
        ("TRAJ", "COORDINATES", "X Z A"),
        ("CARRYSTEP", "PORT", "/dev/ttyACM3"),
        ("JOINT_0", "SCALE", "80"),
        ("JOINT_0", "MAX_VELOCITY", "100"),
        ("JOINT_0", "HOME_OFFSET", "2"),
        ("JOINT_0", "HOME_SEQUENCE", "1"),
        ("JOINT_1", "MAX_VELOCITY", "15"),
        ("JOINT_1", "MAX_ACCELERATION", "500"),
        ("JOINT_1", "MIN_LIMIT", "-100"),
        ("AXIS_Z", "MAX_LIMIT", "10"),
        ("JOINT_1", "HOME_OFFSET", "8.5"),
        ("JOINT_1", "HOME_SEQUENCE", "0"),
        ("JOINT_2", "TYPE", "ANGULAR"),
        ("JOINT_2", "MAX_VELOCITY", "720"),
    ];
    for (section, key, wanted) in wanted {
        assert_eq!(value(&ini, section, key), wanted, "{key} of {section}");
    }
    assert!(!ini.split("[JOINT_2]").nth(1).unwrap().contains("LIMIT"), "A turns without end");
    // The build id is that of the same machine's gateware.
    let id = hal.split("build=").nth(1).unwrap().split('\n').next().unwrap();
    let virtual_board = folder.run("verilog --board icebreaker --machine mill.toml --out v --json");
    assert_eq!(virtual_board.status, 2, "this machine has another clock than the board");
    assert!(ran.stdout.contains(&format!("build {id}")), "{id}: {}", ran.stdout);
    for net in ["carrystep.0.joint.1.limit-max => joint.1.pos-lim-sw-in", "carrystep.0.probe => "] {
        assert!(hal.contains(net), "{net}: {hal}");
    }
}

/// A board at an SPI: a spidev, and a rate that the gateware's clock and wires allow.
#[test]
fn board_at_an_spi_has_a_spidev() {
    let text = MILL.replace("[machine.inputs]", "[machine.link]\nspi = true\n[machine.inputs]");
    let (folder, ran) = write(&text, "");
    assert_eq!(ran.status, 0, "{}", ran.stderr);
    assert!(ran.stdout.contains("/dev/spidev0.0 at 4000000 Hz"), "{}", ran.stdout);
    let (ini, hal) = (read(&folder, "out/mill.ini"), read(&folder, "out/mill.hal"));
    assert_eq!(value(&ini, "CARRYSTEP", "PORT"), "/dev/spidev0.0");
    assert!(hal.contains(" speed=4000000 joints=3 ") && !hal.contains("baud="), "{hal}");
    // The build is another one than that with a UART.
    let id = |hal: &str| hal.split("build=").nth(1).unwrap().split('\n').next().unwrap().to_owned();
    assert_ne!(id(&hal), id(&read(&write(MILL, "").0, "out/mill.hal")));
    // With a slow clock the SPI is slower, too.
    let slow = text.replace("[machine]", "[machine]\nclock_hz = 12_000_000");
    let (folder, ran) = write(&slow, "--port /dev/spidev1.2 --json");
    assert_eq!(ran.status, 0, "{}", ran.stderr);
    let told: serde_json::Value = serde_json::from_str(&ran.stdout).unwrap();
    assert_eq!((&told["sck_hz"], &told["port"]), (&1_200_000.into(), &"/dev/spidev1.2".into()));
    assert_eq!(told.get("baud"), None);
    assert!(read(&folder, "out/mill.hal").contains(" speed=1200000 "));
}

/// Spindle, coolant, PWM, and latches for the probe and for index pulses.
#[test]
fn outputs_and_latches_have_their_nets() {
    let (folder, ran) = write(MILL, "");
    assert_eq!(ran.status, 0, "{}", ran.stderr);
    assert!(!read(&folder, "out/mill.hal").contains("_latch"), "no latch, no parameter");
    let inputs = "[machine.inputs]\nlatches = [{ edge = \"falling\", source = \"probe\" }, \
        { edge = \"rising\" }, { edge = \"rising\", source = \"probe\" }]";
    let outputs = "[machine.outputs]\ncount = 5\npwm_divider = 1\n\
                   spindle = 2\nflood = 0\nspindle_rpm = 24000";
    let text = MILL.replace("[machine.inputs]", &format!("{outputs}\n{inputs}"));
    let (folder, ran) = write(&text, "");
    assert_eq!(ran.status, 0, "{}", ran.stderr);
    let hal = read(&folder, "out/mill.hal");
    for words in [
        " outputs=5 pwm=1 probe_latch=2 index_latch=1\n",
        " num_dio=8\n",
        "net spindle-on spindle.0.on => carrystep.0.out-2\n",
        "net flood iocontrol.0.coolant-flood => carrystep.0.out-0\n",
        "net digital-4 motion.digital-out-04 => carrystep.0.out-4\n",
        "setp carrystep.0.pwm-scale 24000\n",
        "net joint-1-index joint.1.index-enable <=> carrystep.0.joint.1.index-enable\n",
    ] {
        assert!(hal.contains(words), "{words}: {hal}");
    }
    let text = text.replace("spindle_rpm = 24000", "");
    let hal = read(&write(&text, "").0, "out/mill.hal");
    assert!(hal.contains("net duty motion.analog-out-00 => carrystep.0.pwm-duty\n"), "{hal}");
}

/// LinuxCNC homes on general inputs.
#[test]
fn home_switches_at_general_inputs() {
    let text = MILL
        .replace("[machine.inputs]", "[machine.inputs]\ngeneral = [\"low\", \"low\", \"high\"]");
    let x = "--home-switch x,input=2,toward=min,seek_speed=30,slow_speed=2,pull_off=4,position=1";
    let z = "--home-switch z,input=1,toward=max,seek_speed=5,slow_speed=5,pull_off=2,position=9.5";
    let (folder, ran) = write(&text, &format!("{x} {z}"));
    assert_eq!(ran.status, 0, "{}", ran.stderr);
    let (ini, hal) = (read(&folder, "out/mill.ini"), read(&folder, "out/mill.hal"));
    for (section, key, wanted) in [
        ("JOINT_0", "HOME_SEARCH_VEL", "-30"),
        ("JOINT_0", "HOME_LATCH_VEL", "-2"),
        ("JOINT_0", "HOME_OFFSET", "1"),
        ("JOINT_0", "HOME", "5"),
        ("JOINT_0", "HOME_SEQUENCE", "1"),
        ("JOINT_1", "HOME_SEARCH_VEL", "5"),
        ("JOINT_1", "HOME", "7.5"),
        ("JOINT_1", "HOME_SEQUENCE", "0"),
        ("JOINT_2", "HOME_SEARCH_VEL", "0"),
    ] {
        assert_eq!(value(&ini, section, key), wanted, "{key} of {section}");
    }
    assert!(hal.contains("net in-2-0 carrystep.0.in-2-0 => joint.0.home-sw-in"), "{hal}");
    assert!(hal.contains("net in-1-1 carrystep.0.in-1-1 => joint.1.home-sw-in"), "{hal}");
    for (old, new, words) in [
        ("x,", "q,", "axis 'q': no axis has this name"),
        ("input=2", "input=3", "no general input 3"),
        ("input=2", "input=x", "input is not a number"),
        ("input=2", "input=255", "no general input 255"),
        ("toward=min", "toward=left", "toward is min or max"),
        ("seek_speed=30", "seek_speed=300", "seek_speed is over speed_limit"),
        ("slow_speed=2", "slow_speed=31", "slow_speed is over seek_speed"),
        ("slow_speed=2", "slow_speed=nan", "slow_speed is not a number over 0"),
        ("pull_off=4,", "", "no pull_off"),
        ("pull_off=4", "pull_off=4,pull_off=5", "two values of pull_off"),
        ("pull_off=4", "pulloff=4", "no key 'pulloff'"),
        ("position=1", "position=-100", "is outside of travel"),
    ] {
        let (folder, ran) = write(&text, &x.replacen(old, new, 1));
        ran.refuses(words);
        assert!(!folder.path("out").exists(), "{words}");
    }
    write(&text, &format!("{x} {x}")).1.refuses("it has two");
    let both = format!("{x} {}", z.replace("input=1", "input=2"));
    write(&text, &both).1.refuses("input 2 is that of another axis");
}

#[test]
fn existing_files_stay_unless_they_may_be_replaced() {
    let folder = Folder::new();
    folder.write("mill.toml", MILL);
    std::fs::create_dir(folder.path("out")).unwrap();
    folder.write("out/mill.tbl", "T1 P1 D3\n");
    let command = "linuxcnc --machine mill.toml --out out";
    folder.run(command).refuses("mill.tbl is there already");
    assert_eq!(read(&folder, "out/mill.tbl"), "T1 P1 D3\n");
    assert!(!folder.path("out/mill.ini").exists(), "all files or none");
    assert_eq!(folder.run(&format!("{command} --force")).status, 0);
    assert!(read(&folder, "out/mill.tbl").contains("no tool"));
    folder.run(command).refuses("mill.ini is there already");
}

#[test]
fn sources_of_the_component_are_written_on_request() {
    let (folder, ran) = write(MILL, "--component");
    assert_eq!(ran.status, 0, "{}", ran.stderr);
    for (name, text) in carrystep_linuxcnc::component() {
        assert_eq!(read(&folder, &format!("out/component/{name}")), text);
    }
}

/// Segments are as short, and the horizon as long, as line and queues allow.
#[test]
fn segments_and_horizon_fit_line_and_queues() {
    let link = |baud: u32| format!("[machine.link]\nbaud = {baud}\n{MILL}");
    let rows = [
        (MILL.to_owned(), "", Ok((4, 40))),
        (MILL.to_owned(), "--horizon-ms 120", Ok((4, 120))),
        (MILL.to_owned(), "--horizon-ms 200", Ok((8, 200))),
        (MILL.replace("queue_depth = 31", "queue_depth = 7"), "", Ok((8, 40))),
        (MILL.to_owned(), "--horizon-ms 600", Err("at most 496 ms with this queue_depth")),
        (MILL.to_owned(), "--horizon-ms 5", Err("at least 8 ms")),
        (link(230_400), "", Ok((16, 80))),
        (link(115_200), "", Err("the line is too slow: segments of 3 joints in 16 ms")),
        (link(250_000), "", Err("one of 115200, 230400")),
    ];
    for (text, options, wanted) in rows {
        let (folder, ran) = write(&text, options);
        match wanted {
            Ok((periods, horizon)) => {
                assert_eq!(ran.status, 0, "{options}: {}", ran.stderr);
                let hal = read(&folder, "out/mill.hal");
                let words = format!("periods={periods} horizon={horizon} ");
                assert!(hal.contains(&words), "{words}: {hal}");
            }
            Err(words) => {
                ran.refuses(words);
                assert!(!folder.path("out").exists());
            }
        }
    }
}

#[test]
fn machines_that_linuxcnc_cannot_have_are_refused_by_name() {
    let rows = [
        ("name = \"x\"", "name = \"left\"", "axis 'left' has no letter"),
        ("name = \"z\"", "name = \"X\"", "two axes have the letter X"),
        ("unit = \"deg\"", "unit = \"mm\"", "axis 'A' is in mm: LinuxCNC has it in deg"),
        ("unit = \"deg\"\n", "", "name"),
        ("queue_depth = 31", "queue_depth = 31\nphase = \"zero\"", "phase = \"zero\""),
        ("queue_depth = 31", "tick_ns = 250\nqueue_depth = 31", "mill.toml"),
    ];
    for (old, new, words) in rows {
        // z stands behind x in the home order, too.
        let text = MILL.replacen(old, new, 1).replace("[[\"z\"], [\"x\"]]", "[]");
        let text = text.replace("home_order = []\n", "");
        if words == "name" {
            // A rotary axis without a unit is taken to be in degrees.
            assert_eq!(write(&text, "").1.status, 0);
            continue;
        }
        let (folder, ran) = write(&text, "");
        ran.refuses(words);
        assert!(!folder.path("out").exists(), "{words}");
    }
    let inches = MILL.replacen("unit = \"mm\"", "unit = \"inch\"", 1);
    write(&inches, "").1.refuses("axis 'z' is in mm, and an axis before it is not");
    let (folder, ran) = write(&MILL.replace("unit = \"mm\"", "unit = \"inch\""), "");
    assert_eq!(ran.status, 0, "{}", ran.stderr);
    assert_eq!(value(&read(&folder, "out/mill.ini"), "TRAJ", "LINEAR_UNITS"), "inch");
    let axis = &MILL[MILL.find("[[machine.axis]]").unwrap()..];
    let nine = (0..9).map(|number| {
        axis.split("travel").next().unwrap().replace("\"x\"", &format!("\"x{number}\""))
    });
    write(&format!("[machine]\n{}", nine.collect::<String>()), "").1.refuses("at most 8");
    write(MILL, "--port /dev/tty\tX").1.refuses("cannot stand in LinuxCNC's files");
    write(MILL, "--display a;b").1.refuses("cannot stand in LinuxCNC's files");
}
