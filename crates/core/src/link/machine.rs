//! The little machine at the gateware's end of the link: its instructions, as they lie in its program memory.
//!
//! A byte comes every hundred clocks or so: time enough for a program, which takes a block RAM, where the same talk as
//! gates takes hundreds of cells. It has an accumulator A, an index X, and no arithmetic but exclusive or and X + 1.
//!
//! ```text
//! clock     | fetch | address | execute |       three clocks an instruction; a wait and a CRC step hold the third
//!
//! bit    15     14     13     12     11       10 9 8       7 .. 0
//!        sets                        xor      source       operand      A <= value, or A xor value
//!               stores                              X   operand      data[operand or X] <= A
//!                      jumps         invert   condition    target       pc <= target
//!                             acts   put      start go br  wait .. tax  what these bits do
//! ```
//!
//! Of `acts` the two that change X go together with a value or a store whose operand says nothing else.

/// One instruction, encoded.
pub type Code = u16;

/// A takes a value.
pub const SETS: Code = 1 << 15;
/// A is stored.
pub const STORES: Code = 1 << 14;
/// The program goes on elsewhere, if the condition holds.
pub const JUMPS: Code = 1 << 13;
/// Something is done.
pub const ACTS: Code = 1 << 12;

/// Of [`SETS`]: the value is xored to A.
pub const XOR: Code = 1 << 11;
/// Of [`STORES`]: at X, not at the operand.
pub const INDEXED: Code = 1 << 8;
/// Of [`JUMPS`]: if the condition does not hold.
pub const UNLESS: Code = 1 << 11;

/// Where a value comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Source {
    /// The data memory, at the operand.
    Data = 0,
    /// The data memory, at X.
    DataAtX = 1,
    /// The next received byte; it is the next one's turn then.
    Received = 2,
    /// X.
    X = 3,
    /// The low byte of the CRC.
    Crc = 4,
    /// The engine, what the operand says ([`STATE`] and so on).
    Engine = 5,
}

/// Of [`Source::Engine`]: byte 3 of an answer.
pub const STATE: u8 = 0;
/// The room that the axis of A had in its last turn.
pub const ROOM: u8 = 1;
/// The axes that a stop came from, none without a fault.
pub const CULPRITS: u8 = 2;
/// The axes that wait for their limit.
pub const HOMING: u8 = 3;

/// What a jump asks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Condition {
    /// Nothing.
    Always = 0,
    /// A = 0.
    Zero = 1,
    /// Bit 7 of X.
    X7 = 2,
    /// Bit 6 of X.
    X6 = 3,
    /// No byte was received.
    Nothing = 4,
    /// The engine has a fault.
    Fault = 5,
    /// The engine takes a start.
    Startable = 6,
    /// A is 0xc0 or more, as END and ESC are.
    Special = 7,
}

/// X <= A.
pub const TAX: Code = 1 << 0;
/// X <= X + 1, when the instruction is over.
pub const INX: Code = 1 << 1;
/// The CRC goes on by eight bits.
pub const CRC_STEP: Code = 1 << 2;
/// With [`CRC_STEP`]: A is fed to it; without, A is shifted in above it and its next byte comes down.
pub const CRC_FEED: Code = 1 << 3;
/// The CRC begins; with [`CRC_FEED`] its register takes the facts at X instead.
pub const CRC_BEGIN: Code = 1 << 4;
/// Not over before what is offered is taken, or the engine has a fault; where nothing is offered: before the
/// scan of all axes' items comes round ([`SCAN`] turns).
pub const WAIT: Code = 1 << 5;
/// With [`WAIT`]: over as soon as the axis of A has told its room, or the scan comes round.
pub const FOR_ROOM: Code = 1 << 3;
/// A is the control register; with [`KICK`] the axes that wait for their limit.
pub const CONTROL: Code = 1 << 6;
/// The host was heard of.
pub const KICK: Code = 1 << 7;
/// The segment protocol is broken.
pub const BROKEN: Code = 1 << 8;
/// With [`CONTROL`]: the engine shall clear, until the control register is written anew.
pub const CLEARING: Code = 1 << 9;
/// With [`WAIT`]: A goes to the host.
pub const GOES: Code = 1 << 9;
/// A start of the axes of A is offered.
pub const STARTS: Code = 1 << 10;
/// The CRC's register is offered as a word of a segment: bits 5..3 of A are its axis, bits 4..2 of X its place.
pub const PUTS: Code = 1 << 11;

/// Turns of axes in which all items of all axes have been asked for once.
pub const SCAN: u32 = 32;

/// Where the data memory keeps a request: its sequence number, then its address.
pub const REQUEST: u8 = 0x1e;
/// And its words: those of a segment end where bit 6 of X begins.
pub const WORDS: u8 = 0x20;
/// First address past what a request may fill.
pub const REQUEST_END: u8 = 0x80;
