//! The program of the link processor: it implements the gateware's end of docs/protocol.md.
//!
//! ```text
//! begin -> next <---------------.
//!            | END              |   receive: until then removes escapes, appends bytes
//!            v                  |
//!          ended: length, CRC --'   check: damaged or of a wrong length: no answer
//!            | valid
//!            v
//!          valid -> claim -> sequence -> execute -> done -> answer -> send -> begin
//!              session    order      '--- again, refused ----^
//! ```

mod answer;
mod check;
mod cut;
mod execute;
mod inputs;
mod layout;
mod order;
mod receive;
mod segments;
mod send;
mod session;

use super::assembler::{Assembler, Image};

/// The contents of the machine's memories after configuration, for a build with several latches or
/// for one with at most one.
pub fn image(several_latches: bool) -> Image {
    let mut a = Assembler::default();
    layout::tables(&mut a);
    receive::receive(&mut a);
    check::check(&mut a);
    session::session(&mut a);
    order::order(&mut a);
    execute::execute(&mut a, several_latches);
    cut::cut(&mut a);
    segments::segments(&mut a);
    order::done(&mut a);
    answer::answer(&mut a);
    send::send(&mut a);
    a.finish()
}

#[cfg(test)]
mod tests {
    #[test]
    fn program_fits_the_memory() {
        for several_latches in [false, true] {
            let words = super::image(several_latches).program.len();
            assert!(words > 100 && words <= 512, "{words}");
        }
    }
}
