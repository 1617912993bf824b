/// \file scene_file.c
/// Scenes from YAML. libyaml finds values and lines, the values of the command line are put in, the tree is checked
/// against the tables of keys and the rules between them, and what has passed is written out with every default: from
/// that text libcyaml fills the structures, and it is kept, with mesh files by their whole paths.
#define _XOPEN_SOURCE 700 /* realpath */
#include "scree/scene.h"

#include "io/run_folder.h"
#include "io/scene_reader.h"

#include <errno.h>
#include <locale.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/// Room for a scene of hundreds of thousands of bodies with every default filled in; more is a slip.
#define MAX_FILE_SIZE (64 * 1024 * 1024)

static const cyaml_config_t cyaml_settings = {.mem_fn = cyaml_mem, .flags = CYAML_CFG_DEFAULT};

/// Folder of a path: "." for a plain name.
static char *folder_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    const size_t length = slash == NULL ? 1 : slash == path ? 1 : (size_t)(slash - path);
    char *folder = malloc(length + 1);
    if (folder == NULL) return NULL;
    memcpy(folder, slash == NULL ? "." : path, length);
    folder[length] = '\0';
    return folder;
}

/// Mesh files by their whole paths, so that the text is the same scene in any folder. A file that is not there is left
/// as it is: the maker of shapes tells.
static scree_status resolve_mesh_files(const scree_scene_file *file, scree_scene_reader *reader)
{
    const scree_yaml_node *shapes = scree_yaml_find(reader->root, "shapes");
    for (int64_t k = 0; shapes != NULL && k < shapes->num_items; ++k)
    {
        scree_yaml_node *mesh = scree_yaml_find(shapes->items[k], "file");
        if (mesh == NULL || mesh->text[0] == '\0' || mesh->text[0] == '/') continue;
        char *path = scree_path_join(file->folder, mesh->text);
        char *whole = path == NULL ? NULL : realpath(path, NULL);
        const scree_yaml_node *copy = whole == NULL ? NULL : scree_yaml_add(&reader->tree, SCREE_YAML_SCALAR, whole);
        const bool is_complete = path != NULL && (whole == NULL || copy != NULL);
        free(path);
        free(whole);
        if (!is_complete) return SCREE_OUT_OF_MEMORY;
        if (copy == NULL) continue;
        mesh->text = copy->text;
        mesh->is_quoted = true;
    }
    return SCREE_OK;
}

/// Structures and text from a tree without faults.
static scree_status load(scree_scene_file *file, scree_scene_reader *reader)
{
    char *numbers = NULL;
    size_t length = 0, num_numbers = 0;
    scree_scene *scene = NULL;
    scree_status status = scree_yaml_write(reader->root, true, &numbers, &num_numbers);
    if (status == SCREE_OK) status = resolve_mesh_files(file, reader);
    if (status == SCREE_OK) status = scree_yaml_write(reader->root, false, &file->text, &length);
    if (status == SCREE_OK)
    {
        const cyaml_err_t fault = cyaml_load_data((const uint8_t *)numbers, num_numbers, &cyaml_settings,
                                                  scree_scene_root_value(), (cyaml_data_t **)&scene, NULL);
        // the text was made by libyaml itself, so nothing but a lack of memory makes libyaml refuse it
        if (fault == CYAML_ERR_OOM || fault == CYAML_ERR_LIBYAML_PARSER || fault == CYAML_ERR_LIBYAML_PARSER_INIT)
            status = SCREE_OUT_OF_MEMORY;
        else if (fault != CYAML_OK)
        {
            scree_report_add(reader->report, "%.600s: libcyaml refuses the checked scene: %s; please report this",
                             reader->path, cyaml_strerror(fault));
            status = SCREE_INVALID_INPUT;
        }
    }
    free(numbers);
    if (status != SCREE_OK) return status;
    file->owned = scene;
    file->scene = *scene;
    return SCREE_OK;
}

/// Everything between the text and the structures.
static scree_status read_text(scree_scene_file *file, scree_scene_reader *reader, const scree_yaml_text *text,
                              int num_overrides)
{
    scree_status status = scree_yaml_parse(&reader->tree, text, &reader->root, reader->report);
    if (status != SCREE_OK) return status;
    if (reader->root == NULL || scree_yaml_is_null(reader->root))
    {
        scree_report_add(reader->report,
                         "%.600s: there is nothing in it; the smallest scene is \"time: {end: 1, step: 1e-4}\"",
                         reader->path);
        return SCREE_INVALID_INPUT;
    }
    for (int k = 0; k < num_overrides && !reader->is_exhausted; ++k) scree_scene_override(reader, k);
    if (!reader->is_exhausted) scree_scene_check(reader);
    if (!reader->is_exhausted) scree_scene_check_rules(reader);
    if (reader->is_exhausted) return SCREE_OUT_OF_MEMORY;
    if (reader->num_faults > SCREE_SCENE_MAX_TOLD)
        scree_report_add(reader->report, "%.600s: %d more faults", reader->path,
                         reader->num_faults - SCREE_SCENE_MAX_TOLD);
    if (reader->num_faults > 0) return SCREE_INVALID_INPUT;
    return load(file, reader);
}

