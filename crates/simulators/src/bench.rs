//! The benches of the engine's Verilog, alone and on a board, made from the tables of their ports.

use crate::LevelError;
use carrystep_core::engine::{
    ENGINE_PORTS, MORE_LATCH_PORTS, STATUS_BITS, SWITCH_LEVEL, SWITCH_STATE, StateItem,
    is_recorded, ports_of,
};
use carrystep_core::link::BYTE_PORTS;
use carrystep_core::ports::{Direction, Peer, Port, Width};
use minijinja::syntax::SyntaxConfig;
use minijinja::{Environment, UndefinedBehavior, Value, context};

const ICARUS: &str = include_str!("../bench/engine_bench.v");
const VERILATOR: &str = include_str!("../bench/engine_bench.cpp");
const BOARD: &str = include_str!("../bench/board_bench.v");
const BOARD_PROCESS: &str = include_str!("../bench/board_bench.cpp");

/// The bench that replays a recording in Icarus. `several` is true for the engine of a build with
/// several latches, which has further ports; `adders` is the number of its adders.
pub(crate) fn icarus(several: bool, adders: usize) -> Result<String, LevelError> {
    rendered(ICARUS, several, adders)
}

/// The bench that replays a recording in Verilator.
pub(crate) fn verilator(several: bool, adders: usize) -> Result<String, LevelError> {
    rendered(VERILATOR, several, adders)
}

/// Line, link and engine of a board as one module.
pub(crate) fn board(several: bool, adders: usize) -> Result<String, LevelError> {
    rendered(BOARD, several, adders)
}

/// The bench that runs a board in Verilator as a process.
pub(crate) fn board_process(several: bool, adders: usize) -> Result<String, LevelError> {
    rendered(BOARD_PROCESS, several, adders)
}

/// True if an engine has this port.
pub(crate) fn has(several: bool, port: &Port) -> bool {
    several || !MORE_LATCH_PORTS.contains(port)
}

fn rendered(template: &str, several: bool, adders: usize) -> Result<String, LevelError> {
    let row = |port: &Port| row(port, adders);
    let mut environment = Environment::new();
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    environment.set_syntax(
        SyntaxConfig::builder()
            .trim_blocks(true)
            .keep_trailing_newline(true)
            .build()
            .unwrap_or_default(),
    );
    let of = |direction| ports_of(direction).filter(move |port| has(several, port));
    let recorded = |direction| of(direction).filter(|port| is_recorded(port));
    let all = ENGINE_PORTS.iter().chain(MORE_LATCH_PORTS).filter(|port| has(several, port));
    let rows = |direction| recorded(direction).map(row).collect::<Vec<_>>();
    let values = context! {
        ports => all.map(row).collect::<Vec<_>>(),
        several,
        adders,
        bytes => BYTE_PORTS.iter().map(row).collect::<Vec<_>>(),
        inputs => rows(Direction::Input),
        pins => of(Direction::Input)
            .filter(|port| port.peer == Peer::Pins)
            .map(row)
            .collect::<Vec<_>>(),
        outputs => rows(Direction::Output),
        status => StateItem::Status as u8,
        status_meant => (1_u32 << STATUS_BITS) - 1,
        switch => StateItem::Switch as u8,
        switch_meant => SWITCH_STATE | SWITCH_LEVEL,
    };
    environment
        .render_str(template, values)
        .map_err(|error| LevelError::Gateware(format!("a bench of the engine: {error}")))
}

/// The values of a port in the templates.
fn row(port: &Port, adders: usize) -> Value {
    let (width, range) = match port.width {
        Width::Axes => ("AXES".to_owned(), "[AXES-1:0] ".to_owned()),
        Width::WordPerAxis => ("32 * AXES".to_owned(), "[32*AXES-1:0] ".to_owned()),
        Width::PerAdder(bits) => match bits * adders as u32 {
            1 => ("1".to_owned(), String::new()),
            bits => (bits.to_string(), format!("[{}:0] ", bits - 1)),
        },
        Width::Bits(1) => ("1".to_owned(), String::new()),
        Width::Bits(bits) => (bits.to_string(), format!("[{}:0] ", bits - 1)),
    };
    context! {
        name => port.name,
        input => port.direction == Direction::Input,
        width,
        range,
        valid_with => port.valid_with,
        shown => port.peer != Peer::Host || port.direction == Direction::Output,
    }
}
