# SPDX-License-Identifier: MIT OR Apache-2.0
#
# The synchronizers of the asynchronous inputs of carrystep_uart, for Vivado. The inputs have no
# relation to the clock. Each of them reaches only first flip-flops of synchronizers, so the paths
# to these are false paths, and the second flip-flop must be placed next to the first. This file is
# generated from the netlist: change the generator instead. It has not been tested, because Vivado
# was not available.
#
# They apply to all instances of carrystep_uart, if the file is read with
#     read_xdc -ref carrystep_uart carrystep_uart.xdc

# rx
set_property ASYNC_REG TRUE [get_cells {uart_in/sync_reg uart_in/now_reg}]
set_false_path -to [get_pins {uart_in/sync_reg/D}]
