/// \file status.c
/// Texts of the status codes and the collected messages of a report. A message for whose text there is no memory is
/// still counted, with a text that says so; only if there is none for its pointer either is it dropped.
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scree/base.h"

static const char warning_prefix[] = "warning: ";
/// Stands in for a message for which there was no memory. Never freed.
static char lost_message[] = "a message was lost: there is not enough memory";

const char *scree_status_text(scree_status status)
{
    switch (status)
    {
#define STATUS_CASE(name, value, text) \
    case name:                         \
        return text;
        SCREE_STATUS_LIST(STATUS_CASE)
#undef STATUS_CASE
    }
    return "unknown status";
}

/// Prefix and formatted text in fresh memory; lost_message if there is none or the format is bad.
static char *message_text(const char *prefix, const char *format, va_list arguments)
{
    va_list copy;
    va_copy(copy, arguments);
    const int length = vsnprintf(NULL, 0, format, copy);
    va_end(copy);
    if (length < 0) return lost_message;
    const size_t num_prefix = strlen(prefix);
    char *text = malloc(num_prefix + (size_t)length + 1);
    if (text == NULL) return lost_message;
    memcpy(text, prefix, num_prefix);
    vsnprintf(text + num_prefix, (size_t)length + 1, format, arguments);
    return text;
}

/// Room for one more pointer; false if there is no memory for it.
static bool make_room(scree_report *report)
{
    if (report->num_messages < report->max_messages) return true;
    if (report->max_messages > INT_MAX / 2) return false;
    const int max_messages = report->max_messages < 8 ? 8 : 2 * report->max_messages;
    char **messages = realloc(report->messages, (size_t)max_messages * sizeof *messages);
    if (messages == NULL) return false;
    report->messages = messages;
    report->max_messages = max_messages;
    return true;
}

static void add_message(scree_report *report, const char *prefix, const char *format, va_list arguments)
{
    if (report == NULL || !make_room(report)) return;
    report->messages[report->num_messages++] = message_text(prefix, format, arguments);
    if (prefix[0] != '\0') ++report->num_warnings;
}

void scree_report_add(scree_report *report, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    add_message(report, "", format, arguments);
    va_end(arguments);
}

void scree_report_warn(scree_report *report, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    add_message(report, warning_prefix, format, arguments);
    va_end(arguments);
}

int scree_report_num_faults(const scree_report *report)
{
    return report == NULL ? 0 : report->num_messages - report->num_warnings;
}

void scree_report_clear(scree_report *report)
{
    if (report == NULL) return;
    for (int i = 0; i < report->num_messages; ++i)
        if (report->messages[i] != lost_message) free(report->messages[i]);
    free(report->messages);
    memset(report, 0, sizeof *report);
}
