// SPDX-License-Identifier: GPL-3.0-or-later
//
// The server from outside, through a socket: who is let in, what is answered, what is refused.
#include "live/live_routes.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <arpa/inet.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

static const char token[LIVE_TOKEN_SIZE] = "0123456789abcdef0123456789abcdef";
static struct live_view view;
static struct live_server server;
static char before[4096];

/// The working folder of the view is one of the test's own.
static int enter(void **state) {
    if (temporary_folder_create(state) != 0 || getcwd(before, sizeof before) == NULL)
        return -1;
    struct temporary_folder *folder = *state;
    if (chdir(folder->path) != 0)
        return -1;
    temporary_folder_write(folder, "run.json", "{\"target\": {}}", 14);
    temporary_folder_write(folder, "scene.json", "{\"box\": [5, 5, 5]}", 18);
    temporary_folder_write(folder, "broken.json", "{", 1);
    if (mf_live_view_init(&view, "[]", true) != STATUS_OK)
        return -1;
    server = (struct live_server){.token = token, .answerer = mf_live_routes(&view)};
    if (mf_live_server_start(&server, 0) == STATUS_OK)
        return 0;
    print_message("%s\n", mf_status_message());
    return -1;
}

static int leave(void **state) {
    mf_live_feed_close(&view.feed);
    mf_live_server_stop(&server);
    mf_live_view_clear(&view);
    return chdir(before) != 0 ? -1 : temporary_folder_remove(state);
}

static char answer[65536];

static int connect_to_server(void) {
    const struct sockaddr_in address = {.sin_family = AF_INET,
                                        .sin_port = htons((uint16_t)server.port),
                                        .sin_addr = {htonl(INADDR_LOOPBACK)}};
    const int connection = socket(AF_INET, SOCK_STREAM, 0);
    assert_int_equal(connect(connection, (const struct sockaddr *)&address, sizeof address), 0);
    setsockopt(connection, SOL_SOCKET, SO_RCVTIMEO, &(struct timeval){.tv_sec = 10},
               sizeof(struct timeval));
    return connection;
}

/// Send bytes and read to the end, or until `until` has come, into `to`; returns the code, 0
/// without one.
static int talk(const char *bytes, size_t size, const char *until, char *to, size_t capacity) {
    const int connection = connect_to_server();
    size_t got = 0;
    for (size_t sent = 0; sent < size;) {
        const ssize_t now = send(connection, bytes + sent, size - sent, MSG_NOSIGNAL);
        if (now <= 0)
            break;
        sent += (size_t)now;
    }
    for (ssize_t now;
         got + 1 < capacity && (now = recv(connection, to + got, capacity - 1 - got, 0)) > 0;) {
        got += (size_t)now;
        to[got] = '\0';
        if (until && strstr(to, until))
            break;
    }
    to[got] = '\0';
    close(connection);
    return strncmp(to, "HTTP/1.1 ", 9) == 0 ? atoi(to + 9) : 0;
}

static int exchange(const char *bytes, size_t size, const char *until) {
    return talk(bytes, size, until, answer, sizeof answer);
}

/// A request with these lines in its head, each ended by "\r\n".
static int ask(const char *line, const char *heads, const char *body) {
    static char text[32768];
    const int size = snprintf(text, sizeof text,
                              "%s HTTP/1.1\r\n%sConnection: close\r\nContent-Length: %zu\r\n\r\n%s",
                              line, heads, strlen(body), body);
    return exchange(text, (size_t)size, NULL);
}

#define HOST "Host: localhost:7\r\n"
#define TOKEN "X-Mesofit-Token: 0123456789abcdef0123456789abcdef\r\n"
#define GOOD HOST TOKEN

