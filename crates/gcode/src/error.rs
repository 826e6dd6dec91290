//! What can be wrong with a program: the mistake, its file, line and column, and what to do.

use std::fmt;
use std::sync::Arc;
use thiserror::Error;

/// A program that cannot be run.
#[derive(Debug, Clone, PartialEq, Error)]
pub struct GcodeError {
    /// Name of the file, as the caller gave it.
    pub file: Arc<str>,
    /// Line in the file, from 1; 0 if the mistake belongs to the whole file.
    pub line: u64,
    /// Column in characters, from 1; 0 if the mistake belongs to the whole line.
    pub column: u32,
    /// The mistake.
    pub kind: ErrorKind,
}

impl fmt::Display for GcodeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file)?;
        for number in [self.line, self.column.into()].into_iter().take_while(|&number| number > 0) {
            write!(f, ":{number}")?;
        }
        write!(f, ": {}\n  help: {}", self.kind, self.kind.help())
    }
}

/// A mistake in a line, before the file and the line are known.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Fault {
    /// Column in characters, from 1; 0 for the whole line.
    pub(crate) column: u32,
    pub(crate) kind: ErrorKind,
}

impl Fault {
    pub(crate) fn new(column: u32, kind: ErrorKind) -> Self {
        Self { column, kind }
    }
}

/// A number as messages show it: with an exponent if it would have many digits.
pub(crate) fn short(value: f64) -> String {
    let is_long = value != 0.0 && !(1e-9..1e12).contains(&value.abs());
    if is_long { format!("{value:e}") } else { value.to_string() }
}

