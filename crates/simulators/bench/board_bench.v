// Connects the line to the host (a UART, or an SPI if the macro SPI is defined), the host link and
// the engine of a board. The clock manager and the pins of the board are left out.
module board_bench #(parameter AXES = 6) (
    input wire clock,
    input wire rx,       // RX of the UART or MOSI of the SPI
    output wire tx,      // TX of the UART or MISO of the SPI
    input wire sck,
    input wire select_n,
    input wire estop,
    input wire [AXES-1:0] limit_min,
    input wire [AXES-1:0] limit_max,
    output wire [AXES-1:0] step,
    output wire [AXES-1:0] dir,
    output wire enabled,
    output wire idle,
    output wire fault,
    output wire halted,
    output wire [2:0] cause,
    output wire [AXES-1:0] culprits,
    output wire started
);
    wire received_valid, answer_valid, answer_take;
    wire [7:0] received, answer;
    wire put_valid, put_ready, room_valid, start_valid, start_ready, clear, stop, broken, home_valid, kick, enable;
    wire get_valid, latch, armed, ready;
    wire [2:0] put_axis, put_word, get_axis, room, latch_axis;
    wire [1:0] get_item;
    wire [31:0] put_data, get_data;
    wire [AXES-1:0] start_mask, home_mask, homing;

`ifdef SPI
    carrystep_spi line (.mosi(rx), .miso(tx), .*);
`else
    carrystep_uart line (.*);
`endif
    carrystep_link link (.*);
    carrystep_engine engine (.reset(1'b0), .resetting(), .*);
endmodule
