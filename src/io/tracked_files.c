// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/tracked_files.h"

#include "base/memory.h"
#include "base/process_lock.h"
#include "base/ranks.h"
#include "io/tracked_file.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

/// So much of a folder is read for digests, of what was written last; of the rest, sizes are known
/// [bytes].
static const int64_t max_read = (int64_t)1 << 30;

/// All folders that are open, by the lock of the process.
static struct tracked_files *all;

/// A run may take days: the folder is still that which was opened.
static enum status check_place(const struct tracked_files *own) {
    struct stat then, now;
    if (fstat(own->list.place, &then) == 0 && stat(own->folder, &now) == 0 &&
        then.st_dev == now.st_dev && then.st_ino == now.st_ino)
        return STATUS_OK;
    return mf_status_fail(STATUS_IO, "%s is gone: it was removed, or replaced, while it was used",
                          own->folder);
}

// One folder --------------------------------------------------------------------------------------

/// Links are not followed: what they lead to is somebody else's.
static enum status check_link(const char *folder) {
    char path[OUTPUT_PATH_SIZE];
    struct stat about;
    size_t length = strlen(folder);
    while (length > 1 && folder[length - 1] == '/')
        length--;
    snprintf(path, sizeof path, "%.*s", (int)length, folder);
    if (lstat(path, &about) != 0 || !S_ISLNK(about.st_mode))
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s is a link: give -o the folder that it points to, or another", path);
}

enum status mf_tracked_files_open(struct tracked_files *own, const char *folder, const char *list) {
    enum status status = STATUS_OK;
    *own = (struct tracked_files){.list = {.name = list, .file = -1}};
    snprintf(own->folder, sizeof own->folder, "%s", folder);
    TRY(check_link(folder));
    own->list.folder = own->folder;
    own->list.place = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (own->list.place < 0)
        return mf_status_fail(STATUS_IO, "%s: %s", folder, strerror(errno));
    CHECK(mf_manifest_read(&own->list));
    mf_process_lock();
    own->open = true;
    own->next = all;
    all = own;
    mf_process_unlock();
done:
    if (status != STATUS_OK) {
        mf_manifest_clear(&own->list);
        close(own->list.place);
    }
    return status;
}

enum status mf_tracked_files_make(struct tracked_files *own, const char *folder, const char *list) {
    struct stat about;
    const bool missing = stat(folder, &about) != 0 && errno == ENOENT;
    *own = (struct tracked_files){.open = false};
    TRY(check_link(folder));
    TRY(mf_output_make_folder(folder));
    TRY(mf_tracked_files_open(own, folder, list));
    own->made = missing;
    return STATUS_OK;
}

enum status mf_tracked_files_lock(struct tracked_files *own) {
    own->alone = flock(own->list.place, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
    if (own->alone)
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT, "%s: another process is running in this folder",
                          own->folder);
}

bool mf_tracked_files_has(const struct tracked_files *own, const char *name) {
    const struct manifest_entry *entry = mf_manifest_find(&own->list, name);
    return entry && mf_tracked_file_state(own->list.place, name, entry) != TRACKED_FILE_ABSENT;
}

bool mf_tracked_files_has_others(const struct tracked_files *own) {
    struct dirent **entries;
    bool others = false;
    const int count = scandir(own->folder, &entries, NULL, alphasort);
    for (int k = 0; k < count; k++) {
        const char *name = entries[k]->d_name;
        char folder[sizeof entries[k]->d_name + 1];
        snprintf(folder, sizeof folder, "%s/", name);
        others = others ||
                 (strcmp(name, ".") != 0 && strcmp(name, "..") != 0 &&
                  strcmp(name, own->list.name) != 0 && mf_manifest_find(&own->list, name) == NULL &&
                  mf_manifest_find(&own->list, folder) == NULL);
        free(entries[k]);
    }
    if (count >= 0)
        free(entries);
    return others;
}

static enum status spare_input(const struct tracked_files *own, const char *name) {
    char path[2 * OUTPUT_PATH_SIZE];
    snprintf(path, sizeof path, "%s/%s", own->folder, name);
    return own->inputs ? mf_input_files_protect(own->inputs, path) : STATUS_OK;
}

