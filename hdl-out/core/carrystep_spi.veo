// SPDX-License-Identifier: MIT OR Apache-2.0
//
// An instance of carrystep_spi to be copied into a design. The values of the parameters are the
// defaults, and may be left out. Ports without a comment on their width have one bit; the comments
// in carrystep_spi.v describe the ports. An output that is not used stays empty; each input needs a
// value. This file is generated: change the generator instead.
carrystep_spi spi (
    .clock(),          // input
    .sck(),            // input
    .select_n(),       // input
    .mosi(),           // input
    .miso(),           // output
    .received(),       // output [7:0]
    .received_valid(), // output
    .answer(),         // input [7:0]
    .answer_valid(),   // input
    .answer_take()     // output
);
