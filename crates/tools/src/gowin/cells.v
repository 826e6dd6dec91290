// Simulation models of cells of a Gowin part for which yosys has none with a function: the clock
// cells and the block RAMs.

// The PLL outputs its reference clock unchanged and is always locked.
module rPLL #(
    parameter FCLKIN = "27", DEVICE = "", IDIV_SEL = 0, FBDIV_SEL = 0, ODIV_SEL = 8,
    parameter DYN_IDIV_SEL = "false", DYN_FBDIV_SEL = "false", DYN_ODIV_SEL = "false",
    parameter PSDA_SEL = "0000", DYN_DA_EN = "false", DUTYDA_SEL = "1000",
    parameter CLKFB_SEL = "internal", CLKOUT_BYPASS = "false", CLKOUTP_BYPASS = "false",
    parameter CLKOUTD_BYPASS = "false", DYN_SDIV_SEL = 2, CLKOUTD_SRC = "CLKOUT",
    parameter CLKOUTD3_SRC = "CLKOUT"
) (
    input CLKIN, CLKFB, RESET, RESET_P,
    input [5:0] FBDSEL, IDSEL, ODSEL,
    input [3:0] PSDA, DUTYDA, FDLY,
    output CLKOUT, CLKOUTP, CLKOUTD, CLKOUTD3, LOCK
);
    assign CLKOUT = CLKIN;
    assign CLKOUTP = CLKIN;
    assign LOCK = 1'b1;
endmodule

// A buffer of a global clock.
module BUFG (
    input I,
    output O
);
    assign O = I;
endmodule

// A clock gate that samples its enable while its input clock is low.
module DQCE (
    input CLKIN, CE,
    output CLKOUT
);
    reg enabled = 1'b0;
    always @(CLKIN or CE) if (!CLKIN) enabled <= CE;
    assign CLKOUT = CLKIN & enabled;
endmodule

