// A board in Verilator that runs for as many clocks as its input requests.
//
// A line `COUNT PINS MIN MAX` on standard input requests COUNT clocks with these levels. PINS, MIN
// and MAX are hexadecimal; bit 0 of PINS is RX or MOSI, followed by SCK, chip select and e-stop. A
// line `0 ...` requests the state.
//
// Lines on standard output, each with the first cycle in which the change is visible: `t CYCLE TX`,
// `p CYCLE STEP DIR`, `l CYCLE` when a start has loaded, `f CYCLE CAUSE` when a stop comes into
// force, and for the state `. CYCLE IDLE HALTED FAULT CAUSE CULPRITS`.
#include "Vboard_bench.h"
#include "verilated.h"
#include <cinttypes>
#include <cstdio>

namespace {

struct Seen {
    unsigned tx = 1, step = 0, dir = 0, fault = 0;
};

void look(const Vboard_bench& board, uint64_t cycle, Seen& seen) {
    if (board.tx != seen.tx) std::printf("t %" PRIu64 " %u\n", cycle, unsigned{board.tx});
    if (board.step != seen.step || board.dir != seen.dir)
        std::printf("p %" PRIu64 " %x %x\n", cycle, unsigned{board.step}, unsigned{board.dir});
    if (board.fault && !seen.fault) std::printf("f %" PRIu64 " %u\n", cycle, unsigned{board.cause});
    seen = {board.tx, board.step, board.dir, board.fault};
}

}  // namespace

int main() {
    VerilatedContext context;
    Vboard_bench board{&context};
    Seen seen;
    board.clock = 0;
    board.rx = board.select_n = 1;
    board.eval();
    uint64_t cycle = 0, count;
    unsigned pins, limit_min, limit_max;
    while (std::scanf("%" SCNu64 " %x %x %x", &count, &pins, &limit_min, &limit_max) == 4) {
        board.rx = pins & 1;
        board.sck = pins >> 1 & 1;
        board.select_n = pins >> 2 & 1;
        board.estop = pins >> 3 & 1;
        board.limit_min = limit_min;
        board.limit_max = limit_max;
        board.eval();
        if (count == 0) {
            std::printf(". %" PRIu64 " %u %u %u %u %x\n", cycle, unsigned{board.idle}, unsigned{board.halted},
                        unsigned{board.fault}, unsigned{board.cause}, unsigned{board.culprits});
            std::fflush(stdout);
        }
        for (; count != 0; --count) {
            const bool started = board.started;
            board.clock = 1;
            board.eval();
            board.clock = 0;
            board.eval();
            ++cycle;
            if (started) std::printf("l %" PRIu64 "\n", cycle);
            look(board, cycle, seen);
        }
    }
    return 0;
}