static void test_page_and_its_files_need_no_token(void **state) {
    (void)state;
    assert_int_equal(ask("GET /", HOST, ""), 200);
    assert_contains(answer, "<title>mesofit</title>");
    assert_contains(answer, "Content-Security-Policy: default-src 'none'; script-src 'self'; "
                            "style-src 'self'; connect-src 'self'");
    assert_null(strstr(answer, "unsafe"));
    assert_contains(answer, "Referrer-Policy: no-referrer");
    assert_int_equal(ask("GET /app.js", HOST, ""), 200);
    assert_int_equal(ask("GET /chart.js", HOST, ""), 200);
    assert_contains(answer, "Chart.js v");
    assert_int_equal(ask("GET /licences.txt", HOST, ""), 200);
    assert_int_equal(ask("GET /?token=0123456789abcdef0123456789abcdef", HOST, ""), 200);
}

static void test_stale_token_is_refused_even_for_the_page(void **state) {
    (void)state;
    assert_int_equal(ask("GET /?token=00000000000000000000000000000000", HOST, ""), 403);
    assert_contains(answer, "token");
}

static const char *const paths[] = {"GET /api/state",
                                    "GET /api/text",
                                    "GET /api/topics",
                                    "GET /api/particles",
                                    "GET /api/files",
                                    "GET /api/events",
                                    "GET /api/file?path=run.json",
                                    "GET /api/zip",
                                    "POST /api/wish",
                                    "POST /api/start",
                                    "POST /api/open?path=run.json",
                                    "POST /api/file?path=new.json",
                                    "GET /api/nothing"};

static void test_nothing_of_the_run_is_told_without_the_token(void **state) {
    static const char *const heads[] = {HOST, HOST "X-Mesofit-Token: \r\n",
                                        HOST
                                        "X-Mesofit-Token: 0123456789abcdef0123456789abcdee\r\n",
                                        HOST "Cookie: token=0123456789abcdef0123456789abcdef\r\n"};
    (void)state;
    for (size_t p = 0; p < sizeof paths / sizeof *paths; p++)
        for (size_t h = 0; h < sizeof heads / sizeof *heads; h++)
            assert_int_equal(ask(paths[p], heads[h], ""), 403);
    // After the "?" it opens the page alone.
    assert_int_equal(ask("GET /api/state?token=0123456789abcdef0123456789abcdef", HOST, ""), 403);
    assert_int_not_equal(access("new.json", F_OK), 0);
}

static void test_other_hosts_and_origins_are_refused(void **state) {
    (void)state;
    assert_int_equal(ask("GET /api/state", GOOD, ""), 200);
    assert_int_equal(ask("GET /api/state", TOKEN "Host: evil.example\r\n", ""), 403);
    assert_int_equal(ask("GET /", "Host: evil.example:80\r\n", ""), 403);
    assert_int_equal(
        ask("POST /api/file?path=new.json&in=work", GOOD "Origin: http://evil.example\r\n", "x"),
        403);
    assert_int_equal(ask("POST /api/file?path=new.json", GOOD "Origin: null\r\n", "x"), 403);
    assert_int_not_equal(access("new.json", F_OK), 0);
    assert_int_equal(
        ask("POST /api/file?path=new.json", GOOD "Origin: http://localhost:7\r\n", "x"), 200);
    assert_int_equal(access("new.json", F_OK), 0);
}

static void test_paths_and_methods_that_are_not_there_are_refused(void **state) {
    (void)state;
    assert_int_equal(ask("GET /api/file?path=../../etc/passwd", GOOD, ""), 404);
    assert_int_equal(ask("GET /api/file?path=%2e%2e%2fsecret", GOOD, ""), 404);
    assert_int_equal(ask("GET /api/file?path=/etc/passwd", GOOD, ""), 404);
    assert_int_equal(ask("POST /api/file?path=cut.json%00.txt", GOOD, "x"), 400);
    assert_int_equal(ask("GET /api/file?path=cut.json", GOOD, ""), 404);
    assert_int_equal(ask("GET /api/files?in=elsewhere", GOOD, ""), 404);
    assert_int_equal(ask("GET /etc/passwd", HOST, ""), 403);
    assert_int_equal(ask("GET /../etc/passwd", GOOD, ""), 404);
    assert_int_equal(ask("GET /api/wish", GOOD, ""), 405);
    assert_int_equal(ask("DELETE /api/file?path=run.json", GOOD, ""), 405);
    assert_int_equal(access("run.json", F_OK), 0);
}

