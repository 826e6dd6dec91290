//! Which pins of a board the gateware of a machine has: the ports of the top level, and what stands
//! where a pin of the engine has none.

use super::Gateware;
use carrystep_core::engine::{
    ENGINE_PORTS, EngineBuild, EngineInputs, Latch, LatchSource, LimitWiring, MAX_LATCHES,
};
use carrystep_core::link::{LineKind, line_pins};
use carrystep_core::ports::{Direction, Peer, Port, Width};

/// The engine's ports for the two rows of inputs, and the port of the board for the first input of
/// each.
pub(super) const INPUTS: [(&str, &str); 2] = [("inputs_0", "probe"), ("inputs_1", "interlock")];

impl Gateware<'_> {
    /// The bits of the top level's ports.
    pub(super) fn ports(&self) -> Vec<String> {
        let axes = self.build.axes();
        let bits =
            |name: &str, count| (0..count).map(|bit| bit_of(name, bit, count)).collect::<Vec<_>>();
        let (low, high) = limit_bits(&self.build);
        let switches = self.switches().filter(|(_, pin)| *pin).flat_map(|(port, _)| {
            let count = self.pins_of(port.name);
            (0..count).map(|bit| bit_of(port.name, bit, count)).collect::<Vec<_>>()
        });
        let inputs = INPUTS.iter().zip(self.build.guard.inputs);
        let inputs = inputs.filter(|(_, row)| row.exist & 1 == 1).map(|((_, first), _)| *first);
        let inputs = inputs.map(str::to_owned);
        let fixed = ["enable_n".to_owned()].into_iter().chain(switches).chain(inputs);
        let line = self.line_pins().map(|(_, pin)| pin.to_owned());
        let led = self.has_led().then(|| "led".to_owned());
        let pwm = self.has_pwm().then(|| "pwm".to_owned());
        [
            bits("step", axes),
            bits("dir", axes),
            fixed.collect(),
            line.collect(),
            bits("limit_min", low),
            bits("limit_max", high),
            self.general().collect(),
            bits("outputs", self.outputs()),
        ]
        .concat()
        .into_iter()
        .chain(pwm)
        .chain(led)
        .collect()
    }

    /// The pins of the line module, and the ports of the board to which they are connected.
    pub(super) fn line_pins(&self) -> impl Iterator<Item = (&'static Port, &'static str)> {
        let board: &[_] = match self.line {
            LineKind::Uart(_) => &["uart_rx", "uart_tx"],
            LineKind::Spi => &["spi_sck", "spi_cs_n", "spi_mosi", "spi_miso"],
        };
        line_pins(self.line).iter().zip(board.iter().copied())
    }

    /// The general inputs, as ports of the top level.
    pub(super) fn general(&self) -> impl Iterator<Item = String> + use<'_> {
        let count = self.general_bits().iter().flatten().flatten().count();
        (0..count).map(move |bit| bit_of("general", bit, count))
    }

    /// The number of the general input at each bit of the two rows of inputs, if there is one: they
    /// take turns, from bit 1 on (`[machine.inputs]` in docs/machine-files.md).
    pub(super) fn general_bits(&self) -> [Vec<Option<usize>>; 2] {
        let exists = |row: usize, bit: usize| self.build.guard.inputs[row].exist >> bit & 1 == 1;
        [0, 1].map(|row| {
            let number = |bit: usize| (bit > 0 && exists(row, bit)).then(|| 2 * (bit - 1) + row);
            (0..self.build.axes()).map(number).collect()
        })
    }

    /// The Verilog of a row of inputs: its pins, and the inactive level where there is none.
    pub(super) fn row_of_inputs(&self, row: usize) -> String {
        let (port, first) = INPUTS[row];
        let (general, count) = (self.general_bits(), self.general().count());
        let inactive = self.inactive(port).unwrap_or_default();
        let bit = |bit: usize| match general[row][bit] {
            Some(number) => bit_of("general", number, count),
            None if bit == 0 && self.build.guard.inputs[row].exist & 1 == 1 => first.to_owned(),
            None => format!("1'b{}", inactive >> bit & 1),
        };
        let bits: Vec<String> = (0..self.build.axes()).rev().map(bit).collect();
        format!("{{{}}}", bits.join(", "))
    }

    /// The number of outputs besides the PWM.
    pub(super) fn outputs(&self) -> usize {
        self.build.outputs.exist.count_ones() as usize
    }

    pub(super) fn has_pwm(&self) -> bool {
        self.build.outputs.pwm_divider != 0
    }

    /// The switches of the engine that are not switches of an axis, and whether each has a pin in
    /// this build. One without a pin is tied to its inactive level.
    pub(super) fn switches(&self) -> impl Iterator<Item = (&'static Port, bool)> {
        let single = |port: &&Port| {
            let of_all = port.width == Width::Bits(1);
            of_all && port.peer == Peer::Pins && port.direction == Direction::Input
        };
        let exists = |name: &str| name != "latch" || self.pins_of_latches() > 0;
        ENGINE_PORTS
            .iter()
            .filter(single)
            .map(move |port| (port, self.board.bits(port.name) > 0 && exists(port.name)))
    }

    /// The inactive level of the pins at a port of the engine.
    pub(super) fn inactive(&self, name: &str) -> Option<u64> {
        let levels = EngineInputs::default().levels(&self.build.guard).at_ports();
        levels.iter().find(|(port, _)| *port == name).and_then(|(_, level)| *level)
    }

    /// The number of latches that have pins of their own.
    pub(super) fn pins_of_latches(&self) -> usize {
        let own = |latch: &&Latch| latch.source == LatchSource::Pin;
        self.build.guard.latches.iter().filter(own).count()
    }

    /// The number of pins at a port of the engine that is no switch of an axis.
    pub(super) fn pins_of(&self, name: &str) -> usize {
        if name == "latch" { self.pins_of_latches() } else { 1 }
    }

    /// The Verilog of the pin of each latch of the build, and 0 for those that it does not have.
    pub(super) fn latches(&self) -> [String; MAX_LATCHES] {
        let (axes, (low, _)) = (self.build.axes(), limit_bits(&self.build));
        let (latches, pins) = (&self.build.guard.latches, self.pins_of_latches());
        let mut own = 0;
        std::array::from_fn(|number| match latches.get(number).map(|latch| latch.source) {
            None => "1'b0".to_owned(),
            Some(LatchSource::Pin) => {
                own += 1;
                bit_of("latch", own - 1, pins)
            }
            Some(LatchSource::Switch { row: 0, axis }) => bit_of("limit_min", axis.into(), low),
            Some(LatchSource::Switch { row: 1, axis }) => bit_of("limit_max", axis.into(), axes),
            Some(LatchSource::Switch { row, axis }) => {
                let (row, axis) = (usize::from(row & 1), usize::from(axis));
                match self.general_bits()[row][axis] {
                    Some(input) => bit_of("general", input, self.general().count()),
                    None => INPUTS[row].1.to_owned(),
                }
            }
        })
    }

    pub(super) fn has_led(&self) -> bool {
        self.board.bits("led") > 0
    }
}

/// Number of limit inputs at the low ends, and at the high ends.
pub(super) fn limit_bits(build: &EngineBuild) -> (usize, usize) {
    match build.guard.limits {
        LimitWiring::None => (0, 0),
        LimitWiring::One => (1, 0),
        LimitWiring::Each => (build.axes(), 0),
        LimitWiring::Pair => (build.axes(), build.axes()),
    }
}

/// Name of a port's bit. If the port has one bit only, the name has no number.
fn bit_of(name: &str, bit: usize, count: usize) -> String {
    if count == 1 { name.to_owned() } else { format!("{name}[{bit}]") }
}
