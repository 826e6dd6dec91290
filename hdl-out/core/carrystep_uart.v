// SPDX-License-Identifier: MIT OR Apache-2.0
//
// carrystep_uart: the line to the host.
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
// Line         uart, 87 clocks a bit

`default_nettype none

// The UART receiver: eight data bits, no parity, one stop bit.
module carrystep_uart_in #(
    // Length of a UART bit in clocks: clock frequency / baud rate; 8 to 40000
    parameter [31:0] BIT_CLOCKS = 32'd87
) (
    // The clock.
    input  wire         clock,
    // The line from the host, high when idle; asynchronous.
    input  wire         line,
    // The received byte. It is valid while `valid` is asserted and stays until the next byte
    // begins.
    output wire   [7:0] data,
    // Asserted for one clock per received byte.
    output wire         valid
);
    // A mask of the bits that a counter from 0 to `greatest` uses.
    function [15:0] used_bits_16(input [15:0] greatest);
        begin
            used_bits_16 = greatest;
            used_bits_16 = used_bits_16 | (used_bits_16 >> 1);
            used_bits_16 = used_bits_16 | (used_bits_16 >> 2);
            used_bits_16 = used_bits_16 | (used_bits_16 >> 4);
            used_bits_16 = used_bits_16 | (used_bits_16 >> 8);
        end
    endfunction
    localparam [15:0] TO_FIRST = (BIT_CLOCKS[15:0] + BIT_CLOCKS[16:1]) - 16'd1;
    localparam [15:0] TO_NEXT = BIT_CLOCKS[15:0] - 16'd1;
    localparam [15:0] TIMER_BITS = used_bits_16((BIT_CLOCKS[15:0] + BIT_CLOCKS[16:1]) - 16'd1);
    localparam [15:0] ONE = 16'd1;
    localparam [8:0] MARK = 9'd256;
    localparam [8:0] TOP = 9'd256;
    localparam BY_ONE = 1'b1;

    generate
        if ((BIT_CLOCKS < 32'd8) | (BIT_CLOCKS > 32'd40000)) begin : bit_clocks_out_of_range
            carrystep_error_bit_clocks_out_of_range error ();
        end
    endgenerate

    reg sync = 1'b1;
    reg now = 1'b1;
    reg busy = 1'b0;
    reg [8:0] bits = 9'd0;
    reg [15:0] timer = 16'd0;

    wire due = timer == 16'd0;
    wire done = busy & due & bits[0];

    assign data = bits[8:1];
    assign valid = done & now;

    always @(posedge clock) begin
        sync <= line;
        now <= sync;
        timer <= (timer - ONE) & TIMER_BITS;
        if (due) begin
            timer <= TO_NEXT;
        end
        if (busy & due & !bits[0]) begin
            bits <= bits >> BY_ONE;
            if (now) begin
                bits <= (bits >> BY_ONE) | TOP;
            end
        end
        if (done) begin
            busy <= 1'b0;
        end
        if (!busy & !now) begin
            busy <= 1'b1;
            bits <= MARK;
            timer <= TO_FIRST;
        end
    end
endmodule

// The UART transmitter: eight data bits, no parity, one stop bit.
module carrystep_uart_out #(
    // Length of a UART bit in clocks: clock frequency / baud rate; 8 to 40000
    parameter [31:0] BIT_CLOCKS = 32'd87
) (
    // The clock.
    input  wire         clock,
    // The byte that the link offers.
    input  wire   [7:0] data,
    // The link offers a byte and holds it until the transmitter accepts it.
    input  wire         valid,
    // The transmitter accepts the offered byte in this clock.
    output wire         take,
    // The line to the host.
    output wire         line
);
    // A mask of the bits that a counter from 0 to `greatest` uses.
    function [15:0] used_bits_16(input [15:0] greatest);
        begin
            used_bits_16 = greatest;
            used_bits_16 = used_bits_16 | (used_bits_16 >> 1);
            used_bits_16 = used_bits_16 | (used_bits_16 >> 2);
            used_bits_16 = used_bits_16 | (used_bits_16 >> 4);
            used_bits_16 = used_bits_16 | (used_bits_16 >> 8);
        end
    endfunction
    localparam [15:0] LAST_CLOCK = BIT_CLOCKS[15:0] - 16'd1;
    localparam [15:0] TIMER_BITS = used_bits_16(BIT_CLOCKS[15:0] - 16'd1);
    localparam [15:0] ONE = 16'd1;
    localparam [8:0] STOP = 9'd256;
    localparam BY_ONE = 1'b1;

    reg pin = 1'b1;
    reg [8:0] bits = 9'd0;
    reg [15:0] timer = 16'd0;

    wire due = timer == 16'd0;
    wire taken = due & (bits == 9'd0) & valid;

    assign take = taken;
    assign line = pin;

    always @(posedge clock) begin
        if (!due) begin
            timer <= (timer - ONE) & TIMER_BITS;
        end
        if (due & (bits != 9'd0)) begin
            timer <= LAST_CLOCK;
            bits <= bits >> BY_ONE;
            pin <= bits[0];
        end
        if (taken) begin
            timer <= LAST_CLOCK;
            bits <= {1'b0, data} | STOP;
            pin <= 1'b0;
        end
    end
endmodule

// A UART: receiver and transmitter.
module carrystep_uart #(
    // Length of a UART bit in clocks: clock frequency / baud rate; 8 to 40000
    parameter [31:0] BIT_CLOCKS = 32'd87
) (
    // The clock.
    input  wire         clock,
    // The line from the host, high when idle; asynchronous.
    input  wire         rx,
    // The line to the host.
    output wire         tx,
    // The received byte. It is valid while `received_valid` is asserted and stays until the next
    // byte begins.
    output wire   [7:0] received,
    // Asserted for one clock per received byte.
    output wire         received_valid,
    // The byte of the answer that the link offers.
    input  wire   [7:0] answer,
    // The link offers a byte and holds it until the line accepts it.
    input  wire         answer_valid,
    // The line accepts the offered byte in this clock.
    output wire         answer_take
);

    wire [7:0] uart_in_data;
    wire uart_in_valid;
    wire uart_out_take;
    wire uart_out_line;

    assign tx = uart_out_line;
    assign received = uart_in_data;
    assign received_valid = uart_in_valid;
    assign answer_take = uart_out_take;

    carrystep_uart_in #(
        .BIT_CLOCKS(BIT_CLOCKS)
    ) uart_in (
        .clock(clock),
        .line(rx),
        .data(uart_in_data),
        .valid(uart_in_valid)
    );

    carrystep_uart_out #(
        .BIT_CLOCKS(BIT_CLOCKS)
    ) uart_out (
        .clock(clock),
        .data(answer),
        .valid(answer_valid),
        .take(uart_out_take),
        .line(uart_out_line)
    );
endmodule

`default_nettype wire
