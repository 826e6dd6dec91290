//! Converts a machine file that homes to the parameters of homing, as the command does.

use carrystep_core::engine::LimitWiring;
use carrystep_files::Machine;
use carrystep_files::machine::End;
use carrystep_link::{AxisHoming, Homing, Wiring};

/// The parameters of homing, with their groups.
pub struct Owned {
    homing: Homing<'static>,
    groups: Vec<u8>,
}

impl Owned {
    pub fn as_homing(&self) -> Homing<'_> {
        Homing { groups: &self.groups, ..self.homing }
    }
}

/// The parameters of homing of a machine.
pub fn homing_of(machine: &Machine) -> Owned {
    let mut axes = [None; 8];
    for (number, (place, axis)) in axes.iter_mut().zip(&machine.axes).enumerate() {
        let [forward, backward] = machine.homing_motors(number);
        *place = axis.home.map(|home| AxisHoming {
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
    let groups = machine
        .home_order
        .iter()
        .map(|group| group.iter().fold(0, |mask, axis| mask | 1 << axis))
        .collect();
    let (round, debounce) = (machine.guard.round, machine.guard.debounce);
    Owned { homing: Homing { wiring, axes, groups: &[], others: 0, round, debounce }, groups }
}
