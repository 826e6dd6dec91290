// Drives the oscillator of the clock module MODULE, and prints each change that the checks look at:
// a word, the time in ps, and the level. Ends after EDGES clocks, or at the time LIMIT_PS.
`timescale 1 ps / 1 ps

module bench;
    reg oscillator = 1'b0;
    always begin
        #(`LOW_PS) oscillator = 1'b1;
        #(`HIGH_PS) oscillator = 1'b0;
    end

    wire clock;
    `MODULE dut (.oscillator(oscillator), .clock(clock));

    integer edges = 0;
    // The level at the end of the global reset is printed even if it does not change there.
    always @(glbl.GSR) begin
        $display("reset %0d %b", $time, glbl.GSR);
        $display("clock %0d %b", $time, clock);
    end
    always @(dut.locked) $display("locked %0d %b", $time, dut.locked);
    always @(posedge dut.made) $display("made %0d %b", $time, dut.made);
    always @(clock) begin
        $display("clock %0d %b", $time, clock);
        if (clock === 1'b1) edges = edges + 1;
        if (edges == `EDGES) $finish;
    end
    initial #(`LIMIT_PS) $finish;
endmodule
