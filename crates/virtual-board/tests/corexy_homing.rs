//! Homing of two crossed belts: both motors move a letter to its switch, stop at it in the same tick,
//! and the letter ends at its place, from any start and however the other letter stands.

use crate::asked::homing_of;
use crate::axes::{Bench, Make, Never, Start, machine};
use crate::random::Random;
use crate::repeats;
use carrystep_files::Machine;
use carrystep_files::machine::{End, overrun};
use carrystep_link::{Homed, HomingFault, HostError, Wish};
use carrystep_virtual_board::{ModelBoard, SimulatedBoard, VerilatedBoard};

/// Crossed belts and z. The axes stand in this order, and x and y home toward these ends.
fn belts(order: [&str; 3], toward: [&str; 2], stop: &str) -> Machine {
    let axis = |name: &str| {
        let toward = match name {
            "x" => toward[0],
            "y" => toward[1],
            _ => "max",
        };
        let position = if toward == "min" { 0 } else { 60 };
        format!(
            "[[machine.axis]]\nname = \"{name}\"\nsteps_per_unit = 10\nspeed_limit = 200\n\
             accel_limit = 4000\nstop_accel = 8000\ndriver = \"a4988\"\ntravel = [0, 60]\n\
             home = {{ toward = \"{toward}\", seek_speed = 150, slow_speed = 8, move_off = 8, \
             max_travel = 90, pull_off = 1, position = {position} }}\n"
        )
    };
    machine(&format!(
        "[machine]\nclock_hz = 8_000_000\ntick_ns = 8000\nkinematics = \"corexy\"\n\
         home_order = [[\"z\", \"y\"], [\"x\"]]\n\
         [machine.guard]\nwatchdog_ms = 60\nenable_ms = 1\ndebounce_us = 400\nlimits = \"one\"\n\
         limit_stop = \"{stop}\"\n[machine.link]\nbaud = 500_000\n{}",
        order.map(axis).concat()
    ))
}

const XYZ: [&str; 3] = ["x", "y", "z"];

/// Homes. The places of the letters at which their switches were found, in steps of one motor after
/// the other.
fn home<B: Make>(bench: &Bench<B>, machine: &Machine) -> Result<[i32; 8], HostError<Never>> {
    let mut host = bench.connect(machine);
    host.enable().unwrap();
    let homing = homing_of(machine);
    let homed = host.home(&homing.as_homing(), |_, _, _| Wish::GoOn);
    let answer = host.read_status().unwrap().answer;
    assert!(answer.idle && !answer.fault && answer.seeking == 0, "{answer:?}");
    let Homed::At(edges) = homed? else { panic!("stopped") };
    Ok(edges)
}

/// Homes as often as this kind of board does, and compares where the letters are with where their
/// switches are.
fn homes<B: Make>(machine: &Machine, starts: &[Start; 3], seed: u64) {
    let what = format!("{starts:?}, seed {seed}");
    let bench = Bench::<B>::new(machine, starts, seed);
    for again in 0..B::homes() {
        let edges =
            home(&bench, machine).unwrap_or_else(|error| panic!("{what}, {again}: {error}"));
        let round = u128::from(machine.guard.round);
        let ticks = (u128::from(machine.guard.debounce) + 1) * round + 4 + round;
        for (axis, &edge) in edges.iter().enumerate().take(3) {
            let home = machine.axes[axis].home.unwrap();
            let sign = if home.toward == End::Max { 1 } else { -1 };
            let edge = edge.div_euclid(machine.motors_of(axis).count_ones() as i32);
            // The switch is accepted behind the place where it closes, by the distance at the slow
            // speed until then, and rounding.
            let late = ((u128::from(home.slow) * ticks) >> 64) as i32 + 1;
            let beyond = (edge - bench.edge(axis)) * sign;
            assert!(
                (-1..=late).contains(&beyond),
                "{what}, {again}: axis {axis} is {beyond} beyond"
            );
            let off = (bench.place(axis) - edge) * -sign - home.pull_off as i32;
            assert!(off.abs() <= 1, "{what}, {again}: axis {axis} rests {off} off");
            let ran = overrun(home.seek, machine.axes[axis].stop, &machine.guard) as i32;
            let slice = ((u128::from(home.seek) * u128::from(bench.slice_ticks())) >> 64) as i32;
            let most = (ran + slice + 2).max(bench.stood(axis));
            assert!(bench.deepest(axis) <= most, "{what}: axis {axis}, {}", bench.deepest(axis));
        }
    }
}

