//! Homing of a letter with two motors, each with a switch of its own: the motors end square, however
//! skew they begin, and a motor does not move further alone than the machine file allows.

use crate::asked::homing_of;
use crate::axes::{self, Bench, Make, Start, machine};
use crate::random::Random;
use crate::repeats;
use carrystep_files::Machine;
use carrystep_files::machine::End;
use carrystep_link::{Homed, HomingFault, HostError, Wish};
use carrystep_virtual_board::{ModelBoard, SimulatedBoard, VerilatedBoard};

/// How far one motor may move alone, steps.
const MOST_APART: i32 = 60;

/// A gantry with a motor at each side, toward one end, and an axis between them. The second motor's
/// switch closes 4 steps further up when the gantry is square.
fn gantry(limits: &str, toward: &str) -> Machine {
    let (positions, pulls) = match toward {
        "min" => ([0.0, 0.4], [1.0, 0.6]),
        _ => ([60.0, 60.4], [1.0, 1.4]),
    };
    let motor = |name: &str, number: usize| {
        format!(
            "[[machine.axis]]\nname = \"{name}\"\nletter = \"y\"\nsteps_per_unit = 10\nspeed_limit = 200\n\
             accel_limit = 4000\nstop_accel = 8000\ndriver = \"a4988\"\ntravel = [-1, 61]\nhome = {{ toward = \
             \"{toward}\", seek_speed = 150, slow_speed = 8, move_off = 8, max_travel = 90, pull_off = {:?}, \
             position = {:?}, most_apart = 6 }}\n",
            pulls[number], positions[number]
        )
    };
    let x = "[[machine.axis]]\nname = \"x\"\nsteps_per_unit = 10\nspeed_limit = 200\naccel_limit = 4000\n\
             stop_accel = 8000\ndriver = \"a4988\"\ntravel = [0, 60]\nhome = { toward = \"min\", seek_speed = 150, \
             slow_speed = 8, pull_off = 1, position = 0 }\n";
    machine(&format!(
        "[machine]\nclock_hz = 8_000_000\ntick_ns = 8000\nhome_order = [[\"x\", \"y\"]]\n[machine.guard]\n\
         watchdog_ms = 60\nenable_ms = 1\ndebounce_us = 400\nlimits = \"{limits}\"\n[machine.link]\n\
         baud = 500_000\n{}{x}{}",
        motor("y", 0),
        motor("y2", 1)
    ))
}

/// Homes. The machine places of the two motors at the end, or the error; then the positions.
fn home<B: Make>(bench: &Bench<B>, machine: &Machine) -> Result<[i64; 2], HostError<axes::Never>> {
    let mut host = bench.connect(machine);
    host.enable().unwrap();
    let homing = homing_of(machine);
    let homed = host.home(&homing.as_homing(), |_, _, _| Wish::GoOn);
    let answer = host.read_status().unwrap().answer;
    assert!(answer.idle && !answer.fault && answer.seeking == 0, "{answer:?}");
    let Homed::At(edges) = homed? else { panic!("stopped") };
    Ok([0, 2].map(|motor| {
        let home = machine.axes[motor].home.unwrap();
        i64::from(host.status().positions[motor]) + home.position - i64::from(edges[motor])
    }))
}

/// Where the motors are, relative to where they would be in a square gantry: steps from the switch
/// of each, less what the file says.
fn skew<B: Make>(bench: &Bench<B>, machine: &Machine) -> i32 {
    let [first, second] = [0, 2].map(|motor| {
        let position = machine.axes[motor].home.unwrap().position as i32;
        bench.board().position(motor) - bench.edge(motor) + position
    });
    second - first
}

/// A bench whose gantry begins this skew, steps.
fn skewed<B: Make>(machine: &Machine, start: Start, by: i32, seed: u64) -> Bench<B> {
    let bench = Bench::<B>::new(machine, &[start, Start::Open, Start::Open], seed);
    let [first, second] = [0, 2].map(|motor| machine.axes[motor].home.unwrap().position as i32);
    bench.put_edge(2, bench.edge(0) + second - first - by);
    bench
}

