// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/// PATH while it is another; "" if it is not.
static char search_path[4096];

int small_inputs_enter(void **state) {
    temporary_folder_create(state);
    return chdir(((struct temporary_folder *)*state)->path);
}

int small_inputs_enter_without_gnuplot(void **state) {
    snprintf(search_path, sizeof search_path, "%s", getenv("PATH"));
    setenv("PATH", "/nowhere", 1);
    return small_inputs_enter(state);
}

int small_inputs_leave(void **state) {
    if (search_path[0])
        setenv("PATH", search_path, 1);
    search_path[0] = '\0';
    return chdir("/") == 0 ? temporary_folder_remove(state) : -1;
}

void small_inputs_need_gnuplot(void) {
    if (system("gnuplot --version >/dev/null 2>&1") != 0)
        skip();
}

const char small_inputs_scene[] =
    "{\n"
    "  \"seed\": 1,\n"
    "  \"box\": [3, 3, 3],\n"
    "  \"particles\": {\"count\": 81},\n"
    "  \"temperature\": 1,\n"
    "  \"time_step\": 0.02,\n"
    "  \"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25},\n"
    "  \"dissipative\": {\"law\": \"power\", \"sigma\": 2},\n"
    "  \"measure\": {\"equilibration\": 2, \"samples\": 4, \"every\": 1}\n"
    "}\n";

const char small_inputs_run[] =
    "{\n"
    "  \"seed\": 1,\n"
    "  \"target\": {\"rdf\": {\"file\": \"target.tsv\"}},\n"
    "  \"scene\": {\n"
    "    \"box\": [3, 3, 3],\n"
    "    \"particles\": {\"count\": 81},\n"
    "    \"time_step\": 0.02,\n"
    "    \"dissipative\": {\"law\": \"power\", \"sigma\": 2}\n"
    "  },\n"
    "  \"method\": {\"name\": \"imc\", \"replicas\": 2, \"equilibration\": 1, \"samples\": 8,\n"
    "             \"every\": 1, \"iterations\": 1},\n"
    "  \"verification\": {\"replicas\": 1, \"equilibration\": 1, \"samples\": 2, \"every\": 1}\n"
    "}\n";

const char small_inputs_target[] = "# r g error\n0.1 0.3 0.1\n0.3 0.6 0.1\n0.5 0.8 0.1\n"
                                   "0.7 1.1 0.1\n0.9 1.0 0.1\n";

void small_inputs_write(struct temporary_folder *folder, const char *name, const char *text,
                        const char *from, const char *to) {
    char changed[4096];
    const char *at = from ? strstr(text, from) : text;
    if (at == NULL)
        fail_msg("\"%s\" is not in the good file", from);
    const int length = from ? snprintf(changed, sizeof changed, "%.*s%s%s", (int)(at - text), text,
                                       to, at + strlen(from))
                            : snprintf(changed, sizeof changed, "%s", text);
    assert_in_range(length, 1, sizeof changed - 1);
    temporary_folder_write(folder, name, changed, (size_t)length);
}

void small_inputs_change(struct temporary_folder *folder, const char *name, const char *from,
                         const char *to) {
    char *text = temporary_folder_read(name);
    small_inputs_write(folder, name, text, from, to);
    free(text);
}
