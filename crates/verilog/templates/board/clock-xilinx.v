{% extends "clock.v" %}
{% block made %}
{% if made_by == "oscillator" %}
    IBUFG ibufg (.I(oscillator), .O(made));
    assign locked = 1'b1;
{% else %}
{% block manager %}{% endblock %}
{% endif %}
{% endblock %}
{% block gate %}
    BUFGCE gate (.I({{ "made" if made_by == "oscillator" else "synthesised" }}), .CE(waited[{{ bits }}]), .O(clock));
{% endblock %}
