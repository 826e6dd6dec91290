// Replays the recorded inputs of a host to carrystep_engine in Verilator, and prints every cycle in
// which any output changed, with the checksum of all words of state before. The last line is `S`
// and the checksum of all of them. Arguments: FILE [+mutant=N]; compiled for AXES axes.
//
// A template: `inputs` and `outputs` are the recorded ports of the engine, in the order of the
// stimuli and of the printed bits; of the items `status` and `switch`, only the bits of
// `status_meant` and `switch_meant` have a meaning.
#include "Vcarrystep_engine.h"
#include "verilated.h"
#include <cinttypes>
#include <cstdio>

namespace {

unsigned __int128 outputs(const Vcarrystep_engine& core) {
    unsigned __int128 all = 0;
    const auto add = [&all](uint64_t value, int bits) { all = all << bits | value; };
{% for port in outputs %}
    add({% if port.valid_with %}core.{{ port.valid_with }} ? core.{{ port.name }} : 0{% else %}core.{{ port.name }}{% endif %}, {{ port.width }});
{% endfor %}
    return all;
}

// The checksum of the words of state up to this cycle; `sum` is that of the cycles before.
uint64_t checksum(const Vcarrystep_engine& core, uint64_t sum) {
    if (!core.state_valid && !core.refreshed) return sum;
    uint64_t word = 0;
    if (core.state_valid) {
        const unsigned address = core.state_page << 6 | core.state_item << 3 | core.state_axis;
        const uint64_t meant = core.state_item == {{ status }} ? {{ status_meant }}u
                             : core.state_item == {{ switch }} ? {{ switch_meant }}u : ~0u;
        word = uint64_t{address} << 32 | (core.state & meant);
{% if several %}
        word |= uint64_t{core.state_record} << 41;
{% endif %}
    }
    return (sum << 7 | sum >> 57) ^ (uint64_t{core.refreshed} << 40 | word);
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
    unsigned __int128 before = ~static_cast<unsigned __int128>(0);
    uint64_t cycle = 0, sum = 0, count;
    unsigned {% for port in inputs %}{{ port.name }}{{ ", " if not loop.last }}{% endfor %};
    while (std::fscanf(file, "%" SCNu64 "{% for port in inputs %} %x{% endfor %}", &count
{%- for port in inputs %}, &{{ port.name }}{% endfor %}) == {{ inputs | length + 1 }}) {
{% for port in inputs %}
        core.{{ port.name }} = {{ port.name }};
{% endfor %}
        core.eval();
        for (; count != 0; --count, ++cycle) {
            const auto now = outputs(core);
            if (now != before)
                std::printf("%" PRIu64 " %" PRIx64 "%016" PRIx64 " %" PRIx64 "\n", cycle, uint64_t(now >> 64), uint64_t(now), sum);
            before = now;
            sum = checksum(core, sum);
            tick(core);
        }
    }
    std::printf("S %" PRIx64 "\n", sum);
    return 0;
}
