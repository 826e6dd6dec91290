    // {{ gate.port }}: {{ gate.why }}.
    // The outputs to the host are driven only after {{ gate.port }} has been 1 for this number of
    // clocks: {{ gate.clocks }}. They have high impedance again as soon as it is 0.
    reg [1:0] {{ gate.port }}_seen = 2'd0;
    reg [{{ gate.bits - 1 }}:0] {{ gate.port }}_waited = {{ gate.bits }}'d0;
    always @(posedge clock) begin
        {{ gate.port }}_seen <= { {{- gate.port }}_seen[0], {{ gate.port }}};
        if (!{{ gate.port }}_seen[1]) {{ gate.port }}_waited <= {{ gate.bits }}'d0;
        else if (!{{ gate.port }}_waited[{{ gate.bits - 1 }}]) {{ gate.port }}_waited <= {{ gate.port }}_waited + 1'b1;
    end
    wire driven = {{ gate.port }}_waited[{{ gate.bits - 1 }}];
