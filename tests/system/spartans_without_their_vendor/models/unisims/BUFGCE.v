// CE counts while the clock is low: no pulse is cut (Xilinx UG331, UG382 and UG472).
module BUFGCE (input I, CE, output O);
    reg enabled = 1'b0;
    always @(I or CE) if (!I) enabled = CE;
    assign O = I & enabled;
endmodule
