`timescale 1ps / 1ps
// Models of iCE40 cells with delays, written from the description of the cells. The delays of wires,
// and those from the inputs of a LUT or a carry to its outputs, are in front of the inputs here: the
// converter adds the two and writes one delay per input.
//
// Flip-flops and block RAMs examine each input at the cell's own pin. An input that changes within
// its set-up time before the clock edge, at the clock edge itself, or within its hold time after it,
// is a violation. The state that follows is that of the inputs at the clock edge.
// They ignore clock edges in the first microsecond, in which all levels that follow from the
// configuration come to rest.
//
// At a clock edge, they also print the time from the edge before it to the last change of an input,
// with the set-up time of that input, if it is longer than ever before: the shortest period for which
// that change is not a violation.

module timed_lut #(
    parameter [15:0] LUT = 0
) (
    input i0, input i1, input i2, input i3,
    output o
);
    assign o = LUT[{i3, i2, i1, i0}];
endmodule

module timed_carry (
    input i1, input i2, input cin,
    output cout
);
    assign cout = (i1 & i2) | ((i1 | i2) & cin);
endmodule

// A logic cell with its flip-flop. SETUP and HOLD are 32 bits for each input, I0 lowest.
module timed_flip_flop #(
    parameter [15:0] LUT = 0,
    parameter SET = 0,
    parameter [191:0] SETUP = 0,
    parameter [191:0] HOLD = 0,
    parameter CLK_TO_O = 0
) (
    input clk,
    input sr, input cen, input i3, input i2, input i1, input i0,
    output reg o
);
    reg state, next;
    // The time of the last clock edge, 0 before the first, and the time from which on every input
    // has been stable for its set-up time.
    reg [63:0] clocked, due, latest, now;
    initial begin
        o = 0;
        state = 0;
        clocked = 0;
        due = 0;
        latest = 0;
    end

    wire [5:0] inputs = {sr, cen, i3, i2, i1, i0};
    genvar pin;
    generate for (pin = 0; pin < 6; pin = pin + 1) begin : input_
        localparam [63:0] SETUP_OF_PIN = SETUP[32 * pin +: 32];
        localparam [63:0] HOLD_OF_PIN = HOLD[32 * pin +: 32];
        always @(inputs[pin]) begin
            if (due < $time + SETUP_OF_PIN) due = $time + SETUP_OF_PIN;
            if (clocked != 0 && $time <= clocked + HOLD_OF_PIN)
                $display("VIOLATION hold %0d %m", $time);
        end
    end endgenerate

    always @(posedge clk) if ($time >= 1000000) begin
        now = $time;
        if (due > now) $display("VIOLATION set-up %0d %m", now);
        if (clocked != 0 && due > clocked + latest) begin
            latest = due - clocked;
            $display("LATEST %0d %m", latest);
        end
        clocked = now;
        if (cen) begin
            next = sr ? SET : LUT[{i3, i2, i1, i0}];
            if (next !== state) begin
                state = next;
                o <= #CLK_TO_O next;
            end
        end
    end
endmodule

// A block RAM. Mode m has words of 16 >> m bits; the address bits from 8 on select one of the words
// that share 16 bits. A word that is read and written in one clock is read as it was before.
module timed_ram #(
    parameter READ_MODE = 0,
    parameter WRITE_MODE = 0,
    parameter [4095:0] INIT = 0,
    parameter [63:0] SETUP_R = 0, parameter [63:0] HOLD_R = 0,
    parameter [63:0] SETUP_W = 0, parameter [63:0] HOLD_W = 0,
    parameter RCLK_TO_RDATA = 0
) (
    input rclk, input rclke, input re, input [10:0] raddr,
    input wclk, input wclke, input we, input [10:0] waddr, input [15:0] mask, input [15:0] wdata,
    output reg [15:0] rdata
);
    localparam READ_STEP = 1 << READ_MODE, WRITE_STEP = 1 << WRITE_MODE;
    // The place of a narrow word's bit among the pins that belong to its neighbours as well.
    localparam READ_PIN = READ_MODE == 0 ? 0 : READ_STEP / 2 - 1;
    localparam WRITE_PIN = WRITE_MODE == 0 ? 0 : WRITE_STEP / 2 - 1;

    reg [15:0] memory [0:255];
    reg [15:0] state, next;
    reg [63:0] r_clocked, r_due, w_clocked, w_due, latest, now;
    integer word, r_bit, w_bit;
    initial begin
        for (word = 0; word < 256; word = word + 1) memory[word] = INIT[16 * word +: 16];
        rdata = 0;
        state = 0;
        r_clocked = 0;
        r_due = 0;
        w_clocked = 0;
        w_due = 0;
        latest = 0;
    end

    always @(raddr or re or rclke) begin
        r_due = $time + SETUP_R;
        if (r_clocked != 0 && $time <= r_clocked + HOLD_R)
            $display("VIOLATION hold %0d %m", $time);
    end
    always @(waddr or we or wclke or mask or wdata) begin
        w_due = $time + SETUP_W;
        if (w_clocked != 0 && $time <= w_clocked + HOLD_W)
            $display("VIOLATION hold %0d %m", $time);
    end

    always @(posedge rclk) if ($time >= 1000000) begin
        now = $time;
        if (r_due > now) $display("VIOLATION set-up %0d %m", now);
        if (r_clocked != 0 && r_due > r_clocked + latest) begin
            latest = r_due - r_clocked;
            $display("LATEST %0d %m", latest);
        end
        r_clocked = now;
        if (re && rclke) begin
            next = 0;
            for (r_bit = 0; r_bit < 16; r_bit = r_bit + READ_STEP)
                next[r_bit + READ_PIN] =
                    memory[raddr[7:0]][r_bit + raddr[10:8] % READ_STEP];
            if (next !== state) begin
                state = next;
                rdata <= #RCLK_TO_RDATA next;
            end
        end
    end

    always @(posedge wclk) if ($time >= 1000000) begin
        now = $time;
        if (w_due > now) $display("VIOLATION set-up %0d %m", now);
        if (w_clocked != 0 && w_due > w_clocked + latest) begin
            latest = w_due - w_clocked;
            $display("LATEST %0d %m", latest);
        end
        w_clocked = now;
        if (we && wclke)
            for (w_bit = 0; w_bit < 16; w_bit = w_bit + 1)
                if (w_bit % WRITE_STEP == waddr[10:8] % WRITE_STEP
                    && !(WRITE_MODE == 0 && mask[w_bit]))
                    memory[waddr[7:0]][w_bit] <=
                        wdata[w_bit - w_bit % WRITE_STEP + WRITE_PIN];
    end
endmodule

