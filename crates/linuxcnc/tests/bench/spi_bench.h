/* See spi_bench.c. */
#ifndef SPI_BENCH_H
#define SPI_BENCH_H

#include "carrystep_line.h"

/* Executes a command, if this word is one of the stand-in's. */
bool spi_bench(const char *word, carrystep_shared *shared, carrystep_pump *pump);

#endif
