/* The C client: it reads the commands of tests/support/client.rs, and prints a line for each. */
#include "carrystep_feeder.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MOST 400000
#define LINE (1 << 22)

typedef struct {
    bool is_start;
    uint8_t axis; /* or the mask */
    carrystep_segment segment;
} command;

static command commands[MOST];
static size_t count;
static size_t next_segment[CARRYSTEP_MOST_AXES];
static size_t next_start;
static carrystep_session session;
static carrystep_feeder feeder;
static bool loaded;
static char in[LINE];
static char out[LINE];
static size_t used;

static bool take_segment(void *context, uint8_t axis, carrystep_segment *segment)
{
    (void)context;
    while (next_segment[axis] < count) {
        const command *c = &commands[next_segment[axis]++];
        if (!c->is_start && c->axis == axis) {
            *segment = c->segment;
            return true;
        }
    }
    return false;
}

static bool take_start(void *context, uint8_t *mask)
{
    (void)context;
    while (next_start < count) {
        const command *c = &commands[next_start++];
        if (c->is_start) {
            *mask = c->axis;
            return true;
        }
    }
    return false;
}

static void put(const char *text)
{
    size_t length = strlen(text);
    memcpy(out + used, text, length + 1);
    used += length;
}

static void put_bytes(const uint8_t *bytes, size_t length, bool first)
{
    for (size_t at = 0; at < length; at++) {
        char pair[8];
        snprintf(pair, sizeof pair, at == 0 && first ? "%02x" : " %02x", (unsigned)bytes[at]);
        put(pair);
    }
}

static void put_answer(const carrystep_answer *a)
{
    char text[80];
    snprintf(text, sizeof text, "%02x:%02x:%02x:%c%c%c%c%c%c:%u:%u:%u:%02x:%02x:%08" PRIx32, (unsigned)a->sequence,
             (unsigned)a->address, (unsigned)a->next, a->fault ? 'f' : '.', a->halted ? 'h' : '.', a->idle ? 'i' : '.',
             a->ready ? 'r' : '.', a->armed ? 'a' : '.', a->written ? 'w' : '.', (unsigned)a->reason,
             (unsigned)a->cause, (unsigned)a->free, (unsigned)a->culprits, (unsigned)a->seeking, a->data);
    put(text);
}

static void take_bytes(uint32_t now, char *text)
{
    bool any = false;
    for (char *word = strtok(text, " "); word != NULL; word = strtok(NULL, " ")) {
        carrystep_answer answer;
        carrystep_event event;
        if (strcmp(word, "-") == 0) {
            continue;
        }
        event = carrystep_receive(&session, (uint8_t)strtoul(word, NULL, 16), now, &answer);
        if (event == CARRYSTEP_QUIET) {
            continue;
        }
        if (any) {
            put(" ");
        }
        any = true;
        if (event == CARRYSTEP_HEARD) {
            put_answer(&answer);
        } else {
            put(event == CARRYSTEP_DAMAGED ? "damaged" : "lost");
        }
    }
    if (!any) {
        put("-");
    }
}

static const char *feed(void)
{
    static const char *const words[] = {"feeding", "fed", "bad", "unpowered"};
    return loaded ? words[carrystep_feed(&session, &feeder)] : "fed";
}

static void send_one(uint32_t now)
{
    uint8_t line[CARRYSTEP_LINE_BYTES];
    size_t length = carrystep_transmit(&session, now, line);
    if (length == 0) {
        put("-");
    }
    put_bytes(line, length, true);
}

static void send_all(uint32_t now)
{
    uint8_t line[CARRYSTEP_LINE_BYTES];
    bool any = false;
    for (;;) {
        size_t length = carrystep_transmit(&session, now, line);
        if (length == 0) {
            break;
        }
        put_bytes(line, length, !any);
        any = true;
    }
    if (!any) {
        put("-");
    }
}

/* The first command of a program that follows a loaded one begins a new program. */
static command *add(void)
{
    if (loaded) {
        count = 0;
        loaded = false;
    }
    return &commands[count < MOST ? count++ : MOST - 1];
}

static const char *yes(bool done)
{
    return done ? "yes" : "no";
}

