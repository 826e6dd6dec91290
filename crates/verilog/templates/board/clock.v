// SPDX-License-Identifier: MIT OR Apache-2.0
//
// {{ title }}: {{ to }} MHz of the oscillator's {{ from }} MHz. Generated: change the generator, not this file.
//
// The clock starts late: engine and link have no reset, but come up as the bitstream says. So no edge may reach them that
// is too fast (while a PLL locks, its clock is anything), and none while block RAMs are not ready (an iCE40's are not for some
// microseconds after configuration). {{ wait }} clocks after the lock the gate opens, for ever: a clock that stops could leave a STEP high.

`default_nettype none

module carrystep_clock (
    input wire oscillator,
    output wire clock
);
    wire made;
    wire locked;
{% block made %}{% endblock %}

    // Held at 0 until the lock is seen, whatever `made` does until then.
    reg [1:0] seen = 2'd0;
    reg [{{ bits }}:0] waited = {{ bits + 1 }}'d0;
    always @(posedge made) begin
        seen <= {seen[0], locked};
        if (!waited[{{ bits }}]) waited <= seen[1] ? waited + 1'b1 : {{ bits + 1 }}'d0;
    end

{% block gate %}{% endblock %}
endmodule

`default_nettype wire
