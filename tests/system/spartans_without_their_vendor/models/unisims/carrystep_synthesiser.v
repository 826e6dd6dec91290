// A frequency synthesiser: `out` has MULTIPLY / DIVIDE times the frequency of `reference`, exactly.
// Until the lock, CLOCKS clocks of `reference` after the reset, `out` runs 1.6 times as fast.
`timescale 1 ps / 1 fs

module carrystep_synthesiser #(
    parameter real MULTIPLY = 1.0,
    parameter real DIVIDE = 1.0,
    parameter integer CLOCKS = 400
) (
    input reference, reset,
    output reg out, locked
);
    real last = 0.0;
    real period = 20000.0;
    integer count = 0;

    initial begin
        out = 1'b0;
        locked = 1'b0;
    end

    always @(posedge reference) begin
        period = $realtime - last;
        last = $realtime;
        count = reset ? 0 : count + 1;
        locked <= count >= CLOCKS;
    end

    always #(period * DIVIDE / MULTIPLY / (locked ? 2.0 : 3.2)) out = !out;
endmodule
