// A board in Verilator that runs for as many clocks as its input requests.
//
// A line `COUNT LINE PINS...` on standard input requests COUNT clocks with these levels. LINE and
// the pins are hexadecimal; bit 0 of LINE is RX or MOSI, followed by SCK and chip select. A line
// `0 ...` requests the state.
//
// Lines on standard output, each with the first cycle in which the change is visible: `t CYCLE TX`,
// `p CYCLE STEP DIR`, `o CYCLE OUTPUTS PWM ENABLED`, `l CYCLE` when a start has loaded, `f CYCLE
// CAUSE` when a stop comes into force, and for the state `. CYCLE IDLE HALTED FAULT CAUSE CULPRITS`.
//
// A template: `pins` are the engine's inputs from pins, in the order of their table.
#include "Vboard_bench.h"
#include "verilated.h"
#include <cinttypes>
#include <cstdio>

namespace {

struct Seen {
    unsigned tx = 1, step = 0, dir = 0, outputs = 0, pwm = 0, enabled = 0, fault = 0;
};

void look(const Vboard_bench& board, uint64_t cycle, Seen& seen) {
    if (board.tx != seen.tx) std::printf("t %" PRIu64 " %u\n", cycle, unsigned{board.tx});
    if (board.step != seen.step || board.dir != seen.dir)
        std::printf("p %" PRIu64 " %x %x\n", cycle, unsigned{board.step}, unsigned{board.dir});
    if (board.outputs != seen.outputs || board.pwm != seen.pwm || board.enabled != seen.enabled)
        std::printf("o %" PRIu64 " %x %u %u\n", cycle, unsigned{board.outputs}, unsigned{board.pwm},
                    unsigned{board.enabled});
    if (board.fault && !seen.fault) std::printf("f %" PRIu64 " %u\n", cycle, unsigned{board.cause});
    seen = {board.tx, board.step, board.dir, board.outputs, board.pwm, board.enabled, board.fault};
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
    unsigned line{% for port in pins %}, {{ port.name }}{% endfor %};
    while (std::scanf("%" SCNu64 " %x{% for port in pins %} %x{% endfor %}", &count, &line
{%- for port in pins %}, &{{ port.name }}{% endfor %}) == {{ pins | length + 2 }}) {
        board.rx = line & 1;
        board.sck = line >> 1 & 1;
        board.select_n = line >> 2 & 1;
{% for port in pins %}
        board.{{ port.name }} = {{ port.name }};
{% endfor %}
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
