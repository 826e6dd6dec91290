//! Recordings of seeks: by every switch, of single axes and of all; with snapshots and the latch in
//! the tick of the hit.

use super::super::Stimulus;
use super::super::cruise::TICK;
use super::{ROUND, THEN, sorted, switches};
use carrystep_core::engine::{EngineOutputs, SWITCH_ROWS, SeekSource};
use carrystep_core::{AXES, Command, EngineBuild, Program, Segment};
use carrystep_simulators::engine::Event;

/// The clock in which the switch of a seek changes.
const REACHED: u64 = THEN + 6 * ROUND;

/// A stop ends every recording, because segments may wait that nobody starts.
const END: u64 = REACHED + 100 * ROUND;

pub(super) fn all(build: &EngineBuild) -> Vec<Stimulus> {
    let mut all = Vec::new();
    for row in 0..SWITCH_ROWS {
        let exists =
            |axis: u8| row < 2 || build.guard.inputs[usize::from(row) - 2].exist >> axis & 1 == 1;
        for axis in (0..AXES as u8).filter(|axis| exists(*axis)) {
            // The interlock stops the axes before they could ramp down by themselves.
            if (row, axis) != (3, 0) {
                let level = (row + axis) % 2 == 0;
                all.push(one_source(build, SeekSource { axis, row, own: false, level }));
            }
        }
        for level in [true, false] {
            all.push(own_sources(build, SeekSource { axis: 5, row, own: true, level }));
        }
    }
    let own = SeekSource { axis: 0, row: 0, own: true, level: true };
    let common = SeekSource { axis: 4, row: 2, own: false, level: true };
    for (name, source) in [("own", own), ("common", common)] {
        all.extend(with_other_pages(build, name, source));
    }
    for (name, source) in [("own", own), ("common", common)] {
        let again = [0x01, 0x20, 0x2a, 0x15].map(|mask| hit_again(build, name, source, mask));
        all.extend(again);
    }
    all.push(ended_early(build));
    all
}

/// The state of the switches of a row, where those of the mask have reached the level of the
/// source and the others have not. The interlock stays closed.
fn reached(source: SeekSource, mask: u8) -> Event {
    let most = if source.row == 3 { 0x3e } else { 0x3f };
    switches(source.row, most & if source.level { mask } else { !mask })
}

/// All axes move in the direction in which they seek a limit, or leave it; for other sources, both
/// ways. A short move of all axes follows.
fn program(source: SeekSource) -> Program {
    let v = |axis: u8| {
        let back = match source.row {
            0 => source.level,
            1 => !source.level,
            _ => axis.is_multiple_of(2),
        };
        let v = (1 << 57) + (i64::from(axis) << 52);
        if back { -v } else { v }
    };
    let row = |ticks, last| {
        (0..AXES as u8).map(move |axis| {
            let v = v(axis);
            Command::Segment { axis, segment: Segment { ticks, v, a: 0, j: 0, last } }
        })
    };
    let mut program: Program = row(250, false).collect();
    program.push(Command::Start { mask: 0x3f });
    program.extend(row(250, false).chain(row(250, true)));
    program.push(Command::Wait { clocks: 100 * TICK as u32 });
    program.extend(row(9, true));
    program.push(Command::Start { mask: 0x3f });
    program.extend([Command::Wait { clocks: 150 * TICK as u32 }, Command::Clear]);
    program.extend(row(9, true).chain([Command::Start { mask: 0x3f }]));
    program
}

/// All axes seek one switch. All others of its row reach the level before it, which is no hit.
fn one_source(build: &EngineBuild, source: SeekSource) -> Stimulus {
    let SeekSource { axis, row, level, .. } = source;
    let others = if row < 2 { 0 } else { 0x3f & !(1 << axis) };
    let events = vec![
        (1, reached(source, 0)),
        (THEN - 50, Event::SeekSource(source)),
        (THEN, Event::Seek(if axis.is_multiple_of(2) { 0x3f } else { 1 << axis | 0x20 })),
        (THEN + ROUND, reached(source, others)),
        (REACHED + 77 * u64::from(axis), reached(source, 0x3f)),
        // The seek ends in the ramp, or long after it.
        (REACHED + (if level { 6 } else { 40 }) * ROUND, Event::Seek(0)),
        (REACHED + 50 * ROUND, reached(source, 0)),
        (REACHED + 60 * ROUND, switches(row, 0)),
        (END, Event::Broken),
    ];
    let name = format!("seek of the switch of row {row} and axis {axis}");
    Stimulus::new(build, name, &program(source), &events)
}

/// Each axis seeks its own switch. The axes reach theirs one after the other, the last ones first.
fn own_sources(build: &EngineBuild, source: SeekSource) -> Stimulus {
    let mut events = vec![
        (1, reached(source, 0)),
        (THEN - 50, Event::SeekSource(source)),
        (THEN, Event::Seek(0x3f)),
    ];
    let mut mask = 0;
    for (place, axis) in (0..AXES as u64).rev().enumerate() {
        mask |= 1 << axis;
        events.push((THEN + ROUND * (5 + place as u64), reached(source, mask)));
    }
    events.push((REACHED + 40 * ROUND, Event::Seek(0)));
    events.push((REACHED + 50 * ROUND, switches(source.row, 0)));
    events.push((END, Event::Broken));
    let level = if source.level { "active" } else { "inactive" };
    let name = format!("seek of own switches of row {}, {level}", source.row);
    Stimulus::new(build, name, &program(source), &events)
}

