// Replays the recorded inputs of a host to carrystep_engine in Icarus, and prints every cycle in
// which any output changed, with the checksum of all words of state before. The last line is `S`
// and the checksum of all of them. Arguments: +stimuli=FILE, -Pengine_bench.AXES=n.
//
// A template: `ports` is the table of the engine's ports; `inputs` and `outputs` are its recorded
// ports, in the order of the stimuli and of the printed bits; of the items `status` and `switch`,
// only the bits of `status_meant` and `switch_meant` have a meaning.
`timescale 1ns / 1ps
module engine_bench;
    parameter AXES = 6;
    localparam BITS = {% for port in outputs %}{{ port.width }}{{ " + " if not loop.last }}{% endfor %};
{% for port in ports %}
    {{ "reg" if port.input else "wire" }} {{ port.range }}{{ port.name }};
{% endfor %}

    carrystep_engine core (
{% for port in ports %}
        .{{ port.name }}({{ port.name }}){{ "," if not loop.last }}
{% endfor %}
    );

    wire [BITS-1:0] recorded = {
{% for port in outputs %}
        {{ port.name }}{% if port.valid_with %} & { {{- port.width }}{ {{- port.valid_with -}} } }{% endif %}{{ "," if not loop.last }}
{% endfor %}
    };
    reg [BITS-1:0] before;
    integer file, fields;
    reg [63:0] cycle, count, sum;
    integer adder;
    wire [{{ adders - 1 }}:0] valid = state_valid;
    reg first;
    reg [2:0] item;
    reg [31:0] mask, meant;
    wire [1:0] record = {{ "state_record" if several else "2'd0" }};
    reg [8*256-1:0] name;

    task tick;
        begin
            clock = 1;
            #1 clock = 0;
            #1;
        end
    endtask

    initial begin
        if (!$value$plusargs("stimuli=%s", name)) $finish;
        file = $fopen(name, "r");
        before = {BITS{1'bx}};
        cycle = 0;
        sum = 0;
        #1 clock = 0;
        #1;
        fields = {{ inputs | length + 1 }};
        while (fields == {{ inputs | length + 1 }}) begin
            fields = $fscanf(file, "%d{% for port in inputs %} %h{% endfor %}", count
{%- for port in inputs %}, {{ port.name }}{% endfor %});
            if (fields == {{ inputs | length + 1 }}) while (count != 0) begin
                #1;
                if (recorded !== before) $display("%0d %h %h", cycle, recorded, sum);
                before = recorded;
                first = refreshed;
                for (adder = 0; adder < {{ adders }}; adder = adder + 1) if (valid[adder]) begin
                    item = state_item[3*adder +: 3];
                    mask = item == {{ status }} ? 32'd{{ status_meant }}
                         : item == {{ switch }} ? 32'd{{ switch_meant }} : 32'hffffffff;
                    meant = state[32*adder +: 32] & mask;
                    sum = {sum[56:0], sum[63:57]}
                        ^ {21'b0, record, 1'b0, state_page[2*adder +: 2], item, state_axis[3*adder +: 3], meant}
                        ^ {23'b0, first, 40'b0};
                    first = 0;
                end
                if (first) sum = {sum[56:0], sum[63:57]} ^ {23'b0, 1'b1, 40'b0};
                tick;
                cycle = cycle + 1;
                count = count - 1;
            end
        end
        $display("S %h", sum);
        $finish;
    end
endmodule
