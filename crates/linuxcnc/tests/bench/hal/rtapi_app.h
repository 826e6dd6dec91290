/* The functions that LinuxCNC calls to load and to remove a component. */
#ifndef RTAPI_APP_H
#define RTAPI_APP_H

int rtapi_app_main(void);
void rtapi_app_exit(void);

#endif