static void test_wishes_are_read_strictly(void **state) {
    (void)state;
    assert_int_equal(ask("POST /api/wish", GOOD, "{"), 400);
    assert_int_equal(ask("POST /api/wish", GOOD, ""), 400);
    assert_int_equal(ask("POST /api/wish", GOOD, "{\"wish\": \"fly\"}"), 400);
    assert_contains(answer, "fly");
    assert_int_equal(ask("POST /api/wish", GOOD, "{\"wish\": \"speed\", \"speed\": -1}"), 400);
    assert_int_equal(ask("POST /api/wish", GOOD, "{\"wish\": \"speed\", \"color\": 1}"), 400);
    assert_int_equal(ask("POST /api/wish", GOOD, "{\"wish\": \"speed\", \"speed\": 10}"), 200);
    assert_int_equal(ask("POST /api/wish", GOOD, "{\"wish\": \"stop\"}"), 400);
    assert_contains(answer, "no run is going on");
}

static void test_file_is_opened_and_ordered(void **state) {
    struct live_order order, other = {.text = NULL};
    (void)state;
    assert_int_equal(ask("POST /api/start", GOOD, ""), 400);
    assert_contains(answer, "choose a scene");
    assert_int_equal(ask("POST /api/open?path=broken.json", GOOD, ""), 400);
    assert_contains(answer, "broken.json:1:");
    assert_int_equal(ask("POST /api/open?path=run.json", GOOD, ""), 200);
    assert_contains(answer, "\"fit\"");
    assert_int_equal(ask("POST /api/open?path=scene.json", GOOD, ""), 200);
    assert_contains(answer, "\"simulation\"");
    assert_int_equal(ask("GET /api/text", GOOD, ""), 200);
    assert_contains(answer, "{\"box\": [5, 5, 5]}");
    assert_int_equal(ask("POST /api/start?folder=../up", GOOD, "{}"), 400);
    assert_int_equal(symlink("/", "root"), 0);
    assert_int_equal(ask("POST /api/start?folder=root/tmp/out", GOOD, "{}"), 400);
    assert_int_equal(ask("POST /api/wish", GOOD, "{\"wish\": \"pause\"}"), 400);
    assert_int_equal(ask("POST /api/start?folder=out&force=1", GOOD, "{\"box\": [6, 6, 6]}"), 200);
    // A run that was ordered is going on: it hears wishes before it is taken, and no other begins.
    assert_contains(answer, "\"running\"");
    assert_int_equal(ask("POST /api/wish", GOOD, "{\"wish\": \"pause\"}"), 200);
    assert_true(mf_live_control_wait(&view.control).paused);
    assert_int_equal(ask("POST /api/start", GOOD, "{}"), 400);
    assert_fails(mf_live_view_order(&view, &other), STATUS_BAD_INPUT, "going on");
    assert_true(mf_live_control_take(&view.control, &order));
    assert_string_equal(order.file, "scene.json");
    assert_string_equal(order.folder, "out");
    assert_string_equal(order.text, "{\"box\": [6, 6, 6]}");
    assert_true(order.force && !order.resume);
    free(order.text);
}

static void test_events_come_while_the_stream_is_open(void **state) {
    static const char request[] = "GET /api/events HTTP/1.1\r\n" GOOD "\r\n";
    (void)state;
    mf_live_feed_push(&view.feed, LIVE_LOG, "hello");
    assert_int_equal(exchange(request, sizeof request - 1, "data: hello"), 200);
    assert_contains(answer, "event: state");
    assert_contains(answer, "event: log\ndata: hello\n\n");
}

