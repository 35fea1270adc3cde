// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/live_server.h"

#include <arpa/inet.h>
#include <errno.h>
#include <microhttpd.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { PIECE = 16384, LONGEST_NAME = 200 };

/// What every answer says: nothing is kept, framed, or loaded from elsewhere.
static const char *const heads[][2] = {
    {"Content-Security-Policy",
     "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; "
     "img-src 'self' blob:; frame-ancestors 'none'; base-uri 'none'; form-action 'none'"},
    {"X-Content-Type-Options", "nosniff"},
    {"X-Frame-Options", "DENY"},
    {"Referrer-Policy", "no-referrer"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
    {"Cross-Origin-Opener-Policy", "same-origin"},
    {"Cache-Control", "no-store"},
};

/// A request while its body arrives.
struct exchange {
    char *body;
    size_t size, capacity;
    bool too_large;
};

/// A stream while it is sent: what is left of its last piece.
struct sending {
    struct live_stream stream;
    char *piece;
    size_t size, sent;
};

const char *mf_live_server_argument(const struct live_request *request, const char *name) {
    const char *value = NULL;
    size_t size = 0;
    const enum MHD_Result found = MHD_lookup_connection_value_n(
        request->connection, MHD_GET_ARGUMENT_KIND, name, strlen(name), &value, &size);
    // "t.json%00.txt" is no name of anything.
    return found == MHD_YES && value && strlen(value) == size ? value : NULL;
}

static const char *find_head(struct MHD_Connection *connection, const char *name) {
    return MHD_lookup_connection_value(connection, MHD_HEADER_KIND, name);
}

// Answers -----------------------------------------------------------------------------------------

static ssize_t send_stream(void *context, uint64_t position, char *to, size_t capacity) {
    struct sending *sending = context;
    (void)position;
    while (sending->sent == sending->size) {
        free(sending->piece);
        sending->piece = sending->stream.next(sending->stream.context);
        sending->sent = 0;
        sending->size = sending->piece ? strlen(sending->piece) : 0;
        if (sending->piece == NULL)
            return MHD_CONTENT_READER_END_OF_STREAM;
    }
    const size_t left = sending->size - sending->sent, now = left < capacity ? left : capacity;
    memcpy(to, sending->piece + sending->sent, now);
    sending->sent += now;
    return (ssize_t)now;
}

static void close_stream(void *context) {
    struct sending *sending = context;
    sending->stream.close(sending->stream.context);
    free(sending->piece);
    free(sending);
}

static struct MHD_Response *begin_stream(const struct live_stream *stream) {
    struct sending *sending = calloc(1, sizeof *sending);
    struct MHD_Response *response = NULL;
    if (sending) {
        sending->stream = *stream;
        response = MHD_create_response_from_callback(MHD_SIZE_UNKNOWN, PIECE, send_stream, sending,
                                                     close_stream);
    }
    if (response == NULL) {
        stream->close(stream->context);
        free(sending);
    }
    return response;
}

/// What the answer owns is the response's from now on.
static struct MHD_Response *make_response(const struct live_answer *answer) {
    struct MHD_Response *response;
    if (answer->stream.next)
        return begin_stream(&answer->stream);
    if (answer->file > 0) {
        response = MHD_create_response_from_fd(answer->size, answer->file);
        if (response == NULL)
            close(answer->file);
        return response;
    }
    if (answer->constant)
        return MHD_create_response_from_buffer(answer->size, (void *)(size_t)answer->constant,
                                               MHD_RESPMEM_PERSISTENT);
    response = MHD_create_response_from_buffer(answer->bytes ? answer->size : 0, answer->bytes,
                                               MHD_RESPMEM_MUST_FREE);
    if (response == NULL)
        free(answer->bytes);
    return response;
}

/// A name to save under, without what would end it.
static void add_name(struct MHD_Response *response, const char *name) {
    char head[LONGEST_NAME + 64], plain[LONGEST_NAME];
    size_t n = 0;
    for (; *name && n + 1 < sizeof plain; name++)
        plain[n++] = *name > ' ' && *name < 127 && strchr("\"\\%;", *name) == NULL ? *name : '_';
    plain[n] = '\0';
    snprintf(head, sizeof head, "attachment; filename=\"%s\"", plain);
    MHD_add_response_header(response, "Content-Disposition", head);
}

static enum MHD_Result give(struct MHD_Connection *connection, const struct live_answer *answer) {
    struct MHD_Response *response = make_response(answer);
    char serial[24];
    if (response == NULL)
        return MHD_NO;
    for (size_t k = 0; k < sizeof heads / sizeof *heads; k++)
        MHD_add_response_header(response, heads[k][0], heads[k][1]);
    MHD_add_response_header(response, "Content-Type",
                            answer->type ? answer->type : "text/plain; charset=utf-8");
    if (answer->name)
        add_name(response, answer->name);
    snprintf(serial, sizeof serial, "%llu", (unsigned long long)answer->serial);
    if (answer->serial)
        MHD_add_response_header(response, "X-Mesofit-Serial", serial);
    const enum MHD_Result queued =
        MHD_queue_response(connection, answer->code ? answer->code : MHD_HTTP_OK, response);
    MHD_destroy_response(response);
    return queued;
}

static enum MHD_Result refuse(struct MHD_Connection *connection, unsigned code, const char *why) {
    return give(connection,
                &(struct live_answer){.code = code, .constant = why, .size = strlen(why)});
}

// Requests ----------------------------------------------------------------------------------------

/// The token in the head or, of the address that was printed, after the "?".
static bool has_token(const struct live_server *server, struct MHD_Connection *connection,
                      const struct live_request *request) {
    const char *given = find_head(connection, "X-Mesofit-Token");
    const char *in_address = mf_live_server_argument(request, "token");
    if (server->answerer.open(server->answerer.context, request))
        return in_address == NULL || mf_live_guard_is_token(server->token, in_address);
    return mf_live_guard_is_token(server->token, given);
}

static int find_socket(struct MHD_Connection *connection) {
    const union MHD_ConnectionInfo *info =
        MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD);
    return info ? info->connect_fd : -1;
}

