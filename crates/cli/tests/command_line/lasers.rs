//! Programs on machines with a laser: the pin of the PWM in simulations, captures, and on boards.

use crate::command::Folder;
use crate::run_programs::{MACHINE, begins, done, folder, hold, resume, run, waits};
use crate::schemas;
use crate::sender::{Sender, Served};
use crate::stops::moving;
use crate::virtual_boards::{Board, passed};
use std::time::Duration;

const JOB: &str = "G21 G90\nM8\nM4 S600\nG1 X1 F2400\nG1 Y1 S900\nG0 X0\nM3 S250\nG1 Y0\nM5 M9\n";

/// The machine with a laser instead of its spindle, and a pump.
fn laser(machine: &str) -> String {
    let keys = "flood = 0\npwm_divider = 2\nspindle_rpm = 1000\nlaser = true\n";
    machine.replace("spindle = 0\n", keys)
}

fn laser_folder(job: &str) -> Folder {
    let folder = folder(job);
    folder.write("machine.toml", laser(MACHINE));
    folder
}

fn read(folder: &Folder, name: &str) -> String {
    std::fs::read_to_string(folder.path(name)).unwrap()
}

/// The code of a signal in a VCD.
fn code<'a>(vcd: &'a str, name: &str) -> &'a str {
    let declared = vcd.lines().find(|line| line.contains(&format!(" {name} "))).unwrap();
    declared.split_whitespace().nth(3).unwrap()
}

/// The time in ps of each edge of the PWM's pin, and its level.
fn edges(vcd: &str) -> Vec<(u64, bool)> {
    let (code, mut time, mut found) = (code(vcd, "pwm"), 0, Vec::new());
    for line in vcd.lines() {
        match line.strip_prefix('#') {
            Some(ps) => time = ps.parse().unwrap(),
            None if time > 0 && line.get(1..) == Some(code) => {
                found.push((time, line.starts_with('1')));
            }
            None => {}
        }
    }
    found
}

#[test]
fn levels_agree_about_the_pin_of_the_pwm() {
    let folder = laser_folder("G21 G90\nM4 S600\nG1 X0.3 F3000\nM5\n");
    let pin = |level: &str| {
        let ran = folder.run(&format!(
            "simulate job.ngc --machine machine.toml --json --level {level} --vcd {level}.vcd"
        ));
        assert_eq!(ran.status, 0, "{}{}", ran.stdout, ran.stderr);
        let report = schemas::check(&ran.stdout)["pwm"].clone();
        (report, edges(&read(&folder, &format!("{level}.vcd"))))
    };
    let fast = pin("fast");
    assert_eq!((&fast.0["passed"], &fast.0["longest_ns"]), (&true.into(), &0.0.into()));
    assert!(fast.1.len() > 100 && fast.0["duties"].as_u64() > Some(3), "{:?}", fast.0);
    assert_eq!(pin("model"), fast);
    assert_eq!(pin("verilator"), fast);
}

#[test]
fn capture_shows_a_pin_that_is_wrong() {
    let folder = laser_folder(JOB);
    passed(&folder.run("simulate job.ngc --machine machine.toml --vcd a.vcd"));
    let check = |options: &str| {
        folder.run(format!("check b.vcd job.ngc --machine machine.toml {options}").trim_end())
    };
    let vcd = read(&folder, "a.vcd");
    folder.write("b.vcd", &vcd);
    let ran = check("--json");
    passed(&ran);
    let report = schemas::check(&ran.stdout)["check"]["pwm"].clone();
    assert_eq!((&report["passed"], &report["longest_ns"]), (&true.into(), &0.0.into()));

    // The pin of another program: the same path, at another power and in another mode.
    for other in [JOB.replace("S600", "S601"), JOB.replace("M4", "M3"), JOB.replace("S250", "S0")] {
        folder.write("other.ngc", other);
        passed(&folder.run("simulate other.ngc --machine machine.toml --vcd b.vcd"));
        let ran = check("");
        assert_eq!(ran.status, 1, "{}{}", ran.stdout, ran.stderr);
        assert!(
            ran.stdout.contains("the pin of the PWM has the wrong level for"),
            "{}",
            ran.stdout
        );
    }

    // A capture by others: its counter is 0 anywhere.
    let foreign =
        vcd.replace("carrystep origin_ps", "made at").lines().fold(String::new(), |text, line| {
            match line.strip_prefix('#').and_then(|ps| ps.parse::<u64>().ok()) {
                Some(ps) if ps > 0 => text + &format!("#{}\n", ps + 777_777),
                _ => text + line + "\n",
            }
        });
    folder.write("b.vcd", &foreign);
    let ran = check("");
    passed(&ran);
    assert!(ran.stdout.contains("PWM: ") && !ran.stdout.contains("not checked"), "{}", ran.stdout);
    let ran = check("--path-only");
    assert!(ran.status == 0 && !ran.stdout.contains("PWM: "), "{}", ran.stdout);

    // Under another name.
    folder.write("b.vcd", foreign.replace(" pwm ", " d7 "));
    let ran = check("");
    assert!(ran.stdout.contains("not checked: the PWM; the capture does not"), "{}", ran.stdout);
    passed(&ran);
    let ran = check("--map pwm=carrystep.d7");
    assert!(ran.status == 0 && ran.stdout.contains("PWM: "), "{}", ran.stdout);
    folder.write("machine.toml", MACHINE);
    let ran = check("--map pwm=carrystep.d7");
    assert!(ran.status == 2 && ran.stderr.contains("on machines that have one"), "{}", ran.stderr);
}