/// A run that can go on would be lost by --force.
static const char *remedy_of(const struct tracked_files *own, enum tracked_file_state found) {
    const char *from = own->goes_on_from;
    if (from && mf_tracked_file_state(own->list.place, from, NULL) != TRACKED_FILE_ABSENT)
        return "move it away, and continue with --resume";
    return found == TRACKED_FILE_FOLDER
               ? "move it away, or write elsewhere with -o"
               : "move it away, or write elsewhere with -o; --force replaces it";
}

/// Whether a file may be replaced; a folder never is. @param[in] entry  its own, or NULL: it is not
static enum status check_replaced(const struct tracked_files *own, const char *name,
                                  const struct manifest_entry *entry) {
    const enum tracked_file_state found = entry && entry->claimed
                                              ? TRACKED_FILE_AS_LEFT
                                              : mf_tracked_file_state(own->list.place, name, entry);
    if (found == TRACKED_FILE_ABSENT)
        return STATUS_OK;
    TRY(spare_input(own, name));
    if (found == TRACKED_FILE_AS_LEFT || (found == TRACKED_FILE_OTHER && own->force))
        return STATUS_OK;
    const char *what = found == TRACKED_FILE_FOLDER ? "is a folder"
                       : entry                      ? "was changed since mesofit wrote it"
                                                    : "is there, and mesofit did not write it";
    return mf_status_fail(STATUS_BAD_INPUT, "%s/%s %s: %s", own->folder, name, what,
                          remedy_of(own, found));
}

static bool is_among(const char *const *names, const char *name) {
    for (; names && *names; names++)
        if (strcmp(*names, name) == 0)
            return true;
    return false;
}

enum status mf_tracked_files_protect_inputs(struct tracked_files *own, const char *const *but) {
    for (size_t k = 0; k < own->list.count; k++)
        if (!own->list.entry[k].gone && !is_among(but, own->list.entry[k].name))
            TRY(spare_input(own, own->list.entry[k].name));
    return STATUS_OK;
}

enum status mf_tracked_files_check(struct tracked_files *own, const char *const *but) {
    for (size_t k = 0; k < own->list.count; k++) {
        const struct manifest_entry *entry = &own->list.entry[k];
        if (!entry->gone && !mf_tracked_file_is_folder(entry->name) && !is_among(but, entry->name))
            TRY(check_replaced(own, entry->name, entry));
    }
    return STATUS_OK;
}

enum status mf_tracked_files_reserve(struct tracked_files *own, const char *name) {
    if (!mf_tracked_file_is_folder(name))
        return check_replaced(own, name, mf_manifest_find(&own->list, name));
    if (!mf_tracked_file_is_link(own->list.place, name))
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT, "%s/%.*s is a link, and links are not followed",
                          own->folder, (int)strlen(name) - 1, name);
}

// From one run to the next ------------------------------------------------------------------------

enum status mf_tracked_files_begin(struct tracked_files *own, uint64_t digest) {
    TRY(mf_manifest_begin(&own->list, digest));
    own->begun = true;
    return STATUS_OK;
}

/// What an earlier run left, if nobody has changed it meanwhile.
static enum status remove_earlier(struct tracked_files *own, struct manifest_entry *entry,
                                  bool folder) {
    const int place = own->list.place;
    if (entry->gone || !entry->earlier || entry->claimed ||
        mf_tracked_file_is_folder(entry->name) != folder)
        return STATUS_OK;
    const enum tracked_file_state found = mf_tracked_file_state(place, entry->name, entry);
    if (!folder && (found == TRACKED_FILE_FOLDER || (found == TRACKED_FILE_OTHER && !own->force)))
        return STATUS_OK;
    const int error = mf_tracked_file_remove(place, entry->name);
    entry->gone = error == 0 || error == ENOENT || error == ENOTDIR || error == ELOOP; // a link
    if (entry->gone || folder)
        return STATUS_OK;
    return mf_status_fail(STATUS_IO, "%s/%s: %s", own->folder, entry->name, strerror(error));
}

enum status mf_tracked_files_remove_earlier(struct tracked_files *own) {
    struct manifest *list = &own->list;
    mf_tracked_file_remove_partial(&own->list);
    for (int folders = 0; folders < 2; folders++)
        for (size_t k = list->count; k-- > 0;) // a folder came before those in it
            TRY(remove_earlier(own, &list->entry[k], folders));
    own->begun = false;
    mf_manifest_compact(list);
    return STATUS_OK;
}

