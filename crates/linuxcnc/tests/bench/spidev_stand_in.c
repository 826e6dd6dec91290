/* A stand-in for spidev in real time (ld --wrap=ioctl): a regular file is the device, and a test at
 * a socket has the board. A transfer is its length, 4 bytes, and its bytes to the socket, and as
 * many bytes from it.
 *
 *     CARRYSTEP_SPI          the socket
 *     CARRYSTEP_SPI_REFUSES  "mode": the controller cannot do mode 0 */
#include <errno.h>
#include <linux/spi/spidev.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

int __real_ioctl(int port, unsigned long request, ...);
int __wrap_ioctl(int port, unsigned long request, ...);

/* Sends or receives all bytes. False if the other end has gone. */
static bool all(int end, uint8_t *bytes, size_t length, bool sends)
{
    for (size_t at = 0; at < length;) {
        ssize_t some = sends ? send(end, bytes + at, length - at, MSG_NOSIGNAL) : recv(end, bytes + at, length - at, 0);
        if (some <= 0) {
            return false;
        }
        at += (size_t)some;
    }
    return true;
}

static int connected(void)
{
    static int end = -1;
    const char *name = getenv("CARRYSTEP_SPI");
    if (end < 0 && name != NULL) {
        struct sockaddr_un address;
        memset(&address, 0, sizeof address);
        address.sun_family = AF_UNIX;
        snprintf(address.sun_path, sizeof address.sun_path, "%s", name);
        end = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
        if (connect(end, (struct sockaddr *)&address, sizeof address) != 0) {
            close(end);
            end = -1;
        }
    }
    return end;
}

static int transfer(const struct spi_ioc_transfer *message)
{
    int end = connected();
    uint8_t *bytes = (uint8_t *)(uintptr_t)message->tx_buf;
    uint32_t length = message->len;
    if (!all(end, (uint8_t *)&length, sizeof length, true) || !all(end, bytes, length, true) ||
        !all(end, (uint8_t *)(uintptr_t)message->rx_buf, length, false)) {
        errno = ESHUTDOWN;
        return -1;
    }
    return (int)length;
}

int __wrap_ioctl(int port, unsigned long request, ...)
{
    struct stat status;
    const char *refuses = getenv("CARRYSTEP_SPI_REFUSES");
    va_list words;
    va_start(words, request);
    void *data = va_arg(words, void *);
    va_end(words);
    if (fstat(port, &status) != 0 || !S_ISREG(status.st_mode)) {
        return __real_ioctl(port, request, data);
    }
    if (request == SPI_IOC_MESSAGE(1)) {
        return transfer(data);
    }
    if (request == SPI_IOC_WR_MODE && refuses != NULL && strcmp(refuses, "mode") == 0) {
        errno = EINVAL;
        return -1;
    }
    if (request == SPI_IOC_RD_MODE || request == SPI_IOC_WR_MODE || request == SPI_IOC_WR_BITS_PER_WORD ||
        request == SPI_IOC_WR_MAX_SPEED_HZ) {
        return 0;
    }
    errno = ENOTTY;
    return -1;
}