/// A connection begins or is about to be closed.
static void note_client(void *context, struct MHD_Connection *connection, void **memory,
                        enum MHD_ConnectionNotificationCode what) {
    struct live_server *server = context;
    (void)memory;
    if (what == MHD_CONNECTION_NOTIFY_STARTED)
        mf_live_clients_add(&server->clients, find_socket(connection));
    else
        mf_live_clients_remove(&server->clients, find_socket(connection));
}

/// Why a request is refused before anything of it is read, and its code; NULL: it is not.
static const char *find_fault(const struct live_server *server, struct MHD_Connection *connection,
                              const char *method, const struct live_request *request,
                              unsigned *code) {
    const char *host = find_head(connection, MHD_HTTP_HEADER_HOST);
    const char *length = find_head(connection, MHD_HTTP_HEADER_CONTENT_LENGTH);
    *code = MHD_HTTP_FORBIDDEN;
    if (!mf_live_guard_is_host(host))
        return "This server answers on 127.0.0.1 and localhost only.";
    if (!mf_live_guard_is_origin(find_head(connection, "Origin"), host))
        return "This page belongs to another site.";
    if (!has_token(server, connection, request))
        return "The token is missing, or that of another run. Use the address that mesofit has "
               "printed last.";
    *code = MHD_HTTP_METHOD_NOT_ALLOWED;
    if (!request->post && strcmp(method, MHD_HTTP_METHOD_GET) != 0 &&
        strcmp(method, MHD_HTTP_METHOD_HEAD) != 0)
        return "This server supports GET, HEAD and POST.";
    *code = MHD_HTTP_CONTENT_TOO_LARGE;
    if (length && strtoull(length, NULL, 10) > LIVE_SERVER_LARGEST)
        return "The request is too large.";
    return NULL;
}

/// Keep a part of the body, with room for a NUL after it.
static void keep(struct exchange *exchange, const char *bytes, size_t size) {
    if (exchange->too_large || size > LIVE_SERVER_LARGEST - exchange->size) {
        exchange->too_large = true;
        return;
    }
    if (exchange->size + size + 1 > exchange->capacity) {
        const size_t capacity = 2 * (exchange->size + size + 1);
        char *body = realloc(exchange->body, capacity);
        exchange->too_large = body == NULL;
        if (body == NULL)
            return;
        exchange->body = body;
        exchange->capacity = capacity;
    }
    memcpy(exchange->body + exchange->size, bytes, size);
    exchange->size += size;
    exchange->body[exchange->size] = '\0';
}

