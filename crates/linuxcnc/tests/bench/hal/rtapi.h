/* What carrystep.so needs of LinuxCNC's rtapi.h, for tests without LinuxCNC. */
#ifndef RTAPI_H
#define RTAPI_H

#define RTAPI_MSG_ERR 1
#define RTAPI_MP_STRING(variable, text) char **parameter_##variable(void) { return &variable; }
#define RTAPI_MP_INT(variable, text) int *parameter_##variable(void) { return &variable; }
#define MODULE_AUTHOR(text) extern int unused_author
#define MODULE_DESCRIPTION(text) extern int unused_description
#define MODULE_LICENSE(text) extern int unused_license

void rtapi_print_msg(int level, const char *format, ...) __attribute__((format(printf, 2, 3)));
long long rtapi_get_time(void);

#endif
