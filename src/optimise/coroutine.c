// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimise/coroutine.h"

#include "base/memory.h"

#include <locale.h>
#include <pthread.h>

enum turn { BODY, CALLER };

struct coroutine {
    pthread_t thread;
    locale_t locale; ///< of who began it
    pthread_mutex_t lock;
    pthread_cond_t changed; ///< the turn
    enum turn turn;
    const double *question; ///< NULL once the body has returned
    double answer;
    bool stopping;
    void (*body)(struct coroutine *self, void *context);
    void *context;
};

static void give_turn(struct coroutine *coroutine, enum turn turn) {
    coroutine->turn = turn;
    pthread_cond_signal(&coroutine->changed);
}

static void wait_for_turn(struct coroutine *coroutine, enum turn turn) {
    while (coroutine->turn != turn)
        pthread_cond_wait(&coroutine->changed, &coroutine->lock);
}

static void *run(void *memory) {
    struct coroutine *coroutine = memory;
    uselocale(coroutine->locale);
    coroutine->body(coroutine, coroutine->context);
    pthread_mutex_lock(&coroutine->lock);
    coroutine->question = NULL;
    give_turn(coroutine, CALLER);
    pthread_mutex_unlock(&coroutine->lock);
    return NULL;
}

struct coroutine *mf_coroutine_begin(void (*body)(struct coroutine *self, void *context),
                                     void *context) {
    struct coroutine *coroutine = mf_memory_zeroed(1, sizeof *coroutine);
    if (coroutine == NULL)
        return NULL;
    coroutine->body = body;
    coroutine->context = context;
    coroutine->turn = BODY;
    coroutine->locale = uselocale((locale_t)0);
    pthread_mutex_init(&coroutine->lock, NULL);
    pthread_cond_init(&coroutine->changed, NULL);
    if (pthread_create(&coroutine->thread, NULL, run, coroutine) == 0)
        return coroutine;
    (void)mf_status_fail(STATUS_NO_MEMORY, "no thread is left for an optimiser");
    pthread_cond_destroy(&coroutine->changed);
    pthread_mutex_destroy(&coroutine->lock);
    mf_memory_free(coroutine);
    return NULL;
}

const double *mf_coroutine_question(struct coroutine *coroutine) {
    pthread_mutex_lock(&coroutine->lock);
    wait_for_turn(coroutine, CALLER);
    const double *question = coroutine->question;
    pthread_mutex_unlock(&coroutine->lock);
    return question;
}

void mf_coroutine_answer(struct coroutine *coroutine, double answer) {
    pthread_mutex_lock(&coroutine->lock);
    wait_for_turn(coroutine, CALLER);
    coroutine->answer = answer;
    if (coroutine->question)
        give_turn(coroutine, BODY);
    pthread_mutex_unlock(&coroutine->lock);
}

void mf_coroutine_end(struct coroutine *coroutine) {
    if (coroutine == NULL)
        return;
    pthread_mutex_lock(&coroutine->lock);
    wait_for_turn(coroutine, CALLER);
    coroutine->stopping = true;
    give_turn(coroutine, BODY);
    pthread_mutex_unlock(&coroutine->lock);
    pthread_join(coroutine->thread, NULL);
    pthread_cond_destroy(&coroutine->changed);
    pthread_mutex_destroy(&coroutine->lock);
    mf_memory_free(coroutine);
}

bool mf_coroutine_measure(struct coroutine *self, const double *question, double *answer) {
    pthread_mutex_lock(&self->lock);
    if (!self->stopping) {
        self->question = question;
        give_turn(self, CALLER);
        wait_for_turn(self, BODY);
        *answer = self->answer;
    }
    const bool goes_on = !self->stopping;
    pthread_mutex_unlock(&self->lock);
    return goes_on;
}
