//! Gowin boards, of which the netlist is compared.

use crate::netlist::Netlists;
use carrystep_boards::Family;
use carrystep_tools::gowin;

/// The LUT at `enable_n` drives a buffer of the pin.
fn drives_enable(netlist: &str) -> String {
    let buffer = netlist.find(".O(enable_n)").expect("a buffer at enable_n");
    let (_, wire) = netlist[..buffer].rsplit_once(".I(").expect("its input");
    let (wire, _) = wire.split_once(')').expect("the end of its input");
    format!(".F({wire})")
}

#[test]
fn gowin_netlists_equal_rust_hdl_on_every_pin() {
    Netlists {
        family: Family::Gowin,
        made: |verilog, top| gowin::FLOW.synthesise(verilog, top).expect("a netlist").verilog,
        simulated: |verilog| gowin::simulated(verilog).expect("models of its cells"),
        first_words: ".INIT_RAM_00(288'h",
        drives_enable,
    }
    .compare_all();
}
