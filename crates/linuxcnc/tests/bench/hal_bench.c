/* A HAL for tests: it loads the component as LinuxCNC does, calls its function from a thread of its
 * own every ms while the component's thread is at the port, and removes it.
 *
 *     hal_bench names                    the pins and parameters: type, direction, name
 *     hal_bench run PORT PERIODS         enables the joints, moves joint 0, disables them
 *     hal_bench load PARAMETER=VALUE ... loads and removes it; prints what it says. wait=PERIODS is
 *                                        half of the time between both. */
#include "rtapi.h"
#include "rtapi_app.h"
#include "hal.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define MOST 256

static struct {
    char name[64];
    const char *type;
    const char *direction;
    void *value;
} names[MOST];
static int count;
static void (*function)(void *, long);
static bool loaded;

char **parameter_port(void);
char **parameter_build(void);
int *parameter_baud(void);
int *parameter_speed(void);
int *parameter_joints(void);
int *parameter_periods(void);
int *parameter_horizon(void);
int *parameter_outputs(void);
int *parameter_pwm(void);
int *parameter_probe_latch(void);
int *parameter_index_latch(void);

void rtapi_print_msg(int level, const char *format, ...)
{
    va_list words;
    (void)level;
    va_start(words, format);
    vprintf(format, words);
    va_end(words);
}

long long rtapi_get_time(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (long long)time.tv_sec * 1000000000LL + time.tv_nsec;
}

/* As HAL: a component of this name is loaded once. */
int hal_init(const char *name)
{
    (void)name;
    if (loaded) {
        return -EINVAL;
    }
    loaded = true;
    return 1;
}

int hal_ready(int id)
{
    (void)id;
    return 0;
}

int hal_exit(int id)
{
    (void)id;
    for (int at = 0; at < count; at++) {
        free(strcmp(names[at].direction, "RW") == 0 ? NULL : names[at].value);
    }
    count = 0;
    loaded = false;
    return 0;
}

static void *blocks[8];
static int used;

void *hal_malloc(long size)
{
    blocks[used] = malloc((size_t)size);
    return blocks[used++];
}

static int add(const char *type, const char *direction, void *value, const char *format, va_list words)
{
    if (count == MOST || value == NULL) {
        return -ENOMEM;
    }
    vsnprintf(names[count].name, sizeof names[count].name, format, words);
    for (int at = 0; at < count; at++) {
        if (strcmp(names[at].name, names[count].name) == 0) {
            return -EINVAL;
        }
    }
    names[count].type = type;
    names[count].direction = direction;
    names[count].value = value;
    count++;
    return 0;
}

static const char *direction_of(hal_pin_dir_t direction)
{
    return direction == HAL_IN ? "IN" : direction == HAL_OUT ? "OUT" : "I/O";
}

