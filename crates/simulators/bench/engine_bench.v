// Replays the recorded inputs of a host to carrystep_engine in Icarus, and prints every cycle in
// which any output changed. Then reads the contents of the engine through the get port. Arguments:
// +stimuli=FILE, -Pengine_bench.AXES=n.
//
// A template: `ports` is the table of the engine's ports; `inputs` and `outputs` are its recorded
// ports, in the order of the stimuli and of the printed bits.
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

    wire [BITS-1:0] outputs = {
{% for port in outputs %}
        {{ port.name }}{% if port.valid_with %} & { {{- port.width }}{ {{- port.valid_with -}} } }{% endif %}{{ "," if not loop.last }}
{% endfor %}
    };
    reg [BITS-1:0] before;
    integer file, fields, axis, item;
    reg [63:0] cycle, count;
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
        get_axis = 0;
        get_item = 0;
        #1 clock = 0;
        #1;
        fields = {{ inputs | length + 1 }};
        while (fields == {{ inputs | length + 1 }}) begin
            fields = $fscanf(file, "%d{% for port in inputs %} %h{% endfor %}", count
{%- for port in inputs %}, {{ port.name }}{% endfor %});
            if (fields == {{ inputs | length + 1 }}) while (count != 0) begin
                #1;
                if (outputs !== before) $display("%0d %h", cycle, outputs);
                before = outputs;
                tick;
                cycle = cycle + 1;
                count = count - 1;
            end
        end
{% for port in inputs if port.released %}
        {{ port.name }} = 0;
{% endfor %}
        for (axis = 0; axis < AXES; axis = axis + 1)
            for (item = 0; item < 4; item = item + 1) begin
                get_axis = axis;
                get_item = item;
                tick;
                while (!get_valid) tick;
                $display("K %h", get_data);
            end
        $finish;
    end
endmodule
