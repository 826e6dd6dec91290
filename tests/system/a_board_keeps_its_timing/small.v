// A small design for an iCE40 with every kind of cell that a board has: a PLL, a gated clock, pins,
// LUTs, carries, flip-flops with enable and synchronous reset, and block RAMs of three widths. All
// registers and memories start at 0.
module small_design (
    input wire oscillator,
    input wire [1:0] pins,
    output reg [7:0] out
);
    wire made;
    SB_PLL40_CORE #(
        .FEEDBACK_PATH("SIMPLE"), .DIVR(4'd0), .DIVF(7'd63), .DIVQ(3'd4), .FILTER_RANGE(3'd1)
    ) pll (
        .REFERENCECLK(oscillator), .PLLOUTGLOBAL(made), .RESETB(1'b1), .BYPASS(1'b0)
    );
    reg open = 1'b0;
    always @(negedge made) open <= 1'b1;
    wire clock;
    SB_GB gate (.USER_SIGNAL_TO_GLOBAL_BUFFER(made & open), .GLOBAL_BUFFER_OUTPUT(clock));

    reg [1:0] first = 2'd0, seen = 2'd0;
    reg [10:0] count = 11'd0;
    reg [15:0] sum = 16'd0, word = 16'd0;
    reg [7:0] half = 8'd0;
    reg [1:0] quarter = 2'd0;
    reg [15:0] words [0:255];
    reg [7:0] halves [0:511];
    reg [1:0] quarters [0:2047];
    integer i;
    initial begin
        out = 8'd0;
        for (i = 0; i < 256; i = i + 1) words[i] = 16'd0;
        for (i = 0; i < 512; i = i + 1) halves[i] = 8'd0;
        for (i = 0; i < 2048; i = i + 1) quarters[i] = 2'd0;
    end

    always @(posedge clock) begin
        first <= pins;
        seen <= first;
        if (seen[0]) count <= count + 11'd37;
        if (seen[1]) sum <= 16'd0;
        else sum <= sum + (word ^ {half, half}) + {count[2:0], quarter, count};
        words[count[7:0]] <= sum;
        halves[count[8:0]] <= sum[11:4];
        if (seen[0]) quarters[count] <= sum[8:7];
        word <= words[sum[9:2]];
        half <= halves[sum[8:0]];
        quarter <= quarters[sum[10:0]];
        out <= sum[15:8] ^ sum[7:0];
    end
endmodule
