// Proves the part of promise 6 that the sequencer keeps, without a bound on time: no segment is
// lost, executed twice, shortened or late.
//
//   parameters   `DUT: the name of the exported sequencer
//   assumptions  A pushed segment has at least one tick, it is pushed only while none waits and the
//                core is not frozen, and only a frozen sequencer is cleared (proved in
//                core/promises.sv). A frozen sequencer receives no strobe (proved in
//                axis/promises.sv).
//
// This file keeps a copy of each segment from its push to its load, and counts its ticks.

module promises (
    input wire clock,
    input wire strobe,
    input wire frozen,
    input wire stop,
    input wire clear,
    input wire go,
    input wire push,
    input wire [31:0] seg_ticks,
    input wire [63:0] seg_v,
    input wire [63:0] seg_a,
    input wire [63:0] seg_j,
    input wire seg_last
);
    wire waiting, startable, running, load, advance, underrun;
    wire [63:0] v, a, j;
    `DUT dut (.*);

    always_comb begin
        assume (!push || !waiting && !frozen && seg_ticks != 0);
        assume (!frozen || !strobe);
        assume (frozen || !clear);
    end

    // ---- The waiting segment, as it was pushed.

    reg full = 0;
    reg [31:0] ticks;
    reg [63:0] pushed_v, pushed_a, pushed_j;
    reg marked_last;
    always @(posedge clock) begin
        if (load || clear) full <= 0;
        if (push) begin
            full <= 1;
            ticks <= seg_ticks;
            {pushed_v, pushed_a, pushed_j, marked_last} <= {seg_v, seg_a, seg_j, seg_last};
        end
    end

    // ---- The running segment, and the number of its ticks before this strobe (`had`).

    reg runs = 0, run_last = 0, was_dry = 0;
    reg [31:0] run_ticks = 0, had = 0;
    wire over = strobe & had + 1 == run_ticks;
    always @(posedge clock) begin
        was_dry <= underrun;
        if (load) begin
            runs <= 1;
            {run_ticks, run_last, had} <= {ticks, marked_last, 32'd0};
        end else if (strobe) begin
            had <= had + 1;
            if (over) runs <= 0;
        end
        if (frozen || stop) runs <= 0;
    end
    // The clock before ended a segment that is not the last of its move, and no segment waited.
    reg was_starved = 0;
    always @(posedge clock) was_starved <= runs & over & !run_last & !waiting;

    // ---- The promises.

    always_comb begin
        promise_6_ready_is_empty: assert (waiting == full);
        promise_6_loaded_as_pushed: assert (!load || full && {v, a, j} == {pushed_v, pushed_a, pushed_j});
        promise_6_runs_its_ticks: assert (running == runs && advance == (runs && strobe && !over));
        promise_6_joins_without_a_gap: assert (!(runs && over && !run_last && waiting) || load);
        promise_6_starts_when_told: assert (!(startable && strobe && go) || load);
        promise_6_never_in_between: assert (!load || strobe && (!runs && go || over && (!run_last || go)));
        promise_6_startable: assert (startable == (waiting && (!runs || run_last && had + 1 == run_ticks)));
        promise_6_dry_is_told: assert (!was_starved || underrun || clear);
        promise_6_dry_is_dry: assert (!underrun || was_dry || was_starved);
    end

    // ---- The invariants that make the promises inductive: the remaining ticks and the executed
    // ones add up to the ticks of the segment.

    (* inside = "dut.left" *) wire [31:0] left;
    (* inside = "dut.last" *) wire last;
    (* inside = "dut.wait_ticks" *) wire [31:0] wait_ticks;
    (* inside = "dut.wait_last" *) wire wait_last;

`ifdef INVARIANTS
    always_comb begin
        invariant_1: assert (!full || ticks != 0 && {wait_ticks, wait_last} == {ticks, marked_last});
        invariant_2: assert (!full || {v, a, j} == {pushed_v, pushed_a, pushed_j});
        invariant_3: assert (!runs || left == run_ticks - had && had < run_ticks && last == run_last);
    end
`endif

    // ---- Covers: some run reaches each of these situations.

    always_comb begin
        cover_6_joined: cover (load && runs && run_ticks == 2 && !run_last);
        cover_6_started_again: cover (load && runs && run_last);
        cover_6_dry: cover (underrun && !was_dry);
        cover_8_cleared_while_waiting: cover (clear && waiting);
    end
endmodule
