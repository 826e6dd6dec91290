/* What the gateware and its clients agree on: constants, the register map, the answer's fields.
 *
 * Generated from crates/core/src/link by `cargo xtask generate`: change that, not this. */
#ifndef CARRYSTEP_REGISTERS_H
#define CARRYSTEP_REGISTERS_H

#include <stdint.h>
{% for row in constants %}
/* {{ row.what }} */
#define CARRYSTEP_{{ row.name }} {{ row.c }}
{%- endfor %}

/* The map; for an axis, its register is CARRYSTEP_OF_AXIS(register, axis). */
#define CARRYSTEP_OF_AXIS(register, axis) ((register) + CARRYSTEP_PER_AXIS * (axis))
{% for row in registers %}
/* {{ row.what }} ({{ row.access }}{{ ", axis 0" if row.per_axis }}) */
#define CARRYSTEP_{{ row.name }} {{ row.address }}u
{%- endfor %}

/* Why the axes were stopped, by the number in an answer. */
{%- for cause in causes %}
#define CARRYSTEP_CAUSE_{{ cause | upper | replace("-", "") }} {{ loop.index0 }}u
{%- endfor %}

/* Fields of an answer, of its bytes without END and ESC. */
{% for row in fields %}
/* {{ row.what }} */
#define CARRYSTEP_ANSWER_{{ row.name | upper }}(answer) {{ row.c }}
{%- endfor %}

#endif
