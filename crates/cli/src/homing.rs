//! Converts a machine's homing settings to the driver's form, and formats the failures of homing in
//! the axes' units.

use crate::failure::Failure;
use crate::memory::BoardMemory;
use carrystep_core::engine::LimitWiring;
use carrystep_files::machine::{End, Home as AxisHome};
use carrystep_files::{Axis, Machine};
use carrystep_link::{AxisHoming, Homing, HomingFault, Status, Wiring};

/// The groups of axes to home, in the machine's order, one bit per axis. No names means all axes
/// that can home.
///
/// # Errors
/// An axis does not exist or has no home table, or no axis has one.
pub fn groups(machine: &Machine, names: &[String]) -> Result<Vec<u8>, Failure> {
    let mut wanted = 0_u8;
    for name in names {
        let number =
            machine.letter_index(name).ok_or_else(|| Failure::input(machine.no_letter(name)))?;
        if machine.axes[number].home.is_none() {
            return Err(Failure::input(format!(
                "axis '{name}' has no home table in the machine file: home = {{ toward = \"min\", ... }}, as in docs/homing.md"
            )));
        }
        // A letter of crossed belts has one axis, whose switch is that of both motors.
        wanted |= machine.with_its_letter(number);
    }
    let mask = |group: &Vec<usize>| group.iter().fold(0_u8, |mask, axis| mask | 1 << axis);
    let wanted = if names.is_empty() { u8::MAX } else { wanted };
    let groups: Vec<u8> = machine
        .home_order
        .iter()
        .map(|group| mask(group) & wanted)
        .filter(|&mask| mask != 0)
        .collect();
    if groups.is_empty() {
        return Err(Failure::input(
            "no axis of the machine has a home table: home = { toward = \"min\", ... }, as in docs/homing.md",
        ));
    }
    Ok(groups)
}

/// The homing of the machine in the driver's form.
pub fn of<'a>(machine: &Machine, groups: &'a [u8]) -> Homing<'a> {
    let mut axes = [None; 8];
    for (number, (place, axis)) in axes.iter_mut().zip(&machine.axes).enumerate() {
        let [forward, backward] = machine.homing_motors(number);
        *place = axis.home.map(|home: AxisHome| AxisHoming {
            toward_max: home.toward == End::Max,
            start: home.start,
            accel: home.accel,
            seek: home.seek,
            slow: home.slow,
            move_off: home.move_off,
            max_travel: home.max_travel,
            pull_off: home.pull_off,
            forward,
            backward,
            beside: machine.with_its_letter(number) & !(1 << number),
            most_apart: home.most_apart,
        });
    }
    let wiring = match machine.guard.limits {
        LimitWiring::Each => Wiring::Each,
        LimitWiring::One => Wiring::One,
        LimitWiring::Pair | LimitWiring::None => Wiring::Pair,
    };
    let (round, debounce) = (machine.guard.round, machine.guard.debounce);
    Homing { wiring, axes, groups, others: 0, round, debounce }
}

/// If all switches share one wire: the other axes that may stand on their switches, one bit each. A
/// homed axis that is at least as far from its switch as homing leaves it does not stand on its
/// switch. In all other wirings the result is 0.
pub fn others(machine: &Machine, wanted: u8, status: &Status, memory: &BoardMemory) -> u8 {
    if machine.guard.limits != LimitWiring::One {
        return 0;
    }
    let clear = |number: usize, home: &AxisHome| {
        let Some(place) = memory.place(number, &status.positions) else { return false };
        let away = place - home.position as f64;
        let away = if home.toward == End::Max { -away } else { away };
        // Half a step is rounding.
        away + 0.5 >= f64::from(home.pull_off) && memory.limit(number).is_none()
    };
    let unclear = |(number, axis): (usize, &Axis)| {
        let home = axis.home.as_ref()?;
        (wanted >> number & 1 == 0 && !clear(number, home)).then_some(1_u8 << number)
    };
    machine.axes.iter().enumerate().filter_map(unclear).fold(0, |mask, bit| mask | bit)
}

/// Forgets the machine coordinates of axes, one bit each, that begin to home.
pub fn forget(memory: &mut BoardMemory, machine: &Machine, mask: u8) {
    let axes = (0..machine.axes.len()).filter(|number| mask >> number & 1 == 1);
    axes.for_each(|number| memory.set_offset(number, None));
}

/// Notes the machine coordinates of axes that have homed. `places` are the places of all letters at
/// which the limits closed, steps, on crossed belts half steps.
pub fn note(memory: &mut BoardMemory, machine: &Machine, mask: u8, places: &[i32]) {
    let homes = machine.axes.iter().zip(places).enumerate();
    for (number, (axis, place)) in homes.filter(|(number, _)| mask >> number & 1 == 1) {
        if let Some(home) = axis.home {
            let parts = if machine.is_crossed(number) { 2 } else { 1 };
            memory.set_offset(number, Some(parts * home.position - i64::from(*place)));
            memory.fit_offset(number);
            memory.set_limit(number, None);
        }
    }
}

/// The message for a failed homing: the cause, the distances in the axes' units, and the remedy.
pub fn fault(machine: &Machine, mask: u8, why: HomingFault) -> String {
    let of = |distance: fn(&AxisHome) -> u32| {
        let axes = machine.axes.iter().enumerate().filter(|(number, _)| mask >> number & 1 == 1);
        let texts = axes.filter_map(|(_, axis)| {
            let steps = distance(axis.home.as_ref()?);
            Some(format!("{} by {}", axis.name, axis.unit.both(f64::from(steps), 0)))
        });
        texts.collect::<Vec<_>>().join(", ")
    };
    let names = || {
        let axes = machine.axes.iter().enumerate().filter(|(number, _)| mask >> number & 1 == 1);
        axes.map(|(_, axis)| &*axis.name).collect::<Vec<_>>().join(", ")
    };
    match why {
        HomingFault::NotFound => {
            let far = of(|home| home.max_travel);
            format!(
                "no limit was met: moved {far}, which is max_travel; look at the switch, its wiring and limit_level"
            )
        }
        HomingFault::Closed => format!(
            "a limit of {} closed while it moved away from its home switch: the other end of the axis, or a switch that bounces \
             for longer than debounce_us; jog toward the home switch until the limit is open, then home again",
            names()
        ),
        HomingFault::StillClosed => format!(
            "the limit is still closed after moving off: moved {}, which is move_off; look at the switch and limit_level, or take \
             a greater move_off",
            of(|home| home.move_off)
        ),
        HomingFault::NotAgain => format!(
            "the slow approach of {} did not find the limit again: the switch did not open within move_off, or it does not \
             close at the same place; look at it, or take a greater move_off",
            names()
        ),
        HomingFault::Apart => format!(
            "{} moved further than the other motor of its letter, over most_apart ({}): the switch of \
             one of them does not close or open where it should, and going on would rack what they \
             move; look at the switches and at their wiring, and bring both ends to the same distance \
             from them by hand, with the drivers off",
            names(),
            of(|home| home.most_apart)
        ),
        HomingFault::TooLong(error) => format!("{}: {error}", names()),
    }
}
