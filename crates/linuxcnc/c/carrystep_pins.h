/* The pins and parameters of HAL: what the real-time function gets from LinuxCNC, and what it shows
 * there. carrystep.9 describes each of them. */
#ifndef CARRYSTEP_PINS_H
#define CARRYSTEP_PINS_H

#include "carrystep_servo.h"

/* What the component has pins for. */
typedef struct {
    int joints;  /* 1 to CARRYSTEP_MOST_AXES */
    int outputs; /* 0 to 8 */
    bool pwm;
} carrystep_shape;

/* Exports all pins and parameters of component `id`. Returns 0, or an error number. */
int carrystep_pins_export(int id, const carrystep_shape *shape);

/* Reads the pins of this servo period. */
void carrystep_pins_read(carrystep_servo_in *in);

/* Shows what came of it. `pause_ms`: time since the last call of the real-time function; 0: none. */
void carrystep_pins_show(const carrystep_servo *servo, const carrystep_servo_out *out, double pause_ms);

#endif
