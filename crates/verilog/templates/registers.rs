//! The protocol between the gateware and its hosts: constants, the register map, and the fields of
//! an answer.
//!
//! This file is generated from `crates/core/src/link` by `cargo xtask generate`: change that source
//! instead.
{% for row in constants %}
/// {{ row.what }}
pub const {{ row.name }}: {{ row.kind }} = {{ row.rust }};
{%- endfor %}
{% for row in registers %}
/// {{ row.what }} ({{ row.access }}{{ ", axis 0" if row.per_axis }}).
pub const {{ row.name }}: u8 = {{ row.address }};
{%- endfor %}

/// The causes of a stop, by their number in the field `cause` of an answer.
pub const CAUSES: [&str; {{ causes | length }}] =
    [{% for cause in causes %}"{{ cause }}"{{ ", " if not loop.last }}{% endfor %}];

/// The reasons of a refusal, by their number in the field `reason` of an answer; 0: not refused.
pub const REASONS: [&str; {{ reasons | length + 1 }}] =
    ["none"{% for row in reasons %}, "{{ row.name }}"{% endfor %}];
{%- for row in reasons %}
/// {{ row.what }}
pub const REASON_{{ row.name | upper | replace(" ", "_") }}: u8 = {{ row.number }};
{%- endfor %}
{% for row in fields %}
/// Of an answer: {{ row.what }}.
pub const fn {{ row.name }}(answer: &[u8; ANSWER_BYTES]) -> {{ "bool" if row.bits == 1 else "u8" }} {
    {{ row.rust }}
}
{% endfor -%}