static scree_status parse(scree_scene_file *file, const scree_yaml_text *text, const char *const *overrides,
                          int num_overrides, scree_report *report)
{
    *file = (scree_scene_file){0};
    scree_scene_reader reader = {.path = text->name, .overrides = overrides, .report = report};
    // numbers have a point, whatever the language of the program around us
    const locale_t plain = newlocale(LC_NUMERIC_MASK, "C", (locale_t)0);
    if (plain == (locale_t)0) return SCREE_OUT_OF_MEMORY;
    const locale_t before = uselocale(plain);
    file->folder = folder_of(text->name);
    scree_status status = file->folder == NULL ? SCREE_OUT_OF_MEMORY : read_text(file, &reader, text, num_overrides);
    uselocale(before);
    freelocale(plain);
    scree_yaml_tree_destroy(&reader.tree);
    if (status == SCREE_OUT_OF_MEMORY) scree_report_add(report, "%.600s: %s", text->name, scree_status_text(status));
    if (status != SCREE_OK) scree_scene_close(file);
    return status;
}

scree_status scree_scene_parse(scree_scene_file *file, const char *text, const char *path, const char *const *overrides,
                               int num_overrides, scree_report *report)
{
    const scree_yaml_text all = {path, text, strlen(text), 0};
    return parse(file, &all, overrides, num_overrides, report);
}

/// The whole file in fresh memory, refused if it cannot be a scene.
static scree_status read_file(const char *path, char **text, size_t *length, scree_report *report)
{
    struct stat about;
    FILE *stream = NULL;
    errno = 0;
    if (stat(path, &about) != 0 || (!S_ISDIR(about.st_mode) && (stream = fopen(path, "rb")) == NULL))
    {
        const bool is_missing = errno == ENOENT || errno == ENOTDIR;
        scree_report_add(report, "%.600s: %s; the scene is a YAML file", path,
                         is_missing ? "there is no such file" : strerror(errno));
        return is_missing ? SCREE_NOT_FOUND : SCREE_READ_FAILED;
    }
    if (stream == NULL)
    {
        scree_report_add(report, "%.600s: this is a folder; name the YAML file in it", path);
        return SCREE_READ_FAILED;
    }
    char *all = NULL;
    size_t num = 0, size = 0;
    for (bool is_done = false; !is_done && num <= MAX_FILE_SIZE;)
    {
        size = size == 0 ? 1 << 16 : 2 * size;
        char *grown = realloc(all, size);
        if (grown == NULL)
        {
            free(all);
            fclose(stream);
            return SCREE_OUT_OF_MEMORY;
        }
        all = grown;
        num += fread(all + num, 1, size - num, stream);
        is_done = num < size;
    }
    const bool is_broken = ferror(stream) != 0;
    fclose(stream);
    if (!is_broken && num <= MAX_FILE_SIZE)
    {
        *text = all;
        *length = num;
        return SCREE_OK;
    }
    free(all);
    if (is_broken) scree_report_add(report, "%.600s: reading failed", path);
    else
        scree_report_add(report,
                         "%.600s: the file has more than %d MB, too much for a scene; fill a region with particles "
                         "instead of listing them in bodies",
                         path, MAX_FILE_SIZE / (1024 * 1024));
    return is_broken ? SCREE_READ_FAILED : SCREE_INVALID_INPUT;
}

scree_status scree_scene_read(scree_scene_file *file, const char *path, const char *const *overrides, int num_overrides,
                              scree_report *report)
{
    *file = (scree_scene_file){0};
    char *text = NULL;
    size_t length = 0;
    scree_status status = read_file(path, &text, &length, report);
    if (status != SCREE_OK) return status;
    const scree_yaml_text all = {path, text, length, 0};
    status = parse(file, &all, overrides, num_overrides, report);
    free(text);
    return status;
}

void scree_scene_close(scree_scene_file *file)
{
    if (file->owned != NULL) cyaml_free(&cyaml_settings, scree_scene_root_value(), file->owned, 0);
    free(file->text);
    free(file->folder);
    *file = (scree_scene_file){0};
}
