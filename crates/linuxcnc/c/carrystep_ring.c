/* See carrystep_ring.h. */
#include "carrystep_ring.h"

#include <string.h>

void carrystep_ring_begin(carrystep_ring *ring, void *cells, size_t size, uint32_t count)
{
    ring->cells = cells;
    ring->size = size;
    ring->count = count;
    ring->put = 0;
    ring->taken = 0;
}

static unsigned char *cell(const carrystep_ring *ring, uint32_t number)
{
    return ring->cells + (size_t)(number & (ring->count - 1u)) * ring->size;
}

bool carrystep_ring_put(carrystep_ring *ring, const void *element)
{
    uint32_t put = ring->put; /* only this thread changes it */
    if (put - __atomic_load_n(&ring->taken, __ATOMIC_ACQUIRE) == ring->count) {
        return false;
    }
    memcpy(cell(ring, put), element, ring->size);
    /* The element is whole before the other thread sees the new number. */
    __atomic_store_n(&ring->put, put + 1u, __ATOMIC_RELEASE);
    return true;
}

bool carrystep_ring_peek(const carrystep_ring *ring, void *element)
{
    uint32_t taken = ring->taken; /* only this thread changes it */
    if (__atomic_load_n(&ring->put, __ATOMIC_ACQUIRE) == taken) {
        return false;
    }
    memcpy(element, cell(ring, taken), ring->size);
    return true;
}

bool carrystep_ring_take(carrystep_ring *ring, void *element)
{
    if (!carrystep_ring_peek(ring, element)) {
        return false;
    }
    __atomic_store_n(&ring->taken, ring->taken + 1u, __ATOMIC_RELEASE);
    return true;
}
