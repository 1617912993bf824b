/// \file scene.h
/// Scenes from YAML files and back.
#ifndef SCREE_SCENE_H
#define SCREE_SCENE_H

#include "scree/types.h"

#ifdef __cplusplus
extern "C"
{
#endif

    /// Owns a scene, its text with every default filled in, and the folder its files are relative to. Start from {0}.
    typedef struct scree_scene_file
    {
        scree_scene scene;
        char *text;   ///< YAML with every default and override filled in, mesh files by their whole paths
        char *folder; ///< folder of the file
        void *owned;  ///< internal
    } scree_scene_file;

    /// Reads a scene. `overrides` is (num_overrides) texts "a.b.c=value"; list items by index ("materials.0.density")
    /// or by name ("materials.rock.density"). All faults go to the report at once: file, line, key, value, what is
    /// allowed, what to do. SCREE_NOT_FOUND, SCREE_READ_FAILED, SCREE_INVALID_INPUT.
    scree_status scree_scene_read(scree_scene_file *file, const char *path, const char *const *overrides,
                                  int num_overrides, scree_report *report);
    /// The same from a text; `path` names it in messages, its folder is where mesh files are looked for.
    scree_status scree_scene_parse(scree_scene_file *file, const char *text, const char *path,
                                   const char *const *overrides, int num_overrides, scree_report *report);
    void scree_scene_close(scree_scene_file *file);

    /// The reference of all keys (name, unit, default, range, meaning) for --help and the manual, written to `stream`
    /// (a FILE *).
    void scree_scene_print_keys(void *stream);

#ifdef __cplusplus
}
#endif
#endif