static enum MHD_Result answer(struct live_server *server, struct MHD_Connection *connection,
                              struct live_request *request, const struct exchange *exchange) {
    struct live_answer answer = {0};
    if (exchange->too_large)
        return refuse(connection, MHD_HTTP_CONTENT_TOO_LARGE, "The request is too large.");
    request->body = exchange->body ? exchange->body : "";
    request->size = exchange->size;
    server->answerer.answer(server->answerer.context, request, &answer);
    return give(connection, &answer);
}

/// Called once with the head, then with parts of the body, then without any.
static enum MHD_Result take(void *context, struct MHD_Connection *connection, const char *path,
                            const char *method, const char *version, const char *part,
                            size_t *part_size, void **memory) {
    struct live_server *server = context;
    struct live_request request = {
        .path = path, .post = strcmp(method, MHD_HTTP_METHOD_POST) == 0, .connection = connection};
    unsigned code;
    (void)version;
    if (*memory == NULL) {
        const char *fault = find_fault(server, connection, method, &request, &code);
        if (fault)
            return refuse(connection, code, fault);
        if (!server->answerer.open(server->answerer.context, &request))
            mf_live_clients_set_known(&server->clients, find_socket(connection));
        *memory = calloc(1, sizeof(struct exchange));
        return *memory ? MHD_YES : MHD_NO;
    }
    if (*part_size > 0) {
        keep(*memory, part, *part_size);
        *part_size = 0;
        return MHD_YES;
    }
    return answer(server, connection, &request, *memory);
}

static void forget(void *context, struct MHD_Connection *connection, void **memory,
                   enum MHD_RequestTerminationCode why) {
    struct exchange *exchange = *memory;
    (void)context;
    (void)connection;
    (void)why;
    if (exchange)
        free(exchange->body);
    free(exchange);
    *memory = NULL;
}

/// What libmicrohttpd says of requests that are none is of no use to who looks at the run.
static void print_nothing(void *context, const char *format, va_list arguments) {
    (void)context;
    (void)format;
    (void)arguments;
}

enum status mf_live_server_start(struct live_server *server, int port) {
    const struct sockaddr_in address = {.sin_family = AF_INET,
                                        .sin_port = htons((uint16_t)port),
                                        .sin_addr = {htonl(INADDR_LOOPBACK)}};
    mf_live_clients_init(&server->clients);
    errno = 0;
    struct MHD_Daemon *daemon = MHD_start_daemon(
        MHD_USE_INTERNAL_POLLING_THREAD | MHD_USE_THREAD_PER_CONNECTION | MHD_USE_POLL |
            MHD_USE_ERROR_LOG,
        0, NULL, NULL, take, server, MHD_OPTION_EXTERNAL_LOGGER, print_nothing, NULL,
        MHD_OPTION_SOCK_ADDR, (const struct sockaddr *)&address, MHD_OPTION_CONNECTION_LIMIT,
        (unsigned)LIVE_GUESTS_ROOM, MHD_OPTION_CONNECTION_TIMEOUT, (unsigned)LIVE_SERVER_PATIENCE,
        MHD_OPTION_NOTIFY_COMPLETED, forget, NULL, MHD_OPTION_NOTIFY_CONNECTION, note_client,
        server, MHD_OPTION_END);
    if (daemon == NULL)
        return mf_status_fail(STATUS_IO, "port %d of 127.0.0.1: %s", port,
                              errno ? strerror(errno) : "no server can be started");
    const union MHD_DaemonInfo *bound = MHD_get_daemon_info(daemon, MHD_DAEMON_INFO_BIND_PORT);
    server->port = bound ? bound->port : port;
    server->daemon = daemon;
    return STATUS_OK;
}

void mf_live_server_stop(struct live_server *server) {
    if (server->daemon) {
        MHD_stop_daemon(server->daemon);
        mf_live_clients_clear(&server->clients);
    }
    server->daemon = NULL;
}
