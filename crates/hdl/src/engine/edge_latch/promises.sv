// Proves promises 13 and 15 of the latch, without a bound on time: which edge of its pin it
// latches, and in which tick.
//
//   parameters   LOOKS: number of consecutive strobes that must find the pin active; 0: no latch
//                LOW: 1 if the pin is active when it is low
//                `DUT: the name of the exported module `edge_latch`, built with these values
//   assumptions  none
//
// The promises that are about the words of the latch are proved in readout/promises.sv.

module promises (
    input wire clock,
    input wire strobe,
    input wire pin,
    input wire arm,
    input wire resetting
);
    localparam [5:0] LOOKS = `LOOKS;
    localparam EXISTS = LOOKS != 0;

    wire comes, latches, armed;
    wire [3:0] edges;
    `DUT dut (.*);

    // ---- The pin, as it was two clocks ago.

    reg first_clock = 1, sync = 0, now = 0;
    always @(posedge clock) begin
        first_clock <= 0;
        {now, sync} <= {sync, (pin != `LOW) & EXISTS};
    end

    // ---- The looks, as docs/clock-by-clock.md specifies them: the number of consecutive strobes
    // that have found the pin different from `accepted`.

    reg accepted = 0, waits = 0, copies = 0;
    reg [5:0] looks = 0;
    reg [3:0] further = 0;
    wire last_look = looks + 1 == LOOKS;
    wire flank = strobe & now & !accepted & last_look & EXISTS;
    always @(posedge clock) begin
        if (strobe) begin
            looks <= now == accepted || last_look ? 0 : looks + 1;
            accepted <= now != accepted && last_look ? now : accepted;
            copies <= flank & waits;
        end
        waits <= arm ? EXISTS : waits & !flank;
        further <= arm ? 0 : flank & !waits & further != 15 ? further + 1 : further;
        if (resetting) {accepted, looks, waits, copies, further} <= 0;
    end

    reg was_armed = 0, was_flank = 0, was_arm = 0, was_resetting = 0, was_strobe = 0, was_latches = 0;
    reg [3:0] was_edges = 0;
    always @(posedge clock) begin
        {was_armed, was_flank, was_arm} <= {armed, flank, arm};
        {was_resetting, was_strobe, was_latches, was_edges} <= {resetting, strobe, latches, edges};
    end

    // ---- The promises.

    always_comb begin
        promise_13_inactive: assert (!first_clock || {comes, latches, armed, edges} == 0);
        promise_13_reset_forgets: assert (!was_resetting || {comes, latches, armed, edges} == 0);
        promise_13_a_build_without_it: assert (EXISTS || {comes, latches, armed, edges} == 0);

        promise_15_one_tick_for_one_edge: assert (latches == copies
            && (was_strobe || !latches || was_latches));
        promise_15_only_where_it_was_armed: assert (!(latches && was_strobe) || was_armed && was_flank && !was_resetting);
        promise_15_told_at_the_strobe: assert (comes == (flank & armed));
        promise_15_armed_until_its_edge: assert (armed == waits && (!was_armed || armed || was_flank || was_resetting));
        promise_15_edges_are_counted: assert (edges == further
            && (was_edges == edges || was_arm || was_resetting || was_flank && !was_armed && edges == was_edges + 4'd1));
    end

    // ---- The invariants that make the promises inductive.

    (* inside = "dut.sync" *) wire dut_sync;
    (* inside = "dut.now" *) wire dut_now;
    (* inside = "dut.accepted" *) wire dut_accepted;
    (* inside = "dut.count" *) wire [3:0] count;

`ifdef INVARIANTS
    always_comb begin
        invariant_1: assert ({dut_sync, dut_now} == {sync, now} && dut_accepted == accepted);
        invariant_2: assert (count == looks && (looks < LOOKS || !EXISTS && looks == 0));
        invariant_3: assert (EXISTS || {sync, now, accepted} == 0);
    end
`endif

    // ---- Covers: some run reaches each of these situations.

    always_comb begin
        cover_15_latched: cover (latches && !armed);
        cover_15_counted: cover (edges == 2);
        cover_15_forgotten: cover (was_resetting && was_armed);
    end
endmodule
