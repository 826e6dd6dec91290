// SPDX-License-Identifier: MIT OR Apache-2.0
//
// carrystep_spi: the line to the host.
// This file is generated: change the generator instead.
//
// Made from    sim/six-axis.toml
// Made by      carrystep 0.1.0, with Rust-HDL 0.46.0
//
// Ports: inputs are sampled at the rising edge of `clock`, and outputs change after it; an output
// can also depend on inputs of the same clock. Signals are active high. The comment of a port says
// if it is otherwise; an asynchronous input may come directly from a pin. P is in 2^-64 step, V in
// 2^-64 step per tick, A in 2^-64 step per tick^2, and J in 2^-64 step per tick^3.
//
// The numbers of a build are parameters of the modules. If you override one, override BUILD_ID of
// the host link too: by this id the host knows the parameters for which it plans moves. With the id
// of other parameters it plans wrong moves, which is unsafe. The defaults of the parameters:
//
// Line         spi

`default_nettype none

// An SPI peripheral in mode 0; SCK may be up to a fifth of the clock.
module carrystep_spi (
    // The clock.
    input  wire         clock,
    // The serial clock from the host; asynchronous.
    input  wire         sck,
    // The select from the host, active low; asynchronous.
    input  wire         select_n,
    // The data from the host; asynchronous.
    input  wire         mosi,
    // The data to the host.
    output wire         miso,
    // The received byte, valid in the clocks in which `received_valid` is asserted.
    output wire   [7:0] received,
    // Asserted for one clock per received byte.
    output wire         received_valid,
    // The byte of the answer that the link offers.
    input  wire   [7:0] answer,
    // The link offers a byte and holds it until the line accepts it. The link must offer the next
    // byte of a frame within the duration of one byte; otherwise the line sends an END, which ends
    // the frame early.
    input  wire         answer_valid,
    // The line accepts the offered byte in this clock.
    output wire         answer_take
);
    localparam [2:0] ONE = 3'd1;
    localparam [2:0] NONE = 3'd0;
    localparam [2:0] FULL = 3'd7;
    localparam BY_ONE = 1'b1;
    localparam [7:0] LOW = 8'd1;
    localparam [7:0] END_BYTE = 8'd192;

    reg sck_1 = 1'b0;
    reg sck_2 = 1'b0;
    reg sck_3 = 1'b0;
    reg mosi_1 = 1'b0;
    reg mosi_2 = 1'b0;
    reg rest_1 = 1'b1;
    reg rest_2 = 1'b1;
    reg [7:0] bits = 8'd0;
    reg [7:0] goes = 8'd192;
    reg [2:0] count = 3'd0;
    reg ended = 1'b1;
    reg [7:0] comes;

    wire rise = sck_2 & !sck_3 & !rest_2;
    wire last = rise & (count == FULL);
    wire is_end = comes == END_BYTE;

    assign miso = goes[7];
    assign received = comes;
    assign received_valid = last & !(is_end & ended);
    assign answer_take = last & answer_valid;

    always @(*) begin
        comes = bits << BY_ONE;
        if (mosi_2) begin
            comes = (bits << BY_ONE) | LOW;
        end
    end

    always @(posedge clock) begin
        sck_1 <= sck;
        sck_2 <= sck_1;
        sck_3 <= sck_2;
        mosi_1 <= mosi;
        mosi_2 <= mosi_1;
        rest_1 <= select_n;
        rest_2 <= rest_1;
        if (rise) begin
            bits <= comes;
            goes <= goes << BY_ONE;
            count <= count + ONE;
        end
        if (last) begin
            ended <= is_end;
            goes <= END_BYTE;
            if (answer_valid) begin
                goes <= answer;
            end
        end
        if (rest_2) begin
            count <= NONE;
        end
    end
endmodule

`default_nettype wire
