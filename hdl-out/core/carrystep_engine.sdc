# SPDX-License-Identifier: MIT OR Apache-2.0
#
# The synchronizers of the asynchronous inputs of carrystep_engine, for Quartus. The inputs have no
# relation to the clock. Each of them reaches only first flip-flops of synchronizers, so the paths
# to these are false paths, and the second flip-flop must be placed next to the first. This file is
# generated from the netlist: change the generator instead. It has not been tested, because Quartus
# was not available.
#
# Add the file to the project as an SDC_FILE. The lines of set_instance_assignment belong in the .qsf
# file of the project, without the # before them.

# estop
set_false_path -to [get_keepers {*carrystep_supervisor:*|sync}]
# set_instance_assignment -name SYNCHRONIZER_IDENTIFICATION FORCED -to "*carrystep_supervisor:*|sync"
# set_instance_assignment -name SYNCHRONIZER_IDENTIFICATION FORCED -to "*carrystep_supervisor:*|now"

# limit_min, limit_max, inputs_0, inputs_1
set_false_path -to [get_keepers {*carrystep_switches:*|sync}]
# set_instance_assignment -name SYNCHRONIZER_IDENTIFICATION FORCED -to "*carrystep_switches:*|sync"
# set_instance_assignment -name SYNCHRONIZER_IDENTIFICATION FORCED -to "*carrystep_switches:*|now"

# latch
set_false_path -to [get_keepers {*carrystep_edge_latch:*|sync}]
# set_instance_assignment -name SYNCHRONIZER_IDENTIFICATION FORCED -to "*carrystep_edge_latch:*|sync"
# set_instance_assignment -name SYNCHRONIZER_IDENTIFICATION FORCED -to "*carrystep_edge_latch:*|now"
