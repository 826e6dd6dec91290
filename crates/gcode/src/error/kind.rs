//! The mistakes, with the messages that name them: first those of the file, then those of the
//! grammar, of O-words, of values, of words, and of the geometry.

use thiserror::Error;

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
    #[error("subroutine `o{label}` is already in line {line}")]
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
    /// A call of a subroutine that is nowhere.
    #[error("the file has no `{0}`")]
    UnknownSub(String),
    /// A call of a subroutine that is not in the file of its name.
    #[error("{file} has no `{sub}`")]
    SubNotInFile {
        /// Name of the file.
        file: String,
        /// The subroutine.
        sub: String,
    },
    /// Subroutines in more files than a program needs.
    #[error("the program has more than {0} files")]
    TooManyFiles(usize),
    /// M99 in the main program, or in a subroutine that M98 has not called.
    #[error("M99 outside of a subroutine that M98 has called")]
    NothingToReturn,
    /// The end of the file in a subroutine that M98 has called.
    #[error("the subroutine of M98 ends without M99")]
    NoReturn,
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
    /// A code that needs a tool table.
    #[error("{0} without a tool table")]
    NoToolTable(String),
    /// A tool that is not in the table.
    #[error("the tool table has no tool {0}")]
    UnknownTool(u32),
    /// The offset of tool 0.
    #[error("G43 with H0")]
    ToolZero,
    /// A tool of two lines of the tool table.
    #[error("tool {0} is in the table twice")]
    ToolTwice(u32),
    /// M66 waits for an analog input.
    #[error("M66 waits for an analog input")]
    AnalogWait,
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
