//! What the command shows to senders: the settings of the machine file, offsets and modes in the
//! terms of Grbl.

use carrystep_core::engine::LimitWiring;
use carrystep_files::machine::End;
use carrystep_files::{Axis, Machine, decimal};
use carrystep_gcode::{LineInterpreter, Turn};
use carrystep_grbl::{
    AxisSettings, HomingSettings, MachineSettings, Parameters, ParserState, Probed,
};
use carrystep_program::{DEFAULT_TOLERANCE, Letters};

/// The first parameters of G54, G28, G30 and G92.
const SYSTEMS: u16 = 5221;
const SYSTEM_STEP: u16 = 20;
const STORED: [u16; 2] = [5161, 5181];
const G92_ON: u16 = 5210;
const G92: u16 = 5211;

/// The index of z.
const Z: usize = 2;

/// Units per minute of a speed in 2^-64 step per tick.
fn per_minute(machine: &Machine, axis: &Axis, speed: u64) -> f64 {
    let steps = speed as f64 / 2f64.powi(64) / machine.timebase.tick_seconds();
    steps / axis.unit.steps * 60.0
}

/// The settings of a machine, of which `soft` says for each axis whether its travel is a bound.
pub fn settings(machine: &Machine, letters: &Letters, soft: &[bool]) -> MachineSettings {
    let first = letters.all().iter().filter_map(|&letter| Some((letter, letters.axis(letter)?)));
    let axes = first.map(|(letter, motor)| {
        let axis = &machine.axes[motor];
        let steps = axis.unit.steps;
        let travel = axis.travel.map_or(0.0, |[low, high]| (high - low) as f64 / steps);
        AxisSettings {
            letter,
            name: axis.letter.clone(),
            steps_per_unit: decimal::to_f64(&axis.steps_per_unit),
            rate: axis.speed_limit.float / steps * 60.0,
            acceleration: axis.accel_limit.float / steps,
            travel,
        }
    });
    let homes = machine.axes.iter().enumerate().filter_map(|(number, axis)| {
        let home = axis.home?;
        Some((letters.of_axes()[number], axis, home))
    });
    let mut homing: Option<HomingSettings> = None;
    for (letter, axis, home) in homes {
        let homing = homing.get_or_insert_with(|| HomingSettings {
            directions: 0,
            slow: per_minute(machine, axis, home.slow),
            seek: per_minute(machine, axis, home.seek),
            pull_off: f64::from(home.pull_off) / axis.unit.steps,
        });
        homing.directions |= u8::from(home.toward == End::Min) << letter;
    }
    MachineSettings {
        pulse_us: machine.axes.first().map_or(0.0, |axis| axis.pins_ns.step_high as f64 / 1000.0),
        soft_limits: soft.contains(&true),
        hard_limits: machine.guard.limits != LimitWiring::None,
        homing,
        spindle: machine.output_uses.spindle_rpm.unwrap_or_default(),
        laser: machine.output_uses.laser,
        tolerance: DEFAULT_TOLERANCE,
        axes: axes.collect(),
    }
}

/// Values of X, Y, Z and of the letters behind them up to the last one that the machine has; 0 for
/// letters without an axis.
pub fn of_axes(letters: &Letters, value: impl Fn(usize) -> f64) -> Vec<f64> {
    let last = letters.all().iter().copied().max().unwrap_or_default().max(Z);
    let known = |letter: usize| letters.axis(letter).map_or(0.0, |_| value(letter));
    (0..=last).map(known).collect()
}

/// What `$#` shows, with the last probe move.
pub fn parameters(lines: &LineInterpreter, letters: &Letters, probed: &Probed) -> Parameters {
    let kept = lines.offsets();
    let from = |first: u16| of_axes(letters, |letter| kept.get(first + letter as u16));
    let on = kept.get(G92_ON) != 0.0;
    Parameters {
        systems: std::array::from_fn(|number| from(SYSTEMS + SYSTEM_STEP * number as u16)),
        stored: STORED.map(from),
        g92: if on { from(G92) } else { of_axes(letters, |_| 0.0) },
        tool_length: kept.tool[Z],
        probed: probed.clone(),
    }
}

/// What `$G` shows.
pub fn modes(lines: &LineInterpreter) -> ParserState {
    let modes = lines.modes();
    let system = match modes.system {
        system @ 1..=6 => format!("G{}", 53 + system),
        system => format!("G59.{}", system - 6),
    };
    let plane = match modes.plane.axes()[2] {
        0 => 19,
        1 => 18,
        _ => 17,
    };
    ParserState {
        motion: lines.motion(),
        system,
        plane,
        inches: modes.inches,
        incremental: modes.incremental,
        inverse_time: modes.inverse_time,
        spindle: match modes.spindle {
            Turn::Off => 5,
            Turn::Clockwise => 3,
            Turn::Counterclockwise => 4,
        },
        mist: modes.mist,
        flood: modes.flood,
        tool: modes.tool,
        feed: modes.feed.unwrap_or_default(),
        rpm: modes.rpm,
    }
}
