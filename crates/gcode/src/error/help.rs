//! What to do about each mistake.

use crate::error::ErrorKind;

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
                "put the subroutine into the file, or into a file of its name beside the program: \
                 name.ngc for o<name>, 100.ngc for o100"
            }
            Kind::SubNotInFile { .. } => "put the subroutine into that file, or correct its label",
            Kind::TooManyFiles(_) => "put several subroutines into one file",
            Kind::NothingToReturn => {
                "end the main program with M2; repeat it by o1 while, and end `sub` with endsub"
            }
            Kind::NoReturn => "end the subroutine with M99, and the program before it with M2",
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
            Kind::NoToolTable(_) => "give a tool table, or the offset itself with G43.1",
            Kind::UnknownTool(_) => "correct the number, or add the tool to the table",
            Kind::ToolZero => {
                "write G43 for the tool in the spindle, as LinuxCNC reads it, or G49 for no offset, \
                 as Fanuc's controls do"
            }
            Kind::ToolTwice(_) => "remove one of the two lines",
            Kind::AnalogWait => "read it with L0, in a loop with G4 P0.1",
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