static void test_too_large_and_broken_requests_end_alone(void **state) {
    static const char *const broken[] = {"GET\r\n\r\n", "\r\n\r\n\r\n", "GET / HTTP/9.9\r\n\r\n",
                                         "POST /api/wish HTTP/1.1\r\n" GOOD
                                         "Transfer-Encoding: chunked\r\n\r\nzz\r\n",
                                         "GET / HTTP/1.1\r\nHost: localhost\r\nHost: evil\r\n\r\n"};
    (void)state;
    assert_int_equal(ask("GET /api/state", GOOD "Content-Length: 99999999999\r\n", "") == 200,
                     false);
    for (size_t k = 0; k < sizeof broken / sizeof *broken; k++) {
        const int connection = connect_to_server();
        assert_true(send(connection, broken[k], strlen(broken[k]), MSG_NOSIGNAL) > 0);
        close(connection);
    }
    char *large = malloc((size_t)LIVE_SERVER_LARGEST + 4096);
    const int head = snprintf(large, 4096,
                              "POST /api/file?path=large.tsv HTTP/1.1\r\n" GOOD
                              "Connection: close\r\nContent-Length: %d\r\n\r\n",
                              LIVE_SERVER_LARGEST + 1);
    // The head alone is refused: nobody waits for the body, and nothing of it is kept.
    assert_int_equal(exchange(large, (size_t)head, "\r\n\r\n"), 413);
    memset(large + head, 'x', LIVE_SERVER_LARGEST + 1);
    assert_int_not_equal(exchange(large, (size_t)head + LIVE_SERVER_LARGEST + 1, NULL), 200);
    free(large);
    assert_int_not_equal(access("large.tsv", F_OK), 0);
    assert_int_equal(ask("GET /api/state", GOOD, ""), 200);
}

static void test_connections_that_say_little_do_not_keep_the_page_out(void **state) {
    enum { SILENT = 3 * LIVE_GUESTS_ROOM };
    static const char events[] = "GET /api/events HTTP/1.1\r\n" GOOD "\r\n";
    int silent[SILENT];
    char byte;
    (void)state;
    const int page = connect_to_server();
    assert_true(send(page, events, sizeof events - 1, MSG_NOSIGNAL) > 0);
    assert_int_equal(recv(page, &byte, 1, 0), 1);
    for (int k = 0; k < SILENT; k++) {
        silent[k] = connect_to_server();
        send(silent[k], "GET / HT", 8, MSG_NOSIGNAL);
        if (k % 8 == 0)
            assert_int_equal(ask("GET /api/state", GOOD, ""), 200);
    }
    assert_int_equal(ask("GET /api/state", GOOD, ""), 200);
    // The oldest have been ended, the youngest and who has shown the token have not.
    assert_true(recv(silent[0], &byte, 1, 0) <= 0);
    setsockopt(silent[SILENT - 1], SOL_SOCKET, SO_RCVTIMEO, &(struct timeval){.tv_usec = 50000},
               sizeof(struct timeval));
    assert_true(recv(silent[SILENT - 1], &byte, 1, 0) < 0);
    mf_live_feed_push(&view.feed, LIVE_LOG, "still here");
    ssize_t got = 0;
    for (ssize_t now; (now = recv(page, answer + got, sizeof answer - 1 - (size_t)got, 0)) > 0;) {
        got += now;
        answer[got] = '\0';
        if (strstr(answer, "still here"))
            break;
    }
    assert_contains(answer, "still here");
    close(page);
    for (int k = 0; k < SILENT; k++)
        close(silent[k]);
}

static void test_second_server_on_the_port_is_refused(void **state) {
    struct live_server second = {.token = token, .answerer = mf_live_routes(&view)};
    char port[32];
    (void)state;
    snprintf(port, sizeof port, "port %d", server.port);
    assert_fails(mf_live_server_start(&second, server.port), STATUS_IO, port);
}