#[test]
fn letters_of_crossed_belts_home_from_every_start() {
    let mut random = Random::new(11);
    let starts = [Start::Open, Start::Closed, Start::Bouncing];
    for (number, toward) in
        [["min", "min"], ["min", "max"], ["max", "min"], ["max", "max"]].into_iter().enumerate()
    {
        let order = [XYZ, ["z", "y", "x"], ["y", "z", "x"]][number % 3];
        let stop = if number % 2 == 0 { "ramp" } else { "freeze" };
        let machine = belts(order, toward, stop);
        homes::<ModelBoard>(&machine, &[Start::Open; 3], number as u64);
        for seed in 0..repeats::part(2, 2) {
            let any = [0; 3].map(|_| starts[random.below(3) as usize]);
            homes::<ModelBoard>(&machine, &any, seed);
        }
    }
}

#[test]
fn letters_of_crossed_belts_home_on_a_board_of_verilog() {
    homes::<VerilatedBoard>(&belts(XYZ, ["min", "max"], "ramp"), &[Start::Open; 3], 3);
}

/// The tool stays on the line along which it homes: the other letter does not move.
#[test]
fn both_motors_stop_together_at_the_switch() {
    let machine = belts(XYZ, ["min", "max"], "ramp");
    let bench = Bench::<ModelBoard>::new(&machine, &[Start::Open; 3], 5);
    let mut host = bench.connect(&machine);
    host.enable().unwrap();
    let homing = homing_of(&machine);
    let mut homing = homing.as_homing();
    homing.groups = &[1];
    let place = |bench: &Bench<ModelBoard>| {
        let [a, b] = [0, 1].map(|motor| bench.board().position(motor));
        (a - b, a + b)
    };
    let (y, x) = place(&bench);
    // The positions of all axes in one tick are those of a snapshot.
    let (mut looks, mut off) = (0, 0);
    let homed = host.home(&homing, |moving, _, progress| {
        if let (1, Some(snapshot)) = (moving, progress.snapshot) {
            let [a, b, ..] = snapshot.axes.map(|axis| axis.commanded());
            looks += 1;
            off = off.max((a - b - y).abs());
        }
        Wish::Snapshot
    });
    assert!(matches!(homed.unwrap(), Homed::At(_)));
    assert!(looks > 10 && off == 0, "{looks} looks, {off} steps off");
    assert_eq!(place(&bench).0, y);
    assert_ne!(place(&bench).1, x);
}

#[test]
fn dead_switch_of_a_letter_is_named_and_both_motors_have_gone_max_travel() {
    let machine = belts(XYZ, ["min", "max"], "ramp");
    for (axis, signs) in [(0, [-1, -1]), (1, [1, -1])] {
        let bench = Bench::<ModelBoard>::new(&machine, &[Start::Open; 3], 5);
        bench.remove(axis);
        bench.remove(2);
        let mut host = bench.connect(&machine);
        host.enable().unwrap();
        let begun = [0, 1].map(|motor| bench.board().position(motor));
        let homing = homing_of(&machine);
        let mut homing = homing.as_homing();
        let group = [1 << axis];
        homing.groups = &group;
        let error = host.home(&homing, |_, _, _| Wish::GoOn).unwrap_err();
        let axes = 1 << axis;
        assert_eq!(error, HostError::Homing { axes, why: HomingFault::NotFound });
        // 80 steps off before the search, and 900 back.
        let moved = [0, 1].map(|motor| bench.board().position(motor) - begun[motor]);
        assert_eq!(moved, signs.map(|sign| sign * (900 - 80)));
    }
}