// What all kinds of block RAM have in common: two ports with one clock, without output registers
// and resets. Data has nine bits a byte; a kind whose bytes have eight leaves the ninth bit unused.
//
// Where nothing is guaranteed, the model returns x. The outputs are x before the first clock. A
// word reads as x where the other port writes any part of it in the same clock, and a bit that both
// write becomes x. While a port writes, its output stays (mode 0), is what it writes and x where
// it writes nothing (mode 1), or is what was there before (mode 2).
module gowin_block_ram #(
    parameter NINE = 1, WIDTH_A = 36, WIDTH_B = 36, MODE_A = 0, MODE_B = 0,
    parameter [18431:0] FIRST = 0
) (
    input CLKA, CLKB, CEA, CEB, WREA, WREB,
    input [13:0] ADA, ADB,
    input [35:0] DIA, DIB,
    output reg [35:0] DOA, DOB
);
    // 512 words of four bytes.
    reg [35:0] words [0:511];
    integer i;
    initial
        for (i = 0; i < 512; i = i + 1)
            words[i] = NINE ? FIRST[36*i +: 36] : {
                1'b0, FIRST[32*i + 24 +: 8], 1'b0, FIRST[32*i + 16 +: 8],
                1'b0, FIRST[32*i + 8 +: 8], 1'b0, FIRST[32*i +: 8]
            };

    // The lowest bit of a word, at address[13:5], that an address means.
    function integer lowest(input integer width, input [4:0] address);
        lowest =
            width >= 32 ? 0 :
            width >= 16 ? (address[4] ? 18 : 0) :
            width >= 8 ? 9 * address[4:3] :
            9 * address[4:3] + address[2:0] / width * width;
    endfunction

    // The bits of the word that are written. The lowest bits of the address enable bytes.
    function [35:0] written(input integer width, input [4:0] address);
        written =
            width >= 32 ? {{9{address[3]}}, {9{address[2]}}, {9{address[1]}}, {9{address[0]}}} :
            width >= 16 ? {{9{address[1]}}, {9{address[0]}}} << lowest(width, address) :
            (width >= 8 ? 36'h1ff : (36'd1 << width) - 36'd1) << lowest(width, address);
    endfunction

    function [35:0] read(input integer width, input [4:0] address, input [35:0] word);
        read = (word >> lowest(width, address))
            & (width >= 32 ? {36{1'b1}} : width >= 16 ? 36'h3ffff : width >= 8 ? 36'h1ff :
                (36'd1 << width) - 36'd1);
    endfunction

    wire [8:0] a = ADA[13:5], b = ADB[13:5];
    wire [35:0] old_a = words[a], old_b = words[b];
    wire [35:0] mask_a = CEA && WREA ? written(WIDTH_A, ADA[4:0]) : 36'd0;
    wire [35:0] mask_b = CEB && WREB ? written(WIDTH_B, ADB[4:0]) : 36'd0;
    wire [35:0] moved_a = DIA << lowest(WIDTH_A, ADA[4:0]);
    wire [35:0] moved_b = DIB << lowest(WIDTH_B, ADB[4:0]);
    // The bits that the other port writes into the same word.
    wire [35:0] met_a = a == b ? mask_b : 36'd0, met_b = a == b ? mask_a : 36'd0;
    wire [35:0] new_a = old_a & ~mask_a | moved_a & mask_a, new_b = old_b & ~mask_b | moved_b & mask_b;

    always @(posedge CLKA)
        if (a == b && (mask_a & mask_b) != 36'd0) words[a] <= 36'bx;
        else if (a == b) words[a] <= new_a & ~mask_b | moved_b & mask_b;
        else begin
            if (mask_a != 36'd0) words[a] <= new_a;
            if (mask_b != 36'd0) words[b] <= new_b;
        end

    always @(posedge CLKA)
        if (CEA && !(WREA && MODE_A == 0))
            DOA <= read(WIDTH_A, ADA[4:0],
                (WREA && MODE_A == 1 ? new_a ^ (~mask_a & 36'bx) : old_a) ^ (met_a & 36'bx));
    always @(posedge CLKB)
        if (CEB && !(WREB && MODE_B == 0))
            DOB <= read(WIDTH_B, ADB[4:0],
                (WREB && MODE_B == 1 ? new_b ^ (~mask_b & 36'bx) : old_b) ^ (met_b & 36'bx));
endmodule

// One port reads and writes.
module SPX9 #(
    parameter READ_MODE = 0, WRITE_MODE = 0, BIT_WIDTH = 36, BLK_SEL = 0, RESET_MODE = "SYNC",
    INIT_RAMS(288)
) (
    input CLK, CE, OCE, RESET, WRE,
    input [2:0] BLKSEL,
    input [13:0] AD,
    input [35:0] DI,
    output [35:0] DO
);
    gowin_block_ram #(
        .WIDTH_A(BIT_WIDTH), .MODE_A(WRITE_MODE), .FIRST({ALL_INIT_RAMS})
    ) ram (
        .CLKA(CLK), .CLKB(CLK), .CEA(CE), .CEB(1'b0), .WREA(WRE), .WREB(1'b0),
        .ADA(AD), .ADB(14'd0), .DIA(DI), .DIB(36'd0), .DOA(DO), .DOB()
    );
endmodule

module SP #(
    parameter READ_MODE = 0, WRITE_MODE = 0, BIT_WIDTH = 32, BLK_SEL = 0, RESET_MODE = "SYNC",
    INIT_RAMS(256)
) (
    input CLK, CE, OCE, RESET, WRE,
    input [2:0] BLKSEL,
    input [13:0] AD,
    input [31:0] DI,
    output [31:0] DO
);
    wire [35:0] data;
    assign DO = BYTES(data);
    gowin_block_ram #(
        .NINE(0), .WIDTH_A(BIT_WIDTH), .MODE_A(WRITE_MODE), .FIRST({ALL_INIT_RAMS})
    ) ram (
        .CLKA(CLK), .CLKB(CLK), .CEA(CE), .CEB(1'b0), .WREA(WRE), .WREB(1'b0),
        .ADA(AD), .ADB(14'd0), .DIA(NINES(DI)), .DIB(36'd0), .DOA(data), .DOB()
    );
endmodule

// Port A writes and port B reads.
module SDPX9B #(
    parameter READ_MODE = 0, BIT_WIDTH_0 = 36, BIT_WIDTH_1 = 36, BLK_SEL_0 = 0, BLK_SEL_1 = 0,
    parameter RESET_MODE = "SYNC",
    INIT_RAMS(288)
) (
    input CLKA, CEA, CLKB, CEB, OCE, RESETA, RESETB,
    input [13:0] ADA, ADB,
    input [2:0] BLKSELA, BLKSELB,
    input [35:0] DI,
    output [35:0] DO
);
    gowin_block_ram #(
        .WIDTH_A(BIT_WIDTH_0), .WIDTH_B(BIT_WIDTH_1), .FIRST({ALL_INIT_RAMS})
    ) ram (
        .CLKA(CLKA), .CLKB(CLKB), .CEA(CEA), .CEB(CEB), .WREA(1'b1), .WREB(1'b0),
        .ADA(ADA), .ADB(ADB), .DIA(DI), .DIB(36'd0), .DOA(), .DOB(DO)
    );
endmodule

module SDPB #(
    parameter READ_MODE = 0, BIT_WIDTH_0 = 32, BIT_WIDTH_1 = 32, BLK_SEL_0 = 0, BLK_SEL_1 = 0,
    parameter RESET_MODE = "SYNC",
    INIT_RAMS(256)
) (
    input CLKA, CEA, CLKB, CEB, OCE, RESETA, RESETB,
    input [13:0] ADA, ADB,
    input [2:0] BLKSELA, BLKSELB,
    input [31:0] DI,
    output [31:0] DO
);
    wire [35:0] data;
    assign DO = BYTES(data);
    gowin_block_ram #(
        .NINE(0), .WIDTH_A(BIT_WIDTH_0), .WIDTH_B(BIT_WIDTH_1), .FIRST({ALL_INIT_RAMS})
    ) ram (
        .CLKA(CLKA), .CLKB(CLKB), .CEA(CEA), .CEB(CEB), .WREA(1'b1), .WREB(1'b0),
        .ADA(ADA), .ADB(ADB), .DIA(NINES(DI)), .DIB(36'd0), .DOA(), .DOB(data)
    );
endmodule

// Each port reads and writes.
module DPX9B #(
    parameter READ_MODE0 = 0, READ_MODE1 = 0, WRITE_MODE0 = 0, WRITE_MODE1 = 0,
    parameter BIT_WIDTH_0 = 18, BIT_WIDTH_1 = 18, BLK_SEL_0 = 0, BLK_SEL_1 = 0,
    parameter RESET_MODE = "SYNC",
    INIT_RAMS(288)
) (
    input CLKA, CEA, CLKB, CEB, OCEA, OCEB, RESETA, RESETB, WREA, WREB,
    input [13:0] ADA, ADB,
    input [2:0] BLKSELA, BLKSELB,
    input [17:0] DIA, DIB,
    output [17:0] DOA, DOB
);
    wire [35:0] a, b;
    assign DOA = a[17:0];
    assign DOB = b[17:0];
    gowin_block_ram #(
        .WIDTH_A(BIT_WIDTH_0), .WIDTH_B(BIT_WIDTH_1), .MODE_A(WRITE_MODE0), .MODE_B(WRITE_MODE1),
        .FIRST({ALL_INIT_RAMS})
    ) ram (
        .CLKA(CLKA), .CLKB(CLKB), .CEA(CEA), .CEB(CEB), .WREA(WREA), .WREB(WREB),
        .ADA(ADA), .ADB(ADB), .DIA({18'd0, DIA}), .DIB({18'd0, DIB}), .DOA(a), .DOB(b)
    );
