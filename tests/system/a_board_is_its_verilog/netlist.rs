//! Boards of which the netlist is compared: the Verilog of a whole board, and the netlist that yosys
//! makes of it and nextpnr places. At both stages the PLL is a model that passes its reference on,
//! and block RAMs are our own models.

use carrystep_boards::{Board, Family, boards};
use carrystep_tests::board_session::Session;
use carrystep_tests::{effort, jobs};
use carrystep_tools::kept;

/// What is particular about the netlists of a family.
pub struct Netlists {
    pub family: Family,
    /// The netlist that yosys makes of Verilog with this top module.
    pub made: fn(&str, &str) -> String,
    /// A netlist with models of its cells.
    pub simulated: fn(&str) -> String,
    /// The beginning of a block RAM's first 320 or 288 bits.
    pub first_words: &'static str,
    /// The connection by which a LUT drives `enable_n` in a netlist.
    pub drives_enable: fn(&str) -> String,
}

impl Netlists {
    /// Compares every board of the family in a long run, and none otherwise: a board takes two
    /// minutes, and `a_self_test_shows_every_pin` compares a netlist of the family in every test
    /// run.
    pub fn compare_all(&self) {
        let family = self.family;
        let all: Vec<_> = boards().iter().filter(|board| board.family == family).collect();
        if !effort::is_every_board() {
            return effort::say(&format!("no whole {family} board: the long runs compare all"));
        }
        jobs::each(&all, |board| self.compare(board));
        effort::figures(&format!(
            "{} {family} boards from Verilog to the netlist, two crossed wires, a flipped bit and a wrong LUT seen on each",
            all.len()
        ));
    }

    fn compare(&self, board: &'static Board) {
        let session = Session::of(board);
        let compare = |verilog: &str| session.difference(&(self.simulated)(verilog));
        let (name, top) = (&board.name, session.gateware.top());
        let netlist = |verilog: &str| (self.made)(verilog, &top);
        let made = netlist(&session.verilog);
        assert_eq!(compare(&made), None, "{name}: the netlist");
        assert_eq!(compare(&session.verilog), None, "{name}: the Verilog");
        let flipped = self.with_a_flipped_bit(&made);
        assert!(compare(&flipped).is_some(), "{name}: a flipped bit of a block RAM is not seen");
        let wrong = self.with_a_wrong_lut(&made);
        assert!(compare(&wrong).is_some(), "{name}: a wrong LUT is not seen");
        for (fault, verilog) in session.crossed() {
            assert!(compare(&netlist(&verilog)).is_some(), "{name}: {fault} is not seen");
        }
        effort::say(&format!("{name}: {} cycles on every pin", session.cycles()));
        kept::say();
    }

    /// The netlist with one bit of the link's first instructions flipped.
    fn with_a_flipped_bit(&self, netlist: &str) -> String {
        let program =
            netlist.find("\\link.processor.instructions.words.0.0  (").expect("the program");
        let begin = netlist[..program].rfind(self.first_words).expect("its first words");
        let at = begin + netlist[begin..].find("),").expect("the last digit") - 1;
        let digit = u8::from_str_radix(&netlist[at..=at], 16).expect("a digit");
        format!("{}{:x}{}", &netlist[..at], digit ^ 1, &netlist[at + 1..])
    }

    /// The netlist with the opposite truth table in the LUT that drives `enable_n`.
    fn with_a_wrong_lut(&self, netlist: &str) -> String {
        let pin = netlist.find(&(self.drives_enable)(netlist)).expect("a LUT at enable_n");
        let begin = netlist[..pin].rfind(".INIT(").expect("its table") + ".INIT(".len();
        let (table, rest) = netlist[begin..].split_once(')').expect("the end of its table");
        let (bits, digits) = table.split_once("'h").expect("hexadecimal digits");
        let bits: u32 = bits.parse().expect("a number of bits");
        let opposite = u32::from_str_radix(digits, 16).expect("digits") ^ ((1 << bits) - 1);
        format!("{}{bits}'h{opposite:x}){rest}", &netlist[..begin])
    }
}
