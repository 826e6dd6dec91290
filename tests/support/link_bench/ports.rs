//! The recordings of link and line, with the ports of the tables in `core`.

use carrystep_core::link::{LineKind, LinkInputs, LinkOutputs, line_ports, link_ports};
use carrystep_core::ports::{Direction, Peer, Port};
use carrystep_core::{AXES, EngineBuild};
use carrystep_hdl::line::LineOutputs;
use carrystep_simulators::vectors::{Bits, Vectors};

/// The recorded cycles of link and line.
#[derive(Debug, Clone)]
pub struct Both {
    /// Cycles of the link.
    pub link: Vectors,
    /// Cycles of its line.
    pub line: Vectors,
    /// The ports of each.
    ports: [Vec<Port>; 2],
}

/// The value of a port, by its name; `None` where it is not valid.
type Value = (&'static str, Option<u64>);

impl Both {
    /// Empty recordings of the link of a build and of this line.
    pub fn new(build: &EngineBuild, kind: LineKind) -> Self {
        let empty = |ports: &[Port]| {
            let of = |way| {
                let named = |port: &Port| (port.name, port.width.of(AXES));
                side(ports, way).map(named).collect::<Vec<_>>()
            };
            Vectors::new(of(Direction::Input), of(Direction::Output))
        };
        let ports = [link_ports(build).collect::<Vec<_>>(), line_ports(kind).collect()];
        Self { link: empty(&ports[0]), line: empty(&ports[1]), ports }
    }

    /// Records the present cycle: what the link sees and shows, the bytes between link and line,
    /// and the levels of the line's pins by their names.
    pub(super) fn add(
        &mut self,
        seen: &LinkInputs,
        shown: &LinkOutputs,
        (line, offered): (LineOutputs, Option<u8>),
        pins: &[(&'static str, bool)],
    ) {
        let bytes = [
            ("received_valid", Some(line.received.is_some().into())),
            ("received", line.received.map(u64::from)),
            ("answer_valid", Some(offered.is_some().into())),
            ("answer", offered.map(u64::from)),
            ("answer_take", Some(line.take.into())),
        ];
        let (told, said) = (shown.engine.at_ports(), seen.engine.at_ports());
        let link: Vec<Value> = bytes.into_iter().chain(told).chain(said).collect();
        let level = |&(name, level): &(&'static str, bool)| (name, Some(u64::from(level)));
        let line: Vec<Value> = bytes.into_iter().chain(pins.iter().map(level)).collect();
        let [of_link, of_line] = &self.ports;
        let sides = |ports: &[Port], values: &[Value]| {
            [Direction::Input, Direction::Output].map(|way| packed(ports, way, values))
        };
        let [inputs, outputs] = sides(of_link, &link);
        self.link.add(inputs, outputs);
        let [inputs, outputs] = sides(of_line, &line);
        self.line.add(inputs, outputs);
    }
}

/// The ports of this direction, except the clock.
fn side(ports: &[Port], way: Direction) -> impl Iterator<Item = &Port> {
    ports.iter().filter(move |port| port.direction == way && port.peer != Peer::Clock)
}

fn packed(ports: &[Port], way: Direction, values: &[Value]) -> Bits {
    side(ports, way).fold(Bits::default(), |bits, port| {
        let value = values.iter().find(|(name, _)| *name == port.name);
        let (_, value) = value.unwrap_or_else(|| panic!("{} has no value", port.name));
        bits.and(port.width.of(AXES), *value)
    })
}