/// A snapshot is requested, an edge of the latch is accepted, or both, in the ticks around that of
/// a hit.
fn with_other_pages(build: &EngineBuild, name: &str, source: SeekSource) -> Vec<Stimulus> {
    let base = vec![
        (THEN - 50, Event::SeekSource(source)),
        (THEN, Event::Seek(0x3f)),
        (THEN, Event::LatchArm(1)),
        (REACHED, reached(source, 0x3f)),
        (REACHED + 40 * ROUND, Event::Seek(0)),
        (REACHED + 40 * ROUND, Event::Latch(0)),
        (REACHED + 50 * ROUND, reached(source, 0)),
        (END, Event::Broken),
    ];
    let alone = Stimulus::new(build, name, &program(source), &base).recording;
    let hit = alone.outputs.iter().find(|(_, outputs)| outputs.hits != 0);
    let hit = hit.map(|(cycle, _)| cycle / TICK * TICK).expect("the axes hit their source");
    let mut all = Vec::new();
    for (latch, snapshot) in
        [(9, -1), (9, 0), (9, 1), (-1, 9), (0, 9), (1, 9), (-1, 0), (0, -1), (0, 0), (0, 1), (1, 0)]
    {
        let mut events = base.clone();
        let tick = |ticks: i64| (hit.cast_signed() + ticks * TICK.cast_signed()).cast_unsigned();
        // 9 stands for never.
        if latch != 9 {
            // The edge is accepted at the strobe of the third tick.
            events.push((tick(latch - 2) + 11, Event::Latch(1)));
        }
        if snapshot != 9 {
            events.push((tick(snapshot) + 60, Event::Snapshot));
            events.push((tick(snapshot) + TICK - 1, Event::Snapshot));
        }
        let name = format!("{name} hits, latch {latch}, snapshot {snapshot}");
        all.push(Stimulus::new(build, name, &program(source), &sorted(events)));
    }
    all
}

/// In the ramp after a hit the host lets some axes wait for the same source again. It still has its
/// level, so its next sample is another hit, while the other axes are in their ramps.
fn hit_again(build: &EngineBuild, name: &str, source: SeekSource, mask: u8) -> Stimulus {
    let mut events = vec![
        (THEN - 50, Event::SeekSource(source)),
        (THEN, Event::Seek(0x3f)),
        (REACHED, reached(source, 0x3f)),
        (REACHED + 40 * ROUND, Event::Seek(0)),
        (REACHED + 50 * ROUND, reached(source, 0)),
        (END, Event::Broken),
    ];
    let name = format!("axes {mask:#04x} hit their {name} source again");
    let once = Stimulus::new(build, &name, &program(source), &events).recording;
    let hit = once.outputs.iter().find(|(_, outputs)| outputs.hits == 0x3f);
    let (hit, _) = hit.expect("all axes hit their source");
    events.push((hit + TICK, Event::Seek(mask)));
    Stimulus::new(build, name, &program(source), &sorted(events))
}

/// The host ends a seek before its hit, replaces its axes and its source, and starts axes that
/// have hit.
fn ended_early(build: &EngineBuild) -> Stimulus {
    let source = |axis, row, own, level| SeekSource { axis, row, own, level };
    let probe = source(0, 2, false, true);
    let mut events = vec![
        (THEN, Event::SeekSource(probe)),
        (THEN + 1, Event::Seek(0x3f)),
        (THEN + 3 * ROUND, Event::Seek(0)),
        (THEN + 4 * ROUND, Event::Inputs0(1)),
        // The level is there when these axes begin to wait.
        (THEN + 12 * ROUND, Event::Seek(0x21)),
        (THEN + 16 * ROUND, Event::Inputs0(0)),
        (THEN + 17 * ROUND, Event::SeekSource(source(5, 2, false, true))),
        (THEN + 17 * ROUND, Event::Seek(0x12)),
        // Both have bits of the other in common.
        (THEN + 19 * ROUND, Event::Inputs0(0x07)),
        (THEN + 26 * ROUND, Event::Inputs0(0x20)),
        (THEN + 40 * ROUND, Event::Seek(0)),
    ];
    // A mask in each clock around a hit of the sampled switch: which comes first?
    for number in 0..12_u64 {
        let at = THEN + (50 + 12 * number) * ROUND;
        events.push((at, Event::SeekSource(source(5, 2, number % 2 == 0, number % 4 < 2))));
        events.push((at + 1, Event::Seek(0x3f)));
        let active = if number % 4 < 2 { 0x3f } else { 0 };
        events.push((at + 20, Event::Inputs0(active)));
        events.push((at + 4 * ROUND + number * 33, Event::Seek(0x3f >> (number % 3))));
        events.push((at + 9 * ROUND, Event::Seek(0)));
    }
    let stimulus = Stimulus::new(build, "seeks that end", &program(probe), &sorted(events));
    let hits = |(_, outputs): &(u64, EngineOutputs)| outputs.hits == 0x21;
    assert!(stimulus.recording.outputs.iter().any(hits), "two axes hit at once");
    stimulus
}
