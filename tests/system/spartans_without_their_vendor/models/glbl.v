// The global reset: it ends when the FPGA is configured.
`timescale 1 ps / 1 ps

module glbl;
    reg GSR = 1'b1;
    initial #100000 GSR = 1'b0;
endmodule
