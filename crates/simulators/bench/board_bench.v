// Line, link and engine of a board, without its clock manager and pins.
//
// A template: `ports` is the table of the engine's ports, `bytes` that of the ports between line and
// link. The outputs of the engine and its inputs from pins are ports of this module.
module board_bench #(parameter AXES = 6) (
    input wire rx,       // or MOSI
    output wire tx,      // or MISO
    input wire sck,
    input wire select_n,
{% for port in ports if port.shown %}
    {{ "input" if port.input else "output" }} wire {{ port.range }}{{ port.name }}{{ "," if not loop.last }}
{% endfor %}
);
{% for port in bytes %}
    wire {{ port.range }}{{ port.name }};
{% endfor %}
{% for port in ports if not port.shown %}
    wire {{ port.range }}{{ port.name }};
{% endfor %}

`ifdef SPI
    carrystep_spi line (.mosi(rx), .miso(tx), .*);
`else
    carrystep_uart line (.*);
`endif
    carrystep_link link (.*);
    carrystep_engine engine (.*);
endmodule
