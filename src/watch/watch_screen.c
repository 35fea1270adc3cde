// SPDX-License-Identifier: GPL-3.0-or-later
#include "watch/watch_screen.h"

#include <poll.h>
#include <stdio.h>
#include <sys/ioctl.h>
#include <unistd.h>

enum status mf_watch_screen_open(struct watch_screen *screen) {
    if (!isatty(STDIN_FILENO) || !isatty(STDOUT_FILENO) ||
        tcgetattr(STDIN_FILENO, &screen->before) != 0)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "watch needs a terminal; the tables in the folder say the same");
    struct termios quiet = screen->before;
    quiet.c_lflag &= ~(tcflag_t)(ICANON | ECHO);
    tcsetattr(STDIN_FILENO, TCSANOW, &quiet);
    printf("\033[?1049h\033[?25l");
    fflush(stdout);
    return STATUS_OK;
}

void mf_watch_screen_close(const struct watch_screen *screen) {
    printf("\033[?25h\033[?1049l");
    fflush(stdout);
    tcsetattr(STDIN_FILENO, TCSANOW, &screen->before);
}

void mf_watch_screen_size(int *columns, int *rows) {
    struct winsize size;
    const int known = ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
    *columns = known ? size.ws_col : 80;
    *rows = known ? size.ws_row : 24;
}

int mf_watch_screen_key(int milliseconds) {
    struct pollfd input = {.fd = STDIN_FILENO, .events = POLLIN};
    char key = 0;
    if (poll(&input, 1, milliseconds) > 0 && read(STDIN_FILENO, &key, 1) <= 0)
        return 'q'; // the terminal has gone
    return key;
}
