//! ECP5 boards, of which the netlist is compared. We know no way back from a bitstream to Verilog
//! for this family.

use crate::netlist::Netlists;
use carrystep_boards::Family;
use carrystep_tools::ecp5;

#[test]
fn ecp5_netlists_equal_rust_hdl_on_every_pin() {
    Netlists {
        family: Family::Ecp5,
        made: |verilog, top| ecp5::FLOW.synthesise(verilog, top).expect("a netlist").verilog,
        simulated: |verilog| ecp5::simulated(verilog).expect("models of its cells"),
        first_words: ".INITVAL_00(320'h",
        drives_enable: |_| ".Z(enable_n)".to_owned(),
    }
    .compare_all();
}
