// The host of docs/clock-by-clock.md for Verilator: feeds a program to the parallel core, and
// prints every cycle in which any output changed. The outputs of axes that the core does not have
// are printed as 0. Macro: AXES, the core's number of axes. Arguments: FILE TAIL MAX.
#include "Vparallel.h"
#include "verilated.h"
#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

enum Kind { SEGMENT, START, WAIT, CLEAR, NONE };

struct Command {
    int kind = NONE;
    unsigned who = 0, last = 0;
    uint32_t ticks = 0;
    uint64_t v = 0, a = 0, j = 0;
};

Command next_command(FILE* file) {
    Command c;
    if (std::fscanf(file, "%d %x %" SCNx32 " %" SCNx64 " %" SCNx64 " %" SCNx64 " %u",
                    &c.kind, &c.who, &c.ticks, &c.v, &c.a, &c.j, &c.last) != 7) c = Command{};
    return c;
}

struct Outputs {
    uint32_t small[11];
    uint32_t position[6], discarded[6];
};

// The 32 bits of one axis in a port of 32 bits, of 64 bits, or of more.
uint32_t word(uint32_t port, int) { return port; }
uint32_t word(uint64_t port, int axis) { return static_cast<uint32_t>(port >> 32 * axis); }
template <class Wide> uint32_t word(const Wide& port, int axis) { return port[axis]; }

Outputs outputs(const Vparallel& core) {
    Outputs o{{core.seg_ready, core.start_ready, core.step, core.dir, core.idle, core.started, core.overrun,
               core.overspeed, core.underrun, core.protocol, core.fault}, {}, {}};
    for (int i = 0; i < AXES; ++i) {
        o.position[i] = word(core.position, i);
        o.discarded[i] = word(core.discarded, i);
    }
    return o;
}

void report(char letter, uint64_t cycle, const Outputs& o) {
    std::printf("%c %" PRIu64, letter, cycle);
    for (int i = 0; i < 10; ++i) std::printf(" %x", o.small[i]);
    std::printf(" ");
    for (int i = 5; i >= 0; --i) std::printf("%08x", o.position[i]);
    std::printf(" ");
    for (int i = 5; i >= 0; --i) std::printf("%08x", o.discarded[i]);
    std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 4) return 2;
    FILE* file = std::fopen(argv[1], "r");
    if (!file) return 2;
    const uint64_t tail = std::strtoull(argv[2], nullptr, 10), max = std::strtoull(argv[3], nullptr, 10);
    VerilatedContext context;
    Vparallel core{&context};
    core.clock = 0;
    core.eval();
    Command command = next_command(file);
    Outputs before;
    std::memset(&before, 0xff, sizeof before);
    uint64_t quiet = 0;
    for (uint64_t cycle = 0; cycle < max; ++cycle) {
        core.seg_valid = command.kind == SEGMENT && !core.fault;
        core.seg_axis = core.seg_valid ? command.who & 7 : 0;
        core.seg_ticks = command.ticks;
        core.seg_v = command.v;
        core.seg_a = command.a;
        core.seg_j = command.j;
        core.seg_last = command.last;
        core.start_valid = command.kind == START && !core.fault;
        core.start_mask = command.who & ((1 << AXES) - 1);
        core.clear = command.kind == CLEAR;
        core.eval();
        const Outputs now = outputs(core);
        if (std::memcmp(&now, &before, sizeof now) != 0) report('O', cycle, now);
        before = now;
        quiet = command.kind == NONE && (core.idle || core.fault) ? quiet + 1 : 0;
        if (quiet == tail) {
            report('E', cycle, now);
            return 0;
        }
        bool done = false;
        switch (command.kind) {
            case SEGMENT: done = core.fault || core.seg_ready; break;
            case START: done = core.fault || core.start_ready; break;
            case WAIT: done = --command.ticks == 0; break;
            case CLEAR: done = !core.fault; break;
            default: break;
        }
        if (done) command = next_command(file);
        core.clock = 1;
        core.eval();
        core.clock = 0;
        core.eval();
    }
    std::puts("X");
    return 0;
}
