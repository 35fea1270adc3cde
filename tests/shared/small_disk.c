// SPDX-License-Identifier: GPL-3.0-or-later
#define _GNU_SOURCE // unshare
#include "shared/small_disk.h"

#include "shared/testing.h"

#include <fcntl.h>
#include <sched.h>
#include <stdio.h>
#include <sys/mount.h>
#include <unistd.h>

enum { PAGE = 4096 };

static void print_size(int pages, char size[32]) {
    snprintf(size, 32, "size=%dk", PAGE / 1024 * pages);
}

bool small_disk_mount(const char *path, int pages) {
    char size[32];
    print_size(pages, size);
    if (unshare(CLONE_NEWNS) != 0 && unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0)
        return false;
    return mount("none", "/", NULL, MS_REC | MS_PRIVATE, NULL) == 0 &&
           mount("none", path, "tmpfs", 0, size) == 0;
}

void small_disk_grow(const char *path, int pages) {
    char size[32];
    print_size(pages, size);
    assert_int_equal(mount("none", path, "tmpfs", MS_REMOUNT, size), 0);
}

void small_disk_unmount(const char *path) {
    umount(path);
}

void small_disk_fill(const char *path, int pages) {
    static const char page[PAGE];
    char name[1024];
    off_t size = 0;
    snprintf(name, sizeof name, "%s/filler", path);
    const int file = open(name, O_WRONLY | O_CREAT | O_TRUNC, 0666);
    assert_true(file >= 0);
    while (write(file, page, sizeof page) == (ssize_t)sizeof page)
        size += (off_t)sizeof page;
    assert_true(size >= pages * (off_t)sizeof page);
    assert_int_equal(ftruncate(file, size - pages * (off_t)sizeof page), 0);
    assert_int_equal(close(file), 0);
}
