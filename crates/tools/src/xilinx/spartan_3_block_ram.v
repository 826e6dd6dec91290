// Simulation model of the Spartan-3 block RAM NAME, whose ports have words of WIDTH_A and WIDTH_B
// bits. The model also has the parity ports that this cell does not have; they stay unconnected.
module NAME #(
    INITS(64, 8)
    parameter INIT_A = 0, INIT_B = 0, SRVAL_A = 0, SRVAL_B = 0, WRITE_MODE_A = "WRITE_FIRST", WRITE_MODE_B = "WRITE_FIRST"
) (
    input CLKA, CLKB, ENA, ENB, SSRA, SSRB, WEA, WEB,
    input [13-LOG_A:0] ADDRA,
    input [13-LOG_B:0] ADDRB,
    input [(1<<LOG_A)-1:0] DIA,
    input [(1<<LOG_B)-1:0] DIB,
    input [3:0] DIPA, DIPB,
    output [(1<<LOG_A)-1:0] DOA,
    output [(1<<LOG_B)-1:0] DOB,
    output [3:0] DOPA, DOPB
);
    wire [14:0] address_a = ADDRA << LOG_A, address_b = ADDRB << LOG_B;
    wire [63:0] a, b;
    wire [7:0] pa, pb;
    bench_block_ram #(
        .BYTES(2048), .INIT(ALL_INITS(64)), .INITP(ALL_INITPS(8)), .READ_FIRST(WRITE_MODE_A == "READ_FIRST"),
        .READ_A(WIDTH_A), .READ_B(WIDTH_B), .WRITE(WIDTH_A)
    ) ram (
        .clock(CLKA | CLKB), .writes(ENA), .reads({ENB, ENA}),
        .address(address_a), .address_a(address_a), .address_b(address_b),
        .mask({8{WEA}}), .data(DIA), .parity(DIPA), .value_a(a), .value_b(b), .parity_a(pa), .parity_b(pb)
    );
    assign DOA = a, DOB = b, DOPA = pa, DOPB = pb;
    always @(WEB) if (WEB) $display("port B of %m writes");
endmodule