endmodule

module DPB #(
    parameter READ_MODE0 = 0, READ_MODE1 = 0, WRITE_MODE0 = 0, WRITE_MODE1 = 0,
    parameter BIT_WIDTH_0 = 16, BIT_WIDTH_1 = 16, BLK_SEL_0 = 0, BLK_SEL_1 = 0,
    parameter RESET_MODE = "SYNC",
    INIT_RAMS(256)
) (
    input CLKA, CEA, CLKB, CEB, OCEA, OCEB, RESETA, RESETB, WREA, WREB,
    input [13:0] ADA, ADB,
    input [2:0] BLKSELA, BLKSELB,
    input [15:0] DIA, DIB,
    output [15:0] DOA, DOB
);
    wire [31:0] in_a = DIA, in_b = DIB;
    wire [35:0] a, b;
    assign DOA = {a[16:9], a[7:0]};
    assign DOB = {b[16:9], b[7:0]};
    gowin_block_ram #(
        .NINE(0), .WIDTH_A(BIT_WIDTH_0), .WIDTH_B(BIT_WIDTH_1), .MODE_A(WRITE_MODE0),
        .MODE_B(WRITE_MODE1), .FIRST({ALL_INIT_RAMS})
    ) ram (
        .CLKA(CLKA), .CLKB(CLKB), .CEA(CEA), .CEB(CEB), .WREA(WREA), .WREB(WREB),
        .ADA(ADA), .ADB(ADB), .DIA(NINES(in_a)), .DIB(NINES(in_b)), .DOA(a), .DOB(b)
    );
endmodule
