/// \file test_folder.h
/// Folders for the files of a test. All of a process are in one, which goes when it ends; what a killed one has left
/// goes when the next begins. Needs _XOPEN_SOURCE 700.
#ifndef SCREE_TEST_FOLDER_H
#define SCREE_TEST_FOLDER_H

#include "harness.h"

#include <dirent.h>
#include <errno.h>
#include <ftw.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

static inline int scree_test_remove_one(const char *path, const struct stat *info, int kind, struct FTW *place)
{
    (void)info;
    (void)kind;
    (void)place;
    return remove(path);
}

static inline int scree_test_remove_tree(const char *path)
{
    return nftw(path, scree_test_remove_one, 16, FTW_DEPTH | FTW_PHYS);
}

/// Removes what processes that are no more have left in `base`.
static inline void scree_test_remove_left(const char *base)
{
    DIR *entries = opendir(base);
    for (struct dirent *entry; entries != NULL && (entry = readdir(entries)) != NULL;)
    {
        char path[600], rest;
        long process;
        if (sscanf(entry->d_name, "scree_test_%ld%c", &process, &rest) != 1 || process <= 0) continue;
        snprintf(path, sizeof path, "%.250s/%s", base, entry->d_name);
        if (process == (long)getpid() || (kill((pid_t)process, 0) != 0 && errno == ESRCH)) scree_test_remove_tree(path);
    }
    if (entries != NULL) closedir(entries);
}

static char scree_test_base_folder[300];

static inline void scree_test_remove_folders(void)
{
    if (scree_test_remove_tree(scree_test_base_folder) != 0) perror(scree_test_base_folder);
}

/// A fresh folder. The text is overwritten by the next call.
static inline const char *scree_test_folder(void)
{
    static char path[400];
    static int num_folders = 0;
    if (num_folders == 0)
    {
        const char *base = getenv("TMPDIR");
        // files in memory spare the waiting for the disk
        if (base == NULL) base = access("/dev/shm", W_OK) == 0 ? "/dev/shm" : "/tmp";
        scree_test_remove_left(base);
        snprintf(scree_test_base_folder, sizeof scree_test_base_folder, "%.250s/scree_test_%ld", base, (long)getpid());
        SCREE_CHECK(mkdir(scree_test_base_folder, 0777) == 0);
        SCREE_CHECK(atexit(scree_test_remove_folders) == 0);
    }
    snprintf(path, sizeof path, "%s/%d", scree_test_base_folder, num_folders++);
    SCREE_CHECK(mkdir(path, 0777) == 0);
    return path;
}

#endif
