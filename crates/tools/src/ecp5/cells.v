// Simulation models of cells of an ECP5 for which yosys has none with a function: the clock cells
// and the block RAM.

// The PLL outputs its reference clock unchanged and is always locked.
module EHXPLLL #(
    parameter PLLRST_ENA = "DISABLED", INTFB_WAKE = "DISABLED", STDBY_ENABLE = "DISABLED",
    parameter DPHASE_SOURCE = "DISABLED", FEEDBK_PATH = "CLKOP",
    parameter OUTDIVIDER_MUXA = "DIVA", OUTDIVIDER_MUXB = "DIVB", OUTDIVIDER_MUXC = "DIVC",
    parameter OUTDIVIDER_MUXD = "DIVD", CLKI_DIV = 1, CLKFB_DIV = 1,
    parameter CLKOP_ENABLE = "ENABLED", CLKOP_DIV = 8, CLKOP_CPHASE = 0, CLKOP_FPHASE = 0,
    parameter CLKOS_ENABLE = "DISABLED", CLKOS_DIV = 8, CLKOS_CPHASE = 0, CLKOS_FPHASE = 0
) (
    input CLKI, CLKFB, RST, STDBY, PHASESEL0, PHASESEL1, PHASEDIR, PHASESTEP, PHASELOADREG,
    input PLLWAKESYNC, ENCLKOP, ENCLKOS,
    output CLKOP, CLKOS, LOCK
);
    assign CLKOP = CLKI;
    assign CLKOS = CLKI;
    assign LOCK = 1'b1;
endmodule

// A clock gate that samples its enable while its input clock is low.
module DCCA (
    input CLKI, CE,
    output CLKO
);
    reg enabled = 1'b0;
    always @(CLKI or CE) if (!CLKI) enabled <= CE;
    assign CLKO = CLKI & enabled;
endmodule

// The block RAM covers only what yosys uses here: port A writes, both ports read, on one clock or with port B unused,
// without output registers, resets or inverted inputs.
//
// Where nothing is guaranteed, the model returns x. The outputs are x before the first clock. A
// word that port B reads while port A writes any part of it reads as x. So does one that port A
// reads while it writes, unless the mode is READBEFOREWRITE. A write at port B makes everything x.
module DP16KD #(
    parameter DATA_WIDTH_A = 18, DATA_WIDTH_B = 18, REGMODE_A = "NOREG", REGMODE_B = "NOREG",
    parameter RESETMODE = "SYNC", ASYNC_RESET_RELEASE = "SYNC", GSR = "ENABLED",
    parameter CSDECODE_A = "0b000", CSDECODE_B = "0b000", CLKAMUX = "CLKA", CLKBMUX = "CLKB",
    parameter WRITEMODE_A = "NORMAL", WRITEMODE_B = "NORMAL",
    INITVALS
) (
    input CLKA, CLKB, CEA, CEB, WEA, WEB, OCEA, OCEB, RSTA, RSTB,
    input CSA0, CSA1, CSA2, CSB0, CSB1, CSB2,
    input BITS(ADA, 14), BITS(ADB, 14), BITS(DIA, 18), BITS(DIB, 18),
    output BITS(DOA, 18), BITS(DOB, 18)
);
    // 1024 words of two bytes of nine bits.
    reg [17:0] words [0:1023];
    wire [64*320-1:0] first = {ALL_INITVALS};
    integer i;
    initial for (i = 0; i < 1024; i = i + 1) words[i] = first[20*i +: 18];

    wire [13:0] a = {ALL(ADA, 14)}, b = {ALL(ADB, 14)};
    wire [35:0] data = {ALL(DIB, 18), ALL(DIA, 18)};

    // The bits of the pair of words at a[13:5] that port A writes, and what it writes there.
    wire [35:0] mask =
        DATA_WIDTH_A == 36 ? {{9{a[3]}}, {9{a[2]}}, {9{a[1]}}, {9{a[0]}}} :
        DATA_WIDTH_A == 18 ? {18'd0, {9{a[1]}}, {9{a[0]}}} << (a[4] ? 18 : 0) :
        DATA_WIDTH_A == 9 ? 36'h1ff << 9 * a[4:3] :
        ((36'd1 << DATA_WIDTH_A) - 1) << 9 * a[4:3] + a[2:0] / DATA_WIDTH_A * DATA_WIDTH_A;
    wire [35:0] moved =
        DATA_WIDTH_A == 36 ? data :
        DATA_WIDTH_A == 18 ? {data[17:0], data[17:0]} :
        DATA_WIDTH_A == 9 ? {4{data[8:0]}} :
        {36{1'b0}} | data[8:0] << 9 * a[4:3] + a[2:0] / DATA_WIDTH_A * DATA_WIDTH_A;
    wire [35:0] before = {words[{a[13:5], 1'b1}], words[{a[13:5], 1'b0}]};
    wire writes = CEA && WEA;
    wire [35:0] after = writes ? before & ~mask | moved & mask : before;
    always @(posedge CLKA) begin
        {words[{a[13:5], 1'b1}], words[{a[13:5], 1'b0}]} <= after;
        if (CEB && WEB) for (i = 0; i < 1024; i = i + 1) words[i] <= 18'bx;
    end

    function [35:0] narrowed(input [35:0] pair, input [4:0] address, input integer width);
        narrowed =
            width == 36 ? pair :
            width == 18 ? pair >> (address[4] ? 18 : 0) :
            width == 9 ? pair >> 9 * address[4:3] & 36'h1ff :
            pair >> 9 * address[4:3] + address[2:0] / width * width & (36'd1 << width) - 1;
    endfunction

    reg [35:0] value_a, value_b;
    wire [35:0] met = writes && a[13:5] == b[13:5] ? mask : 36'd0;
    wire [35:0] pair_b = {words[{b[13:5], 1'b1}], words[{b[13:5], 1'b0}]};
    wire [35:0] uncertain = WRITEMODE_A == "READBEFOREWRITE" ? 36'd0 : writes ? mask : 36'd0;
    // A pair of words that is read at both ports together comes from port B's address.
    localparam WIDE = DATA_WIDTH_B == 36;
    always @(posedge CLKA) if (CEA) value_a <= narrowed(before ^ (uncertain & 36'bx), a, DATA_WIDTH_A);
    always @(posedge CLKB) if (CEB) value_b <= narrowed(pair_b ^ (met & 36'bx), b, DATA_WIDTH_B);
    assign {ALL(DOA, 18)} = WIDE ? value_b[17:0] : value_a[17:0];
    assign {ALL(DOB, 18)} = WIDE ? value_b[35:18] : value_b[17:0];
endmodule
