// SPDX-License-Identifier: GPL-3.0-or-later
//
// mutate PROGRAM CASES FINDINGS SECONDS SEED: runs the program again and again on the folders of
// CASES, each time with one file of them changed at random. A folder's file "words" is the command
// line. The program, built with sanitizers, may do its work or refuse; it may not crash or be
// stopped by them. What does is kept in FINDINGS; the exit status says whether there was any.
#define _GNU_SOURCE // rand_r
#include <dirent.h>
#include <ftw.h>
#include <fcntl.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { MAX_CASES = 64, MAX_FILES = 64, LARGEST = 1 << 20, TIME_LIMIT = 20, MAX_WORDS = 16 };

static unsigned seed;
static const char *program, *findings;
static struct { long runs, done, unconverged, refused, memory, slow, found; } counts;

static _Noreturn void die(const char *what) {
    perror(what);
    exit(2);
}

static size_t below(size_t limit) {
    return limit > 0 ? (size_t)rand_r(&seed) % limit : 0;
}

static void must(const char *format, const char *a, const char *b) {
    char line[16384];
    snprintf(line, sizeof line, format, a, b);
    if (system(line) != 0)
        die(line);
}

// A changed file ----------------------------------------------------------------------------------

struct text {
    unsigned char *bytes;
    size_t length;
};

/// Replace `gone` bytes at `at` by others.
static void replace_part(struct text *text, size_t at, size_t gone, const void *bytes,
                         size_t count) {
    if (gone > text->length - at)
        gone = text->length - at;
    if (text->length - gone + count > LARGEST)
        return;
    memmove(text->bytes + at + count, text->bytes + at + gone, text->length - at - gone);
    memcpy(text->bytes + at, bytes, count);
    text->length += count - gone;
}

static bool is_part_of_number(unsigned char c) {
    return c && strchr("0123456789+-.eE", c) != NULL;
}

/// A number of the text, or what else stands there, becomes another.
static void change_number(struct text *text) {
    static const char *const numbers[] = {"0",
                                          "1",
                                          "-1",
                                          "2",
                                          "3",
                                          "0.5",
                                          "1e-9",
                                          "1e308",
                                          "1e999",
                                          "-1e308",
                                          "1e-320",
                                          "1000",
                                          "1e6",
                                          "nan",
                                          "inf",
                                          "4294967296",
                                          "9007199254740991",
                                          "0x10",
                                          "1,5",
                                          "",
                                          "null",
                                          "[]",
                                          "{}",
                                          "\"\"",
                                          "true"};
    size_t at = below(text->length), end;
    while (at < text->length && !is_part_of_number(text->bytes[at]))
        at++;
    for (end = at; end < text->length && is_part_of_number(text->bytes[end]);)
        end++;
    const char *number = numbers[below(sizeof numbers / sizeof *numbers)];
    replace_part(text, at, end - at, number, strlen(number));
}

static void change(struct text *text) {
    static const char characters[] = "\"{}[]:,#\n\t \r\\/\0\xff\x80'$%-.e0";
    unsigned char piece[256];
    const size_t at = below(text->length + 1), from = below(text->length);
    size_t length = 1 + below(below(2) ? 8 : sizeof piece);
    if (length > text->length - from)
        length = text->length - from;
    memcpy(piece, text->bytes + from, length);
    switch (below(8)) {
    case 0:
        if (text->length > 0)
            text->bytes[from] ^= (unsigned char)(1 << below(8));
        break;
    case 1:
        replace_part(text, at, below(2), &characters[below(sizeof characters - 1)], 1);
        break;
    case 2:
        replace_part(text, at, length, "", 0);
        break;
    case 3:
        replace_part(text, at, 0, piece, length);
        break;
    case 4:
        replace_part(text, at, length, piece, length);
        break;
    case 5:
        text->length = below(8) ? text->length : at;
        break;
    default:
        change_number(text);
    }
}

static void change_file(const char *path) {
    struct text text = {malloc(2 * LARGEST), 0};
    FILE *stream = fopen(path, "rb");
    if (stream == NULL || text.bytes == NULL)
        die(path);
    text.length = fread(text.bytes, 1, LARGEST, stream);
    fclose(stream);
    for (size_t times = 1 + below(below(3) ? 2 : 8); times > 0; times--)
        change(&text);
    stream = fopen(path, "wb");
    if (stream == NULL || fwrite(text.bytes, 1, text.length, stream) != text.length ||
        fclose(stream) != 0)
        die(path);
    free(text.bytes);
}

