// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/process_lock.h"

#include <pthread.h>

static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;

static void lock(void) {
    pthread_mutex_lock(&mutex);
}

static void unlock(void) {
    pthread_mutex_unlock(&mutex);
}

static void see_forks(void) {
    pthread_atfork(lock, unlock, unlock);
}

void mf_process_lock(void) {
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, see_forks);
    lock();
}

void mf_process_unlock(void) {
    unlock();
}
