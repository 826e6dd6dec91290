/* What carrystep.so needs of LinuxCNC's hal.h, for tests without LinuxCNC. */
#ifndef HAL_H
#define HAL_H

#include <stdbool.h>
#include <stdint.h>

typedef volatile bool hal_bit_t;
typedef volatile uint32_t hal_u32_t;
typedef volatile double hal_float_t;
typedef enum { HAL_IN = 16, HAL_OUT = 32, HAL_IO = 48 } hal_pin_dir_t;
typedef enum { HAL_RO = 64, HAL_RW = 192 } hal_param_dir_t;

int hal_init(const char *name);
int hal_ready(int id);
int hal_exit(int id);
void *hal_malloc(long size);
int hal_pin_bit_newf(hal_pin_dir_t direction, hal_bit_t **pin, int id, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
int hal_pin_u32_newf(hal_pin_dir_t direction, hal_u32_t **pin, int id, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
int hal_pin_float_newf(hal_pin_dir_t direction, hal_float_t **pin, int id, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
int hal_param_float_newf(hal_param_dir_t direction, hal_float_t *parameter, int id, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
int hal_export_funct(const char *name, void (*function)(void *, long), void *context, int uses_fp, int reentrant,
                     int id);

#endif
