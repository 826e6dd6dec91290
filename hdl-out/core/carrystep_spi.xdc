# SPDX-License-Identifier: MIT OR Apache-2.0
#
# The synchronizers of the asynchronous inputs of carrystep_spi, for Vivado. The inputs have no
# relation to the clock. Each of them reaches only first flip-flops of synchronizers, so the paths
# to these are false paths, and the second flip-flop must be placed next to the first. This file is
# generated from the netlist: change the generator instead. It has not been tested, because Vivado
# was not available.
#
# They apply to all instances of carrystep_spi, if the file is read with
#     read_xdc -ref carrystep_spi carrystep_spi.xdc

# sck
set_property ASYNC_REG TRUE [get_cells {sck_1_reg sck_2_reg}]
set_false_path -to [get_pins {sck_1_reg/D}]

# select_n
set_property ASYNC_REG TRUE [get_cells {rest_1_reg rest_2_reg}]
set_false_path -to [get_pins {rest_1_reg/D}]

# mosi
set_property ASYNC_REG TRUE [get_cells {mosi_1_reg mosi_2_reg}]
set_false_path -to [get_pins {mosi_1_reg/D}]