/// The mistakes. Lengths are in mm, whatever the units of the program.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ErrorKind {
    /// The operating system does not let the file be read.
    #[error("cannot read the file: {0}")]
    Unreadable(String),
    /// Length or time of change of the file differ from those when it was opened.
    #[error("the file has changed while it was read")]
    Changed,
    /// A line without an end.
    #[error("the line is longer than {0} bytes")]
    LineTooLong(usize),
    /// A byte that does not occur in programs.
    #[error("byte 0x{0:02x} outside of a comment")]
    NotText(u8),

    /// `(` without `)`.
    #[error("the comment is not closed")]
    UnclosedComment,
    /// `(` in a comment.
    #[error("a parenthesis inside a comment")]
    NestedComment,
    /// The text does not continue as the grammar says.
    #[error("expected {expected}, found {found}")]
    Unexpected {
        /// What the grammar allows here.
        expected: &'static str,
        /// What is there.
        found: String,
    },
    /// Digits that are no number.
    #[error("`{0}` is no number")]
    BadNumber(String),
    /// Brackets in brackets.
    #[error("expressions are nested more than {0} deep")]
    TooDeep(u32),

    /// A block that is open at the end of the file.
    #[error("`o{label} {word}` is never closed")]
    NotClosed {
        /// The word that opens it.
        word: &'static str,
        /// Its label.
        label: String,
    },
    /// An O-word that continues or closes a block that is not the innermost open one.
    #[error("`o{label} {word}` has no beginning: {open}")]
    NothingOpen {
        /// The word.
        word: &'static str,
        /// Its label.
        label: String,
        /// What is open there.
        open: String,
    },
    /// More O-words than a program needs.
    #[error("the file has more than {0} O-words")]
    TooManyOWords(usize),
    /// Blocks in blocks.
    #[error("blocks are nested more than {0} deep")]
    BlocksTooDeep(usize),
    /// A second subroutine of this name.
    #[error("`o{label} sub` is already in line {line}")]
    SubTwice {
        /// The label.
        label: String,
        /// Line of the first one.
        line: u64,
    },
    /// A subroutine within a block.
    #[error("a subroutine inside of `o{0}`")]
    SubInside(String),
    /// A computed label where none is possible.
    #[error("a computed label before `{0}`")]
    ComputedLabel(&'static str),
    /// A call of a subroutine that is not in the file.
    #[error("the file has no `o{0} sub`")]
    UnknownSub(String),
    /// Calls within calls.
    #[error("subroutines call each other more than {0} deep")]
    TooManyCalls(usize),
    /// A program that does not end.
    #[error("loops and subroutines have run more than {0} lines")]
    TooManyBlocks(u64),
    /// More values than parameters.
    #[error("a call with more than {0} values")]
    TooManyArguments(usize),

    /// A named parameter without a value.
    #[error("#<{0}> has no value yet")]
    Undefined(String),
    /// More names than a program needs.
    #[error("more than {0} named parameters")]
    TooManyNames(usize),
    /// No such parameter.
    #[error("there is no parameter #{}", short(*.0))]
    ParameterNumber(f64),
    /// A parameter that only the machine sets.
    #[error("#{0} can only be read")]
    ReadOnly(String),
    /// Division, MOD.
    #[error("division by zero")]
    DivisionByZero,
    /// A function outside of its domain.
    #[error("{function} of {} is not defined", short(*.value))]
    Domain {
        /// The function or operator.
        function: &'static str,
        /// The value.
        value: f64,
    },
    /// A result that is no finite number.
    #[error("the value is too great")]
    Overflow,

    /// A letter without a meaning.
    #[error("{0} is no word of this machine")]
    UnknownLetter(char),
    /// A code without a meaning.
    #[error("{0} is unknown")]
    UnknownCode(String),
    /// A code that this interpreter does not do.
    #[error("{code}: {reason}")]
    NotDone {
        /// The code.
        code: String,
        /// What it is, and what would do instead.
        reason: &'static str,
    },
    /// The same letter twice.
    #[error("{0} occurs twice in this line")]
    LetterTwice(char),
    /// Two codes that exclude each other.
    #[error("{first} and {second} exclude each other")]
    SameGroup {
        /// The first.
        first: String,
        /// The second.
        second: String,
    },
    /// A word that no code of the line uses.
    #[error("nothing in this line uses {0}")]
    Unused(char),
    /// A word that a code needs.
    #[error("{code} needs {word}")]
    Missing {
        /// The code.
        code: String,
        /// The word.
        word: &'static str,
    },
    /// A number that must be whole.
    #[error("{letter} is {}, which is not a whole number", short(*.value))]
    NotWhole {
        /// Its letter.
        letter: char,
        /// Its value.
        value: f64,
    },
    /// A number out of its range.
    #[error("{letter} is {}, out of its range: {range}", short(*.value))]
    OutOfRange {
        /// Its letter.
        letter: char,
        /// Its value.
        value: f64,
        /// The range, in words.
        range: &'static str,
    },
    /// Two codes that both use axis words.
    #[error("{first} and {second} both use the axis words")]
    AxesTwice {
        /// The first.
        first: String,
        /// The second.
        second: String,
    },
    /// Axis words without a motion mode.
    #[error("axis words without a G code that uses them")]
    NoMotion,
    /// F and a change of units in one line.
    #[error("F in the line that changes the units")]
    FeedWithUnits,
    /// A feed move without F.
    #[error("{0} without a feed")]
    MissingFeed(String),
    /// A feed move with F0.
    #[error("{0} with a feed of 0")]
    ZeroFeed(String),
    /// A feed move with G93 without an F of its own.
    #[error("{0} in inverse time (G93) without F in its line")]
    MissingInverseFeed(String),
    /// A cycle or a probe with G93.
    #[error("{0} in inverse time (G93)")]
    NotInInverseTime(String),
    /// G53 with anything but G0 and G1.
    #[error("G53 with {0}")]
    MachineMotion(String),
    /// G53 with G91.
    #[error("G53 with incremental distances (G91)")]
    MachineIncremental,

    /// An arc whose radii differ.
    #[error(
        "the arc does not meet its end: the radius is {start:.6} mm at its start and {end:.6} mm \
         at its end, {difference:.6} mm apart"
    )]
    ArcRadii {
        /// Radius at the start, in mm.
        start: f64,
        /// Radius at the end, in mm.
        end: f64,
        /// Their difference, in mm.
        difference: f64,
    },
    /// An arc without length: its centre is its start.
    #[error("the arc has a radius of 0")]
    ArcNoRadius,
    /// An arc by radius that ends where it starts.
    #[error("an arc by radius ends where it starts")]
    ArcSamePoint,
    /// An arc whose radius is less than half the distance of its ends.
    #[error(
        "the arc does not reach its end: its diameter is {diameter:.6} mm, its ends are \
         {distance:.6} mm apart"
    )]
    ArcTooSmall {
        /// Twice R, in mm.
        diameter: f64,
        /// Distance of the ends, in mm.
        distance: f64,
    },
    /// An arc outside of XY with a rotated coordinate system.
    #[error("an arc in G18 or G19 in a rotated coordinate system")]
    ArcRotated,
    /// A cycle that would drill upwards.
    #[error("the bottom of the hole is {0:.6} mm above R")]
    CycleUpwards(f64),
    /// Polar words and X or Y.
    #[error("polar coordinates and X or Y in one line")]
    PolarAndAxes,
    /// Polar words outside of XY.
    #[error("polar coordinates in G18 or G19")]
    PolarPlane,
    /// Polar words without a direction.
    #[error("polar coordinates without an angle to start from, at the origin")]
    PolarOrigin,
    /// A probe move of no length.
    #[error("a probe move of no length")]
    ProbeNoLength,
    /// A place that no machine reaches.
    #[error("{axis} would be at {}, over {limit} from machine zero", short(*.place))]
    TooFar {
        /// The axis.
        axis: char,
        /// The place in mm or degrees.
        place: f64,
        /// The limit in mm or degrees.
        limit: f64,
    },
}