fn squares<B: Make>(machine: &Machine, start: Start, by: i32, seed: u64) {
    let what = format!("{:?}, {start:?}, skew by {by}, seed {seed}", machine.guard.limits);
    let bench = skewed::<B>(machine, start, by, seed);
    assert_eq!(skew(&bench, machine), by, "{what}");
    for again in 0..B::homes() {
        let places =
            home(&bench, machine).unwrap_or_else(|error| panic!("{what}, {again}: {error}"));
        let rests = machine.axes[0].home.unwrap().rests();
        assert_eq!(places, [rests; 2], "{what}, {again}");
        // Each switch is accepted within a step of where the other one is.
        assert!(skew(&bench, machine).abs() <= 1, "{what}, {again}: {}", skew(&bench, machine));
    }
}

#[test]
fn gantry_is_square_behind_homing_however_skew_it_begins() {
    let mut random = Random::new(7);
    for limits in ["pair", "each"] {
        for toward in ["min", "max"] {
            let machine = gantry(limits, toward);
            assert_eq!(machine.axes[0].home.unwrap().toward == End::Max, toward == "max");
            for seed in 0..repeats::part(2, 2) {
                let by = random.below(90) as i32 - 45;
                squares::<ModelBoard>(&machine, Start::Open, by, seed);
            }
            // The first motor stands on its switch. The second one may, less deep: from deeper,
            // moving off would not open its switch.
            let open = if toward == "min" { 1 } else { -1 };
            squares::<ModelBoard>(&machine, Start::Closed, 20 * open, 11);
        }
    }
}

#[test]
fn gantry_of_verilog_is_square_behind_homing() {
    squares::<VerilatedBoard>(&gantry("pair", "min"), Start::Open, 25, 3);
}

#[test]
fn motor_whose_switch_is_dead_does_not_go_on_alone() {
    for limits in ["pair", "each"] {
        for (dead, other) in [(0, 2), (2, 0)] {
            let machine = gantry(limits, "min");
            let bench = skewed::<ModelBoard>(&machine, Start::Open, 0, 5);
            bench.remove(dead);
            let begun = skew(&bench, &machine);
            let error = home(&bench, &machine).unwrap_err();
            let axes = 1 << dead;
            assert_eq!(error, HostError::Homing { axes, why: HomingFault::Apart }, "{limits}");
            let moved = (skew(&bench, &machine) - begun).abs();
            // A ramp from 1500 steps/s at 80 000 steps/s^2, and 1500 steps/s until the host has seen a
            // snapshot: 50 ms, of which it takes half.
            let (ramp, looks) = (14, 75);
            assert!(
                (MOST_APART..MOST_APART + ramp + looks).contains(&moved),
                "{limits}, {other}: {moved}"
            );
        }
    }
}

#[test]
fn gantry_that_begins_too_skew_is_refused() {
    let machine = gantry("pair", "min");
    let bench = skewed::<ModelBoard>(&machine, Start::Open, 150, 5);
    let error = home(&bench, &machine).unwrap_err();
    assert_eq!(error, HostError::Homing { axes: 4, why: HomingFault::Apart });
}

#[test]
fn gantry_without_any_switch_ends_at_max_travel_square() {
    let machine = gantry("pair", "min");
    let bench = skewed::<ModelBoard>(&machine, Start::Open, 3, 5);
    bench.remove(0);
    bench.remove(2);
    let error = home(&bench, &machine).unwrap_err();
    assert_eq!(error, HostError::Homing { axes: 5, why: HomingFault::NotFound });
    assert_eq!([0, 2].map(|motor| bench.board().position(motor)), [-900; 2]);
}

#[test]
fn switch_that_stays_closed_moves_both_motors_off_and_is_named() {
    let machine = gantry("pair", "min");
    let bench = skewed::<ModelBoard>(&machine, Start::Open, 0, 5);
    bench.stick(2);
    let error = home(&bench, &machine).unwrap_err();
    assert_eq!(error, HostError::Homing { axes: 4, why: HomingFault::StillClosed });
    assert_eq!([0, 2].map(|motor| bench.board().position(motor)), [80; 2]);
}
