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

// The state of an adder in the words of the port `state`, which is one number or, if it is wider than
// 64 bits, an array.
uint32_t word_of(uint32_t state, int) { return state; }
uint32_t word_of(uint64_t state, int adder) { return static_cast<uint32_t>(state >> 32 * adder); }
template <typename Wide> uint32_t word_of(const Wide& state, int adder) { return state[adder]; }

// The checksum of the words of state up to this cycle; `sum` is that of the cycles before.
uint64_t checksum(const Vcarrystep_engine& core, uint64_t sum) {
    uint64_t refreshed = core.refreshed;
    for (int adder = 0; adder < {{ adders }}; ++adder) {
        if (!(core.state_valid >> adder & 1)) continue;
        const unsigned item = core.state_item >> 3 * adder & 7;
        const unsigned address =
            (core.state_page >> 2 * adder & 3) << 6 | item << 3 | (core.state_axis >> 3 * adder & 7);
        const uint64_t meant = item == {{ status }} ? {{ status_meant }}u
                             : item == {{ switch }} ? {{ switch_meant }}u : ~0u;
        uint64_t word = uint64_t{address} << 32 | (word_of(core.state, adder) & meant);
{% if several %}
        word |= uint64_t{core.state_record} << 41;
{% endif %}
        sum = (sum << 7 | sum >> 57) ^ (refreshed << 40 | word);
        refreshed = 0;
    }
    return refreshed ? (sum << 7 | sum >> 57) ^ uint64_t{1} << 40 : sum;
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
