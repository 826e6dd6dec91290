// SPDX-License-Identifier: MIT OR Apache-2.0
//
// carrystep_link: the host link of an engine.
// This file is generated: change the generator instead.
//
// Made from    sim/six-axis.toml
// Made by      carrystep 0.1.0, with Rust-HDL 0.46.0
//
// Ports: inputs are sampled at the rising edge of `clock`, and outputs change after it; an output
// can also depend on inputs of the same clock. Signals are active high. The comment of a port says
// if it is otherwise; an asynchronous input may come directly from a pin. P is in 2^-64 step, V in
// 2^-64 step per tick, A in 2^-64 step per tick^2, and J in 2^-64 step per tick^3.
//
// The numbers of a build are parameters of the modules. If you override one, override BUILD_ID of
// the host link too: by this id the host knows the parameters for which it plans moves. With the id
// of other parameters it plans wrong moves, which is unsafe. The defaults of the parameters:
//
// Clock        80000000 Hz
// Line         uart, 87 clocks a bit
// Build id     106e11e37ad8277a

`default_nettype none

// Program memory of the processor carrystep_processor.
module carrystep_instructions (
    // The clock.
    input  wire         clock,
    // The address of the word to read.
    input  wire   [7:0] read_address,
    // The word at the address of the cycle before.
    output wire  [15:0] read_data,
    // The address of the word to write.
    input  wire   [7:0] write_address,
    // The write enable of each bit.
    input  wire  [15:0] write_bits,
    // The new values of the bits that are written.
    input  wire  [15:0] write_data
);
    // No word that is read in the clock in which it is written is ever used: no bypass is needed.
    (* no_rw_check, ram_style = "block" *) reg [15:0] words [0:255];
    reg [15:0] value; // a block RAM gives no value before its first clock
    integer i;

    assign read_data = value;

    initial begin
        for (i = 0; i < 256; i = i + 1) words[i] = 0;
        words[0] = 16'h80fb;
        words[1] = 16'h1011;
        words[2] = 16'h2402;
        words[3] = 16'h8200;
        words[4] = 16'h2709;
        words[5] = 16'h2202;
        words[6] = 16'h100c;
        words[7] = 16'h5102;
        words[8] = 16'h2002;
        words[9] = 16'h4080;
        words[10] = 16'h88fa;
        words[11] = 16'h2123;
        words[12] = 16'h8080;
        words[13] = 16'h88f9;
        words[14] = 16'h2111;
        words[15] = 16'h8080;
        words[16] = 16'h2005;
        words[17] = 16'h2411;
        words[18] = 16'h8200;
        words[19] = 16'h4080;
        words[20] = 16'h88f8;
        words[21] = 16'h211f;
        words[22] = 16'h8080;
        words[23] = 16'h88f7;
        words[24] = 16'h2121;
        words[25] = 16'h8080;
        words[26] = 16'h88fa;
        words[27] = 16'h2100;
        words[28] = 16'h80f6;
        words[29] = 16'h1001;
        words[30] = 16'h2002;
        words[31] = 16'h80fa;
        words[32] = 16'h2005;
        words[33] = 16'h80f9;
        words[34] = 16'h2005;
        words[35] = 16'h8300;
        words[36] = 16'h4081;
        words[37] = 16'h88f5;
        words[38] = 16'h2130;
        words[39] = 16'h801f;
        words[40] = 16'h1001;
        words[41] = 16'h2a00;
        words[42] = 16'h80f4;
        words[43] = 16'h232d;
        words[44] = 16'h80f3;
        words[45] = 16'h8881;
        words[46] = 16'h2900;
        words[47] = 16'h80f6;
        words[48] = 16'h4083;
        words[49] = 16'h80f2;
        words[50] = 16'h1001;
        words[51] = 16'h8400;
        words[52] = 16'h8900;
        words[53] = 16'h2900;
        words[54] = 16'h1006;
        words[55] = 16'h2233;
        words[56] = 16'h1080;
        words[57] = 16'h8083;
        words[58] = 16'h2197;
        words[59] = 16'h801e;
        words[60] = 16'h1001;
        words[61] = 16'h8882;
        words[62] = 16'h214b;
        words[63] = 16'h1002;
        words[64] = 16'h8300;
        words[65] = 16'h881e;
        words[66] = 16'h88f6;
        words[67] = 16'h2148;
        words[68] = 16'h8300;
        words[69] = 16'h8882;
        words[70] = 16'h293f;
        words[71] = 16'h2097;
        words[72] = 16'h80f1;
        words[73] = 16'h4083;
        words[74] = 16'h2097;
        words[75] = 16'h801f;
        words[76] = 16'h1001;
        words[77] = 16'h2376;
        words[78] = 16'h801f;
        words[79] = 16'h88f0;
        words[80] = 16'h215e;
        words[81] = 16'h801f;
        words[82] = 16'h88ef;
        words[83] = 16'h2171;
        words[84] = 16'h801f;
        words[85] = 16'h88ee;
        words[86] = 16'h2167;
        words[87] = 16'h801f;
        words[88] = 16'h88ed;
        words[89] = 16'h2162;
        words[90] = 16'h801f;
        words[91] = 16'h88ec;
        words[92] = 16'h2165;
        words[93] = 16'h2092;
        words[94] = 16'h8020;
        words[95] = 16'h4084;
        words[96] = 16'h1040;
        words[97] = 16'h2092;
        words[98] = 16'h8020;
        words[99] = 16'h10c0;
        words[100] = 16'h2092;
        words[101] = 16'h1140;
        words[102] = 16'h2092;
        words[103] = 16'h8084;
        words[104] = 16'h1240;
        words[105] = 16'h1020;
        words[106] = 16'h1020;
        words[107] = 16'h1020;
        words[108] = 16'h1020;
        words[109] = 16'h1020;
        words[110] = 16'h1020;
        words[111] = 16'h1040;
        words[112] = 16'h2092;
        words[113] = 16'h2592;
        words[114] = 16'h2e48;
        words[115] = 16'h8020;
        words[116] = 16'h1420;
        words[117] = 16'h2092;
        words[118] = 16'h2592;
        words[119] = 16'h1028;
        words[120] = 16'h1028;
        words[121] = 16'h8501;
        words[122] = 16'h2183;
        words[123] = 16'h80eb;
        words[124] = 16'h1001;
        words[125] = 16'h9102;
        words[126] = 16'h88ea;
        words[127] = 16'h2985;
        words[128] = 16'h8300;
        words[129] = 16'h88f5;
        words[130] = 16'h297d;
        words[131] = 16'h1100;
        words[132] = 16'h2092;
        words[133] = 16'h80eb;
        words[134] = 16'h1001;
        words[135] = 16'h9102;
        words[136] = 16'h1004;
        words[137] = 16'h9102;
        words[138] = 16'h1004;
        words[139] = 16'h9102;
        words[140] = 16'h1004;
        words[141] = 16'h8100;
        words[142] = 16'h1004;
        words[143] = 16'h801f;
        words[144] = 16'h1822;
        words[145] = 16'h2b87;
        words[146] = 16'h8082;
        words[147] = 16'h1001;
        words[148] = 16'h1002;
        words[149] = 16'h8300;
        words[150] = 16'h4082;
        words[151] = 16'h801f;
        words[152] = 16'h1001;
        words[153] = 16'h8083;
        words[154] = 16'h21a0;
        words[155] = 16'h80e9;
        words[156] = 16'h2b9f;
        words[157] = 16'h801f;
        words[158] = 16'h88e8;
        words[159] = 16'h1001;
        words[160] = 16'h8500;
        words[161] = 16'h4074;
        words[162] = 16'h8300;
        words[163] = 16'h1020;
        words[164] = 16'h1020;
        words[165] = 16'h8501;
        words[166] = 16'h8883;
        words[167] = 16'h4075;
        words[168] = 16'h8502;
        words[169] = 16'h4076;
        words[170] = 16'h8503;
        words[171] = 16'h4077;
        words[172] = 16'h1018;
        words[173] = 16'h8400;
        words[174] = 16'h4078;
        words[175] = 16'h1004;
        words[176] = 16'h8400;
        words[177] = 16'h4079;
        words[178] = 16'h1004;
        words[179] = 16'h8400;
        words[180] = 16'h407a;
        words[181] = 16'h1004;
        words[182] = 16'h8400;
        words[183] = 16'h407b;
        words[184] = 16'h1004;
        words[185] = 16'h801e;
        words[186] = 16'h4071;
        words[187] = 16'h801f;
        words[188] = 16'h4072;
        words[189] = 16'h8082;
        words[190] = 16'h4073;
        words[191] = 16'h80e7;
        words[192] = 16'h1011;
        words[193] = 16'h9102;
        words[194] = 16'h100c;
        words[195] = 16'h8300;
        words[196] = 16'h88e6;
        words[197] = 16'h29c1;
        words[198] = 16'h8400;
        words[199] = 16'h88ea;
        words[200] = 16'h5102;
        words[201] = 16'h1004;
        words[202] = 16'h2ac6;
        words[203] = 16'h80e7;
        words[204] = 16'h1001;
        words[205] = 16'h80fa;
        words[206] = 16'h1220;
        words[207] = 16'h22e2;
        words[208] = 16'h9102;
        words[209] = 16'h2fce;
        words[210] = 16'h4080;
        words[211] = 16'h88fa;
        words[212] = 16'h21da;
        words[213] = 16'h8080;
        words[214] = 16'h88f9;
        words[215] = 16'h21de;
        words[216] = 16'h8080;
        words[217] = 16'h20ce;
        words[218] = 16'h80f9;
        words[219] = 16'h1220;
        words[220] = 16'h80f8;
        words[221] = 16'h20ce;
        words[222] = 16'h80f9;
        words[223] = 16'h1220;
        words[224] = 16'h80f7;
        words[225] = 16'h20ce;
        words[226] = 16'h80fa;
        words[227] = 16'h1220;
        words[228] = 16'h2000;
    end

    always @(posedge clock) begin
        value <= words[read_address];
        if (write_bits[0]) words[write_address] <= write_data;
    end
endmodule

// Data memory of carrystep_processor: the request, its answer, constants and variables.
module carrystep_data (
    // The clock.
    input  wire         clock,
    // The address of the word to read.
    input  wire   [7:0] read_address,
    // The word at the address of the cycle before.
    output wire   [7:0] read_data,
    // The address of the word to write.
    input  wire   [7:0] write_address,
    // The write enable of each bit.
    input  wire   [7:0] write_bits,
    // The new values of the bits that are written.
    input  wire   [7:0] write_data
);
    // No word that is read in the clock in which it is written is ever used: no bypass is needed.
    (* no_rw_check, ram_style = "block" *) reg [7:0] words [0:255];
    reg [7:0] value; // a block RAM gives no value before its first clock
    integer i;

    assign read_data = value;

    initial begin
        for (i = 0; i < 256; i = i + 1) words[i] = 0;
        words[230] = 8'h7c;
        words[231] = 8'h71;
        words[232] = 8'hb0;
        words[233] = 8'h70;
        words[234] = 8'hff;
        words[235] = 8'h20;
        words[236] = 8'ha4;
        words[237] = 8'ha3;
        words[238] = 8'ha2;
        words[239] = 8'ha1;
        words[240] = 8'ha0;
        words[241] = 8'h88;
        words[242] = 8'hfc;
        words[243] = 8'h28;
        words[244] = 8'h44;
        words[245] = 8'h24;
        words[246] = 8'h80;
        words[247] = 8'hdd;
        words[248] = 8'hdc;
        words[249] = 8'hdb;
        words[250] = 8'hc0;
        words[251] = 8'h1e;
        words[252] = 8'he3;
        words[253] = 8'h20;
        words[254] = 8'hbb;
        words[255] = 8'hde;
    end

    always @(posedge clock) begin
        value <= words[read_address];
        if (write_bits[0]) words[write_address] <= write_data;
    end
endmodule

// Ring buffer of the received bytes that the processor has not read yet.
module carrystep_ring (
    // The clock.
    input  wire         clock,
    // The address of the word to read.
    input  wire   [7:0] read_address,
    // The word at the address of the cycle before.
    output wire   [7:0] read_data,
    // The address of the word to write.
    input  wire   [7:0] write_address,
    // The write enable of each bit.
    input  wire   [7:0] write_bits,
    // The new values of the bits that are written.
    input  wire   [7:0] write_data
);
    // No word that is read in the clock in which it is written is ever used: no bypass is needed.
    (* no_rw_check, ram_style = "block" *) reg [7:0] words [0:255];
    reg [7:0] value; // a block RAM gives no value before its first clock
    integer i;

    assign read_data = value;

    initial begin
        for (i = 0; i < 256; i = i + 1) words[i] = 0;
    end

    always @(posedge clock) begin
        value <= words[read_address];
        if (write_bits[0]) words[write_address] <= write_data;
    end
endmodule

// Computes the CRC-32 of frames, and assembles words from bytes; one bit per clock.
module carrystep_crc (
    // The clock.
    input  wire         clock,
    // Loads the register: with all ones, or with `word` if `feed` is set.
    input  wire         begins,
    // The word that `begins` loads if `feed` is set.
    input  wire  [31:0] word,
    // Shifts the register by one bit per clock. It is held for eight clocks.
    input  wire         step,
    // The byte that is processed.
    input  wire   [7:0] data,
    // If 1 during `step`, the byte enters the CRC. If 0, the byte is shifted into the upper end of
    // the register, and the next byte of the register moves to the lower end.
    input  wire         feed,
    // Asserted in the eighth of the eight clocks.
    output wire         over,
    // The content of the register.
    output wire  [31:0] word_out
);
    localparam [2:0] ONE = 3'd1;
    localparam [2:0] LAST = 3'd7;
    localparam BY_ONE = 1'b1;
    localparam [31:0] ONES = 32'hffffffff;
    localparam [31:0] TOP = 32'h80000000;
    localparam [31:0] POLYNOMIAL = 32'hedb88320;

    reg [31:0] sum = 32'd0;
    reg [2:0] count = 3'd0;

    wire [7:0] shifted = data >> count;
    wire data_bit = shifted[0];
    wire feedback = feed & (sum[0] ^ data_bit);

    assign over = count == LAST;
    assign word_out = sum;

    always @(posedge clock) begin
        if (step) begin
            count <= count + ONE;
            sum <= sum >> BY_ONE;
            if (!feed & data_bit) begin
                sum <= (sum >> BY_ONE) ^ TOP;
            end
            if (feedback) begin
                sum <= (sum >> BY_ONE) ^ POLYNOMIAL;
            end
        end
        if (begins & feed) begin
            sum <= word;
        end
        if (begins & !feed) begin
            sum <= ONES;
        end
    end
endmodule

// A small processor that reads the host's requests, executes them and writes the answers.
module carrystep_processor (
    // The clock.
    input  wire         clock,
    // The line has received a byte; asserted for one clock per byte.
    input  wire         received,
    // The received byte.
    input  wire   [7:0] received_data,
    // A is a byte of the answer. The machine offers it until the line accepts it.
    output wire         answer_valid,
    // The line accepts the offered byte in this clock.
    input  wire         answer_take,
    // X: the address of the facts that are read, and the number of the word that is offered.
    output wire   [7:0] x,
    // A: the byte of the answer, the axis of an offered word, the axes of a start, or the axes that
    // wait for their limit.
    output wire   [7:0] a,
    // The word of the facts at address X.
    input  wire  [31:0] facts,
    // The machine offers a word of a segment to the engine.
    output wire         put_valid,
    // The offered word.
    output wire  [31:0] put_data,
    // The engine accepts the offered word in this clock.
    input  wire         put_ready,
    // The machine offers a start of the axes in A.
    output wire         start_valid,
    // The engine accepts an offered start in this clock.
    input  wire         start_ready,
    // The engine clears a stop.
    output wire         clear,
    // The host has broken the segment protocol.
    output wire         broken,
    // A replaces the mask of the axes that wait for their limit.
    output wire         home_valid,
    // The host requests a snapshot.
    output wire         snapshot,
    // The host has sent a valid request.
    output wire         kick,
    // The host requests power for the motor drivers.
    output wire         enable,
    // The host requests a controlled stop of all axes.
    output wire         stop,
    // The engine has output all live words of a tick.
    input  wire         refreshed,
    // The engine has latched a stop.
    input  wire         fault,
    // No axis moves any more after a stop.
    input  wire         halted,
    // All axes are at rest and no start is armed.
    input  wire         idle,
    // The host requests power for the drivers and they have been powered for long enough, so that
    // the engine can accept a start.
    input  wire         ready,
    // A start is armed.
    input  wire         armed,
    // The first cause of the stop. Without a fault its value and that of `culprits` have no
    // meaning.
    input  wire   [3:0] cause,
    // The number of segments for which the queue of the axis in A has space.
    input  wire   [2:0] room,
    // `room` is valid in this clock.
    input  wire         room_valid,
    // The axes that caused the stop; bit i is axis i.
    input  wire   [5:0] culprits,
    // The axes that wait for their limit; bit i is axis i.
    input  wire   [5:0] homing
);
    localparam [1:0] FETCH = 2'd0;
    localparam [1:0] EXECUTE = 2'd2;
    localparam [1:0] NEXT_STAGE = 2'd1;
    localparam [7:0] ONE = 8'd1;
    localparam [2:0] FROM_DATA = 3'd0;
    localparam [2:0] FROM_DATA_AT_X = 3'd1;
    localparam [2:0] FROM_RING = 3'd2;
    localparam [2:0] FROM_X = 3'd3;
    localparam [2:0] FROM_CHECK = 3'd4;
    localparam [7:0] NONE = 8'd0;
    localparam [15:0] NO_CODE = 16'd0;
    localparam [7:0] ALL = 8'd255;
    localparam [3:0] AT_5 = 4'd5;
    localparam [7:0] BIT_0 = 8'd1;
    localparam [7:0] BIT_1 = 8'd2;
    localparam [7:0] BIT_2 = 8'd4;
    localparam [7:0] BIT_3 = 8'd8;
    localparam [7:0] BIT_4 = 8'd16;
    localparam [2:0] IF_ZERO = 3'd1;
    localparam [2:0] IF_X7 = 3'd2;
    localparam [2:0] IF_X6 = 3'd3;
    localparam [2:0] IF_NOTHING = 3'd4;
    localparam [2:0] IF_FAULT = 3'd5;
    localparam [2:0] IF_STARTABLE = 3'd6;
    localparam [2:0] IF_SPECIAL = 3'd7;

    reg [1:0] stage = 2'd0;
    reg [7:0] pc = 8'd0;
    reg [7:0] sum = 8'd0;
    reg [7:0] index = 8'd0;
    reg [7:0] written = 8'd0;
    reg [7:0] read = 8'd0;
    reg [2:0] space = 3'd0;
    reg [1:0] control = 2'd0;
    reg clears = 1'b0;
    reg [7:0] state;
    reg waited;
    reg holds;
    reg [7:0] port;
    reg [7:0] value;
    reg [7:0] place;
    reg [7:0] data_write_bits;
    reg [7:0] ring_write_bits;

    wire [15:0] instructions_read_data;
    wire [7:0] data_read_data;
    wire [7:0] ring_read_data;
    wire crc_over;
    wire [31:0] crc_word_out;

    wire [15:0] code = instructions_read_data;
    wire executes = stage == EXECUTE;
    wire sets = executes & code[15];
    wire stores = executes & code[14];
    wire jumps = code[13];
    wire acts = executes & code[12];
    wire does = acts & !code[15] & !code[14];
    wire steps = does & code[2];
    wire waits = does & code[5];
    wire over = (!waits | waited) & (!steps | crc_over);
    wire empty = read == written;

    assign answer_valid = waits & code[9];
    assign x = index;
    assign a = sum;
    assign put_valid = does & code[11];
    assign put_data = crc_word_out;
    assign start_valid = does & code[10];
    assign clear = clears;
    assign broken = does & code[8] & !code[6];
    assign home_valid = does & code[6] & code[7];
    assign snapshot = does & code[8] & code[6];
    assign kick = does & code[7] & !code[6];
    assign enable = control[0];
    assign stop = control[1];

    always @(*) begin
        state = NONE;
        if (fault) begin
            state = ({4'b0, cause} << AT_5) | BIT_0;
        end
        if (halted) begin
            state = state | BIT_1;
        end
        if (idle) begin
            state = state | BIT_2;
        end
        if (ready) begin
            state = state | BIT_3;
        end
        if (armed) begin
            state = state | BIT_4;
        end
    end

    always @(*) begin
        waited = refreshed | (code[3] & room_valid);
        if (code[11]) begin
            waited = put_ready | fault;
        end
        if (code[9]) begin
            waited = answer_take;
        end
        if (code[10]) begin
            waited = start_ready | fault;
        end
    end

    always @(*) begin
        holds = 1'b1;
        if (code[10:8] == IF_ZERO) begin
            holds = sum == 8'd0;
        end
        if (code[10:8] == IF_X7) begin
            holds = index[7];
        end
        if (code[10:8] == IF_X6) begin
            holds = index[6];
        end
        if (code[10:8] == IF_NOTHING) begin
            holds = empty;
        end
        if (code[10:8] == IF_FAULT) begin
            holds = fault;
        end
        if (code[10:8] == IF_STARTABLE) begin
            holds = ready & !armed;
        end
        if (code[10:8] == IF_SPECIAL) begin
            holds = sum[7] & sum[6];
        end
    end

    always @(*) begin
        port = state;
        if (code[0]) begin
            port = {5'b0, space};
            if (fault & cause[3]) begin
                port = {5'b0, space} | BIT_4;
            end
        end
        if (code[1]) begin
            port = NONE;
            if (fault) begin
                port = {2'b0, culprits};
            end
            if (code[0]) begin
                port = {2'b0, homing};
            end
        end
    end

    always @(*) begin
        value = port;
        if ((code[10:8] == FROM_DATA) | (code[10:8] == FROM_DATA_AT_X)) begin
            value = data_read_data;
        end
        if (code[10:8] == FROM_RING) begin
            value = ring_read_data;
        end
        if (code[10:8] == FROM_X) begin
            value = index;
        end
        if (code[10:8] == FROM_CHECK) begin
            value = crc_word_out[7:0];
        end
    end

    always @(*) begin
        place = code[7:0];
        if (code[8]) begin
            place = index;
        end
    end

    always @(*) begin
        data_write_bits = NONE;
        if (stores) begin
            data_write_bits = ALL;
        end
    end

    always @(*) begin
        ring_write_bits = NONE;
        if (received) begin
            ring_write_bits = ALL;
        end
    end

    carrystep_instructions instructions (
        .clock(clock),
        .read_address(pc),
        .read_data(instructions_read_data),
        .write_address(NONE),
        .write_bits(NO_CODE),
        .write_data(NO_CODE)
    );

    carrystep_data data (
        .clock(clock),
        .read_address(place),
        .read_data(data_read_data),
        .write_address(place),
        .write_bits(data_write_bits),
        .write_data(sum)
    );

    carrystep_ring ring (
        .clock(clock),
        .read_address(read),
        .read_data(ring_read_data),
        .write_address(written),
        .write_bits(ring_write_bits),
        .write_data(received_data)
    );

    carrystep_crc crc (
        .clock(clock),
        .begins(does & code[4]),
        .word(facts),
        .step(steps),
        .data(sum),
        .feed(code[3]),
        .over(crc_over),
        .word_out(crc_word_out)
    );

    always @(posedge clock) begin
        if (!executes) begin
            stage <= stage + NEXT_STAGE;
        end else if (over) begin
            stage <= FETCH;
        end
        if (executes & over) begin
            pc <= pc + ONE;
            if (jumps & (holds ^ code[11])) begin
                pc <= code[7:0];
            end
        end
        if (sets) begin
            sum <= value;
            if (code[11]) begin
                sum <= sum ^ value;
            end
        end
        if (acts & code[0]) begin
            index <= sum;
        end
        if (acts & code[1] & over) begin
            index <= index + ONE;
        end
        if (sets & (code[10:8] == FROM_RING)) begin
            read <= read + ONE;
        end
        if (received) begin
            written <= written + ONE;
        end
        if (room_valid) begin
            space <= room;
        end
        if (does & code[6] & !code[7] & !code[8]) begin
            control <= sum[1:0];
            clears <= code[9];
        end
    end
endmodule

// Memory of carrystep_register_mirror: constants of the build, and the words of state of each axis.
module carrystep_known #(
    // Build id: override it whenever you override another parameter; unique per set of parameters
    parameter [63:0] BUILD_ID = 64'h106e11e37ad8277a,
    // Frequency of the clock in Hz, reported to the host; 1 to 10^9
    parameter [31:0] CLOCK_HZ = 32'h4c4b400,
    // Length of a tick in ns, reported to the host; 1 to 2^32 - 1
    parameter [31:0] TICK_NS = 32'd1000,
    // Length of a round, the unit of the times below, in ticks; a power of two from 2 to 1024
    parameter [31:0] ROUND_TICKS = 32'd32,
    // Rounds without a valid frame of the host after which all axes stop; 0: no watchdog; 0 to 4095
    parameter [31:0] WATCHDOG_ROUNDS = 32'd3126
) (
    // The clock.
    input  wire         clock,
    // The address of the word to read.
    input  wire   [7:0] read_address,
    // The word at the address of the cycle before.
    output wire  [31:0] read_data,
    // The address of the word to write.
    input  wire   [7:0] write_address,
    // The write enable of each bit.
    input  wire  [31:0] write_bits,
    // The new values of the bits that are written.
    input  wire  [31:0] write_data
);
    // No word that is read in the clock in which it is written is ever used: no bypass is needed.
    (* no_rw_check, ram_style = "block" *) reg [31:0] words [0:255];
    reg [31:0] value; // a block RAM gives no value before its first clock
    integer i;

    assign read_data = value;

    initial begin
        for (i = 0; i < 256; i = i + 1) words[i] = 0;
        words[0] = 32'h50545343;
        words[1] = 32'h2;
        words[2] = BUILD_ID[31:0];
        words[3] = BUILD_ID[63:32];
        words[4] = 32'h6;
        words[5] = CLOCK_HZ;
        words[6] = TICK_NS;
        words[7] = 32'h10;
        words[8] = WATCHDOG_ROUNDS * ROUND_TICKS;
    end

    always @(posedge clock) begin
        value <= words[read_address];
        if (write_bits[0]) words[write_address][15:0] <= write_data[15:0];
        if (write_bits[16]) words[write_address][31:16] <= write_data[31:16];
    end
endmodule

// What the host can read: constants of the build, and the last words of state of each axis.
module carrystep_register_mirror #(
    // Build id: override it whenever you override another parameter; unique per set of parameters
    parameter [63:0] BUILD_ID = 64'h106e11e37ad8277a,
    // Frequency of the clock in Hz, reported to the host; 1 to 10^9
    parameter [31:0] CLOCK_HZ = 32'h4c4b400,
    // Length of a tick in ns, reported to the host; 1 to 2^32 - 1
    parameter [31:0] TICK_NS = 32'd1000,
    // Length of a round, the unit of the times below, in ticks; a power of two from 2 to 1024
    parameter [31:0] ROUND_TICKS = 32'd32,
    // Rounds without a valid frame of the host after which all axes stop; 0: no watchdog; 0 to 4095
    parameter [31:0] WATCHDOG_ROUNDS = 32'd3126
) (
    // The clock.
    input  wire         clock,
    // The address to read.
    input  wire   [7:0] address,
    // The word at the address of the clock before.
    output wire  [31:0] data,
    // The engine outputs a word of state in this clock.
    input  wire         state_valid,
    // Its page.
    input  wire   [1:0] state_page,
    // Its axis.
    input  wire   [2:0] state_axis,
    // Its item.
    input  wire   [2:0] state_item,
    // The word.
    input  wire  [31:0] state
);
    localparam [2:0] AT_3 = 3'd3;
    localparam [2:0] AT_6 = 3'd6;
    localparam [2:0] STATUS = 3'd7;
    localparam [31:0] NONE = 32'd0;
    localparam [31:0] LOW_HALF = 32'd65535;
    localparam [31:0] HIGH_HALF = 32'hffff0000;

    reg [31:0] low_written;
    reg [31:0] high_written;

    wire [31:0] known_read_data;

    wire [7:0] place = ({6'b0, state_page} << AT_6) | ({5'b0, state_item} << AT_3) | {5'b0, state_axis};

    assign data = known_read_data;

    always @(*) begin
        low_written = NONE;
        if (state_valid) begin
            low_written = LOW_HALF;
        end
    end

    always @(*) begin
        high_written = NONE;
        if (state_valid & (state_item != STATUS)) begin
            high_written = HIGH_HALF;
        end
    end

    carrystep_known #(
        .BUILD_ID(BUILD_ID),
        .CLOCK_HZ(CLOCK_HZ),
        .TICK_NS(TICK_NS),
        .ROUND_TICKS(ROUND_TICKS),
        .WATCHDOG_ROUNDS(WATCHDOG_ROUNDS)
    ) known (
        .clock(clock),
        .read_address(address),
        .read_data(known_read_data),
        .write_address(place),
        .write_bits(low_written | high_written),
        .write_data(state)
    );
endmodule

// The host link: receives requests, passes segments to the engine and sends answers.
module carrystep_link #(
    // Build id: override it whenever you override another parameter; unique per set of parameters
    parameter [63:0] BUILD_ID = 64'h106e11e37ad8277a,
    // Frequency of the clock in Hz, reported to the host; 1 to 10^9
    parameter [31:0] CLOCK_HZ = 32'h4c4b400,
    // Length of a tick in ns, reported to the host; 1 to 2^32 - 1
    parameter [31:0] TICK_NS = 32'd1000,
    // Length of a round, the unit of the times below, in ticks; a power of two from 2 to 1024
    parameter [31:0] ROUND_TICKS = 32'd32,
    // Rounds without a valid frame of the host after which all axes stop; 0: no watchdog; 0 to 4095
    parameter [31:0] WATCHDOG_ROUNDS = 32'd3126
) (
    // The clock.
    input  wire         clock,
    // The line has received a byte; asserted for one clock per byte.
    input  wire         received_valid,
    // The received byte.
    input  wire   [7:0] received,
    // The link offers a byte of the answer and holds it until the line accepts it.
    output wire         answer_valid,
    // The offered byte.
    output wire   [7:0] answer,
    // The line accepts the offered byte in this clock.
    input  wire         answer_take,
    // The link offers a word of a segment to the engine.
    output wire         put_valid,
    // The axis of the offered word. Also the axis whose free queue space the link reads.
    output wire   [2:0] put_axis,
    // The number of the offered word in its segment; 7 commits the segment.
    output wire   [2:0] put_word,
    // The offered word.
    output wire  [31:0] put_data,
    // The engine accepts the offered word in this clock.
    input  wire         put_ready,
    // The number of segments for which the queue of the axis `put_axis` has space.
    input  wire   [2:0] room,
    // `room` is valid in this clock.
    input  wire         room_valid,
    // The link offers a start to the engine.
    output wire         start_valid,
    // The axes to start; bit i is axis i.
    output wire   [5:0] start_mask,
    // The engine accepts an offered start in this clock.
    input  wire         start_ready,
    // The engine clears a stop.
    output wire         clear,
    // The host requests a controlled stop, as long as it is asserted.
    output wire         stop,
    // The host has broken the segment protocol.
    output wire         broken,
    // The host replaces the mask of the axes that wait for their limit.
    output wire         home_valid,
    // The axes that wait for their limit, valid with `home_valid`; bit i is axis i.
    output wire   [5:0] home_mask,
    // The host requests a snapshot of the state of all axes.
    output wire         snapshot,
    // The host has sent a valid request: the watchdog restarts.
    output wire         kick,
    // The host requests power for the motor drivers, as long as it is asserted.
    output wire         enable,
    // The engine outputs a word of the state of an axis in this clock.
    input  wire         state_valid,
    // The copy to which it belongs: 0 at the limit, 1 live, 2 snapshot.
    input  wire   [1:0] state_page,
    // Its axis, as a number from 0.
    input  wire   [2:0] state_axis,
    // Its meaning, numbered as at the port `state_item` of the engine.
    input  wire   [2:0] state_item,
    // The word.
    input  wire  [31:0] state,
    // All live words of this tick have been output.
    input  wire         refreshed,
    // The engine has latched a stop.
    input  wire         fault,
    // No axis moves any more after a stop.
    input  wire         halted,
    // All axes are at rest and no start is armed.
    input  wire         idle,
    // The host requests power for the drivers and they have been powered for long enough, so that
    // the engine can accept a start.
    input  wire         ready,
    // A start is armed.
    input  wire         armed,
    // The first cause of the stop, numbered as at the port `cause` of the engine.
    input  wire   [3:0] cause,
    // The axes that caused the stop; bit i is axis i.
    input  wire   [5:0] culprits,
    // The axes that wait for their limit; bit i is axis i.
    input  wire   [5:0] homing
);

    wire processor_answer_valid;
    wire [7:0] processor_x;
    wire [7:0] processor_a;
    wire processor_put_valid;
    wire [31:0] processor_put_data;
    wire processor_start_valid;
    wire processor_clear;
    wire processor_broken;
    wire processor_home_valid;
    wire processor_snapshot;
    wire processor_kick;
    wire processor_enable;
    wire processor_stop;
    wire [31:0] register_mirror_data;

    assign answer_valid = processor_answer_valid;
    assign answer = processor_a;
    assign put_valid = processor_put_valid;
    assign put_axis = processor_a[2:0];
    assign put_word = processor_x[4:2];
    assign put_data = processor_put_data;
    assign start_valid = processor_start_valid;
    assign start_mask = processor_a[5:0];
    assign clear = processor_clear;
    assign stop = processor_stop;
    assign broken = processor_broken;
    assign home_valid = processor_home_valid;
    assign home_mask = processor_a[5:0];
    assign snapshot = processor_snapshot;
    assign kick = processor_kick;
    assign enable = processor_enable;

    carrystep_processor processor (
        .clock(clock),
        .received(received_valid),
        .received_data(received),
        .answer_valid(processor_answer_valid),
        .answer_take(answer_take),
        .x(processor_x),
        .a(processor_a),
        .facts(register_mirror_data),
        .put_valid(processor_put_valid),
        .put_data(processor_put_data),
        .put_ready(put_ready),
        .start_valid(processor_start_valid),
        .start_ready(start_ready),
        .clear(processor_clear),
        .broken(processor_broken),
        .home_valid(processor_home_valid),
        .snapshot(processor_snapshot),
        .kick(processor_kick),
        .enable(processor_enable),
        .stop(processor_stop),
        .refreshed(refreshed),
        .fault(fault),
        .halted(halted),
        .idle(idle),
        .ready(ready),
        .armed(armed),
        .cause(cause),
        .room(room),
        .room_valid(room_valid),
        .culprits(culprits),
        .homing(homing)
    );

    carrystep_register_mirror #(
        .BUILD_ID(BUILD_ID),
        .CLOCK_HZ(CLOCK_HZ),
        .TICK_NS(TICK_NS),
        .ROUND_TICKS(ROUND_TICKS),
        .WATCHDOG_ROUNDS(WATCHDOG_ROUNDS)
    ) register_mirror (
        .clock(clock),
        .address(processor_x),
        .data(register_mirror_data),
        .state_valid(state_valid),
        .state_page(state_page),
        .state_axis(state_axis),
        .state_item(state_item),
        .state(state)
    );
endmodule

`default_nettype wire
