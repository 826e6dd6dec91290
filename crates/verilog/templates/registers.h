/* The protocol between the gateware and its hosts: constants, the register map, and the fields of
 * an answer.
 *
 * This file is generated from crates/core/src/link by `cargo xtask generate`: change that source
 * instead. */
#ifndef CARRYSTEP_REGISTERS_H
#define CARRYSTEP_REGISTERS_H

#include <stdint.h>
{% for row in constants %}
/* {{ row.what }} */
#define CARRYSTEP_{{ row.name }} {{ row.c }}
{%- endfor %}

/* The register map. The address of a register of an axis is CARRYSTEP_OF_AXIS(register, axis). */
#define CARRYSTEP_OF_AXIS(register, axis) ((register) + (axis))
{% for row in registers %}
/* {{ row.what }} ({{ row.access }}{{ ", axis 0" if row.per_axis }}) */
#define CARRYSTEP_{{ row.name }} {{ row.address }}u
{%- endfor %}

/* The causes of a stop, by their number in the field `cause` of an answer. */
{%- for cause in causes %}
#define CARRYSTEP_CAUSE_{{ cause | upper | replace("-", "") }} {{ loop.index0 }}u
{%- endfor %}

/* The reasons of a refusal, by their number in the field `reason` of an answer; 0: not refused. */
{% for row in reasons %}
/* {{ row.what }} */
#define CARRYSTEP_REASON_{{ row.name | upper | replace(" ", "_") }} {{ row.number }}u
{%- endfor %}

/* The fields of an answer, in which the bytes END and ESC of the frame have been decoded. */
{% for row in fields %}
/* {{ row.what }} */
#define CARRYSTEP_ANSWER_{{ row.name | upper }}(answer) {{ row.c }}
{%- endfor %}

#endif