#[test]
fn board_has_the_pin_of_the_plan() {
    let folder = laser_folder(JOB);
    let board = Board::new(&folder, "--vcd a.vcd --fast");
    passed(&run(&folder, &board, ""));
    board.end();
    let ran = folder.run("check a.vcd job.ngc --machine machine.toml");
    passed(&ran);
    assert!(ran.stdout.contains("another level for at most 0.0 ns"), "{}", ran.stdout);
}

/// A path of some 20 seconds with the same power everywhere.
const LONG: &str = "G21 G90 G64 P0.02 F1800\nM3 S500\no1 repeat [6]\nG1 X4 Y4\nG3 X4 Y4 I-3 J1\n\
    G1 X-4 Z0.4\nG1 X0 Y0 Z0\no1 endrepeat\nM2\n";

/// In a hold, and at the end without `M5`, the laser is off where the tool rests.
#[test]
fn laser_is_off_where_a_hold_rests() {
    let folder = laser_folder(LONG);
    let deep = "[machine]\nqueue_depth = 31\ncuts = true\n";
    folder.write("machine.toml", laser(&MACHINE.replacen("[machine]\n", deep, 1)));
    let board = Board::new(&folder, "--vcd a.vcd --fast");
    let mut child = begins(&folder, &board);
    moving(&folder, &mut child, &board.port);
    passed(&hold(&folder, &board));
    waits(&folder, &board, &mut child);
    // While the tool rests, the board's time goes on by at most 25 ms for each read of the host,
    // which on a busy computer come late. Each second has many of them.
    std::thread::sleep(Duration::from_secs(1));
    passed(&resume(&folder, &board));
    done(child);
    board.end();
    let vcd = read(&folder, "a.vcd");
    passed(&folder.run("check a.vcd job.ngc --machine machine.toml --path-only"));
    let axes = vcd.lines().filter(|line| line.contains(" step "));
    let codes: Vec<_> = axes.map(|line| line.split_whitespace().nth(3).unwrap()).collect();
    let (mut time, mut steps) = (0, vec![0]);
    for line in vcd.lines() {
        match line.strip_prefix('#') {
            Some(ps) => time = ps.parse().unwrap(),
            None if line.get(1..).is_some_and(|code| codes.contains(&code)) => steps.push(time),
            None => {}
        }
    }
    let edges = edges(&vcd);
    assert!(edges.len() > 1000 && edges.last().is_some_and(|(_, level)| !level));
    // Between two steps that are so far apart, the tool rests. The light goes off before it rests,
    // and may come a little before the first step behind.
    let (rest, slow) = (75_000_000_000, 30_000_000_000);
    let rests: Vec<_> = steps.windows(2).filter(|two| two[1] - two[0] > rest).collect();
    assert!(!rests.is_empty());
    for two in rests {
        let dark = two[0] + slow..two[1] - slow;
        let light = edges.iter().find(|(ps, _)| dark.contains(ps));
        assert_eq!(light, None, "the tool rests from {} to {} ps", two[0], two[1]);
    }
}

/// At half of the feed, and with the power at 80 %, the beam has 40 % of its power.
#[test]
fn power_follows_the_speed_under_an_override() {
    let folder = laser_folder("G21 G90\nM4 S500\nM0\nG1 X6 F1800\nM2\n");
    let board = Board::new(&folder, "--vcd a.vcd --fast");
    let mut child = begins(&folder, &board);
    waits(&folder, &board, &mut child);
    passed(&folder.run(&format!("override --feed 50 --spindle 80 --port {}", board.port)));
    passed(&resume(&folder, &board));
    done(child);
    board.end();
    let edges = edges(&read(&folder, "a.vcd"));
    let middle = &edges[edges.len() / 3 / 2 * 2..];
    let (rise, fall, next) = (middle[0].0, middle[1].0, middle[2].0);
    assert!(middle[0].1);
    let part = (fall - rise) as f64 / (next - rise) as f64;
    assert!((part - 0.5 * 0.5 * 0.8).abs() < 0.001, "{part}");
}

/// Each line of a sender that waits is planned by itself. The power is in force until another one
/// is said, and a jog is dark.
#[test]
fn power_of_a_sender_stays_in_force() {
    let folder = laser_folder("");
    let board = Board::new(&folder, "--vcd a.vcd --fast");
    let served = Served::with(&folder, &format!("--port {}", board.port));
    let mut sender = Sender::tcp(&served);
    assert!(sender.ask("$$").contains(&"$32=1".to_owned()));
    sender.simple("M4 S500\nG1 X1 F1800");
    sender.place();
    sender.simple("G1 X2");
    sender.place();
    sender.simple("$J=G91 X1 F1800");
    sender.place();
    sender.simple("G1 X4");
    assert_eq!(sender.place(), [4.0, 0.0, 0.0]);
    assert_eq!(served.interrupt().0, 0);
    board.end();
    let vcd = read(&folder, "a.vcd");
    let (pwm, x) = (code(&vcd, "pwm"), code(&vcd, "position"));
    let (mut steps, mut lit) = (0, Vec::new());
    for line in vcd.lines() {
        if let Some(bits) =
            line.strip_prefix('b').and_then(|line| line.strip_suffix(&format!(" {x}")))
        {
            steps = u32::from_str_radix(bits, 2).unwrap();
        } else if line.get(1..) == Some(pwm) && line.starts_with('1') {
            lit.push(steps);
        }
    }
    // The motion is slow at its ends, where steps are long.
    let of = |mm: u32| lit.iter().filter(|&&at| (mm * 80 + 5..mm * 80 + 75).contains(&at)).count();
    let [first, second, jog, last] = [of(0), of(1), of(2), of(3)];
    assert!(first > 100 && second > 100 && last > 100, "{first} {second} {last}");
    assert_eq!(jog, 0);
}
