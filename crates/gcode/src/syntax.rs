//! A line of a program as the grammar gives it: nothing is evaluated yet.
//!
//! Every part has its column in the file, in characters from 1.

/// A line.
#[derive(Debug, Default)]
pub(crate) struct Block {
    /// An O-word; then there are no words and no assignments.
    pub(crate) control: Option<Control>,
    /// Words other than N, in order.
    pub(crate) words: Vec<Word>,
    /// Assignments to parameters, in order.
    pub(crate) assignments: Vec<Assignment>,
}

/// A letter and its value.
#[derive(Debug)]
pub(crate) struct Word {
    /// The letter, in lower case.
    pub(crate) letter: u8,
    pub(crate) column: u32,
    pub(crate) value: Expression,
}

/// `#reference = value`.
#[derive(Debug)]
pub(crate) struct Assignment {
    pub(crate) column: u32,
    pub(crate) reference: Reference,
    pub(crate) value: Expression,
}

/// A parameter.
#[derive(Debug)]
pub(crate) enum Reference {
    /// `#1`, `#[...]`, `##1`.
    Number(Box<Expression>),
    /// `#<name>`, in lower case and without blanks.
    Name(Box<str>),
}

/// A value that is to be computed.
#[derive(Debug)]
pub(crate) struct Expression {
    pub(crate) column: u32,
    pub(crate) kind: ExpressionKind,
}

/// The kinds of expressions.
#[derive(Debug)]
pub(crate) enum ExpressionKind {
    Number(f64),
    Parameter(Reference),
    Exists(Reference),
    Negative(Box<Expression>),
    Function(Function, Box<Expression>),
    /// `ATAN[y]/[x]`.
    Atan(Box<Expression>, Box<Expression>),
    /// Operators of one precedence with their columns, applied from left to right. A list, so that
    /// a long sum is not a deep tree.
    Chain(Box<Expression>, Vec<(u32, Operator, Expression)>),
}

/// Functions of one value; angles are in degrees.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Function {
    Abs,
    Acos,
    Asin,
    Cos,
    Exp,
    Fix,
    Fup,
    Ln,
    Round,
    Sin,
    Sqrt,
    Tan,
}

/// Operators of two values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Operator {
    Power,
    Times,
    Over,
    Mod,
    Plus,
    Minus,
    Equal,
    NotEqual,
    Greater,
    GreaterOrEqual,
    Less,
    LessOrEqual,
    And,
    Or,
    Xor,
}

/// `oLABEL WORD values`.
#[derive(Debug)]
pub(crate) struct Control {
    pub(crate) label: Label,
    pub(crate) word: OWord,
    pub(crate) column: u32,
    pub(crate) values: Vec<Expression>,
}

/// The label of an O-word.
#[derive(Debug)]
pub(crate) enum Label {
    /// Digits, or a name in angle brackets, as messages show it.
    Fixed(Box<str>),
    /// `o#1` or `o[...]`.
    Computed(Expression),
}

/// The O-words.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum OWord {
    Sub,
    EndSub,
    Call,
    Return,
    If,
    ElseIf,
    Else,
    EndIf,
    While,
    EndWhile,
    Do,
    Repeat,
    EndRepeat,
    Break,
    Continue,
    /// No word: the label is the number of a program, which M98 can call.
    Program,
}

impl OWord {
    /// All that are written, longer words before their beginnings.
    pub(crate) const ALL: [Self; 15] = [
        Self::EndSub,
        Self::EndIf,
        Self::EndWhile,
        Self::EndRepeat,
        Self::ElseIf,
        Self::Else,
        Self::Sub,
        Self::Call,
        Self::Return,
        Self::If,
        Self::While,
        Self::Do,
        Self::Repeat,
        Self::Break,
        Self::Continue,
    ];

    /// As it is written, in lower case.
    pub(crate) const fn text(self) -> &'static str {
        match self {
            Self::Sub => "sub",
            Self::EndSub => "endsub",
            Self::Call => "call",
            Self::Return => "return",
            Self::If => "if",
            Self::ElseIf => "elseif",
            Self::Else => "else",
            Self::EndIf => "endif",
            Self::While => "while",
            Self::EndWhile => "endwhile",
            Self::Do => "do",
            Self::Repeat => "repeat",
            Self::EndRepeat => "endrepeat",
            Self::Break => "break",
            Self::Continue => "continue",
            Self::Program => "",
        }
    }

    /// Least and greatest number of values that follow it.
    pub(crate) const fn values(self) -> (usize, usize) {
        match self {
            Self::Call => (0, usize::MAX),
            Self::Return | Self::EndSub => (0, 1),
            Self::If | Self::ElseIf | Self::While | Self::Repeat => (1, 1),
            _ => (0, 0),
        }
    }
}
