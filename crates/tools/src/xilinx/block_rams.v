// Simulation models of the block RAMs of Spartan FPGAs, for which yosys has none. The models cover
// only what yosys uses: one port writes, both ports read, all on one clock, without output
// registers, resets or inverted inputs.
//
// Where the data sheets guarantee nothing, the models return x. The outputs are x before the first
// clock. A byte that is read and written in the same clock reads as x, unless the mode is
// READ_FIRST. A write enable of x writes x.

module bench_block_ram #(
    parameter BYTES = 2048,
    parameter [8*BYTES-1:0] INIT = 0,
    parameter [BYTES-1:0] INITP = 0,
    // Width of a word in bits, parity included; 0 if the port is not used.
    parameter READ_A = 0, READ_B = 0, WRITE = 0,
    parameter READ_FIRST = 0
) (
    input clock, writes,
    input [1:0] reads, // read enables: bit 0 of port A, bit 1 of port B
    // Addresses of the write and of the reads at port A and B, in data bits without parity.
    input [14:0] address, address_a, address_b,
    input [7:0] mask, // write enable of each byte
    input [63:0] data,
    input [7:0] parity,
    output [63:0] value_a, value_b,
    output [7:0] parity_a, parity_b
);
    reg [8:0] bytes [0:BYTES-1]; // bit 8 is the parity bit
    integer i, j;
    initial for (i = 0; i < BYTES; i = i + 1) bytes[i] = {INITP[i], INIT[8*i +: 8]};

    // The number of bytes in a written word (1 for words shorter than a byte), and the index of its
    // first byte.
    localparam MANY = WRITE < 9 ? 1 : WRITE / 9;
    wire [11:0] first = address[14:3] / MANY * MANY;
    wire any = writes && WRITE != 0;
    always @(posedge clock) if (any) begin
        for (i = 0; i < MANY; i = i + 1) if (mask[i] !== 1'b0) begin
            if (WRITE > 8) bytes[first + i] <= mask[i] ? {parity[i], data[8*i +: 8]} : 9'bx;
            else for (j = 0; j < WRITE; j = j + 1)
                bytes[first][address[2:0] / WRITE * WRITE + j] <= mask[i] ? data[j] : 1'bx;
        end
    end

    genvar port, of;
    generate for (port = 0; port < 2; port = port + 1) begin : reader
        localparam READ = port ? READ_B : READ_A, COUNT = READ < 9 ? 1 : READ / 9;
        wire [14:0] address = port ? address_b : address_a;
        reg [63:0] value;
        reg [7:0] odd;
        for (of = 0; of < COUNT && READ != 0; of = of + 1) begin : each
            wire [11:0] at = address[14:3] / COUNT * COUNT + of;
            wire meets = any && at >= first && at < first + MANY && mask[at - first] !== 1'b0;
            wire [2:0] low = READ < 9 ? address[2:0] / READ * READ : 0;
            always @(posedge clock) if (reads[port])
                {odd[of], value[8*of +: 8]} <= meets && !READ_FIRST ? 9'bx : bytes[at] >> low;
        end
    end endgenerate
    assign value_a = reader[0].value;
    assign value_b = reader[1].value;
    assign parity_a = reader[0].odd;
    assign parity_b = reader[1].odd;
endmodule

// The 9 kbit block RAM of the Spartan-6. In SDP mode (simple dual port), port A writes and port B
// reads, and a word uses the data pins of both ports.
module RAMB8BWER #(
    INITS(32, 4)
    parameter DATA_WIDTH_A = 0, DATA_WIDTH_B = 0, DOA_REG = 0, DOB_REG = 0, EN_RSTRAM_A = "TRUE", EN_RSTRAM_B = "TRUE",
    parameter INIT_A = 0, INIT_B = 0, RAM_MODE = "TDP", RSTTYPE = "SYNC", RST_PRIORITY_A = "CE", RST_PRIORITY_B = "CE",
    parameter SRVAL_A = 0, SRVAL_B = 0, WRITE_MODE_A = "WRITE_FIRST", WRITE_MODE_B = "WRITE_FIRST"
) (
    input CLKAWRCLK, CLKBRDCLK, ENAWREN, ENBRDEN, REGCEA, REGCEBREGCE, RSTA, RSTBRST,
    input [1:0] WEAWEL, WEBWEU, DIPADIP, DIPBDIP,
    input [12:0] ADDRAWRADDR, ADDRBRDADDR,
    input [15:0] DIADI, DIBDI,
    output [15:0] DOADO, DOBDO,
    output [1:0] DOPADOP, DOPBDOP
);
    localparam SDP = RAM_MODE == "SDP";
    wire [63:0] a, b;
    wire [7:0] pa, pb;
    bench_block_ram #(
        .BYTES(1024), .INIT(ALL_INITS(32)), .INITP(ALL_INITPS(4)), .READ_FIRST(WRITE_MODE_A == "READ_FIRST"),
        .READ_A(SDP ? 0 : DATA_WIDTH_A), .READ_B(DATA_WIDTH_B), .WRITE(DATA_WIDTH_A)
    ) ram (
        .clock(CLKAWRCLK | CLKBRDCLK), .writes(ENAWREN), .reads({ENBRDEN, ENAWREN}),
        .address({2'd0, ADDRAWRADDR}), .address_a({2'd0, ADDRAWRADDR}), .address_b({2'd0, ADDRBRDADDR}),
        .mask(SDP ? {WEBWEU, WEAWEL} : WEAWEL), .data(SDP ? {DIBDI, DIADI} : DIADI), .parity(SDP ? {DIPBDIP, DIPADIP} : DIPADIP),
        .value_a(a), .value_b(b), .parity_a(pa), .parity_b(pb)
    );
    assign DOADO = SDP ? b[15:0] : a[15:0], DOBDO = SDP ? b[31:16] : b[15:0];
    assign DOPADOP = SDP ? pb[1:0] : pa[1:0], DOPBDOP = SDP ? pb[3:2] : pb[1:0];
    always @(WEBWEU) if (!SDP && |WEBWEU) $display("port B of %m writes");
endmodule

// The 18 kbit block RAM of the Spartan-6.
module RAMB16BWER #(
    INITS(64, 8)
    parameter DATA_WIDTH_A = 0, DATA_WIDTH_B = 0, DOA_REG = 0, DOB_REG = 0, EN_RSTRAM_A = "TRUE", EN_RSTRAM_B = "TRUE",
    parameter INIT_A = 0, INIT_B = 0, RSTTYPE = "SYNC", RST_PRIORITY_A = "CE", RST_PRIORITY_B = "CE",
    parameter SRVAL_A = 0, SRVAL_B = 0, WRITE_MODE_A = "WRITE_FIRST", WRITE_MODE_B = "WRITE_FIRST"
) (
    input CLKA, CLKB, ENA, ENB, REGCEA, REGCEB, RSTA, RSTB,
    input [3:0] WEA, WEB, DIPA, DIPB,
    input [13:0] ADDRA, ADDRB,
    input [31:0] DIA, DIB,
    output [31:0] DOA, DOB,
    output [3:0] DOPA, DOPB
);
    wire [63:0] a, b;
    wire [7:0] pa, pb;
    bench_block_ram #(
        .BYTES(2048), .INIT(ALL_INITS(64)), .INITP(ALL_INITPS(8)), .READ_FIRST(WRITE_MODE_A == "READ_FIRST"),
        .READ_A(DATA_WIDTH_A), .READ_B(DATA_WIDTH_B), .WRITE(DATA_WIDTH_A)
    ) ram (
        .clock(CLKA | CLKB), .writes(ENA), .reads({ENB, ENA}),
        .address({1'd0, ADDRA}), .address_a({1'd0, ADDRA}), .address_b({1'd0, ADDRB}),
        .mask(WEA), .data(DIA), .parity(DIPA), .value_a(a), .value_b(b), .parity_a(pa), .parity_b(pb)
    );
    assign DOA = a, DOB = b, DOPA = pa, DOPB = pb;
    always @(WEB) if (|WEB) $display("port B of %m writes");
endmodule

// The 18 kbit block RAM of the Spartan-7. In SDP mode, port A reads and port B writes, and a word
// uses the data pins of both ports.
module RAMB18E1 #(
    INITS(64, 8)
    parameter DOA_REG = 0, DOB_REG = 0, INIT_A = 0, INIT_B = 0, RAM_MODE = "TDP",
    parameter READ_WIDTH_A = 0, READ_WIDTH_B = 0, WRITE_WIDTH_A = 0, WRITE_WIDTH_B = 0,
    parameter SRVAL_A = 0, SRVAL_B = 0, WRITE_MODE_A = "WRITE_FIRST", WRITE_MODE_B = "WRITE_FIRST"
) (
    input CLKARDCLK, CLKBWRCLK, ENARDEN, ENBWREN, REGCEAREGCE, REGCEB, RSTRAMARSTRAM, RSTRAMB, RSTREGARSTREG, RSTREGB,
    input [1:0] WEA, DIPADIP, DIPBDIP,
    input [3:0] WEBWE,
    input [13:0] ADDRARDADDR, ADDRBWRADDR,
    input [15:0] DIADI, DIBDI,
    output [15:0] DOADO, DOBDO,
    output [1:0] DOPADOP, DOPBDOP
);
    localparam SDP = RAM_MODE == "SDP";
    wire [63:0] a, b;
    wire [7:0] pa, pb;
    bench_block_ram #(
        .BYTES(2048), .INIT(ALL_INITS(64)), .INITP(ALL_INITPS(8)), .READ_FIRST(WRITE_MODE_A == "READ_FIRST"),
        .READ_A(READ_WIDTH_A), .READ_B(READ_WIDTH_B), .WRITE(SDP ? WRITE_WIDTH_B : WRITE_WIDTH_A)
    ) ram (
        .clock(CLKARDCLK | CLKBWRCLK), .writes(SDP ? ENBWREN : ENARDEN), .reads({ENBWREN, ENARDEN}),
        .address({1'd0, SDP ? ADDRBWRADDR : ADDRARDADDR}), .address_a({1'd0, ADDRARDADDR}), .address_b({1'd0, ADDRBWRADDR}),
        .mask(SDP ? WEBWE : WEA), .data(SDP ? {DIBDI, DIADI} : DIADI), .parity(SDP ? {DIPBDIP, DIPADIP} : DIPADIP),
        .value_a(a), .value_b(b), .parity_a(pa), .parity_b(pb)
    );
    assign DOADO = a[15:0], DOBDO = SDP ? a[31:16] : b[15:0];
    assign DOPADOP = pa[1:0], DOPBDOP = SDP ? pa[3:2] : pb[1:0];
    always @(WEA or WEBWE) if (|(SDP ? WEA : WEBWE)) $display("the other port of %m writes");
endmodule

// The 36 kbit block RAM of the Spartan-7.
module RAMB36E1 #(
    INITS(128, 16)
    parameter DOA_REG = 0, DOB_REG = 0, INIT_A = 0, INIT_B = 0, RAM_MODE = "TDP",
    parameter READ_WIDTH_A = 0, READ_WIDTH_B = 0, WRITE_WIDTH_A = 0, WRITE_WIDTH_B = 0,
    parameter SRVAL_A = 0, SRVAL_B = 0, WRITE_MODE_A = "WRITE_FIRST", WRITE_MODE_B = "WRITE_FIRST"
) (
    input CLKARDCLK, CLKBWRCLK, ENARDEN, ENBWREN, REGCEAREGCE, REGCEB, RSTRAMARSTRAM, RSTRAMB, RSTREGARSTREG, RSTREGB,
    input [3:0] WEA, DIPADIP, DIPBDIP,
    input [7:0] WEBWE,
    input [15:0] ADDRARDADDR, ADDRBWRADDR,
    input [31:0] DIADI, DIBDI,
    output [31:0] DOADO, DOBDO,
    output [3:0] DOPADOP, DOPBDOP
);
    localparam SDP = RAM_MODE == "SDP";
    wire [63:0] a, b;
    wire [7:0] pa, pb;
    bench_block_ram #(
        .BYTES(4096), .INIT(ALL_INITS(128)), .INITP(ALL_INITPS(16)), .READ_FIRST(WRITE_MODE_A == "READ_FIRST"),
        .READ_A(READ_WIDTH_A), .READ_B(READ_WIDTH_B), .WRITE(SDP ? WRITE_WIDTH_B : WRITE_WIDTH_A)
    ) ram (
        .clock(CLKARDCLK | CLKBWRCLK), .writes(SDP ? ENBWREN : ENARDEN), .reads({ENBWREN, ENARDEN}),
        .address(SDP ? ADDRBWRADDR[14:0] : ADDRARDADDR[14:0]), .address_a(ADDRARDADDR[14:0]), .address_b(ADDRBWRADDR[14:0]),
        .mask(SDP ? WEBWE : WEA), .data(SDP ? {DIBDI, DIADI} : DIADI), .parity(SDP ? {DIPBDIP, DIPADIP} : DIPADIP),
        .value_a(a), .value_b(b), .parity_a(pa), .parity_b(pb)
    );
    assign DOADO = a[31:0], DOBDO = SDP ? a[63:32] : b[31:0];
    assign DOPADOP = pa[3:0], DOPBDOP = SDP ? pa[7:4] : pb[3:0];
    always @(WEA or WEBWE) if (|(SDP ? WEA : WEBWE)) $display("the other port of %m writes");
endmodule
