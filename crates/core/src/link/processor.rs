//! The link processor, a small processor in the gateware: its instructions, as they are encoded in
//! its program memory.
//!
//! At usual baud rates a byte arrives about every hundred clocks, which is time enough for a
//! program. The program needs two block RAMs; the same protocol in gates would need hundreds of
//! cells. The machine has an accumulator A and an index X. Its only operations are exclusive or,
//! and, and X + 1. The data memory has two pages of 256 bytes: variables and the request, and the
//! constants of the program.
//!
//! ```text
//! clock     | fetch | address | execute |   three clocks per instruction; a wait and a CRC step
//!                                           extend the third
//!
//! bit    15     14     13     12     11      10 9 8         7 .. 0
//!        sets   and           acts   xor     source         operand      A <= value, or A and/xor it
//!        0      stores        acts              X           operand      data[operand or X] <= A
//!        0      0      jumps  invert condition 11..9 | target 8 .. 0     pc <= target
//!        0      0      0      acts   put     start go br    wait .. tax  the actions of these bits
//! ```
//!
//! The two `acts` bits that change X (TAX and INX) can be combined with a value or a store that
//! does not use its operand.

/// One instruction, encoded.
pub type Code = u16;

/// The instruction writes a value to A.
pub const SETS: Code = 1 << 15;
/// The instruction stores A.
pub const STORES: Code = 1 << 14;
/// The instruction jumps if its condition holds.
pub const JUMPS: Code = 1 << 13;
/// The instruction performs the actions whose bits are set.
pub const ACTS: Code = 1 << 12;

/// With [`SETS`]: A receives the exclusive or of A and the value.
pub const XOR: Code = 1 << 11;
/// With [`SETS`]: A receives A and the value, bit by bit.
pub const AND: Code = 1 << 14;
/// With [`STORES`], and with [`ValueSource::Data`]: the address is X and not the operand.
pub const INDEXED: Code = 1 << 8;
/// With [`ValueSource::Data`]: the page of the constants and not that of the variables.
pub const CONSTANTS: Code = 1 << 9;
/// With [`JUMPS`]: jump if the condition does not hold.
pub const UNLESS: Code = 1 << 12;
/// With [`JUMPS`]: the lowest bit of the condition.
pub const CONDITION: u32 = 9;
/// With [`JUMPS`]: the bits of the target.
pub const TARGET: Code = (1 << CONDITION) - 1;

/// Source of a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ValueSource {
    /// The variables, at the operand's address.
    Data = 0,
    /// The variables, at address X.
    DataAtX = 1,
    /// The constants, at the operand's address.
    Constant = 2,
    /// The constants, at address X.
    ConstantAtX = 3,
    /// The received byte; reading it releases the buffer for the next one.
    Received = 4,
    /// X.
    X = 5,
    /// The low byte of the CRC.
    Crc = 6,
    /// The item of the engine that the operand selects ([`STATE`] and the following).
    Engine = 7,
}

/// Item of [`ValueSource::Engine`]: byte 3 of an answer, but for `written`.
pub const STATE: u8 = 0;
/// Item: the least free queue space that axes have reported to [`FOR_ROOM`] since the last
/// [`CRC_BEGIN`]; 31 if none has.
pub const ROOM: u8 = 1;
/// Item: the mask of the axes that caused a stop; it has no meaning without a fault.
pub const CULPRITS: u8 = 2;
/// Item: the mask of the axes that wait for the source of their seek.
pub const SEEKING: u8 = 3;
/// Item: the mask of the axes that have hit it, until the host ends the seek.
pub const HITS: u8 = 4;
/// Item: in bits 3..0 the edges since the latch was armed that it did not latch, in bit 4 whether
/// it is armed.
pub const LATCH: u8 = 5;
/// Item: the cause of the stop; it has no meaning without a fault.
pub const CAUSE: u8 = 6;

/// Condition of a jump.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Condition {
    /// Always true.
    Always = 0,
    /// A is 0.
    Zero = 1,
    /// Bit 7 of X is 1.
    X7 = 2,
    /// X is 0xf0 or more.
    Full = 3,
    /// No received byte is waiting.
    Nothing = 4,
    /// The engine has a fault.
    Fault = 5,
    /// The next word to put is a commit: seven words of a segment have been put.
    Commit = 6,
    /// A is 0xc0 or more, as END and ESC are.
    Special = 7,
}

/// X <= A.
pub const TAX: Code = 1 << 0;
/// X <= X + 1, at the end of the instruction.
pub const INX: Code = 1 << 1;
/// The CRC advances by eight bits.
pub const CRC_STEP: Code = 1 << 2;
/// With [`CRC_STEP`]: A enters the CRC. Without: the CRC register shifts down by a byte, and A
/// enters it at the top.
pub const CRC_FEED: Code = 1 << 3;
/// The CRC register is initialised. With [`CRC_FEED`] it is instead loaded with the fact at address
/// X. Either forgets the item [`ROOM`].
pub const CRC_BEGIN: Code = 1 << 4;
/// The instruction lasts until the engine accepts what it offers, or has a fault. If it offers
/// nothing, it lasts until all live words of a tick have been output (`refreshed`).
pub const WAIT: Code = 1 << 5;
/// With [`WAIT`]: the instruction ends as soon as the axis of A has reported its free queue space,
/// or with `refreshed`. Reports count from the second clock of the instruction to the first clock
/// of the next one, so that none between two such instructions is missed.
pub const FOR_ROOM: Code = 1 << 3;
/// Bit 0 of A is written to the control register. With [`KICK`], A is written to the mask of the
/// axes that seek instead, and with [`KICK`] and [`BROKEN`] to the source of seeks; with [`BROKEN`]
/// it is written nowhere.
pub const CONTROL: Code = 1 << 6;
/// The owner of the session has sent a valid request; this restarts the watchdog. With
/// [`CLEARING`]: arms the latch too.
pub const KICK: Code = 1 << 7;
/// The host has violated the segment protocol. With [`CONTROL`]: requests a snapshot instead. With
/// [`KICK`]: requests a stop of all axes instead.
pub const BROKEN: Code = 1 << 8;
/// With [`CONTROL`]: asserts the engine's `clear` until the control register is written again.
/// With [`KICK`] and without [`CONTROL`]: arms the latch. With [`CONTROL`] and [`BROKEN`]: requests
/// a cut in place of a snapshot.
pub const CLEARING: Code = 1 << 9;
/// With [`WAIT`]: sends A to the host.
pub const GOES: Code = 1 << 9;
/// Offers a start of the axes in A.
pub const STARTS: Code = 1 << 10;
/// Offers the CRC register as a word for the axis in bits 2..0 of A. Where bit 3 of A is set, it is
/// the next word of a segment: the machine counts these words modulo 8, and the eighth is the
/// commit. Otherwise it is word 8, which names the slot of a cut.
pub const PUTS: Code = 1 << 11;

/// Address of a request among the variables: its sequence number, followed by its address byte.
pub const REQUEST: u8 = 0x1b;
/// The first address behind the area that a request can fill; [`Condition::Full`] holds from it on.
pub const REQUEST_END: u8 = 0xf0;
