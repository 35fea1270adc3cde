// SPDX-License-Identifier: GPL-3.0-or-later
//
// In the place of live_server.c and live_assets.c, where a build finds no libmicrohttpd or no
// Chart.js.
#include "live/live_assets.h"
#include "live/live_server.h"

const char *mf_live_server_argument(const struct live_request *request, const char *name) {
    (void)request;
    (void)name;
    return NULL;
}

enum status mf_live_server_start(struct live_server *server, int port) {
    (void)server;
    (void)port;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "this mesofit was built without the live view: install libmicrohttpd-dev "
                          "and libjs-chart.js, and run make again");
}

void mf_live_server_stop(struct live_server *server) {
    (void)server;
}

const struct live_asset *mf_live_assets_find(const char *path) {
    (void)path;
    return NULL;
}