/// The command line may name such a file; JSON cannot.
static void test_state_is_utf8_whatever_the_file_is_called(void **state) {
    temporary_folder_write(*state, "caf\xe9.json", "{\"box\": [5, 5, 5]}", 18);
    assert_ok(mf_live_view_show_file(&view, "caf\xe9.json"));
    assert_int_equal(ask("GET /api/state", GOOD, ""), 200);
    assert_contains(answer, "caf\\\\xe9.json");
    assert_null(strstr(answer, "\xe9"));
}

/// A file of one letter, sent by a thread.
struct upload {
    const char *query;
    char letter;
    int code;
};

enum { UPLOAD = 1000 };

static void *send_upload(void *context) {
    struct upload *upload = context;
    char text[2 * UPLOAD], said[1024];
    const int head = snprintf(text, sizeof text,
                              "POST /api/file?path=%s HTTP/1.1\r\n" GOOD "Connection: close\r\n"
                              "Content-Length: %d\r\n\r\n",
                              upload->query, UPLOAD);
    memset(text + head, upload->letter, UPLOAD);
    upload->code = talk(text, (size_t)head + UPLOAD, NULL, said, sizeof said);
    return NULL;
}

/// Send both at once, each from a thread of its own.
static void send_both(struct upload uploads[2]) {
    pthread_t threads[2];
    for (int k = 0; k < 2; k++)
        assert_int_equal(pthread_create(&threads[k], NULL, send_upload, &uploads[k]), 0);
    for (int k = 0; k < 2; k++)
        pthread_join(threads[k], NULL);
}

static void assert_upload(const char *file, char letter) {
    char expected[UPLOAD + 1], *text = temporary_folder_read(file);
    memset(expected, letter, UPLOAD);
    expected[UPLOAD] = '\0';
    assert_string_equal(text, expected);
    free(text);
}

static void test_uploads_at_once_get_their_own_bytes(void **state) {
    (void)state;
    for (int round = 0; round < 40; round++) {
        struct upload uploads[] = {{"a.txt&replace=1", 'a', 0}, {"b.txt&replace=1", 'b', 0}};
        send_both(uploads);
        for (int k = 0; k < 2; k++) {
            assert_int_equal(uploads[k].code, 200);
            assert_upload(k ? "b.txt" : "a.txt", uploads[k].letter);
        }
    }
}

/// Of two new files of one name there is one, whole, and the other is refused.
static void test_one_of_two_uploads_of_a_name_wins(void **state) {
    (void)state;
    for (int round = 0; round < 20; round++) {
        struct upload uploads[] = {{"new.txt", 'a', 0}, {"new.txt", 'b', 0}};
        send_both(uploads);
        assert_int_equal(uploads[0].code + uploads[1].code, 200 + 400);
        assert_upload("new.txt", uploads[uploads[0].code == 200 ? 0 : 1].letter);
        assert_int_equal(unlink("new.txt"), 0);
    }
}

int main(void) {
#define SERVED(test) cmocka_unit_test_setup_teardown(test, enter, leave)
    const struct CMUnitTest tests[] = {
        SERVED(test_page_and_its_files_need_no_token),
        SERVED(test_stale_token_is_refused_even_for_the_page),
        SERVED(test_nothing_of_the_run_is_told_without_the_token),
        SERVED(test_other_hosts_and_origins_are_refused),
        SERVED(test_paths_and_methods_that_are_not_there_are_refused),
        SERVED(test_wishes_are_read_strictly),
        SERVED(test_file_is_opened_and_ordered),
        SERVED(test_events_come_while_the_stream_is_open),
        SERVED(test_too_large_and_broken_requests_end_alone),
        SERVED(test_connections_that_say_little_do_not_keep_the_page_out),
        SERVED(test_state_is_utf8_whatever_the_file_is_called),
        SERVED(test_uploads_at_once_get_their_own_bytes),
        SERVED(test_one_of_two_uploads_of_a_name_wins),
        SERVED(test_second_server_on_the_port_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
