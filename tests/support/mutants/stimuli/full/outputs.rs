//! Recordings of the outputs and of the PWM.

use super::super::Stimulus;
use super::super::cruise::{TICK, cruise};
use super::{THEN, numbers, sorted};
use carrystep_core::{AXES, Command, EngineBuild, OutputChange, Program, Segment};
use carrystep_simulators::engine::{Event, Events};

/// Clocks of a period of the PWM.
const PERIOD: u64 = 3 * 4096;

pub(super) fn all(build: &EngineBuild) -> Vec<Stimulus> {
    let exist = build.outputs.exist;
    let mut all = vec![
        Stimulus::new(build, "outputs in every slot", &in_every_slot(exist), &Events::new()),
        Stimulus::new(build, "duties", &duties(), &Events::new()),
        Stimulus::new(build, "outputs of single starts", &single_starts(exist), &Events::new()),
        off(
            build,
            "outputs in a ramp",
            &[(THEN, Event::Stop(true)), (THEN + 1, Event::Stop(false))],
        ),
        off(build, "outputs in a freeze", &[(THEN + 7, Event::Broken)]),
        off(
            build,
            "outputs without power",
            &[(THEN, Event::Enable(false)), (THEN + 60 * TICK, Event::Enable(true))],
        ),
        off(
            build,
            "outputs in a reset",
            &[(THEN, Event::Reset(true)), (THEN + 1, Event::Reset(false))],
        ),
        dropped(build),
    ];
    all.extend([0, 1, 5].map(|axis| stray_bits(build, axis)));
    all
}

fn segment(axis: u8, ticks: u32, last: bool) -> Command {
    let v = if axis.is_multiple_of(2) { 1 << 57 } else { -(1 << 57) };
    Command::Segment { axis, segment: Segment { ticks, v, a: 0, j: 0, last } }
}

/// Segments of axis 0 with changes of any outputs, of other outputs, and with none, through the
/// queue's whole memory several times. Axis 1 runs beside it.
fn in_every_slot(exist: u8) -> Program {
    let mut numbers = numbers();
    let mut next = || numbers.next().unwrap_or_default();
    let mut program = vec![segment(1, 600, true)];
    for place in 0..45_u8 {
        let (mask, levels) = (next() as u8 & exist, next() as u8 & exist);
        match place {
            // Each output alone, first on and then off.
            0..16 => {
                let levels = if place < 8 { exist } else { 0 };
                program.push(outputs(exist & 1 << (place % 8), levels, None));
            }
            // Levels without a mask, and a duty beside them.
            20 | 30 => program.push(outputs(0, exist, None)),
            25 => program.push(outputs(0, levels, Some(2000))),
            35 | 36 => {}
            _ => program.push(outputs(mask, levels, None)),
        }
        program.push(segment(0, 9 + (next() % 5) as u32, place == 44));
        if place == 4 {
            program.push(Command::Start { mask: 3 });
        }
    }
    program
}

fn outputs(mask: u8, levels: u8, duty: Option<u16>) -> Command {
    Command::Outputs(OutputChange { mask, levels, duty })
}

/// Duties of every kind, which change wherever the counter is in its period: with small and great
/// counts, just above and just below the count, and for longer than a period.
fn duties() -> Program {
    let mut numbers = numbers();
    let mut next = || numbers.next().unwrap_or_default();
    let mut program = Program::new();
    let long = (PERIOD / TICK) as u32 + 12;
    let fixed = [(4095, long), (1, long), (4094, long), (0, 40), (2048, long), (2047, 70)];
    let single = (0..12).map(|bit| (1 << bit, 20 + 3 * bit));
    let any = (0..40).map(|_| ((next() % 4096) as u16, 9 + (next() % 60) as u32));
    let all: Vec<(u16, u32)> = fixed.into_iter().chain(single).chain(any).collect();
    for (place, (duty, ticks)) in all.iter().enumerate() {
        program.push(outputs(0, 0, Some(*duty)));
        program.push(segment(0, *ticks, place + 1 == all.len()));
        if place == 3 {
            program.push(Command::Start { mask: 1 });
        }
    }
    program
}