enum status mf_tracked_files_resume(struct tracked_files *own, uint64_t digest) {
    bool earlier = false;
    for (size_t k = 0; k < own->list.count; k++)
        earlier = earlier || (own->list.entry[k].earlier && !own->list.entry[k].gone);
    if (earlier && own->list.began != digest)
        TRY(mf_manifest_keep(&own->list));
    else if (earlier)
        return mf_tracked_files_remove_earlier(own);
    mf_tracked_file_remove_partial(&own->list);
    return STATUS_OK;
}

enum status mf_tracked_files_adopt(struct tracked_files *own, const char *name) {
    struct manifest *list = &own->list;
    struct manifest_entry *entry = mf_manifest_find(list, name);
    int64_t bytes = max_read;
    if (entry && mf_tracked_file_state(list->place, name, entry) == TRACKED_FILE_AS_LEFT)
        return STATUS_OK;
    if (entry == NULL)
        TRY(mf_manifest_add(list, name, &entry));
    mf_tracked_file_seal(list->place, entry, &bytes);
    return mf_manifest_enter(list, &entry, 1);
}

/// Tell the list how the files were left that this process has written. Where that fails, their
/// names are known alone.
static bool seal(struct tracked_files *own) {
    struct manifest *list = &own->list;
    struct manifest_entry **entry = mf_memory_zeroed(list->count + 1, sizeof *entry);
    int64_t bytes = max_read;
    size_t count = 0;
    bool left = false;
    for (size_t k = list->count; entry && k-- > 0;) {
        if (list->entry[k].claimed && !mf_tracked_file_is_folder(list->entry[k].name)) {
            if (!list->entry[k].gone)
                mf_tracked_file_seal(list->place, &list->entry[k], &bytes);
            entry[count++] = &list->entry[k];
        }
        left = left || !list->entry[k].gone;
    }
    const bool entered = entry && mf_manifest_enter(list, entry, count) == STATUS_OK;
    mf_memory_free(entry);
    return left || !entered;
}

static void forget(struct tracked_files *own) {
    mf_process_lock();
    struct tracked_files **link = &all;
    while (*link && *link != own)
        link = &(*link)->next;
    if (*link)
        *link = own->next;
    mf_process_unlock();
    close(own->list.place);
    mf_manifest_clear(&own->list);
    own->open = false;
}

void mf_tracked_files_close(struct tracked_files *own) {
    char message[STATUS_MESSAGE_SIZE]; // of why it is closed
    if (!own->open)
        return;
    snprintf(message, sizeof message, "%s", mf_status_message());
    if (own->begun && mf_manifest_keep(&own->list) != STATUS_OK)
        own->begun = false;
    if (!seal(own) && own->made && own->alone) {
        unlinkat(own->list.place, own->list.name, 0);
        rmdir(own->folder);
    }
    forget(own);
    mf_status_fail(STATUS_OK, "%s", message);
}

void mf_tracked_files_remove_all(struct tracked_files *own) {
    struct manifest *list = &own->list;
    mf_tracked_file_remove_partial(&own->list);
    for (int folders = 0; folders < 2; folders++)
        for (size_t k = list->count; k-- > 0;)
            if (!list->entry[k].gone && mf_tracked_file_is_folder(list->entry[k].name) == folders)
                mf_tracked_file_remove(list->place, list->entry[k].name);
    unlinkat(list->place, list->name, 0);
    rmdir(own->folder); // unless there is something else in it
    forget(own);
}

// By their paths ----------------------------------------------------------------------------------

/// The name that a path has in a folder, or NULL if it is not in it.
static const char *name_in(const struct tracked_files *own, const char *path) {
    const size_t length = strlen(own->folder);
    if (length == 0 || strncmp(path, own->folder, length) != 0)
        return NULL;
    path += length;
    return *path == '/' || *path == '\0' || path[-1] == '/' ? path + strspn(path, "/") : NULL;
}

/// The innermost folder that is open.
static struct tracked_files *find(const char *path, const char **name) {
    struct tracked_files *found = NULL;
    *name = NULL;
    for (struct tracked_files *own = all; own; own = own->next) {
        const char *in = name_in(own, path);
        if (in && (found == NULL || in > *name)) {
            found = own;
            *name = in;
        }
    }
    return found;
}

