// Replays the recorded inputs of a host to carrystep_engine in Verilator, and prints every cycle in
// which any output changed. Then reads the contents of the engine through the get port. Arguments:
// FILE [+mutant=N]; compiled for AXES axes.
//
// A template: `inputs` and `outputs` are the recorded ports of the engine, in the order of the
// stimuli and of the printed bits.
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
{% for port in outputs %}
    add({% if port.valid_with %}core.{{ port.valid_with }} ? core.{{ port.name }} : 0{% else %}core.{{ port.name }}{% endif %}, {{ port.width }});
{% endfor %}
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
    unsigned {% for port in inputs %}{{ port.name }}{{ ", " if not loop.last }}{% endfor %};
    while (std::fscanf(file, "%" SCNu64 "{% for port in inputs %} %x{% endfor %}", &count
{%- for port in inputs %}, &{{ port.name }}{% endfor %}) == {{ inputs | length + 1 }}) {
{% for port in inputs %}
        core.{{ port.name }} = {{ port.name }};
{% endfor %}
        core.eval();
        for (; count != 0; --count, ++cycle) {
            const uint64_t now = outputs(core);
            if (now != before) std::printf("%" PRIu64 " %" PRIx64 "\n", cycle, now);
            before = now;
            tick(core);
        }
    }
{% for port in inputs if port.released %}
    core.{{ port.name }} = 0;
{% endfor %}
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