/// Each segment is a move of its own. Other axes are started too, and axis 0 rests meanwhile.
fn single_starts(exist: u8) -> Program {
    let mut program = Program::new();
    for place in 0..12_u8 {
        program.push(outputs(exist, 0x5a_u8.rotate_left(place.into()) & exist, Some(341 * 11)));
        program.push(segment(0, 3, true));
        program.push(segment(4, 7, true));
        // Now and then axis 0 is not among the axes that start.
        let mask = if place % 4 == 3 { 0b1_0000 } else { 0b1_0001 };
        program.push(Command::Start { mask });
        if mask & 1 == 0 {
            program.extend([Command::Wait { clocks: 9 * TICK as u32 }, Command::Start { mask: 1 }]);
        }
        program.push(Command::Wait { clocks: 12 * TICK as u32 });
    }
    program
}

/// All outputs and the PWM are on when something turns them off. The first segments afterwards
/// turn them on again.
fn off(build: &EngineBuild, name: &str, events: &[(u64, Event)]) -> Stimulus {
    let on = outputs(build.outputs.exist, 0xff, Some(4095));
    let mut program = vec![on, segment(0, 50, false), on, segment(0, 20, true)];
    program.extend([segment(3, 70, true), Command::Start { mask: 0b1001 }]);
    program.extend([Command::Wait { clocks: 130 * TICK as u32 }, Command::Clear]);
    // The program has waited for so long that the stop is over; a move without a change shows that
    // the outputs stay off.
    program.extend([segment(0, 5, true), Command::Start { mask: 1 }]);
    program.extend([Command::Wait { clocks: 20 * TICK as u32 }, on]);
    program.extend([segment(0, 5, true), Command::Start { mask: 1 }]);
    Stimulus::new(build, name, &program, &sorted(events.to_vec()))
}

/// A seek of axis 0 drops segments that would change outputs, and so does the clear of a stop; the
/// segments that come into the same slots afterwards do not change them.
fn dropped(build: &EngineBuild) -> Stimulus {
    let on = outputs(build.outputs.exist, 0xff, Some(4095));
    let mut program = Program::new();
    for _ in 0..2 {
        program.push(segment(0, 30, false));
        for place in 0..6 {
            program.extend([on, segment(0, 30, place == 5)]);
        }
        program.extend([Command::Start { mask: 1 }, Command::Wait { clocks: 60 * TICK as u32 }]);
        program.extend([Command::Clear, Command::Wait { clocks: 12 * TICK as u32 }]);
        (0..7).for_each(|place| program.push(segment(0, 4, place == 6)));
        program.extend([Command::Start { mask: 1 }, Command::Wait { clocks: 40 * TICK as u32 }]);
    }
    let events = vec![(THEN, Event::Stop(true)), (THEN + 1, Event::Stop(false))];
    Stimulus::new(build, "outputs of dropped segments", &program, &events)
}

/// A commit has one of its bits set, each in turn, whether or not the build has what the bit is
/// about. After each fault follows a clear.
fn stray_bits(build: &EngineBuild, axis: u8) -> Stimulus {
    let mut program = Program::new();
    let mut events = Events::new();
    let step = 34 * TICK;
    for bit in 1..32_u8 {
        let at = u64::from(bit) * step;
        events.push((at - step / 2, Event::Stray(1 << bit)));
        // The start takes the segment out of the queue if the bit is no fault.
        program.extend([segment(axis, 3, true), Command::Start { mask: 1 << axis }]);
        // One word is taken in a tick; the stop and its clear take some more.
        program.extend([Command::Wait { clocks: 12 * TICK as u32 }, Command::Clear]);
        program.push(Command::Wait { clocks: 9 * TICK as u32 });
    }
    events.push((33 * step, Event::Stray(0)));
    program.extend(cruise(5, [1 << 57; AXES]));
    Stimulus::new(build, format!("stray bits of axis {axis}"), &program, &sorted(events))
}
