/* The parts of the RP2040's SDK that the example uses, so that it compiles and runs on a PC. */
#ifndef STUB_GPIO_H
#define STUB_GPIO_H
#include <stdbool.h>
enum { GPIO_FUNC_SPI = 1, GPIO_OUT = 1 };
static inline void gpio_set_function(unsigned pin, int function) { (void)pin; (void)function; }
static inline void gpio_init(unsigned pin) { (void)pin; }
static inline void gpio_set_dir(unsigned pin, bool out) { (void)pin; (void)out; }
static inline void gpio_put(unsigned pin, bool value) { (void)pin; (void)value; }
#endif
