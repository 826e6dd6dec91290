// SPDX-License-Identifier: MIT OR Apache-2.0
//
// Makes the clock of the gateware, {{ to }} MHz, from the oscillator of {{ from }} MHz.
// Board: {{ title }}. This file is generated: change the generator instead.
//
// The clock starts late. The engine and the host link have no reset: the bitstream gives the
// initial values of their registers. So they must not receive a clock edge while the clock may be
// too fast (the output of a PLL has no defined frequency until it locks), nor while the block RAMs
// are not ready (those of an iCE40 are not ready for some microseconds after configuration). The
// gate opens {{ wait }} clocks after the lock. It then stays open, because a clock that stops could
// leave a STEP pin high.

`default_nettype none

module {{ name }} (
    input wire oscillator,
    output wire clock
);
    wire made;
    wire locked;
{% block made %}{% endblock %}

    // `seen` synchronizes `locked`. `waited` is 0 until the lock, whatever the frequency of `made`
    // is until then; after the lock it counts clocks of `made` until its highest bit is set.
    reg [1:0] seen = 2'd0;
    reg [{{ bits }}:0] waited = {{ bits + 1 }}'d0;
    always @(posedge made) begin
        seen <= {seen[0], locked};
        if (!waited[{{ bits }}]) waited <= seen[1] ? waited + 1'b1 : {{ bits + 1 }}'d0;
    end

{% block gate %}{% endblock %}
endmodule

`default_nettype wire