/// Read the list once more: another process may have entered something.
static enum status read_again(struct manifest *list) {
    struct manifest now = *list;
    now.file = -1;
    now.entry = NULL;
    now.number = NULL;
    now.count = now.capacity = 0;
    const enum status status = mf_manifest_read(&now);
    for (size_t k = 0; status == STATUS_OK && k < list->count; k++) {
        struct manifest_entry *same = mf_manifest_find(&now, list->entry[k].name);
        if (same && list->entry[k].claimed) {
            same->claimed = true;
            same->digested = false;
            same->bytes = -1;
        }
    }
    mf_manifest_clear(list);
    *list = now;
    return status;
}

static enum status find_entry(struct tracked_files *own, const char *name,
                              struct manifest_entry **entry) {
    struct manifest *list = &own->list;
    *entry = mf_manifest_find(list, name);
    if (*entry || mf_tracked_file_state(list->place, name, NULL) == TRACKED_FILE_ABSENT)
        return STATUS_OK;
    TRY(read_again(list));
    *entry = mf_manifest_find(list, name);
    return STATUS_OK;
}

static enum status claim(struct tracked_files *own, const char *name) {
    struct manifest_entry *entry;
    TRY(check_place(own));
    if (!mf_manifest_accepts(name))
        return mf_status_fail(STATUS_BAD_INPUT, "%s: not a valid file name: \"%s\"", own->folder,
                              name);
    TRY(find_entry(own, name, &entry));
    if (entry && entry->claimed)
        return STATUS_OK;
    if (!mf_tracked_file_is_folder(name))
        TRY(check_replaced(own, name, entry));
    TRY(mf_manifest_add(&own->list, name, &entry));
    entry->claimed = true;
    return mf_manifest_enter(&own->list, &entry, 1);
}

enum status mf_tracked_files_claim(const char *path, bool later) {
    const char *name;
    enum status status = STATUS_OK;
    mf_process_lock();
    struct tracked_files *own = find(path, &name);
    if (own) {
        own->list.later = later;
        status = claim(own, name);
        own->list.later = false;
    }
    mf_process_unlock();
    return status;
}

void mf_tracked_files_remove(const char *path) {
    const char *name;
    if (!ranks_lead())
        return;
    mf_process_lock();
    struct tracked_files *own = find(path, &name);
    struct manifest_entry *entry = own ? mf_manifest_find(&own->list, name) : NULL;
    if (own == NULL)
        unlink(path);
    else if (entry && (entry->claimed ||
                       mf_tracked_file_state(own->list.place, name, entry) == TRACKED_FILE_AS_LEFT))
        entry->gone = mf_tracked_file_remove(own->list.place, name) == 0 || entry->gone;
    mf_process_unlock();
}

/// @param[in] name  with / at its end
static enum status make_one(struct tracked_files *own, const char *name) {
    const int place = own->list.place, length = (int)strlen(name) - 1;
    struct stat about;
    TRY(mf_tracked_files_reserve(own, name));
    if (mf_tracked_file_state(place, name, NULL) == TRACKED_FILE_ABSENT) {
        TRY(claim(own, name));
        if (mkdirat(place, name, 0777) != 0 && errno != EEXIST)
            return mf_status_fail(STATUS_IO, "cannot make folder %s/%.*s: %s", own->folder, length,
                                  name, strerror(errno));
    }
    if (fstatat(place, name, &about, AT_SYMLINK_NOFOLLOW) == 0 && S_ISDIR(about.st_mode))
        return STATUS_OK;
    return mf_status_fail(STATUS_IO, "cannot make folder %s/%.*s: it is not a folder", own->folder,
                          length, name);
}

static enum status make_all(struct tracked_files *own, const char *name) {
    char folder[OUTPUT_PATH_SIZE];
    size_t length = 0;
    TRY(check_place(own));
    while (name[length]) {
        length += strcspn(name + length, "/");
        snprintf(folder, sizeof folder, "%.*s/", (int)length, name);
        TRY(make_one(own, folder));
        length += strspn(name + length, "/");
    }
    return STATUS_OK;
}

enum status mf_tracked_files_make_folder(const char *path, bool *done) {
    const char *name;
    mf_process_lock();
    struct tracked_files *own = find(path, &name);
    *done = own != NULL;
    const enum status status = own ? make_all(own, name) : STATUS_OK;
    mf_process_unlock();
    return status;
}
