// Runs carrystep_parallel_6 by toggling its clock. A cycle without a command only toggles.
//
// Arguments: FEED CLOCKS [TRACE.vcd]. Each line of the feed is `cycle kind who ticks v a j last`.
// Kind 0 is a segment for axis `who`, kind 1 a start of the mask `who`. All numbers but the cycle,
// kind and last are in hex. The program prints the seconds of processor time and the positions.
#include "Vcarrystep_parallel_6.h"
#include "verilated.h"
#if VM_TRACE
#include "verilated_vcd_c.h"
#endif
#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <vector>

struct Feed { uint64_t cycle; unsigned kind, who, last; uint32_t ticks; uint64_t v, a, j; };

int main(int argc, char** argv) {
    if (argc < 3) return 2;
    std::vector<Feed> feed;
    FILE* file = std::fopen(argv[1], "r");
    if (!file) return 2;
    for (Feed f; std::fscanf(file, "%" SCNu64 " %u %x %" SCNx32 " %" SCNx64 " %" SCNx64 " %" SCNx64 " %u", &f.cycle, &f.kind,
                             &f.who, &f.ticks, &f.v, &f.a, &f.j, &f.last) == 8;) feed.push_back(f);
    const uint64_t clocks = std::strtoull(argv[2], nullptr, 10);
    VerilatedContext context;
#if VM_TRACE
    context.traceEverOn(true);
#endif
    Vcarrystep_parallel_6 core{&context};
    core.clock = 0;
    core.eval();
#if VM_TRACE
    VerilatedVcdC trace;
    if (argc > 3) { core.trace(&trace, 1); trace.open(argv[3]); }
#endif
    uint64_t cycle = 0;
    const auto run_to = [&](uint64_t end) {
        for (; cycle < end; ++cycle) {
            core.clock = 1;
            core.eval();
#if VM_TRACE
            if (trace.isOpen()) trace.dump(cycle + 1);
#endif
            core.clock = 0;
            core.eval();
        }
    };
    const std::clock_t begin = std::clock();
    for (const Feed& f : feed) {
        if (f.cycle >= clocks) break;
        run_to(f.cycle);
        core.seg_valid = f.kind == 0;
        core.start_valid = f.kind == 1;
        core.seg_axis = core.start_mask = f.who;
        core.seg_ticks = f.ticks;
        core.seg_v = f.v;
        core.seg_a = f.a;
        core.seg_j = f.j;
        core.seg_last = f.last;
        run_to(f.cycle + 1);
        core.seg_valid = core.start_valid = 0;
    }
    run_to(clocks);
#if VM_TRACE
    trace.close();
#endif
    std::printf("%.6f", double(std::clock() - begin) / CLOCKS_PER_SEC);
    for (int axis = 0; axis < 6; ++axis) std::printf(" %" PRId32, int32_t(core.position[axis]));
    std::printf("\n");
    return 0;
}