static void obey(char *words)
{
    char verb[16] = "";
    int skip = 0;
    unsigned long a[2] = {0, 0};
    sscanf(words, "%15s%n", verb, &skip);
    char *rest = words + skip;
    if (strcmp(verb, "begin") == 0) {
        sscanf(rest, "%lu %lu", &a[0], &a[1]);
        carrystep_begin(&session, (uint32_t)a[0], (uint32_t)a[1]);
        count = 0;
        loaded = false;
    } else if (strcmp(verb, "open") == 0) {
        sscanf(rest, "%lx %lu", &a[0], &a[1]);
        carrystep_open(&session, (uint16_t)a[0], (uint8_t)a[1]);
    } else if (strcmp(verb, "owns") == 0) {
        put(yes(carrystep_owns(&session)));
    } else if (strcmp(verb, "seek-ended") == 0) {
        put(yes(carrystep_seek_ended(&session)));
    } else if (strcmp(verb, "cut-refused") == 0) {
        put(yes(carrystep_cut_refused(&session)));
    } else if (strcmp(verb, "cut") == 0) {
        uint8_t mask = (uint8_t)strtoul(rest, &rest, 16);
        uint8_t slots[CARRYSTEP_MOST_AXES];
        for (unsigned axis = 0; axis < CARRYSTEP_MOST_AXES; axis++) {
            slots[axis] = (uint8_t)strtoul(rest, &rest, 10);
        }
        put(yes(carrystep_cut(&session, mask, slots)));
    } else if (strcmp(verb, "stop") == 0) {
        carrystep_stop(&session);
    } else if (strcmp(verb, "read") == 0) {
        put(yes(carrystep_read(&session, (uint8_t)strtoul(rest, NULL, 16))));
    } else if (strcmp(verb, "write") == 0) {
        sscanf(rest, "%lx %lx", &a[0], &a[1]);
        put(yes(carrystep_write(&session, (uint8_t)a[0], (uint32_t)a[1])));
    } else if (strcmp(verb, "segment") == 0) {
        command *c = add();
        uint32_t commit = 0;
        c->is_start = false;
        sscanf(rest, "%" SCNu8 " %" SCNu32 " %" SCNd64 " %" SCNd64 " %" SCNd64 " %" SCNu32, &c->axis, &c->segment.ticks,
               &c->segment.v, &c->segment.a, &c->segment.j, &commit);
        c->segment.last = (commit & 1u) != 0;
        c->segment.outputs = commit & ~UINT32_C(1);
    } else if (strcmp(verb, "start") == 0) {
        command *c = add();
        c->is_start = true;
        c->axis = (uint8_t)strtoul(rest, NULL, 16);
    } else if (strcmp(verb, "load") == 0) {
        carrystep_source source = {take_segment, take_start, NULL};
        memset(next_segment, 0, sizeof next_segment);
        next_start = 0;
        loaded = true;
        carrystep_load(&feeder, source);
    } else if (strcmp(verb, "feed") == 0) {
        put(feed());
    } else if (strcmp(verb, "withdraw") == 0) {
        carrystep_withdraw(&session);
    } else if (strcmp(verb, "send") == 0) {
        send_one((uint32_t)strtoul(rest, NULL, 10));
    } else if (strcmp(verb, "take") == 0) {
        uint32_t now = (uint32_t)strtoul(rest, &rest, 10);
        take_bytes(now, rest);
    } else if (strcmp(verb, "step") == 0) {
        uint32_t now = (uint32_t)strtoul(rest, &rest, 10);
        take_bytes(now, rest);
        put(" | ");
        put(feed());
        put(" | ");
        send_all(now);
    } else if (strcmp(verb, "check") == 0) {
        static const char *const verdicts[] = {"fine", "device", "protocol", "build"};
        uint32_t identity = 0;
        uint32_t protocol = 0;
        uint64_t build = 0;
        uint64_t wanted = 0;
        sscanf(rest, "%" SCNx32 " %" SCNx32 " %" SCNx64 " %" SCNx64, &identity, &protocol, &build, &wanted);
        put(verdicts[carrystep_check(identity, protocol, build, wanted)]);
    } else if (strcmp(verb, "busy") == 0) {
        put(yes(carrystep_waiting(&session)));
        put(" ");
        put(yes(carrystep_writing(&session)));
    } else {
        put("no such words");
    }
}

int main(void)
{
    while (fgets(in, sizeof in, stdin) != NULL) {
        in[strcspn(in, "\n")] = '\0';
        used = 0;
        out[0] = '\0';
        obey(in);
        puts(out);
        fflush(stdout);
    }
    return 0;
}