impl ErrorKind {
    /// What to do about it.
    pub fn help(&self) -> &'static str {
        use ErrorKind as Kind;
        match self {
            Kind::Unreadable(_) => "check its name and its permissions",
            Kind::Changed => "leave the file alone until the program has been read",
            Kind::LineTooLong(_) => "give a G-code program, with one block a line",
            Kind::NotText(_) => "give a G-code program as text; other characters only in comments",
            Kind::UnclosedComment => "close it with `)` in the same line",
            Kind::NestedComment => "close the first comment with `)` before the next one",
            Kind::Unexpected { .. } => "correct the line; docs/gcode.md lists the language",
            Kind::BadNumber(_) => {
                "write digits with at most one point, and a sign only before them"
            }
            Kind::TooDeep(_) => "compute parts of it in parameters, as in #1=[...]",
            Kind::NotClosed { .. } => {
                "close it with endsub, endif, endwhile, endrepeat or while, under the same label"
            }
            Kind::NothingOpen { .. } => "give each block one beginning and one end with its label",
            Kind::TooManyOWords(_) => "repeat lines by loops",
            Kind::BlocksTooDeep(_) => "move inner blocks into subroutines",
            Kind::TooManyNames(_) => "use numbered parameters",
            Kind::SubTwice { .. } => "give each subroutine a label of its own",
            Kind::SubInside(_) => "move the subroutine out of all blocks and subroutines",
            Kind::ComputedLabel(_) => {
                "write the label as a number or a name; only call computes it"
            }
            Kind::UnknownSub(_) => {
                "put the subroutine into this file; other files are not searched"
            }
            Kind::TooManyCalls(_) => "end the recursion by a condition, or use a loop",
            Kind::TooManyBlocks(_) => {
                "check the condition of the loop, or raise the limit of blocks"
            }
            Kind::TooManyArguments(_) => "pass more values in global parameters, as in #<_name>",
            Kind::Undefined(_) => "set it before it is read, or ask with EXISTS[#<name>]",
            Kind::ParameterNumber(_) => "use whole numbers from 1 to 5602",
            Kind::ReadOnly(_) => "choose another parameter",
            Kind::DivisionByZero => "check the divisor with if before",
            Kind::Domain { .. } => "check the value with if before",
            Kind::Overflow => "keep values under 10^300",
            Kind::UnknownLetter('@' | '^') => {
                "compute X and Y from polar coordinates by COS and SIN"
            }
            Kind::UnknownLetter(_) => "use the axes x y z a b c; docs/gcode.md lists all words",
            Kind::UnknownCode(_) => "docs/gcode.md lists the codes that are done",
            Kind::NotDone { .. } => "docs/gcode.md lists the codes that are done",
            Kind::LetterTwice(_) => "keep one of the two words",
            Kind::SameGroup { .. } => "write them in two lines",
            Kind::Unused(_) => "remove the word, or add the code that it belongs to",
            Kind::Missing { .. } => "add the word",
            Kind::NotWhole { .. } => "give a whole number",
            Kind::OutOfRange { .. } => "give a number in its range",
            Kind::AxesTwice { .. } => "write them in two lines",
            Kind::NoMotion => "write G0, G1 or another motion before the axis words",
            Kind::FeedWithUnits => {
                "put F into the next line: LinuxCNC reads it in the old units, Grbl in the new ones"
            }
            Kind::MissingFeed(_) => "set a feed with F, in units per minute",
            Kind::ZeroFeed(_) => "set a feed above 0 with F, in units per minute",
            Kind::MissingInverseFeed(_) => {
                "add F to the line: with F2 the move takes half a minute"
            }
            Kind::NotInInverseTime(_) => "change to G94 and set F before it",
            Kind::MachineMotion(_) => "use G53 only with G0 or G1",
            Kind::MachineIncremental => "write G90 before it",
            Kind::ArcRadii { .. } => {
                "correct the centre or the end; 0.005 mm, or 0.1 % up to 0.5 mm, are allowed"
            }
            Kind::ArcNoRadius => "give the distance from start to centre with I, J or K",
            Kind::ArcSamePoint => "give the centre of a full circle with I, J or K",
            Kind::ArcTooSmall { .. } => "correct R or the end",
            Kind::ArcRotated => "set the rotation to 0 (G10 L2 R0), or use G17",
            Kind::CycleUpwards(_) => "set R above the bottom of the hole",
            Kind::PolarAndAxes => "write either @ and ^ or X and Y",
            Kind::PolarPlane => "write G17 before it, or compute the place by COS and SIN",
            Kind::PolarOrigin => "give both @ and ^, with G90",
            Kind::ProbeNoLength => "give a target at some distance from the present place",
            Kind::TooFar { .. } => "check the numbers and the units (G20, G21)",
        }
    }
}
