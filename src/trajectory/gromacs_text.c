// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/gromacs_text.h"

#include "base/memory.h"
#include "io/text_file.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { MAX_DEPTH = 16, MAX_FILES = 256, MAX_WORDS = 1024, MAX_LEVELS = 32 };

struct word {
    char name[64];
    char text[256];
};

struct reading {
    gromacs_take *take;
    void *context;
    struct word *word; ///< shape [MAX_WORDS]: defined
    size_t words;
    int files, depth;
    bool taken[MAX_LEVELS]; ///< of each #ifdef that is open: whether its lines count
    int levels;
};

enum status mf_gromacs_fail(const struct gromacs_line *line, const char *format, ...) {
    char message[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    return mf_status_fail(STATUS_BAD_INPUT, "%s:%zu: %s", line->file, line->number, message);
}

static bool counts(const struct reading *reading) {
    for (int k = 0; k < reading->levels; k++)
        if (!reading->taken[k])
            return false;
    return true;
}

static struct word *find_word(const struct reading *reading, const char *name, size_t length) {
    for (size_t k = 0; k < reading->words; k++)
        if (strlen(reading->word[k].name) == length &&
            strncmp(reading->word[k].name, name, length) == 0)
            return &reading->word[k];
    return NULL;
}

// Directives --------------------------------------------------------------------------------------

static enum status define(struct reading *reading, struct gromacs_line *line, char *rest) {
    const size_t length = strcspn(rest, " \t");
    struct word *word = find_word(reading, rest, length);
    const char *text = rest + length + strspn(rest + length, " \t");
    if (length == 0 || length >= sizeof word->name || strlen(text) >= sizeof word->text)
        return mf_gromacs_fail(line, "#define of a word that is empty or too long");
    if (word == NULL && reading->words == MAX_WORDS)
        return mf_gromacs_fail(line, "more than %d words are defined", MAX_WORDS);
    if (word == NULL)
        word = &reading->word[reading->words++];
    snprintf(word->name, sizeof word->name, "%.*s", (int)length, rest);
    snprintf(word->text, sizeof word->text, "%s", text);
    return STATUS_OK;
}

static enum status read_file(struct reading *reading, const char *file);

/// What GROMACS brings along, where it is or says that it is.
static bool find_shared(const char *name, size_t length, char path[GROMACS_PATH_SIZE]) {
    const char *const library = getenv("GMXLIB"), *const data = getenv("GMXDATA");
    const char *const folder[] = {library ? library : "", data ? data : "", "/usr/share/gromacs",
                                  "/usr/local/gromacs/share/gromacs"};
    struct stat found;
    for (size_t k = 0; k < sizeof folder / sizeof *folder; k++) {
        char other[GROMACS_PATH_SIZE];
        const int size = snprintf(other, sizeof other, "%s%s/%.*s", folder[k], k ? "/top" : "",
                                  (int)length, name);
        if (folder[k][0] == '/' && size < (int)sizeof other && stat(other, &found) == 0) {
            memcpy(path, other, sizeof other);
            return true;
        }
    }
    return false;
}

static enum status include(struct reading *reading, struct gromacs_line *line, const char *rest) {
    char path[GROMACS_PATH_SIZE];
    struct stat found;
    const size_t length = strcspn(rest + (rest[0] != '\0'), "\">");
    const char *slash = strrchr(line->file, '/');
    const int folder = slash && rest[1] != '/' ? (int)(slash - line->file) + 1 : 0;
    if (rest[0] != '"' && rest[0] != '<')
        return mf_gromacs_fail(line, "#include names a file in quotation marks");
    snprintf(path, sizeof path, "%.*s%.*s", folder, line->file, (int)length, rest + 1);
    if (stat(path, &found) != 0 && !find_shared(rest + 1, length, path))
        return mf_gromacs_fail(line, "#include: there is no file %.300s", path);
    if (reading->depth == MAX_DEPTH || reading->files == MAX_FILES)
        return mf_gromacs_fail(line, "#include: more than %d levels or %d files", MAX_DEPTH,
                               MAX_FILES);
    return read_file(reading, path);
}

static enum status open_level(struct reading *reading, struct gromacs_line *line, const char *rest,
                              bool wanted) {
    if (reading->levels == MAX_LEVELS)
        return mf_gromacs_fail(line, "more than %d #ifdef are open", MAX_LEVELS);
    reading->taken[reading->levels++] =
        (find_word(reading, rest, strcspn(rest, " \t")) != NULL) == wanted;
    return STATUS_OK;
}

static bool is(const char *text, size_t length, const char *name) {
    return length == strlen(name) && strncmp(text, name, length) == 0;
}

static enum status direct(struct reading *reading, struct gromacs_line *line, int lowest) {
    char *name = line->text + 1 + strspn(line->text + 1, " \t");
    const size_t length = strcspn(name, " \t\"<");
    char *rest = name + length + strspn(name + length, " \t");
    if (is(name, length, "ifdef") || is(name, length, "ifndef"))
        return open_level(reading, line, rest, is(name, length, "ifdef"));
    if (is(name, length, "else") || is(name, length, "endif")) {
        if (reading->levels == lowest)
            return mf_gromacs_fail(line, "#%.*s without an #ifdef", (int)length, name);
        if (is(name, length, "endif"))
            reading->levels--;
        else
            reading->taken[reading->levels - 1] = !reading->taken[reading->levels - 1];
        return STATUS_OK;
    }
    if (!counts(reading))
        return STATUS_OK;
    if (is(name, length, "include"))
        return include(reading, line, rest);
    if (is(name, length, "error"))
        return mf_gromacs_fail(line, "#error %.300s", rest);
    if (is(name, length, "define"))
        return define(reading, line, rest);
    if (!is(name, length, "undef"))
        return mf_gromacs_fail(line, "#%.*s is not known", (int)length, name);
    struct word *word = find_word(reading, rest, strcspn(rest, " \t"));
    if (word)
        *word = reading->word[--reading->words];
    return STATUS_OK;
}

// Lines -------------------------------------------------------------------------------------------

/// Put the text of defined words in their place.
static enum status replace(const struct reading *reading, struct gromacs_line *line) {
    char replaced[GROMACS_LINE_SIZE];
    size_t at = 0;
    if (reading->words == 0)
        return STATUS_OK;
    for (const char *text = line->text; *text;) {
        const size_t blank = strspn(text, " \t"), length = strcspn(text + blank, " \t");
        const struct word *word = find_word(reading, text + blank, length);
        const char *own = word ? word->text : text + blank;
        const size_t size = word ? strlen(word->text) : length;
        if (at + size + 2 > sizeof replaced)
            return mf_gromacs_fail(line, "the line is too long after macro expansion");
        at += (size_t)snprintf(replaced + at, sizeof replaced - at, "%.*s ", (int)size, own);
        text += blank + length;
    }
    memcpy(line->text, replaced, at + 1);
    return STATUS_OK;
}

/// Take the next line, joined with those after it while they end with a backslash, without
/// comment and blanks around; false after the last.
static enum status take_line(const char **text, struct gromacs_line *line, size_t *lines,
                             bool *there) {
    size_t at = 0;
    bool more = true;
    *there = **text != '\0';
    line->number = *lines + 1;
    for (; more && **text; ++*lines) {
        const size_t length = strcspn(*text, "\n");
        size_t used = strcspn(*text, ";\n");
        while (used > 0 && strchr(" \t\r", (*text)[used - 1]))
            used--;
        more = used > 0 && (*text)[used - 1] == '\\';
        used -= more;
        if (at + used + 2 > sizeof line->text)
            return mf_gromacs_fail(line, "the line is longer than %zu characters",
                                   sizeof line->text);
        memcpy(line->text + at, *text, used);
        at += used;
        if (more)
            line->text[at++] = ' ';
        *text += length + ((*text)[length] == '\n');
    }
    line->text[at] = '\0';
    const size_t blank = strspn(line->text, " \t");
    memmove(line->text, line->text + blank, at - blank + 1);
    return STATUS_OK;
}

static enum status read_lines(struct reading *reading, const char *file, const char *text) {
    const int lowest = reading->levels;
    struct gromacs_line line = {.file = file};
    size_t lines = 0;
    for (bool there = true; there;) {
        TRY(take_line(&text, &line, &lines, &there));
        if (line.text[0] == '#') {
            TRY(direct(reading, &line, lowest));
        } else if (line.text[0] && counts(reading)) {
            TRY(replace(reading, &line));
            TRY(reading->take(reading->context, &line));
        }
    }
    if (reading->levels != lowest)
        return mf_gromacs_fail(&line, "an #ifdef has no #endif");
    return STATUS_OK;
}

static enum status read_file(struct reading *reading, const char *file) {
    char *text;
    size_t length;
    TRY(mf_text_file_read(file, &text, &length));
    reading->files++;
    reading->depth++;
    const enum status status = read_lines(reading, file, text);
    reading->depth--;
    mf_memory_free(text);
    return status;
}

enum status mf_gromacs_text_read(const char *file, gromacs_take *take, void *context) {
    enum status status = STATUS_OK;
    struct reading reading = {.take = take, .context = context};
    NEW_ARRAY(reading.word, MAX_WORDS);
    status = read_file(&reading, file);
done:
    mf_memory_free(reading.word);
    return status;
}
