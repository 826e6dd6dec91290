//! The commands whose growth is measured, and the amount of work of each. To add a command: a line
//! in `ROWS`.

/// What a command reads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Input {
    /// A move file with one move per unit.
    Moves,
    /// A move file with a single move, of one step per unit.
    OneMove,
    /// The VCD of a move file with one move per unit, and that file.
    Capture,
    /// A move file with one move of a single step per unit.
    Steps,
    /// The VCD of such a file, and the file.
    StepsCapture,
    /// A sweep. The number of its cases is an argument.
    Sweep,
    /// Nothing but arguments.
    Arguments,
}

/// A command whose work grows with its input.
#[derive(Debug, Clone, Copy)]
pub struct Row {
    /// The words of the command line. `MOVE`, `CAPTURE`, `SWEEP` and `OUT` stand for files, `UNITS`
    /// for the amount of work.
    pub command: &'static str,
    pub input: Input,
    /// The unit of work.
    pub unit: &'static str,
    /// The amount of work at factor 1. It takes about 50 ms of processor time or more, except where
    /// the command accepts too little input for that at the greatest factor.
    pub units: u64,
}

const fn moves(command: &'static str, units: u64) -> Row {
    Row { command, input: Input::Moves, unit: "move", units }
}

/// All commands whose work grows with their input, except `run`, which keeps the pace of its board.
pub const ROWS: [Row; 15] = [
    moves("plan MOVE", 1_000),
    moves("plan MOVE --json", 1_000),
    moves("plan MOVE --json-lines", 1_000),
    moves("simulate MOVE", 250),
    moves("simulate MOVE --core parallel", 1_000),
    moves("simulate MOVE --vcd OUT", 250),
    moves("simulate MOVE --fst OUT", 250),
    moves("simulate MOVE --csv OUT", 250),
    moves("simulate MOVE --plot OUT", 250),
    Row { command: "simulate MOVE", input: Input::OneMove, unit: "pulse", units: 400_000 },
    Row { command: "check CAPTURE MOVE", input: Input::Capture, unit: "move", units: 500 },
    Row { command: "sweep SWEEP --sample UNITS", input: Input::Sweep, unit: "case", units: 200 },
    // Each curve of a profile and the ramp of a table have at most a million steps.
    Row {
        command: "profile trapezoid scurve sine logistic --steps UNITS --speed 50000 --accel 500000 --jerk 1.6e7 --csv OUT",
        input: Input::Arguments,
        unit: "step",
        units: 10_000,
    },
    Row {
        command: "profile trapezoid scurve sine logistic --steps UNITS --speed 50000 --accel 500000 --jerk 1.6e7 --json",
        input: Input::Arguments,
        unit: "step",
        units: 10_000,
    },
    Row {
        command: "table sine --ramp-steps UNITS --clock-hz 16000000 --prescaler 256 --top-speed 50000 --pulses-by-time 0.001",
        input: Input::Arguments,
        unit: "step",
        units: 10_000,
    },
];

const fn steps(command: &'static str) -> Row {
    Row { command, input: Input::Steps, unit: "move", units: MANY }
}

/// The number of moves of which the memory is measured.
const MANY: u64 = 1_000_000;

/// The commands whose memory is measured. Those with the engine need no more than those with the
/// parallel core, which are sooner through.
pub const MEMORY_ROWS: [Row; 7] = [
    steps("plan MOVE"),
    steps("plan MOVE --json"),
    steps("plan MOVE --json-lines"),
    steps("simulate MOVE --csv OUT"),
    steps("simulate MOVE --core parallel --vcd OUT"),
    steps("simulate MOVE --core parallel --fst OUT"),
    Row { command: "check CAPTURE MOVE", input: Input::StepsCapture, unit: "move", units: MANY },
];
