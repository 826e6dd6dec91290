//! What the gateware and its clients agree on: constants, the register map, the answer's fields.
//!
//! Generated from `crates/core/src/link` by `cargo xtask generate`: change that, not this.
{% for row in constants %}
/// {{ row.what }}
pub const {{ row.name }}: {{ row.kind }} = {{ row.rust }};
{%- endfor %}
{% for row in registers %}
/// {{ row.what }} ({{ row.access }}{{ ", axis 0" if row.per_axis }}).
pub const {{ row.name }}: u8 = {{ row.address }};
{%- endfor %}

/// Why the axes were stopped, by the number in an answer.
pub const CAUSES: [&str; {{ causes | length }}] =
    [{% for cause in causes %}"{{ cause }}"{{ ", " if not loop.last }}{% endfor %}];
{% for row in fields %}
/// Of an answer: {{ row.what }}.
pub const fn {{ row.name }}(answer: &[u8; ANSWER_BYTES]) -> {{ "bool" if row.bits == 1 else "u8" }} {
    {{ row.rust }}
}
{% endfor -%}
