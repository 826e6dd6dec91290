// Replays the recorded inputs of a host to carrystep_engine in Verilator, and prints every cycle in
// which any output changed. Then reads the contents of the engine through the get port. Arguments:
// FILE [+mutant=N]; compiled for AXES axes.
#include "Vcarrystep_engine.h"
#include "verilated.h"
#include <cinttypes>
#include <cstdio>

namespace {

// Greatest number of clocks until the get port answers.
constexpr int PATIENCE = 1 << 18;

uint64_t outputs(const Vcarrystep_engine& core) {
    uint64_t all = 0;
    const auto add = [&all](uint64_t value, int bits) { all = all << bits | value; };
    add(core.latch, 1);
    add(core.latch ? core.latch_axis : 0, 3);
    add(core.room_valid, 1);
    add(core.room_valid ? core.room : 0, 3);
    add(core.armed, 1);
    add(core.ready, 1);
    add(core.homing, AXES);
    add(core.put_ready, 1);
    add(core.start_ready, 1);
    add(core.idle, 1);
    add(core.fault, 1);
    add(core.halted, 1);
    add(core.resetting, 1);
    add(core.started, 1);
    add(core.enabled, 1);
    add(core.fault ? core.cause : 0, 3);
    add(core.step, AXES);
    add(core.dir, AXES);
    add(core.fault ? core.culprits : 0, AXES);
    return all;
}

void tick(Vcarrystep_engine& core) {
    core.clock = 1;
    core.eval();
    core.clock = 0;
    core.eval();
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2) return 2;
    FILE* file = std::fopen(argv[1], "r");
    if (!file) return 2;
    VerilatedContext context;
    context.commandArgs(argc, argv);
    Vcarrystep_engine core{&context};
    core.clock = 0;
    core.eval();
    uint64_t before = ~uint64_t{0}, cycle = 0, count;
    unsigned put_valid, put_axis, put_word, put_data, start_valid, start_mask, clear, reset;
    unsigned stop, broken, home_valid, home_mask, kick, enable, estop, limit_min, limit_max;
    while (std::fscanf(file, "%" SCNu64 " %u %x %x %x %u %x %u %u %u %u %u %x %u %u %u %x %x", &count, &put_valid, &put_axis, &put_word, &put_data,
                       &start_valid, &start_mask, &clear, &reset, &stop, &broken, &home_valid, &home_mask, &kick, &enable, &estop, &limit_min,
                       &limit_max) == 18) {
        core.put_valid = put_valid;
        core.put_axis = put_axis;
        core.put_word = put_word;
        core.put_data = put_data;
        core.start_valid = start_valid;
        core.start_mask = start_mask;
        core.clear = clear;
        core.reset = reset;
        core.stop = stop;
        core.broken = broken;
        core.home_valid = home_valid;
        core.home_mask = home_mask;
        core.kick = kick;
        core.enable = enable;
        core.estop = estop;
        core.limit_min = limit_min;
        core.limit_max = limit_max;
        core.eval();
        for (; count != 0; --count, ++cycle) {
            const uint64_t now = outputs(core);
            if (now != before) std::printf("%" PRIu64 " %" PRIx64 "\n", cycle, now);
            before = now;
            tick(core);
        }
    }
    core.put_valid = core.start_valid = core.clear = core.reset = core.stop = core.broken = core.home_valid = core.kick = 0;
    for (int axis = 0; axis < AXES; ++axis)
        for (int item = 0; item < 4; ++item) {
            core.get_axis = axis;
            core.get_item = item;
            tick(core);
            for (int clocks = 0; clocks < PATIENCE && !core.get_valid; ++clocks) tick(core);
            std::printf(core.get_valid ? "K %x\n" : "no answer\n", core.get_data);
        }
    return 0;
}
