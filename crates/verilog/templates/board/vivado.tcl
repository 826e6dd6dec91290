# Makes the bitstream with Vivado for this board: {{ board.title }}.
# Run it with: vivado -mode batch -source build.tcl
# This file is generated: change the generator instead.
#
# This script has not been tested, because Vivado was not available.
cd [file dirname [file normalize [info script]]]
create_project -in_memory -part {{ part.ordered }}
read_verilog [list {{ sources | join(" ") }}]
read_xdc {{ top }}.xdc
synth_design -top {{ top }}
opt_design
place_design
route_design
report_utilization -file utilization.txt
report_timing_summary -file timing.txt
if {[get_property SLACK [get_timing_paths]] < 0} {
    error "{{ mhz }} MHz is not reached: see timing.txt"
}
write_bitstream -force {{ top }}.bit
puts "{{ bitstream }} is made; load it with: {{ flash }}"
