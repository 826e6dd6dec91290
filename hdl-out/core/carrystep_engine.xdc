# SPDX-License-Identifier: MIT OR Apache-2.0
#
# The synchronizers of the asynchronous inputs of carrystep_engine, for Vivado. The inputs have no
# relation to the clock. Each of them reaches only first flip-flops of synchronizers, so the paths
# to these are false paths, and the second flip-flop must be placed next to the first. This file is
# generated from the netlist: change the generator instead. It has not been tested, because Vivado
# was not available.
#
# They apply to all instances of carrystep_engine, if the file is read with
#     read_xdc -ref carrystep_engine carrystep_engine.xdc

# estop
set_property ASYNC_REG TRUE [get_cells {supervisor/sync_reg supervisor/now_reg}]
set_false_path -to [get_pins {supervisor/sync_reg/D}]

# limit_min, limit_max, inputs_0, inputs_1
set_property ASYNC_REG TRUE [get_cells {switches/sync_reg switches/now_reg}]
set_false_path -to [get_pins {switches/sync_reg/D}]

# latch
set_property ASYNC_REG TRUE [get_cells {edge_latch/sync_reg edge_latch/now_reg}]
set_false_path -to [get_pins {edge_latch/sync_reg/D}]
