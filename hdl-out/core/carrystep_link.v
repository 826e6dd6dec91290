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
// Build id     5db5a34c719955df

`default_nettype none

// Program memory of the processor carrystep_processor.
module carrystep_instructions (
    // The clock.
    input  wire         clock,
    // The address of the word to read.
    input  wire   [8:0] read_address,
    // The word at the address of the cycle before.
    output wire  [15:0] read_data,
    // The address of the word to write.
    input  wire   [8:0] write_address,
    // The write enable of each bit.
    input  wire  [15:0] write_bits,
    // The new values of the bits that are written.
    input  wire  [15:0] write_data
);
    // No word that is read in the clock in which it is written is ever used: no bypass is needed.
    (* no_rw_check, ram_style = "block" *) reg [15:0] words [0:511];
    reg [15:0] value; // a block RAM gives no value before its first clock
    integer i;

    assign read_data = value;

    initial begin
        for (i = 0; i < 512; i = i + 1) words[i] = 0;
        words[0] = 16'h8209;
        words[1] = 16'h1011;
        words[2] = 16'h2802;
        words[3] = 16'h8400;
        words[4] = 16'h2e09;
        words[5] = 16'h2602;
        words[6] = 16'h100c;
        words[7] = 16'h5102;
        words[8] = 16'h2002;
        words[9] = 16'h4000;
        words[10] = 16'h8a0a;
        words[11] = 16'h221f;
        words[12] = 16'h8a09;
        words[13] = 16'h2210;
        words[14] = 16'h8000;
        words[15] = 16'h2005;
        words[16] = 16'h2810;
        words[17] = 16'h8400;
        words[18] = 16'h8a0b;
        words[19] = 16'h221b;
        words[20] = 16'h8a0c;
        words[21] = 16'h221d;
        words[22] = 16'h8a0d;
        words[23] = 16'h2200;
        words[24] = 16'h820e;
        words[25] = 16'h1001;
        words[26] = 16'h2002;
        words[27] = 16'h820a;
        words[28] = 16'h2005;
        words[29] = 16'h820f;
        words[30] = 16'h2005;
        words[31] = 16'h8210;
        words[32] = 16'h4003;
        words[33] = 16'h400b;
        words[34] = 16'h8500;
        words[35] = 16'h4001;
        words[36] = 16'h8a11;
        words[37] = 16'h2240;
        words[38] = 16'h8a12;
        words[39] = 16'h2240;
        words[40] = 16'h801c;
        words[41] = 16'h1001;
        words[42] = 16'h3400;
        words[43] = 16'hc213;
        words[44] = 16'h2239;
        words[45] = 16'h801c;
        words[46] = 16'h8a14;
        words[47] = 16'h2248;
        words[48] = 16'h8215;
        words[49] = 16'h4010;
        words[50] = 16'h8216;
        words[51] = 16'h4011;
        words[52] = 16'h8217;
        words[53] = 16'h8801;
        words[54] = 16'h3200;
        words[55] = 16'h8218;
        words[56] = 16'h2040;
        words[57] = 16'h8219;
        words[58] = 16'h8801;
        words[59] = 16'h3200;
        words[60] = 16'h8218;
        words[61] = 16'h4002;
        words[62] = 16'h8210;
        words[63] = 16'h2043;
        words[64] = 16'h4002;
        words[65] = 16'h801c;
        words[66] = 16'hc21a;
        words[67] = 16'h8a1b;
        words[68] = 16'h1001;
        words[69] = 16'h8300;
        words[70] = 16'h4008;
        words[71] = 16'h2069;
        words[72] = 16'h8218;
        words[73] = 16'h4002;
        words[74] = 16'h801f;
        words[75] = 16'h4008;
        words[76] = 16'h821c;
        words[77] = 16'h4010;
        words[78] = 16'h821d;
        words[79] = 16'h4011;
        words[80] = 16'h821b;
        words[81] = 16'h4009;
        words[82] = 16'h1001;
        words[83] = 16'h8008;
        words[84] = 16'hc300;
        words[85] = 16'h225c;
        words[86] = 16'h8011;
        words[87] = 16'h1001;
        words[88] = 16'h1002;
        words[89] = 16'h1002;
        words[90] = 16'h8500;
        words[91] = 16'h4011;
        words[92] = 16'h8009;
        words[93] = 16'h1001;
        words[94] = 16'h1002;
        words[95] = 16'h8500;
        words[96] = 16'h2451;
        words[97] = 16'h8011;
        words[98] = 16'h1001;
        words[99] = 16'h8300;
        words[100] = 16'h8801;
        words[101] = 16'h3200;
        words[102] = 16'h1002;
        words[103] = 16'h8300;
        words[104] = 16'h4011;
        words[105] = 16'h821e;
        words[106] = 16'h1001;
        words[107] = 16'h8600;
        words[108] = 16'h8b00;
        words[109] = 16'h3200;
        words[110] = 16'h1006;
        words[111] = 16'h346b;
        words[112] = 16'h8002;
        words[113] = 16'h2277;
        words[114] = 16'h801c;
        words[115] = 16'h8a1f;
        words[116] = 16'h327a;
        words[117] = 16'h1180;
        words[118] = 16'h2164;
        words[119] = 16'h8001;
        words[120] = 16'h8a11;
        words[121] = 16'h2364;
        words[122] = 16'h801d;
        words[123] = 16'h327e;
        words[124] = 16'h801e;
        words[125] = 16'h22a5;
        words[126] = 16'h8002;
        words[127] = 16'h2283;
        words[128] = 16'h801c;
        words[129] = 16'h8a20;
        words[130] = 16'h228d;
        words[131] = 16'h801d;
        words[132] = 16'h8805;
        words[133] = 16'h32a5;
        words[134] = 16'h801e;
        words[135] = 16'h8806;
        words[136] = 16'h32a5;
        words[137] = 16'h1080;
        words[138] = 16'h8002;
        words[139] = 16'h2364;
        words[140] = 16'h20a8;
        words[141] = 16'h8700;
        words[142] = 16'hc20a;
        words[143] = 16'h2299;
        words[144] = 16'h801d;
        words[145] = 16'h4005;
        words[146] = 16'h801e;
        words[147] = 16'h4006;
        words[148] = 16'h8210;
        words[149] = 16'h4004;
        words[150] = 16'h10c0;
        words[151] = 16'h1080;
        words[152] = 16'h2164;
        words[153] = 16'h801f;
        words[154] = 16'hc20c;
        words[155] = 16'h229d;
        words[156] = 16'h1180;
        words[157] = 16'h8221;
        words[158] = 16'h20a6;
        words[159] = 16'h8222;
        words[160] = 16'h20a6;
        words[161] = 16'h8213;
        words[162] = 16'h20a6;
        words[163] = 16'h8224;
        words[164] = 16'h20a6;
        words[165] = 16'h8225;
        words[166] = 16'h4003;
        words[167] = 16'h2164;
        words[168] = 16'h801b;
        words[169] = 16'h1001;
        words[170] = 16'h8804;
        words[171] = 16'h22b5;
        words[172] = 16'h1002;
        words[173] = 16'h8500;
        words[174] = 16'h881b;
        words[175] = 16'h8a1d;
        words[176] = 16'h229f;
        words[177] = 16'h8500;
        words[178] = 16'h8804;
        words[179] = 16'h32ac;
        words[180] = 16'h2164;
        words[181] = 16'h801c;
        words[182] = 16'h8a26;
        words[183] = 16'h22ea;
        words[184] = 16'hc213;
        words[185] = 16'h2302;
        words[186] = 16'h801c;
        words[187] = 16'h8a28;
        words[188] = 16'h22c8;
        words[189] = 16'h8a0c;
        words[190] = 16'h22df;
        words[191] = 16'h8a29;
        words[192] = 16'h22d5;
        words[193] = 16'h8a0c;
        words[194] = 16'h22cc;
        words[195] = 16'h8a1a;
        words[196] = 16'h22d3;
        words[197] = 16'h8a29;
        words[198] = 16'h22d1;
        words[199] = 16'h215f;
        words[200] = 16'h801f;
        words[201] = 16'h4007;
        words[202] = 16'h1040;
        words[203] = 16'h215f;
        words[204] = 16'h8020;
        words[205] = 16'h11c0;
        words[206] = 16'h801f;
        words[207] = 16'h10c0;
        words[208] = 16'h215f;
        words[209] = 16'h1280;
        words[210] = 16'h215f;
        words[211] = 16'h1140;
        words[212] = 16'h215f;
        words[213] = 16'h8007;
        words[214] = 16'h1240;
        words[215] = 16'h1020;
        words[216] = 16'h1020;
        words[217] = 16'h1020;
        words[218] = 16'h1020;
        words[219] = 16'h1020;
        words[220] = 16'h1020;
        words[221] = 16'h1040;
        words[222] = 16'h215f;
        words[223] = 16'h2b5f;
        words[224] = 16'h8704;
        words[225] = 16'hc01f;
        words[226] = 16'h32a1;
        words[227] = 16'h8700;
        words[228] = 16'hc22a;
        words[229] = 16'h8a12;
        words[230] = 16'h329d;
        words[231] = 16'h801f;
        words[232] = 16'h1420;
        words[233] = 16'h215f;
        words[234] = 16'h8215;
        words[235] = 16'h1001;
        words[236] = 16'h9102;
        words[237] = 16'h1004;
        words[238] = 16'h9102;
        words[239] = 16'h1004;
        words[240] = 16'h9102;
        words[241] = 16'h1004;
        words[242] = 16'h9102;
        words[243] = 16'h1004;
        words[244] = 16'h22f7;
        words[245] = 16'h8300;
        words[246] = 16'h1820;
        words[247] = 16'h8300;
        words[248] = 16'h3eec;
        words[249] = 16'h1340;
        words[250] = 16'h1020;
        words[251] = 16'h1020;
        words[252] = 16'h1020;
        words[253] = 16'h2b5f;
        words[254] = 16'h8700;
        words[255] = 16'hc222;
        words[256] = 16'h32a3;
        words[257] = 16'h215f;
        words[258] = 16'h2b5f;
        words[259] = 16'h822c;
        words[260] = 16'h1001;
        words[261] = 16'h8008;
        words[262] = 16'h2323;
        words[263] = 16'h1018;
        words[264] = 16'h8600;
        words[265] = 16'h1001;
        words[266] = 16'h8008;
        words[267] = 16'hc300;
        words[268] = 16'h8808;
        words[269] = 16'h3323;
        words[270] = 16'h8704;
        words[271] = 16'hc008;
        words[272] = 16'h32a1;
        words[273] = 16'h8010;
        words[274] = 16'h1001;
        words[275] = 16'h9102;
        words[276] = 16'h400c;
        words[277] = 16'h9102;
        words[278] = 16'h400d;
        words[279] = 16'h9102;
        words[280] = 16'h400e;
        words[281] = 16'h9102;
        words[282] = 16'h400f;
        words[283] = 16'hc00c;
        words[284] = 16'hc00d;
        words[285] = 16'hc00e;
        words[286] = 16'h8a2d;
        words[287] = 16'h2323;
        words[288] = 16'h2169;
        words[289] = 16'h8701;
        words[290] = 16'h3325;
        words[291] = 16'h1100;
        words[292] = 16'h215f;
        words[293] = 16'h8011;
        words[294] = 16'h1001;
        words[295] = 16'h9102;
        words[296] = 16'h40f0;
        words[297] = 16'h9102;
        words[298] = 16'h40f1;
        words[299] = 16'h9102;
        words[300] = 16'h40f2;
        words[301] = 16'h9102;
        words[302] = 16'h40f3;
        words[303] = 16'h821b;
        words[304] = 16'h4009;
        words[305] = 16'h1001;
        words[306] = 16'h8008;
        words[307] = 16'hc300;
        words[308] = 16'h2359;
        words[309] = 16'h8010;
        words[310] = 16'h1001;
        words[311] = 16'h800c;
        words[312] = 16'h5102;
        words[313] = 16'h800d;
        words[314] = 16'h5102;
        words[315] = 16'h800e;
        words[316] = 16'h5102;
        words[317] = 16'h800f;
        words[318] = 16'h5102;
        words[319] = 16'h8010;
        words[320] = 16'h1001;
        words[321] = 16'h8500;
        words[322] = 16'h4010;
        words[323] = 16'h9102;
        words[324] = 16'h1004;
        words[325] = 16'h9102;
        words[326] = 16'h1004;
        words[327] = 16'h9102;
        words[328] = 16'h1004;
        words[329] = 16'h9102;
        words[330] = 16'h1004;
        words[331] = 16'h8009;
        words[332] = 16'h1820;
        words[333] = 16'h2752;
        words[334] = 16'h3d41;
        words[335] = 16'h820e;
        words[336] = 16'h1001;
        words[337] = 16'h2143;
        words[338] = 16'h80f0;
        words[339] = 16'hc20c;
        words[340] = 16'h40f0;
        words[341] = 16'h8210;
        words[342] = 16'h40f1;
        words[343] = 16'h40f2;
        words[344] = 16'h40f3;
        words[345] = 16'h8009;
        words[346] = 16'h1001;
        words[347] = 16'h1002;
        words[348] = 16'h8500;
        words[349] = 16'h2530;
        words[350] = 16'h215f;
        words[351] = 16'h8004;
        words[352] = 16'h1001;
        words[353] = 16'h1002;
        words[354] = 16'h8500;
        words[355] = 16'h4004;
        words[356] = 16'h8700;
        words[357] = 16'h8802;
        words[358] = 16'h40f3;
        words[359] = 16'h820c;
        words[360] = 16'h400b;
        words[361] = 16'h1010;
        words[362] = 16'h821b;
        words[363] = 16'h4009;
        words[364] = 16'h1001;
        words[365] = 16'h8008;
        words[366] = 16'hc300;
        words[367] = 16'h2373;
        words[368] = 16'h8009;
        words[369] = 16'h1028;
        words[370] = 16'h1028;
        words[371] = 16'h8009;
        words[372] = 16'h1001;
        words[373] = 16'h1002;
        words[374] = 16'h8500;
        words[375] = 16'h256b;
        words[376] = 16'h800b;
        words[377] = 16'h2321;
        words[378] = 16'h8701;
        words[379] = 16'h40f4;
        words[380] = 16'h8002;
        words[381] = 16'h2385;
        words[382] = 16'h801c;
        words[383] = 16'hc213;
        words[384] = 16'h2383;
        words[385] = 16'h801c;
        words[386] = 16'hc21a;
        words[387] = 16'h8a2e;
        words[388] = 16'h2186;
        words[389] = 16'h801c;
        words[390] = 16'h1001;
        words[391] = 16'h1020;
        words[392] = 16'h1020;
        words[393] = 16'h80f3;
        words[394] = 16'hc20c;
        words[395] = 16'h2390;
        words[396] = 16'h8702;
        words[397] = 16'h40f5;
        words[398] = 16'h8706;
        words[399] = 16'h2191;
        words[400] = 16'h40f5;
        words[401] = 16'h8803;
        words[402] = 16'h40f7;
        words[403] = 16'h8703;
        words[404] = 16'h40f6;
        words[405] = 16'h1018;
        words[406] = 16'h8600;
        words[407] = 16'h40f8;
        words[408] = 16'h1004;
        words[409] = 16'h8600;
        words[410] = 16'h40f9;
        words[411] = 16'h1004;
        words[412] = 16'h8600;
        words[413] = 16'h40fa;
        words[414] = 16'h1004;
        words[415] = 16'h8600;
        words[416] = 16'h40fb;
        words[417] = 16'h1004;
        words[418] = 16'h8002;
        words[419] = 16'h33d5;
        words[420] = 16'h801c;
        words[421] = 16'h8a30;
        words[422] = 16'h23ad;
        words[423] = 16'h8a29;
        words[424] = 16'h23b2;
        words[425] = 16'h8a0c;
        words[426] = 16'h33d5;
        words[427] = 16'h8213;
        words[428] = 16'h21b3;
        words[429] = 16'h8704;
        words[430] = 16'h40f8;
        words[431] = 16'h8705;
        words[432] = 16'h40f9;
        words[433] = 16'h21d5;
        words[434] = 16'h821d;
        words[435] = 16'h4012;
        words[436] = 16'h8228;
        words[437] = 16'h4013;
        words[438] = 16'h8210;
        words[439] = 16'h400a;
        words[440] = 16'h821b;
        words[441] = 16'h4009;
        words[442] = 16'h8013;
        words[443] = 16'h1001;
        words[444] = 16'h8009;
        words[445] = 16'h8b00;
        words[446] = 16'h1001;
        words[447] = 16'h1018;
        words[448] = 16'h8009;
        words[449] = 16'h1001;
        words[450] = 16'h8600;
        words[451] = 16'hc012;
        words[452] = 16'h23c8;
        words[453] = 16'h800a;
        words[454] = 16'h8b00;
        words[455] = 16'h400a;
        words[456] = 16'h1002;
        words[457] = 16'h8500;
        words[458] = 16'h25b9;
        words[459] = 16'h8013;
        words[460] = 16'h8a31;
        words[461] = 16'h1001;
        words[462] = 16'h800a;
        words[463] = 16'h5102;
        words[464] = 16'h8500;
        words[465] = 16'h8a32;
        words[466] = 16'h23d5;
        words[467] = 16'h8a34;
        words[468] = 16'h21b5;
        words[469] = 16'h801b;
        words[470] = 16'h40f0;
        words[471] = 16'h801c;
        words[472] = 16'h40f1;
        words[473] = 16'h8004;
        words[474] = 16'h40f2;
        words[475] = 16'h820e;
        words[476] = 16'h1011;
        words[477] = 16'h9102;
        words[478] = 16'h100c;
        words[479] = 16'h8500;
        words[480] = 16'h8a32;
        words[481] = 16'h33dd;
        words[482] = 16'h8600;
        words[483] = 16'h8a2d;
        words[484] = 16'h5102;
        words[485] = 16'h1004;
        words[486] = 16'h25e2;
        words[487] = 16'h820e;
        words[488] = 16'h1001;
        words[489] = 16'h820a;
        words[490] = 16'h1220;
        words[491] = 16'h35fd;
        words[492] = 16'h9102;
        words[493] = 16'h3fea;
        words[494] = 16'h4000;
        words[495] = 16'h8a0a;
        words[496] = 16'h23f5;
        words[497] = 16'h8a09;
        words[498] = 16'h23f9;
        words[499] = 16'h8000;
        words[500] = 16'h21ea;
        words[501] = 16'h820f;
        words[502] = 16'h1220;
        words[503] = 16'h820b;
        words[504] = 16'h21ea;
        words[505] = 16'h820f;
        words[506] = 16'h1220;
        words[507] = 16'h8235;
        words[508] = 16'h21ea;
        words[509] = 16'h820a;
        words[510] = 16'h1220;
        words[511] = 16'h2000;
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
    input  wire   [8:0] read_address,
    // The word at the address of the cycle before.
    output wire   [7:0] read_data,
    // The address of the word to write.
    input  wire   [8:0] write_address,
    // The write enable of each bit.
    input  wire   [7:0] write_bits,
    // The new values of the bits that are written.
    input  wire   [7:0] write_data
);
    // No word that is read in the clock in which it is written is ever used: no bypass is needed.
    (* no_rw_check, ram_style = "block" *) reg [7:0] words [0:511];
    reg [7:0] value; // a block RAM gives no value before its first clock
    integer i;

    assign read_data = value;

    initial begin
        for (i = 0; i < 512; i = i + 1) words[i] = 0;
        words[257] = 8'h1;
        words[258] = 8'h3;
        words[259] = 8'h7;
        words[260] = 8'hf;
        words[261] = 8'h1f;
        words[262] = 8'h3f;
        words[263] = 8'h7f;
        words[264] = 8'hff;
        words[265] = 8'h1b;
        words[266] = 8'hc0;
        words[267] = 8'hdc;
        words[268] = 8'h1;
        words[269] = 8'h1d;
        words[270] = 8'hf0;
        words[271] = 8'hdb;
        words[273] = 8'h21;
        words[274] = 8'h2;
        words[275] = 8'h40;
        words[276] = 8'hc8;
        words[277] = 8'h1f;
        words[278] = 8'h3b;
        words[279] = 8'h43;
        words[280] = 8'h8;
        words[281] = 8'h27;
        words[282] = 8'h7;
        words[283] = 8'hf8;
        words[284] = 8'h23;
        words[285] = 8'h80;
        words[286] = 8'h7c;
        words[287] = 8'ha6;
        words[288] = 8'ha5;
        words[289] = 8'h20;
        words[290] = 8'h10;
        words[292] = 8'h50;
        words[293] = 8'h30;
        words[294] = 8'hd0;
        words[295] = 8'h1;
        words[296] = 8'ha0;
        words[297] = 8'h3;
        words[298] = 8'h6;
        words[299] = 8'h2;
        words[300] = 8'h4;
        words[301] = 8'hff;
        words[302] = 8'h70;
        words[303] = 8'h3;
        words[304] = 8'h9;
        words[305] = 8'h58;
        words[306] = 8'hfc;
        words[307] = 8'h4;
        words[308] = 8'ha4;
        words[309] = 8'hdd;
        words[311] = 8'h5;
        words[315] = 8'h6;
        words[319] = 8'hc7;
        words[380] = 8'he3;
        words[381] = 8'h20;
        words[382] = 8'hbb;
        words[383] = 8'hde;
        words[384] = 8'h2f;
        words[385] = 8'h27;
        words[386] = 8'h47;
        words[387] = 8'h3f;
        words[388] = 8'h5f;
        words[389] = 8'h57;
        words[390] = 8'h77;
        words[391] = 8'h6f;
        words[392] = 8'h8f;
        words[393] = 8'h87;
        words[394] = 8'ha7;
        words[395] = 8'h9f;
        words[396] = 8'hbf;
        words[397] = 8'hb7;
        words[398] = 8'hd7;
        words[399] = 8'hcf;
        words[400] = 8'hef;
        words[401] = 8'he7;
        words[416] = 8'he8;
        words[417] = 8'ha8;
        words[418] = 8'h68;
        words[419] = 8'h28;
        words[504] = 8'h1;
        words[505] = 8'h2;
        words[506] = 8'h4;
        words[507] = 8'h8;
        words[508] = 8'h10;
        words[509] = 8'h20;
        words[510] = 8'h40;
        words[511] = 8'h80;
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
    input  wire   [8:0] read_address,
    // The word at the address of the cycle before.
    output wire   [7:0] read_data,
    // The address of the word to write.
    input  wire   [8:0] write_address,
    // The write enable of each bit.
    input  wire   [7:0] write_bits,
    // The new values of the bits that are written.
    input  wire   [7:0] write_data
);
    // No word that is read in the clock in which it is written is ever used: no bypass is needed.
    (* no_rw_check, ram_style = "block" *) reg [7:0] words [0:511];
    reg [7:0] value; // a block RAM gives no value before its first clock
    integer i;

    assign read_data = value;

    initial begin
        for (i = 0; i < 512; i = i + 1) words[i] = 0;
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
    // X: the address of the facts that are read.
    output wire   [7:0] x,
    // A: the byte of the answer, the axis of an offered word, the axes of a start, or the axes that
    // wait for their limit.
    output wire   [7:0] a,
    // The word of the facts at address X.
    input  wire  [31:0] facts,
    // The machine offers a word of a segment to the engine.
    output wire         put_valid,
    // The number of the offered word: 0 to 7 in its segment, or 8 where it names the slot of a cut.
    output reg    [3:0] put_word,
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
    // A replaces the source of seeks.
    output wire         seek_source_valid,
    // A replaces the mask of the axes that wait for the source of their seek.
    output wire         seek_valid,
    // The latch is armed.
    output wire         latch_arm,
    // The host requests a snapshot.
    output wire         snapshot,
    // The host requests a cut.
    output wire         cut,
    // The owner of the session has sent a valid request.
    output wire         kick,
    // The host requests power for the motor drivers.
    output wire         enable,
    // The host requests a controlled stop of all axes.
    output wire         stop,
    // The engine has output all live words of a tick.
    input  wire         refreshed,
    // The engine has refused the last cut.
    input  wire         cut_refused,
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
    input  wire   [4:0] room,
    // `room` is valid in this clock.
    input  wire         room_valid,
    // The axes that caused the stop; bit i is axis i.
    input  wire   [5:0] culprits,
    // The axes that wait for the source of their seek; bit i is axis i.
    input  wire   [5:0] seeking,
    // The axes that have hit it, until the host ends the seek; bit i is axis i.
    input  wire   [5:0] hits,
    // The latch waits for its edge.
    input  wire         latch_armed,
    // The edges since the latch was armed that it did not latch, at most 15.
    input  wire   [3:0] latch_edges
);
    localparam [1:0] FETCH = 2'd0;
    localparam [1:0] EXECUTE = 2'd2;
    localparam [1:0] NEXT_STAGE = 2'd1;
    localparam [7:0] ONE = 8'd1;
    localparam [8:0] NEXT_PLACE = 9'd1;
    localparam [2:0] NEXT_WORD = 3'd1;
    localparam [2:0] LAST_WORD = 3'd7;
    localparam [8:0] CONSTANTS = 9'd256;
    localparam [2:0] FROM_RING = 3'd4;
    localparam [7:0] NONE = 8'd0;
    localparam [8:0] NO_PLACE = 9'd0;
    localparam [15:0] NO_CODE = 16'd0;
    localparam [7:0] ALL = 8'd255;
    localparam [4:0] ANY_SPACE = 5'd31;
    localparam [3:0] SLOT_OF_CUT = 4'd8;
    localparam [3:0] TOP = 4'd15;
    localparam [7:0] BIT_0 = 8'd1;
    localparam [7:0] BIT_1 = 8'd2;
    localparam [7:0] BIT_2 = 8'd4;
    localparam [7:0] BIT_4 = 8'd16;
    localparam [7:0] BIT_6 = 8'd64;
    localparam [7:0] BIT_7 = 8'd128;
    localparam [2:0] IF_ZERO = 3'd1;
    localparam [2:0] IF_X7 = 3'd2;
    localparam [2:0] IF_FULL = 3'd3;
    localparam [2:0] IF_NOTHING = 3'd4;
    localparam [2:0] IF_FAULT = 3'd5;
    localparam [2:0] IF_COMMIT = 3'd6;
    localparam [2:0] IF_SPECIAL = 3'd7;

    reg [1:0] stage = 2'd0;
    reg [8:0] pc = 9'd0;
    reg [7:0] sum = 8'd0;
    reg [7:0] index = 8'd0;
    reg [8:0] written = 9'd0;
    reg [8:0] read = 9'd0;
    reg [2:0] word = 3'd0;
    reg [4:0] space = 5'd0;
    reg power = 1'b0;
    reg clears = 1'b0;
    reg [7:0] state;
    reg waited;
    reg holds;
    reg [7:0] port;
    reg [7:0] other;
    reg [7:0] value;
    reg [7:0] place;
    reg [8:0] page;
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
    wire stores = executes & code[14] & !code[15];
    wire jumps = code[13];
    wire acts = executes & code[12] & !code[13];
    wire only_acts = !code[13] & !code[14] & !code[15];
    wire does = executes & only_acts;
    wire steps = does & code[2];
    wire waits = does & code[5];
    wire over = (!waits | waited) & (!steps | crc_over);
    wire empty = read == written;
    wire reports = only_acts & code[5] & code[3] & room_valid;
    wire is_segment = sum[3];

    assign answer_valid = waits & code[9];
    assign x = index;
    assign a = sum;
    assign put_valid = does & code[11];
    assign put_data = crc_word_out;
    assign start_valid = does & code[10];
    assign clear = clears;
    assign broken = does & code[8] & !code[6] & !code[7];
    assign seek_source_valid = does & code[6] & code[7] & code[8];
    assign seek_valid = does & code[6] & code[7] & !code[8];
    assign latch_arm = does & code[7] & code[9] & !code[6] & !code[8];
    assign snapshot = does & code[8] & code[6] & !code[7] & !code[9];
    assign cut = does & code[8] & code[6] & !code[7] & code[9];
    assign kick = does & code[7] & !code[6] & !code[8];
    assign enable = power;
    assign stop = does & code[7] & code[8] & !code[6];

    always @(*) begin
        state = NONE;
        if (fault) begin
            state = state | BIT_0;
        end
        if (ready) begin
            state = state | BIT_1;
        end
        if (armed) begin
            state = state | BIT_2;
        end
        if (cut_refused) begin
            state = state | BIT_4;
        end
        if (idle) begin
            state = state | BIT_6;
        end
        if (halted) begin
            state = state | BIT_7;
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
        if (code[11:9] == IF_ZERO) begin
            holds = sum == 8'd0;
        end
        if (code[11:9] == IF_X7) begin
            holds = index[7];
        end
        if (code[11:9] == IF_FULL) begin
            holds = index[7:4] == TOP;
        end
        if (code[11:9] == IF_NOTHING) begin
            holds = empty;
        end
        if (code[11:9] == IF_FAULT) begin
            holds = fault;
        end
        if (code[11:9] == IF_COMMIT) begin
            holds = word == LAST_WORD;
        end
        if (code[11:9] == IF_SPECIAL) begin
            holds = sum[7] & sum[6];
        end
    end

    always @(*) begin
        port = state;
        if (code[0]) begin
            port = {3'b0, space};
        end
        if (code[1]) begin
            port = NONE;
            if (fault) begin
                port = {2'b0, culprits};
            end
            if (code[0]) begin
                port = {2'b0, seeking};
            end
        end
        if (code[2]) begin
            port = {2'b0, hits};
            if (code[0]) begin
                port = {4'b0, latch_edges};
                if (latch_armed) begin
                    port = {4'b0, latch_edges} | BIT_4;
                end
            end
            if (code[1]) begin
                port = {4'b0, cause};
            end
        end
    end

    always @(*) begin
        other = ring_read_data;
        if (code[8]) begin
            other = index;
        end
        if (code[9]) begin
            other = crc_word_out[7:0];
            if (code[8]) begin
                other = port;
            end
        end
    end

    always @(*) begin
        value = data_read_data;
        if (code[10]) begin
            value = other;
        end
    end

    always @(*) begin
        place = code[7:0];
        if (code[8]) begin
            place = index;
        end
    end

    always @(*) begin
        page = {1'b0, place};
        if (code[9]) begin
            page = {1'b0, place} | CONSTANTS;
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

    always @(*) begin
        put_word = SLOT_OF_CUT;
        if (is_segment) begin
            put_word = {1'b0, word};
        end
    end

    carrystep_instructions instructions (
        .clock(clock),
        .read_address(pc),
        .read_data(instructions_read_data),
        .write_address(NO_PLACE),
        .write_bits(NO_CODE),
        .write_data(NO_CODE)
    );

    carrystep_data data (
        .clock(clock),
        .read_address(page),
        .read_data(data_read_data),
        .write_address(page),
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
            pc <= pc + NEXT_PLACE;
            if (jumps & (holds ^ code[12])) begin
                pc <= code[8:0];
            end
        end
        if (sets) begin
            sum <= value;
            if (code[11]) begin
                sum <= sum ^ value;
            end
            if (code[14]) begin
                sum <= sum & value;
            end
        end
        if (acts & code[0]) begin
            index <= sum;
        end
        if (acts & code[1] & over) begin
            index <= index + ONE;
        end
        if (sets & (code[10:8] == FROM_RING)) begin
            read <= read + NEXT_PLACE;
        end
        if (received) begin
            written <= written + NEXT_PLACE;
        end
        if (does & code[4]) begin
            space <= ANY_SPACE;
        end
        if (reports & (room < space)) begin
            space <= room;
        end
        if (does & code[6] & !code[7] & !code[8]) begin
            power <= sum[0];
            clears <= code[9];
        end
        if (put_valid & over & is_segment) begin
            word <= word + NEXT_WORD;
        end
    end
endmodule

// Memory of carrystep_register_mirror: constants of the build, and the words of state of each axis.
module carrystep_known #(
    // Build id: override it whenever you override another parameter; unique per set of parameters
    parameter [63:0] BUILD_ID = 64'h5db5a34c719955df,
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
        words[12] = 32'h7;
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
    parameter [63:0] BUILD_ID = 64'h5db5a34c719955df,
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
    parameter [63:0] BUILD_ID = 64'h5db5a34c719955df,
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
    // The number of the offered word in its segment, 7 of which commits it; 8 names the slot of a
    // cut.
    output wire   [3:0] put_word,
    // The offered word.
    output wire  [31:0] put_data,
    // The engine accepts the offered word in this clock.
    input  wire         put_ready,
    // The number of segments for which the queue of the axis `put_axis` has space.
    input  wire   [4:0] room,
    // `room` is valid in this clock.
    input  wire         room_valid,
    // The link offers a start to the engine.
    output wire         start_valid,
    // The axes to start; bit i is axis i.
    output wire   [5:0] start_mask,
    // The engine accepts an offered start in this clock.
    input  wire         start_ready,
    // The host requests a cut in the axes whose slots were named; asserted for one clock.
    output wire         cut,
    // A cut was requested and is not decided yet.
    input  wire         cut_busy,
    // The last cut was refused: nothing was dropped.
    input  wire         cut_refused,
    // The engine clears a stop.
    output wire         clear,
    // The host requests a controlled stop.
    output wire         stop,
    // The host has broken the segment protocol.
    output wire         broken,
    // The host replaces the source of seeks.
    output wire         seek_source_valid,
    // The source: axis in bits 2..0, row in bits 4..3, own in bit 5, level in bit 6.
    output wire   [6:0] seek_source,
    // The host replaces the mask of the axes that wait for the source of their seek.
    output wire         seek_valid,
    // The axes that wait for it, valid with `seek_valid`; bit i is axis i.
    output wire   [5:0] seek_mask,
    // The host arms the latch.
    output wire         latch_arm,
    // The host requests a snapshot of the state of all axes.
    output wire         snapshot,
    // The owner of the session has sent a valid request: the watchdog restarts.
    output wire         kick,
    // The host requests power for the motor drivers, as long as it is asserted.
    output wire         enable,
    // The engine outputs a word of the state of an axis in this clock.
    input  wire         state_valid,
    // The copy to which it belongs: 0 hit of a seek, 1 live, 2 snapshot, 3 latch.
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
    // The axes that wait for the source of their seek; bit i is axis i.
    input  wire   [5:0] seeking,
    // The axes that have hit it, until the host ends the seek; bit i is axis i.
    input  wire   [5:0] hits,
    // The latch waits for its edge.
    input  wire         latch_armed,
    // The edges since the latch was armed that it did not latch, at most 15.
    input  wire   [3:0] latch_edges
);

    wire processor_answer_valid;
    wire [7:0] processor_x;
    wire [7:0] processor_a;
    wire processor_put_valid;
    wire [3:0] processor_put_word;
    wire [31:0] processor_put_data;
    wire processor_start_valid;
    wire processor_clear;
    wire processor_broken;
    wire processor_seek_source_valid;
    wire processor_seek_valid;
    wire processor_latch_arm;
    wire processor_snapshot;
    wire processor_cut;
    wire processor_kick;
    wire processor_enable;
    wire processor_stop;
    wire [31:0] register_mirror_data;

    assign answer_valid = processor_answer_valid;
    assign answer = processor_a;
    assign put_valid = processor_put_valid;
    assign put_axis = processor_a[2:0];
    assign put_word = processor_put_word;
    assign put_data = processor_put_data;
    assign start_valid = processor_start_valid;
    assign start_mask = processor_a[5:0];
    assign cut = processor_cut;
    assign clear = processor_clear;
    assign stop = processor_stop;
    assign broken = processor_broken;
    assign seek_source_valid = processor_seek_source_valid;
    assign seek_source = processor_a[6:0];
    assign seek_valid = processor_seek_valid;
    assign seek_mask = processor_a[5:0];
    assign latch_arm = processor_latch_arm;
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
        .put_word(processor_put_word),
        .put_data(processor_put_data),
        .put_ready(put_ready),
        .start_valid(processor_start_valid),
        .start_ready(start_ready),
        .clear(processor_clear),
        .broken(processor_broken),
        .seek_source_valid(processor_seek_source_valid),
        .seek_valid(processor_seek_valid),
        .latch_arm(processor_latch_arm),
        .snapshot(processor_snapshot),
        .cut(processor_cut),
        .kick(processor_kick),
        .enable(processor_enable),
        .stop(processor_stop),
        .refreshed(refreshed),
        .cut_refused(cut_refused),
        .fault(fault),
        .halted(halted),
        .idle(idle),
        .ready(ready),
        .armed(armed),
        .cause(cause),
        .room(room),
        .room_valid(room_valid),
        .culprits(culprits),
        .seeking(seeking),
        .hits(hits),
        .latch_armed(latch_armed),
        .latch_edges(latch_edges)
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
