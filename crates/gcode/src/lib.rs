//! G-code as canonical moves.
//!
//! [`Interpreter`] reads a program in RS274/NGC, as LinuxCNC's milling programs and Grbl's senders
//! use it, and gives its [`Step`]s one by one: straight moves, arcs, probes, dwells and switches,
//! in machine coordinates, mm and degrees. `docs/gcode.md` lists the language.
//!
//! ```text
//! lines    source     the file, line by line, and jumps
//!          squeeze    without comments and blanks, with columns
//!          grammar -> syntax       words, expressions, O-words
//! control  files      the program, and the files beside it whose subroutines it calls
//!          outline    all O-words and where they lead, before the first line is executed
//!          flow       which line is next
//! values   evaluate   expressions; parameters in memory and values; assign
//! words    request    one code of each modal group (codes), one value of each letter
//!          execute    in the order of LinuxCNC, on a state with a frame of offsets
//!            motion   lines, arcs (circle), probes; drill: cycles (cycle); polar
//!            offsets  coordinate systems and stored places
//!            tool_length offsets of tools; tools: the tool table
//!            kept     what a machine keeps of them from one program to the next
//!            switches spindle, coolant, tool; inputs_outputs
//! senders  lines    lines that come one after the other, each executed whole or not at all
//! blocks   block      lines as they are executed; modes: the modes between two of them
//! ```
//!
//! The memory is constant, whatever the length of the program, but for the O-words. No program
//! makes the interpreter panic or run without end: brackets, calls and lines that run again are
//! limited.

mod assign;
mod block;
pub mod canon;
mod circle;
mod codes;
mod comment;
mod cycle;
mod drill;
pub mod error;
mod evaluate;
mod execute;
mod files;
mod flow;
mod frame;
mod grammar;
mod inputs_outputs;
mod interpreter;
mod kept;
mod lines;
mod memory;
mod modes;
mod motion;
mod offsets;
mod options;
mod outcome;
mod outline;
mod polar;
mod request;
mod seal;
mod source;
mod squeeze;
mod state;
mod switches;
mod syntax;
mod tool_length;
mod tools;
mod values;

pub use block::ExecutedBlock;
pub use canon::{
    AXES, AXIS_LETTERS, Arc, Canon, Input, Pace, PathMode, Plane, Point, Step, Turn, Until,
};
pub use error::{ErrorKind, GcodeError};
pub use interpreter::Interpreter;
pub use kept::Offsets;
pub use lines::LineInterpreter;
pub use modes::Modes;
pub use options::{DEFAULT_BLOCKS, Options};
pub use tools::{Tool, ToolTable};
