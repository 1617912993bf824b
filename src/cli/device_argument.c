#include "cli/device_argument.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

bool scree_parse_device(const char *text, int32_t *number)
{
    *number = -1;
    if (strcmp(text, "cpu") == 0) return true;
    if (strncmp(text, "cuda", 4) != 0) return false;
    *number = 0;
    if (text[4] == '\0') return true;
    if (text[4] != ':' || text[5] < '0' || text[5] > '9') return false;
    char *end;
    errno = 0;
    const long parsed = strtol(text + 5, &end, 10);
    if (errno != 0 || *end != '\0' || parsed > 1023) return false;
    *number = (int32_t)parsed;
    return true;
}

scree_status scree_open_device(int32_t number, scree_device **device, scree_report *report)
{
    *device = NULL;
    if (number < 0) return SCREE_OK;
    scree_device_def def = scree_default_device_def();
    def.number = number;
    def.arena_bytes = (int64_t)16 << 20; // the share of the scene is taken once it is known
    return scree_device_open(device, &def, report);
}
