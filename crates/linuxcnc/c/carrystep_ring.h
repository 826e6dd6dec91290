/* A queue between two threads of which one only puts and the other only takes. Neither ever waits,
 * takes a lock or allocates memory, so a real-time function can be either of them.
 *
 * C99 with the atomic operations of GCC and Clang. */
#ifndef CARRYSTEP_RING_H
#define CARRYSTEP_RING_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct {
    unsigned char *cells;
    size_t size;    /* bytes of an element */
    uint32_t count; /* elements that fit, a power of two */
    uint32_t put;   /* elements put since the beginning, modulo 2^32 */
    uint32_t taken;
} carrystep_ring;

/* Begins an empty queue. `cells` has `count` x `size` bytes, `count` is a power of two. */
void carrystep_ring_begin(carrystep_ring *ring, void *cells, size_t size, uint32_t count);

/* Copies an element into the queue. False if it is full. */
bool carrystep_ring_put(carrystep_ring *ring, const void *element);

/* Copies the oldest element out of the queue, and removes it. False if the queue is empty. */
bool carrystep_ring_take(carrystep_ring *ring, void *element);

/* Copies the oldest element and leaves it there. False if the queue is empty. Only the thread that
 * takes may call it. */
bool carrystep_ring_peek(const carrystep_ring *ring, void *element);

#endif