#define PIN(type, c_type, zero)                                                                                 \
    int hal_pin_##type##_newf(hal_pin_dir_t direction, c_type **pin, int id, const char *format, ...)            \
    {                                                                                                           \
        va_list words;                                                                                          \
        (void)id;                                                                                               \
        *pin = calloc(1, sizeof **pin);                                                                         \
        va_start(words, format);                                                                                \
        int bad = add(#type, direction_of(direction), (void *)*pin, format, words);                             \
        va_end(words);                                                                                          \
        return bad;                                                                                             \
    }
PIN(bit, hal_bit_t, false)
PIN(u32, hal_u32_t, 0)
PIN(float, hal_float_t, 0.0)

int hal_param_float_newf(hal_param_dir_t direction, hal_float_t *parameter, int id, const char *format, ...)
{
    va_list words;
    (void)id;
    va_start(words, format);
    int bad = add("float", direction == HAL_RW ? "RW" : "RO", (void *)parameter, format, words);
    va_end(words);
    return bad;
}

int hal_export_funct(const char *name, void (*exported)(void *, long), void *context, int uses_fp, int reentrant,
                     int id)
{
    (void)name;
    (void)context;
    (void)uses_fp;
    (void)reentrant;
    (void)id;
    function = exported;
    return 0;
}

static void *pin(const char *name)
{
    for (int at = 0; at < count; at++) {
        if (strcmp(names[at].name, name) == 0) {
            return names[at].value;
        }
    }
    printf("no pin %s\n", name);
    exit(1);
}

#define BIT(name) (*(hal_bit_t *)pin("carrystep.0." name))
#define FLOAT(name) (*(hal_float_t *)pin("carrystep.0." name))

static void period(void)
{
    struct timespec nap = {0, 1000000};
    function(NULL, 1000000);
    nanosleep(&nap, NULL);
}

static int run(int periods)
{
    int waited = 0;
    FLOAT("joint.0.scale") = 100.0;
    while ((!BIT("connected") || BIT("fault")) && waited++ < 20000) {
        period();
    }
    double from = FLOAT("joint.0.position-fb");
    BIT("joint.0.enable") = true;
    BIT("joint.1.enable") = true;
    BIT("joint.2.enable") = true;
    BIT("out-0") = true;
    FLOAT("pwm-duty") = 0.5;
    for (int at = 0; at < periods; at++) {
        FLOAT("joint.0.position-cmd") = from + 1.0 - cos(at * 0.01);
        period();
    }
    BIT("joint.0.enable") = false;
    for (int at = 0; at < 300; at++) {
        FLOAT("joint.0.position-cmd") = FLOAT("joint.0.position-fb");
        period();
    }
    printf("connected %d fault %u moved %.3f\n", BIT("connected"), *(hal_u32_t *)pin("carrystep.0.fault-code"),
           FLOAT("joint.0.position-fb") - from);
    return 0;
}

static int waits = 50; /* periods before and behind the second instance */

/* Sets a parameter of loadrt, as LinuxCNC does, or `waits`. */
static bool set(char *word)
{
    static const struct {
        const char *name;
        int *(*number)(void);
    } NUMBERS[] = {
        {"baud", parameter_baud},       {"joints", parameter_joints},           {"periods", parameter_periods},
        {"horizon", parameter_horizon}, {"outputs", parameter_outputs},         {"pwm", parameter_pwm},
        {"speed", parameter_speed},     {"probe_latch", parameter_probe_latch}, {"index_latch", parameter_index_latch},
    };
    char *value = strchr(word, '=');
    if (value == NULL) {
        return false;
    }
    *value++ = '\0';
    if (strcmp(word, "wait") == 0) {
        waits = atoi(value);
        return true;
    }
    for (size_t at = 0; at < sizeof NUMBERS / sizeof NUMBERS[0]; at++) {
        if (strcmp(word, NUMBERS[at].name) == 0) {
            *NUMBERS[at].number() = atoi(value);
            return true;
        }
    }
    if (strcmp(word, "port") == 0) {
        *parameter_port() = value;
    } else if (strcmp(word, "build") == 0) {
        *parameter_build() = value;
    } else {
        return false;
    }
    return true;
}

int main(int words, char **word)
{
    const char *what = words > 1 ? word[1] : "";
    int status = 0;
    *parameter_outputs() = 8;
    *parameter_pwm() = 1;
    *parameter_port() = "/dev/null";
    if (strcmp(what, "names") == 0) {
        *parameter_joints() = 8;
    } else if (strcmp(what, "run") == 0 && words == 4) {
        *parameter_port() = word[2];
        /* Long, because checkers make everything slow; the queue holds 31 segments. */
        *parameter_periods() = 16;
        *parameter_horizon() = 450;
    } else {
        for (int at = 2; at < words; at++) {
            if (!set(word[at])) {
                return 1;
            }
        }
    }
    int bad = rtapi_app_main();
    if (bad != 0) {
        printf("refused %d\n", bad);
        return 0;
    }
    if (strcmp(what, "names") == 0) {
        for (int at = 0; at < count; at++) {
            printf("%s %s %s\n", names[at].type, names[at].direction, names[at].name);
        }
    } else if (strcmp(what, "run") == 0) {
        status = run(atoi(word[3]));
    } else {
        printf("loaded\n");
        for (int at = 0; at < waits; at++) {
            period();
        }
        /* A second time, as `loadrt carrystep` twice. */
        printf("again %d\n", rtapi_app_main());
        for (int at = 0; at < waits; at++) {
            period();
        }
    }
    rtapi_app_exit();
    for (int at = 0; at < used; at++) {
        free(blocks[at]);
    }
    return status;
}