static char *files[MAX_FILES];
static size_t file_count;

static int note_file(const char *path, const struct stat *about, int type, struct FTW *place) {
    (void)about;
    const char *name = path + place->base;
    if (type == FTW_F && strcmp(name, "words") != 0 && strcmp(name, "prepare") != 0 &&
        file_count < MAX_FILES)
        files[file_count++] = strdup(path);
    return 0;
}

/// Change a file of the working copy, most often one of those that the case came with.
static void change_some_file(const char *work) {
    file_count = 0;
    if (nftw(work, note_file, 16, FTW_PHYS) != 0 || file_count == 0)
        die(work);
    change_file(files[below(file_count)]);
    while (file_count > 0)
        free(files[--file_count]);
}

// A run -------------------------------------------------------------------------------------------

static void become(const char *work) {
    static char line[1024];
    const char *words[MAX_WORDS + 1] = {program};
    if (chdir(work) != 0)
        _exit(125);
    FILE *stream = fopen("words", "r");
    if (stream == NULL || fgets(line, sizeof line, stream) == NULL)
        _exit(125);
    int count = 1;
    for (char *rest, *word = strtok_r(line, " \n", &rest); word && count < MAX_WORDS;
         word = strtok_r(NULL, " \n", &rest))
        words[count++] = word;
    const int said = open("said", O_WRONLY | O_CREAT | O_TRUNC, 0666);
    dup2(said, STDOUT_FILENO);
    dup2(said, STDERR_FILENO);
    setrlimit(RLIMIT_FSIZE, &(struct rlimit){1 << 28, 1 << 28});
    setrlimit(RLIMIT_CORE, &(struct rlimit){0, 0});
    alarm(TIME_LIMIT);
    execv(program, (char *const *)words);
    _exit(125);
}

/// Whether a sanitizer spoke.
static bool has_report(const char *work) {
    char path[8192], text[65536];
    snprintf(path, sizeof path, "%s/said", work);
    FILE *stream = fopen(path, "r");
    const size_t length = stream ? fread(text, 1, sizeof text - 1, stream) : 0;
    text[length] = '\0';
    if (stream)
        fclose(stream);
    // "WARNING: AddressSanitizer failed to allocate" is want of memory, which the exit code tells.
    return strstr(text, "runtime error:") || strstr(text, "SUMMARY: ");
}

static void run_case(const char *from, const char *work) {
    must("rm -rf '%s'%s", work, "");
    must("cp -r '%s' '%s'", from, work);
    change_some_file(work);
    const pid_t child = fork();
    if (child == 0)
        become(work);
    int status;
    if (child < 0 || waitpid(child, &status, 0) != child)
        die("fork");
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    if (code == 125)
        die(program);
    const bool known = code == -SIGALRM || (code >= 0 && code <= 3);
    counts.runs++;
    counts.done += code == 0;
    counts.unconverged += code == 1;
    counts.refused += code == 2;
    counts.memory += code == 3;
    counts.slow += code == -SIGALRM;
    if (known && !has_report(work))
        return;
    char place[4096];
    snprintf(place, sizeof place, "%s/%ld", findings, ++counts.found);
    must("cp -r '%s' '%s'", work, place);
    printf("found: exit %d, kept in %s\n", code, place);
}

static int is_case(const struct dirent *entry) {
    return entry->d_name[0] != '.';
}

int main(int count, char **words) {
    struct dirent **cases;
    char from[4096], work[4096];
    if (count != 6) {
        fprintf(stderr, "usage: mutate PROGRAM CASES FINDINGS SECONDS SEED\n");
        return 2;
    }
    program = words[1];
    findings = words[3];
    seed = (unsigned)atol(words[5]);
    const time_t end = time(NULL) + atol(words[4]);
    const int max = scandir(words[2], &cases, is_case, alphasort);
    if (max <= 0)
        die(words[2]);
    snprintf(work, sizeof work, "%s/work", findings);
    for (long k = 0; time(NULL) < end; k++) {
        snprintf(from, sizeof from, "%s/%s", words[2], cases[k % max]->d_name);
        run_case(from, work);
    }
    must("rm -rf '%s'%s", work, "");
    printf("%ld runs on changed files: %ld done, %ld not converged or unstable, %ld refused, %ld "
           "out of "
           "memory, %ld too slow; %ld findings\n",
           counts.runs, counts.done, counts.unconverged, counts.refused, counts.memory, counts.slow,
           counts.found);
    return counts.found > 0;
}
