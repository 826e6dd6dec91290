//! The configuration of a machine file.

use super::refused::MachineRefused;
use super::{
    BoardLine, Configuration, HomeSwitch, Homing, Joint, LETTERS, OutputNets, SwitchRefused, rates,
};
use carrystep_core::StartPhase;
use carrystep_core::engine::{Guard, Latch, LatchSource, LimitWiring};
use carrystep_core::link::LineKind;
use carrystep_files::machine::{End, Kinematics};
use carrystep_files::{Axis, Machine, decimal};

/// What the machine file does not say.
#[derive(Debug, Clone)]
pub struct Wishes {
    /// Name of the machine, and of the files: letters, digits, `-` and `_`.
    pub name: String,
    /// The serial port, or the spidev.
    pub port: String,
    /// Time from a command to its pulses, ms; `None`: as short as is usual.
    pub horizon_ms: Option<u32>,
    /// LinuxCNC's user interface.
    pub display: String,
    /// The home switches at general inputs.
    pub switches: Vec<HomeSwitch>,
}

impl Configuration {
    /// The configuration of a machine, and what its user should know.
    ///
    /// A joint without a home switch at a general input homes where it is. If its axis has a `home`
    /// table, LinuxCNC gives this place the coordinate at which `carrystep home` leaves the axis.
    ///
    /// # Errors
    /// [`MachineRefused`] if LinuxCNC or the component cannot have this machine.
    pub fn of_machine(
        machine: &Machine,
        wishes: Wishes,
    ) -> Result<(Self, Vec<String>), MachineRefused> {
        if machine.phase != StartPhase::Half {
            return Err(MachineRefused::Phase);
        }
        if machine.kinematics != Kinematics::Cartesian {
            return Err(MachineRefused::Kinematics);
        }
        let engine = machine.engine();
        engine.check().map_err(|error| MachineRefused::Build(error.to_string()))?;
        let kind = machine.line().map_err(|error| MachineRefused::Build(error.to_string()))?;
        let line = match kind {
            LineKind::Uart(uart) => BoardLine::Uart { baud: uart.baud() },
            LineKind::Spi => BoardLine::Spi { sck_hz: rates::sck_hz(machine.timebase.clock_hz()) },
        };
        let mut inches = None;
        let mut joints: Vec<Joint> = Vec::with_capacity(machine.axes.len());
        let mut notes = Vec::new();
        for (number, axis) in machine.axes.iter().enumerate() {
            if machine.leader(number) != number {
                let (letter, axis) = (axis.letter.clone(), axis.name.clone());
                return Err(MachineRefused::Gantry { letter, axis });
            }
            let letter = letter(axis)?;
            if joints.iter().any(|joint| joint.letter == letter) {
                return Err(MachineRefused::Twice { letter });
            }
            let angular = "ABC".contains(letter);
            has_its_unit(axis, angular, &mut inches)?;
            let mut joint = joint(machine, number, letter, angular);
            let switch = wishes.switches.iter().find(|switch| switch.axis == axis.name);
            if let Some(switch) = switch {
                joint.homing = switch.homing(machine, axis)?;
                // As machine files have it: the tool is up before the table moves.
                joint.sequence = u32::from(letter != 'Z');
            }
            note(axis, number, switch, &mut notes);
            joints.push(joint);
        }
        has_one_switch_each(machine, &wishes.switches)?;
        let count = u32::try_from(joints.len()).unwrap_or(u32::MAX);
        let depth = u32::try_from(machine.queue).unwrap_or(u32::MAX);
        let (periods, horizon_ms) = rates::choose(count, line, depth, wishes.horizon_ms)?;
        let configuration = Self {
            name: wishes.name,
            port: wishes.port,
            line,
            build: Some(kind.build_id(&engine).0),
            periods,
            horizon_ms,
            inches: inches == Some(true),
            joints,
            limits: machine.guard.limits == LimitWiring::Pair,
            probe: machine.guard.inputs[0].exist & 1 != 0,
            probe_latch: latch(&machine.guard, |latch| {
                let closes = latch.low == (machine.guard.inputs[0].low & 1 != 0);
                closes && latch.source == LatchSource::Switch { row: PROBE_ROW, axis: 0 }
            }),
            index_latch: latch(&machine.guard, |latch| latch.source == LatchSource::Pin),
            outputs: OutputNets {
                count: u8::try_from(machine.outputs.exist.count_ones()).unwrap_or(0),
                pwm: machine.outputs.pwm_divider != 0,
                spindle: machine.output_uses.spindle,
                spindle_reverse: machine.output_uses.spindle_reverse,
                mist: machine.output_uses.mist,
                flood: machine.output_uses.flood,
                spindle_rpm: machine.output_uses.spindle_rpm,
            },
            display: wishes.display,
            hal_files: Vec::new(),
        };
        Ok((configuration, notes))
    }
}

