# Makes the bitstream with Vivado for this board: Digilent Cmod S7.
# Run it with: vivado -mode batch -source build.tcl
# This file is generated: change the generator instead.
#
# This script has not been tested, because Vivado was not available.
cd [file dirname [file normalize [info script]]]
create_project -in_memory -part xc7s25csga225-1
read_verilog [list carrystep_cmod_s7_top.v carrystep_clock.v ../core/carrystep_uart.v ../core/carrystep_link.v ../core/carrystep_engine.v]
read_xdc carrystep_cmod_s7_top.xdc
synth_design -top carrystep_cmod_s7_top
opt_design
place_design
route_design
report_utilization -file utilization.txt
report_timing_summary -file timing.txt
if {[get_property SLACK [get_timing_paths]] < 0} {
    error "80 MHz is not reached: see timing.txt"
}
write_bitstream -force carrystep_cmod_s7_top.bit
puts "carrystep_cmod_s7_top.bit is made; load it with: openFPGALoader -b cmod_s7 carrystep_cmod_s7_top.bit"