fn has_one_switch_each(machine: &Machine, switches: &[HomeSwitch]) -> Result<(), SwitchRefused> {
    for (number, switch) in switches.iter().enumerate() {
        let refused = |why: String| Err(SwitchRefused { axis: switch.axis.clone(), why });
        if machine.axis_index(&switch.axis).is_none() {
            return refused(format!("no axis has this name; there are {}", machine.axis_names()));
        }
        let before = &switches[..number];
        if before.iter().any(|other| other.axis == switch.axis) {
            return refused("it has two".to_owned());
        }
        if before.iter().any(|other| other.input == switch.input) {
            return refused(format!("input {} is that of another axis", switch.input));
        }
    }
    Ok(())
}

/// The row of switches whose first input is the probe.
const PROBE_ROW: u8 = 2;

/// The number of the first latch that fits.
fn latch(guard: &Guard, fits: impl Fn(&Latch) -> bool) -> Option<u8> {
    guard.latches.iter().position(fits).and_then(|number| u8::try_from(number).ok())
}

fn letter(axis: &Axis) -> Result<char, MachineRefused> {
    let mut characters = axis.letter.chars().map(|character| character.to_ascii_uppercase());
    match (characters.next(), characters.next()) {
        (Some(letter), None) if LETTERS.contains(letter) => Ok(letter),
        _ => Err(MachineRefused::Name { axis: axis.name.clone() }),
    }
}

/// Checks the unit of an axis, and that all lengths have one unit. An axis without a unit in its
/// file is taken to be in mm or degrees.
fn has_its_unit(
    axis: &Axis,
    angular: bool,
    inches: &mut Option<bool>,
) -> Result<(), MachineRefused> {
    let unit = axis.unit.name.as_str();
    let found = match unit {
        "deg" | "degree" | "degrees" | "\u{b0}" | "units" if angular => return Ok(()),
        "mm" | "units" if !angular => false,
        "in" | "inch" | "\"" if !angular => true,
        _ => {
            let wanted = if angular { "deg" } else { "mm or inch" };
            return Err(MachineRefused::Unit {
                axis: axis.name.clone(),
                unit: unit.into(),
                wanted,
            });
        }
    };
    match inches.replace(found) {
        Some(before) if before != found => {
            Err(MachineRefused::Mixed { axis: axis.name.clone(), unit: unit.into() })
        }
        _ => Ok(()),
    }
}

fn joint(machine: &Machine, number: usize, letter: char, angular: bool) -> Joint {
    let axis = &machine.axes[number];
    let scale = decimal::to_f64(&axis.steps_per_unit);
    let units = |steps: i64| steps as f64 / scale;
    let group = machine.home_order.iter().position(|group| group.contains(&number));
    Joint {
        letter,
        scale,
        speed: axis.speed_limit.float / scale,
        acceleration: axis.accel_limit.float / scale,
        travel: axis.travel.map(|[low, high]| (units(low), units(high))),
        angular,
        homing: Homing::InPlace { at: units(rests(axis)) },
        sequence: u32::try_from(group.unwrap_or(0)).unwrap_or(0),
    }
}

/// Where an axis rests after `carrystep home`, steps; 0 if it does not home.
fn rests(axis: &Axis) -> i64 {
    axis.home.as_ref().map_or(0, |home| match home.toward {
        End::Min => home.position + i64::from(home.pull_off),
        End::Max => home.position - i64::from(home.pull_off),
    })
}

fn note(axis: &Axis, number: usize, switch: Option<&HomeSwitch>, notes: &mut Vec<String>) {
    let name = &axis.name;
    if axis.travel.is_none() {
        notes.push(format!("axis '{name}' has no travel: LinuxCNC does not limit joint {number}"));
    }
    notes.push(match (switch, &axis.home) {
        (Some(switch), _) => format!("LinuxCNC homes axis '{name}' on {}", switch.pin()),
        (None, Some(_)) => format!(
            "axis '{name}' homes by `carrystep home` before LinuxCNC starts: joint {number} then takes \
             the place where it is for {}",
            axis.unit.own(rests(axis) as f64, 0)
        ),
        (None, None) => format!(
            "axis '{name}' has no home table: joint {number} takes the place where it is for {}",
            axis.unit.own(0.0, 0)
        ),
    });
}
